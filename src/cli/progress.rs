//! Progress on stderr, and the seconds of each step.

use super::interruption::is_interrupted;
use super::messages;
use crate::style::{Observer, Picture};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Shown after this much work.
const PATIENCE: Duration = Duration::from_millis(500);

/// Watches a style for the command line.
pub(super) struct Watcher {
    bar: ProgressBar,
    started: Instant,
    steps: Mutex<Vec<(String, Instant)>>,
}

impl Watcher {
    pub(super) fn new(is_quiet: bool) -> Self {
        let is_shown = !is_quiet && std::io::stderr().is_terminal();
        let target = if is_shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(100), target);
        if let Ok(style) = ProgressStyle::with_template("{msg:14} [{bar:30}] {elapsed}") {
            bar.set_style(style.progress_chars("=> "));
        }
        Self { bar, started: Instant::now(), steps: Mutex::new(Vec::new()) }
    }

    /// Ends the last step and gives the seconds of each.
    pub(super) fn finish(&self) -> Vec<(String, f64)> {
        self.bar.finish_and_clear();
        let mut steps = self.steps.lock().expect("no step panics while it holds the lock").clone();
        steps.push((String::new(), Instant::now()));
        steps.windows(2).map(|w| (w[0].0.clone(), (w[1].1 - w[0].1).as_secs_f64())).collect()
    }

    pub(super) fn elapsed(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }
}

impl Observer for Watcher {
    fn begin(&self, step: &str) {
        self.steps.lock().expect("no step panics while it holds the lock").push((step.to_owned(), Instant::now()));
        if self.started.elapsed() > PATIENCE {
            self.bar.set_message(step.to_owned());
            self.bar.set_position(0);
        }
    }

    fn progress(&self, fraction: f64) {
        if self.started.elapsed() > PATIENCE {
            self.bar.set_position((fraction * 100.0) as u64);
        }
    }

    fn picture(&self, _: &str, _: &dyn Fn() -> Picture) {}

    fn warn(&self, message: &str) {
        self.bar.suspend(|| messages::warn(message));
    }

    fn is_interrupted(&self) -> bool {
        is_interrupted()
    }
}
