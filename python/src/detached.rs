//! Work without the interpreter's lock that Ctrl-C ends.

use pyo3::prelude::*;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::{Builder, scope};
use std::time::Duration;

/// How often signals are looked for.
const INTERVAL: Duration = Duration::from_millis(50);
/// Of a program's first thread on most systems.
const STACK: usize = 8 << 20;

/// What `job` gives; other threads of the interpreter go on meanwhile. After an interruption `stop` is to make it end soon.
///
/// # Errors
/// What a handler of signals raises, such as `KeyboardInterrupt`; what the system says if there are no more threads.
pub fn detached<T: Send>(py: Python, stop: impl Fn() + Sync, job: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| {
        scope(|scope| {
            let (done, wait) = channel::<()>();
            let work = move || {
                // gone with the thread's work, however that ends
                let _done = done;
                job()
            };
            let worker = Builder::new().stack_size(STACK).spawn_scoped(scope, work)?;
            let mut heard = Ok(());
            while wait.recv_timeout(INTERVAL) == Err(RecvTimeoutError::Timeout) {
                if let (Ok(()), Err(interruption)) = (&heard, Python::attach(|py| py.check_signals())) {
                    stop();
                    heard = Err(interruption);
                }
            }
            let result = worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            heard.map(|()| result)
        })
    })
}
