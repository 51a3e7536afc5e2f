//! Progress on stderr, and the time of each step.

use super::interruption::is_interrupted;
use super::messages;
use crate::source::MaskRole;
use crate::style::{Observer, Picture};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Delay before the bar is shown.
const PATIENCE: Duration = Duration::from_millis(500);
/// Refresh interval of the bar's clock.
const TICK: Duration = Duration::from_millis(250);

/// The command line's observer of a style.
pub(super) struct Watcher {
    bar: ProgressBar,
    started: Instant,
    steps: Mutex<Vec<(String, Instant)>>,
    /// True if another program reads the progress: a line on stderr for each step.
    is_told: bool,
}

impl Watcher {
    pub(super) fn new(is_quiet: bool) -> Self {
        let bar = ProgressBar::with_draw_target(Some(100), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{msg:14} [{bar:30}] {elapsed}") {
            bar.set_style(style.progress_chars("=> "));
        }
        if !is_quiet && std::io::stderr().is_terminal() {
            show_later(bar.clone());
        }
        let is_told = std::env::var_os("DRYPOINT_PROGRESS").is_some_and(|manner| manner == "lines");
        Self { bar, started: Instant::now(), steps: Mutex::new(Vec::new()), is_told }
    }

    /// Ends the last step; returns the seconds of each step.
    pub(super) fn finish(&self) -> Vec<(String, f64)> {
        self.bar.finish_and_clear();
        let mut steps = self.steps.lock().unwrap_or_else(PoisonError::into_inner).clone();
        steps.push((String::new(), Instant::now()));
        steps.windows(2).map(|w| (w[0].0.clone(), (w[1].1 - w[0].1).as_secs_f64())).collect()
    }

    pub(super) fn elapsed(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }
}

/// Shows the bar after [`PATIENCE`] with the step then running, even if that step reports no progress.
fn show_later(bar: ProgressBar) {
    std::thread::spawn(move || {
        std::thread::sleep(PATIENCE);
        if !bar.is_finished() {
            bar.set_draw_target(ProgressDrawTarget::stderr());
            bar.enable_steady_tick(TICK);
        }
    });
}

impl Observer for Watcher {
    fn begin(&self, step: &str) {
        self.steps.lock().unwrap_or_else(PoisonError::into_inner).push((step.to_owned(), Instant::now()));
        if self.is_told {
            messages::say!("step: {step}");
        }
        self.bar.set_message(step.to_owned());
        self.bar.set_position(0);
    }

    fn progress(&self, fraction: f64) {
        self.bar.set_position((fraction * 100.0) as u64);
    }

    fn picture(&self, _: &str, _: &dyn Fn() -> Picture) {}

    fn warn(&self, message: &str) {
        self.bar.suspend(|| messages::warning_line(message));
    }

    fn want_mask(&self, role: MaskRole, message: &str) {
        self.warn(&format!("{message}; give --mask {}=FILE", role.name()));
    }

    fn is_interrupted(&self) -> bool {
        is_interrupted()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bar_bears_the_name_of_the_step_that_runs() {
        let watcher = Watcher::new(true);
        for step in ["photograph", "seeds"] {
            watcher.begin(step);
            assert_eq!((watcher.bar.message().as_str(), watcher.bar.position()), (step, 0));
            watcher.progress(0.4);
            assert_eq!(watcher.bar.position(), 40);
        }
        assert_eq!(watcher.finish().iter().map(|(step, _)| step.as_str()).collect::<Vec<_>>(), ["photograph", "seeds"]);
    }
}
