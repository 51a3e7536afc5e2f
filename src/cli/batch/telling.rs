//! What a batch tells: a JSON line per picture, progress, and a summary.

use super::super::arguments::BatchOptions;
use super::super::failure::Failure;
use super::super::messages::say;
use super::super::toolpaths::duration;
use super::inputs::{Named, Unnamed};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;
use std::fs::File;
use std::io::{IsTerminal, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// A drawn picture.
pub(super) struct Drawn {
    pub sha256: String,
    pub bytes: u64,
    pub warnings: Vec<String>,
    /// False if it was there already.
    pub is_new: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Status {
    Done,
    Skipped,
    Failed,
}

/// What became of a picture: one line of the results.
#[derive(Serialize)]
pub(super) struct Outcome {
    photo: String,
    name: String,
    output: String,
    status: Status,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    warnings: Vec<String>,
    seconds: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    sha256: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bytes: Option<u64>,
}

impl Outcome {
    pub(super) fn done(named: &Named, output: &str, drawn: Drawn, time: Duration) -> Self {
        Self {
            status: if drawn.is_new { Status::Done } else { Status::Skipped },
            reason: None,
            warnings: drawn.warnings,
            sha256: Some(drawn.sha256),
            bytes: Some(drawn.bytes),
            ..Self::failed(named, output, String::new()).after(time)
        }
    }

    pub(super) fn failed(named: &Named, output: &str, reason: String) -> Self {
        Self {
            photo: named.photo.clone(),
            name: named.name.clone(),
            output: output.to_owned(),
            status: Status::Failed,
            reason: Some(reason),
            warnings: Vec::new(),
            seconds: 0.0,
            sha256: None,
            bytes: None,
        }
    }

    /// A line of a manifest, or a folder, that gives no picture.
    pub(super) fn failed_manifest(unnamed: &Unnamed) -> Self {
        let named = Named { photo: unnamed.photo.clone(), name: String::new() };
        Self::failed(&named, "", unnamed.reason.clone())
    }

    pub(super) fn after(self, time: Duration) -> Self {
        Self { seconds: (time.as_secs_f64() * 1000.0).round() / 1000.0, ..self }
    }
}

/// How many pictures ended how.
#[derive(Clone, Copy, Default)]
struct Tally {
    done: u64,
    skipped: u64,
    failed: u64,
}

/// The lines, the progress bar and the counts.
pub(super) struct Telling {
    bar: ProgressBar,
    is_quiet: bool,
    begun: Instant,
    told: Mutex<(Tally, Option<File>)>,
}

impl Telling {
    pub(super) fn new(options: &BatchOptions, count: Option<u64>) -> Result<Self, Failure> {
        let open = |path: &std::path::PathBuf| {
            let file = File::options().create(true).append(true).open(path);
            file.map_err(Failure::writing(&path.to_string_lossy()))
        };
        let results = options.results.as_ref().map(open).transpose()?;
        let is_quiet = options.draw.reporting.quiet;
        let bar = match count {
            Some(count) => ProgressBar::new(count),
            None => ProgressBar::no_length(),
        };
        let shown = if is_quiet || !std::io::stderr().is_terminal() {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        bar.set_draw_target(shown);
        let template = if count.is_some() { "{pos}/{len} [{bar:30}] {elapsed}, {eta} left{msg}" } else { "{pos} {elapsed}{msg}" };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        Ok(Self { bar, is_quiet, begun: Instant::now(), told: Mutex::new((Tally::default(), results)) })
    }

    /// Writes the line of a picture.
    pub(super) fn tell(&self, outcome: &Outcome) -> Result<(), Failure> {
        let line = serde_json::to_string(outcome).map_err(|error| Failure::Work(error.to_string()))? + "\n";
        let mut told = self.told();
        let (tally, results) = &mut *told;
        match outcome.status {
            Status::Done => tally.done += 1,
            Status::Skipped => tally.skipped += 1,
            Status::Failed => tally.failed += 1,
        }
        if let Some(file) = results {
            file.write_all(line.as_bytes()).map_err(Failure::writing("the file of --results"))?;
        }
        let mut stdout = std::io::stdout().lock();
        stdout.write_all(line.as_bytes()).and_then(|()| stdout.flush()).map_err(Failure::writing("stdout"))?;
        if tally.failed > 0 {
            self.bar.set_message(format!(", {} failed", tally.failed));
        }
        self.bar.inc(1);
        Ok(())
    }

    /// True if no picture has succeeded so far.
    pub(super) fn nothing_is_drawn(&self) -> bool {
        let (tally, _) = &*self.told();
        tally.done + tally.skipped == 0
    }

    /// True if no line is written so far.
    pub(super) fn nothing_is_told(&self) -> bool {
        let (tally, _) = &*self.told();
        tally.done + tally.skipped + tally.failed == 0
    }

    /// The summary; a failure if pictures failed.
    pub(super) fn finish(&self) -> Result<(), Failure> {
        self.bar.finish_and_clear();
        let (Tally { done, skipped, failed }, _) = *self.told();
        if done + skipped + failed == 0 {
            say!("drypoint: there are no pictures here");
        } else if !self.is_quiet {
            let seconds = self.begun.elapsed().as_secs_f64();
            say!("{done} drawn, {skipped} skipped, {failed} failed, in {}", duration(seconds));
        }
        if failed == 0 { Ok(()) } else { Err(Failure::Some { failed }) }
    }

    fn told(&self) -> MutexGuard<'_, (Tally, Option<File>)> {
        self.told.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
