//! The reduced models in a web page: a scene, open to other numbers, and what the models give for them.
//!
//! Compiled to WebAssembly it reads no file and starts nothing. The page sends requests in JSON and gets answers in JSON, through three functions.

#![warn(missing_docs)]

mod curves;
mod flown;
mod page;
mod request;

pub use page::LivePage;
pub use request::PageRequest;

use std::cell::RefCell;

/// What sources the models are of: a program embeds no models of others, which would give other results than its own.
#[used]
#[unsafe(no_mangle)]
pub static SOURCES: &[u8] = impactcheck_embedded::sources!();

thread_local! {
    static PAGE: RefCell<LivePage> = RefCell::new(LivePage::default());
    static TEXT: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Address of room for a request of so many `bytes`, which the page writes there.
#[unsafe(no_mangle)]
pub extern "C" fn room(bytes: usize) -> *mut u8 {
    TEXT.with_borrow_mut(|text| {
        *text = vec![0; bytes];
        text.as_mut_ptr()
    })
}

/// Answers the request that stands in [`room`], where the answer then stands; returns its length in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> usize {
    let request = TEXT.take();
    let answer = PAGE.with_borrow_mut(|page| page.answer(&request)).into_bytes();
    let length = answer.len();
    TEXT.set(answer);
    length
}

/// Address of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn answered() -> *const u8 {
    TEXT.with_borrow(|text| text.as_ptr())
}
