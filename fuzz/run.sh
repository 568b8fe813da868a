#!/bin/sh
# Fuzzes TARGET (scene or store) for SECONDS: fuzz/run.sh TARGET SECONDS. Starts from the shipped scenes and a stored
# solution; what is found lies in fuzz/artifacts, the corpus in fuzz/corpus.
set -eu
cd "$(dirname "$0")"
target=$1
seconds=$2
corpus=corpus/$target
mkdir -p "$corpus"
case $target in
scene) cp ../scenes/*.toml ../scenes/*/*.toml "$corpus" ;;
store)
    # the first byte chooses the file: see fuzz_targets/store.rs (6 = history.csv, 5 = summary.json, 7 = provenance.json)
    for entry in ../fem_reference/solutions/scaled-plate-*/coarse; do
        name=$(basename "$(dirname "$entry")")
        { printf '\006'; head -20 "$entry/history.csv"; } > "$corpus/$name-history"
        { printf '\005'; cat "$entry/summary.json"; } > "$corpus/$name-summary"
        { printf '\007'; cat "$entry/provenance.json"; } > "$corpus/$name-provenance"
        { printf '\004'; cat "$entry/checksums.sha256"; } > "$corpus/$name-checksums"
    done
    ;;
*) echo "unknown target $target: scene or store" >&2; exit 2 ;;
esac
host=$(rustc -vV | sed -n 's/^host: //p')
# as cargo-fuzz does it, without an address sanitizer: the stable toolchain is enough
RUSTFLAGS="--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
-Cllvm-args=-sanitizer-coverage-trace-compares" cargo build --release --target "$host" --bin "$target"
mkdir -p artifacts
exec "target/$host/release/$target" "$corpus" -max_total_time="$seconds" -max_len=8192 -timeout=20 \
    -artifact_prefix="artifacts/$target-" -print_final_stats=1
