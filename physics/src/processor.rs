//! A sentence instead of a crash on a processor without the instructions that the program was compiled with (`.cargo/config.toml`).

use std::arch::x86_64::{__cpuid, __cpuid_count};
use std::io::Write;

const MESSAGE: &[u8] =
    b"error: impactcheck needs a processor with the instructions AVX2 and FMA, and this one has none. Build it \
    for this one: RUSTFLAGS=\"-C target-cpu=x86-64\" cargo build --release\n";
/// Exit status of wrong usage.
const USAGE: i32 = 2;

/// Called by the loader before any other code of the program or of a library that holds it.
#[used]
#[cfg_attr(target_os = "linux", unsafe(link_section = ".init_array"))]
#[cfg_attr(target_vendor = "apple", unsafe(link_section = "__DATA,__mod_init_func"))]
#[cfg_attr(windows, unsafe(link_section = ".CRT$XCU"))]
static AT_START: extern "C" fn() = check;

/// Ends the process with a message if instructions are missing. It uses none of them itself: no formatting, no copies.
extern "C" fn check() {
    if !has_instructions() {
        let _ = std::io::stderr().write_all(MESSAGE);
        std::process::exit(USAGE);
    }
}

/// Asks the processor: the standard library would repeat what the compiler was told.
#[allow(unused_unsafe, reason = "safe in newer Rust")]
fn has_instructions() -> bool {
    let has = |register: u32, bit: u32| register & (1 << bit) != 0;
    // SAFETY: every x86-64 processor has the instruction
    let [leaves, basic, extended] = unsafe { [__cpuid(0).eax, __cpuid(1).ecx, __cpuid_count(7, 0).ebx] };
    if leaves < 7 {
        return false;
    }
    let (fma, registers_are_kept, avx2) = (has(basic, 12), has(basic, 27), has(extended, 5));
    fma && registers_are_kept && avx2
}
