//! A progress bar on standard error for what takes longer than a moment; silent when nobody watches.

use super::Context;
use crate::reference::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Bar over the phases of a reference solution.
pub struct Bar(ProgressBar);

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
        Self(bar)
    }

    /// Shows how far the solution is.
    pub fn show(&self, progress: &Progress) {
        self.0.set_message(format!("{}: {}", progress.phase, progress.message));
        self.0.set_position((1000.0 * progress.done.clamp(0.0, 1.0)) as u64);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
