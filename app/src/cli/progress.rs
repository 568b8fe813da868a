//! A progress bar on standard error for what takes longer than a moment; silent when nobody watches.

use super::Context;
use crate::reference::Progress;
use crate::sweep;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, OnceLock, mpsc};
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
pub struct Bar {
    bar: ProgressBar,
    context: Context,
    begun: Arc<Begun>,
}

/// Where the work began whose rate shows the time left: in a thousandth of all, and after so many milliseconds. The rate is the mean one:
/// that of the last seconds says little where meshing, stepping and waiting for a contact to end take turns.
#[derive(Default)]
struct Begun(OnceLock<[u64; 2]>);

impl Begun {
    /// The time left, if something has been done since.
    fn left(&self, state: &ProgressState) -> Option<Duration> {
        let [place, time] = *self.0.get()?;
        let done = state.pos().checked_sub(place).filter(|done| *done > 0)?;
        let spent = state.elapsed().saturating_sub(Duration::from_millis(time));
        let rest = WHOLE.saturating_sub(state.pos());
        Some(spent.mul_f64(rest as f64 / done as f64))
    }
}

/// Length of the bar.
const WHOLE: u64 = 1000;

/// The phases of a solver's messages: what is to be read and kept, whatever the run does; and the steps in time.
const NOTE: &str = "note";
const STEPPING: &str = "stepping";

impl Bar {
    /// A bar titled `title`; hidden when the context is quiet or standard error is no terminal.
    pub fn new(context: &Context, title: &str) -> Self {
        let bar = ProgressBar::new(WHOLE);
        if context.quiet {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        let begun = Arc::<Begun>::default();
        let template = "{prefix} {bar:30} {percent:>3} % {msg} [{elapsed}, {left} left]";
        if let Ok(style) = ProgressStyle::with_template(template) {
            let begun = begun.clone();
            let left = move |state: &ProgressState, out: &mut dyn Write| {
                let _ = match begun.left(state) {
                    Some(left) => write!(out, "{:#}", HumanDuration(left)),
                    None => write!(out, "?"),
                };
            };
            bar.set_style(style.with_key("left", left));
        }
        bar.set_prefix(title.to_owned());
        Self { bar, context: context.clone(), begun }
    }

    /// Goes to a `share` of all, 0 to 1.
    fn go_to(&self, share: f64) {
        self.bar.set_position((WHOLE as f64 * share.clamp(0.0, 1.0)) as u64);
    }

    /// Begins the work here, unless it has begun.
    fn begin(&self) {
        self.begun.0.get_or_init(|| [self.bar.position(), self.bar.elapsed().as_millis() as u64]);
    }

    /// Shows how far the solution is; a note stays.
    pub fn show(&self, progress: &Progress) {
        if progress.phase == NOTE {
            return self.bar.suspend(|| self.context.note(&progress.message));
        }
        // of several meshes the bar shows all together, and the time left is that of all
        let share = progress.series.unwrap_or(progress.done);
        let Progress { phase, message, done, .. } = progress;
        self.bar.set_message(match progress.series {
            Some(_) => format!("{message} ({phase}, {:.0} %)", 100.0 * done),
            None => format!("{phase}: {message}"),
        });
        self.go_to(share);
        // a resumed run is back at its place by then
        if phase == STEPPING {
            self.begin();
        }
    }

    /// Shows the part of a set-up that is being done; `done` is the share before it, 0 to 1.
    pub fn part(&self, part: &'static str, done: f64) {
        self.bar.set_message(part);
        self.go_to(done);
        self.begin();
        // the next call may be seconds away
        self.bar.enable_steady_tick(Duration::from_millis(200));
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
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
