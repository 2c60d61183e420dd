//! Progress of long work on stderr: a bar on a terminal, nothing in a pipe or with `--json`.

use crate::note::is_quiet;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal};

/// Steps of a full bar.
const STEPS: u64 = 1000;

/// A progress bar, or nothing.
pub(crate) struct Progress(Option<ProgressBar>);

impl Progress {
    /// Creates a bar for the work `what`.
    pub(crate) fn new(what: &str, json: bool) -> Self {
        if json || is_quiet() || !io::stderr().is_terminal() {
            return Self(None);
        }
        let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template("{prefix} [{bar:30}] {percent:>3} % {msg}")
        {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.set_prefix(what.to_owned());
        Self(Some(bar))
    }

    /// Shows the completed fraction and the current work.
    pub(crate) fn at(&self, fraction: f64, message: &str) {
        if let Some(bar) = &self.0 {
            // The cast saturates.
            bar.set_position((fraction * STEPS as f64) as u64);
            bar.set_message(message.to_owned());
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}
