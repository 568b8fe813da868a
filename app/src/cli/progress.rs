//! A progress bar on standard error for what takes longer than a moment; silent when nobody watches.

use super::Context;
use crate::reference::Progress;
use crate::sweep;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc;
use std::time::Duration;

/// How long a run goes on without a word.
const PATIENCE: Duration = Duration::from_secs(3);

/// Does `work`, and says on standard error that `what` is still at it when that takes longer than one expects.
pub fn watched<T>(context: &Context, what: &str, work: impl FnOnce() -> T) -> T {
    std::thread::scope(|scope| {
        let (working, end) = mpsc::channel::<()>();
        scope.spawn(move || {
            let mut after = PATIENCE;
            // the other end is dropped when the work is done
            while end.recv_timeout(after) == Err(mpsc::RecvTimeoutError::Timeout) {
                context.note(format_args!(
                    "{what}: still at work; a larger --tolerance or a `run.end_time` shortens it"
                ));
                after *= 4;
            }
        });
        let result = work();
        drop(working);
        result
    })
}

/// Bar over the phases of a reference solution.
pub struct Bar(ProgressBar, Context);

/// The phase of a solver's message that is to be read and kept, whatever the run does.
const NOTE: &str = "note";

impl Bar {
    /// A bar titled `title`; hidden when the context is quiet or standard error is no terminal.
    pub fn new(context: &Context, title: &str) -> Self {
        let bar = ProgressBar::new(1000);
        if context.quiet {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) =
            ProgressStyle::with_template("{prefix} {bar:30} {percent:>3} % {msg} [{elapsed}, {eta} left]")
        {
            bar.set_style(style);
        }
        bar.set_prefix(title.to_owned());
        Self(bar, context.clone())
    }

    /// Shows how far the solution is; a note stays.
    pub fn show(&self, progress: &Progress) {
        if progress.phase == NOTE {
            return self.0.suspend(|| self.1.note(&progress.message));
        }
        // of several meshes the bar shows all together, and the time left is that of all
        let share = progress.series.unwrap_or(progress.done);
        let Progress { phase, message, done, .. } = progress;
        self.0.set_message(match progress.series {
            Some(_) => format!("{message} ({phase}, {:.0} %)", 100.0 * done),
            None => format!("{phase}: {message}"),
        });
        self.0.set_position((1000.0 * share.clamp(0.0, 1.0)) as u64);
    }

    /// Shows the part of a set-up that is being done; `done` is the share before it, 0 to 1.
    pub fn part(&self, part: &'static str, done: f64) {
        self.0.set_message(part);
        self.0.set_position((1000.0 * done.clamp(0.0, 1.0)) as u64);
        // the next call may be seconds away
        self.0.enable_steady_tick(Duration::from_millis(200));
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// Bar over the points of a sweep; shared by threads.
pub struct Counter {
    bar: ProgressBar,
    /// Points of the shard, and how many were recorded by this run.
    counted: [AtomicUsize; 2],
}

impl Counter {
    /// A bar titled `title`; hidden when the context is quiet or standard error is no terminal.
    pub fn new(context: &Context, title: &str) -> Self {
        let bar = ProgressBar::new(0);
        if context.quiet {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) = ProgressStyle::with_template(
            "{prefix} {bar:30} {pos} of {len} [{elapsed}, {eta} left, {per_sec}]",
        ) {
            bar.set_style(style);
        }
        bar.set_prefix(title.to_owned());
        Self { bar, counted: Default::default() }
    }

    /// Shows how far the sweep is.
    pub fn show(&self, progress: sweep::Progress) {
        match progress {
            sweep::Progress::Start { points, done } => {
                self.counted[0].store(points, Relaxed);
                self.bar.set_length(points as u64);
                self.bar.set_position(done as u64);
                self.bar.reset_eta();
            }
            sweep::Progress::Recorded(count) => {
                self.counted[1].fetch_add(count, Relaxed);
                self.bar.inc(count as u64);
            }
        }
    }

    /// Takes the bar away and gives the points of the shard and how many were recorded.
    pub fn finish(self) -> (usize, usize) {
        self.bar.finish_and_clear();
        let [points, fresh] = self.counted;
        (points.into_inner(), fresh.into_inner())
    }
}
