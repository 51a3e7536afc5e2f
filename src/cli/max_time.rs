//! `draw --max-time`: the smallest pitch whose plot takes no longer, found by trial drawings.

use super::advice;
use super::affordable;
use super::arguments::{DrawOptions, Order};
use super::estimate::{Care, Estimator, Plan};
use super::failure::Failure;
use super::inking::{drawing_of, uncovered};
use super::interruption::{interrupt, is_interrupted};
use super::job;
use super::layout::reach_of;
use super::long_waits::smaller_size;
use super::messages::{say, warning};
use super::pens::PenSet;
use super::task::Task;
use super::toolpaths::{self, duration};
use crate::elementary::Elementary as _;
use crate::plot::{InkModel, Job, Profile, lower};
use crate::style::{Observer, Picture};

/// Fraction of the allowed time that is near enough: further trials would not change the pitch visibly.
const NEAR_ENOUGH: f64 = 0.97;
/// Maximum number of trial drawings; each about halves the bracket of the pitch.
const MOST_TRIALS: usize = 12;

/// A pitch in millimetres and its plotting time in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Trial {
    pitch: f64,
    seconds: f64,
}

/// The options with the smallest pitch, not below the requested one, whose plot takes at most `limit` seconds.
pub(super) fn within(options: &DrawOptions, limit: f64) -> Result<DrawOptions, Failure> {
    if options.picture.photo == "-" {
        return Err(Failure::Usage("--max-time draws several times; give the photograph as a file, not as -".to_owned()));
    }
    let mut trials = Trials::new(options)?;
    let style = trials.task.manner.style.name();
    let no_pitch = || Failure::Usage(format!("--max-time seeks a pitch, and {style} has none; use a smaller --size"));
    let (start, most) = (trials.task.manner.settings.pitch().ok_or_else(no_pitch)?, trials.task.largest_useful_pitch());
    let mut found = search(start, most.max(start), limit, |pitch| trials.seconds_at(pitch))?;
    if let (true, Ok(quick)) = (options.dry_run, found) {
        found = trials.refined_by_careful_estimate(quick, most.max(start), limit)?;
    }
    let chosen = found.map_err(|last| {
        let smaller = trials.smaller_size(last.pitch, last.seconds, limit);
        let smaller = smaller.unwrap_or_else(|| "a smaller --size on the same --page".to_owned());
        Failure::Work(format!(
            "--max-time {}: even with --pitch {}mm, the coarsest that keeps the picture recognisable, the plot takes {}; {smaller} would take less",
            duration(limit),
            last.pitch,
            duration(last.seconds)
        ))
    })?;
    if !options.reporting.quiet {
        let why = if chosen.pitch > start { "chosen" } else { "as requested" };
        say!("pitch {} mm ({why}): about {} of {}", chosen.pitch, duration(chosen.seconds), duration(limit));
    }
    Ok(with_pitch(options, chosen.pitch))
}

/// Warns if the finished plot takes longer than the limit. Its trial was shorter because it was ordered differently.
pub(super) fn warn_if_longer(jobs: &[Job<'_>], limit: Option<f64>) {
    let seconds: f64 = jobs.iter().filter_map(|job| job.report().total.seconds).sum();
    if let Some(limit) = limit.filter(|limit| seconds > *limit) {
        warning!("the plot takes {}, longer than --max-time {}", duration(seconds), duration(limit));
    }
}

/// Rounds up to thousandths of a millimetre, so that the reported pitch is exactly the pitch drawn.
fn rounded(pitch: f64) -> f64 {
    (pitch * 1000.0 - 1e-6).ceil() / 1000.0
}

/// The smallest pitch within the limit, or as an error the trial of the largest pitch if none is. Brackets the pitch, then narrows
/// the bracket by a power law through its ends.
fn search(
    start: f64,
    most: f64,
    limit: f64,
    mut seconds: impl FnMut(f64) -> Result<f64, Failure>,
) -> Result<Result<Trial, Trial>, Failure> {
    let mut at = |pitch: f64| seconds(pitch).map(|seconds| Trial { pitch, seconds });
    let mut low = at(start)?;
    if low.seconds <= limit {
        return Ok(Ok(low));
    }
    let mut high = None;
    for _ in 1..MOST_TRIALS {
        let Some(fits) = high else {
            // Time falls at most with the square of the pitch, so this guess is a lower bound; go a little beyond it.
            let next = at(rounded(1.05 * low.pitch * (low.seconds / limit).sqrt()).min(most))?;
            if next.seconds <= limit {
                high = Some(next);
            } else if next.pitch >= most {
                return Ok(Err(next));
            } else {
                low = next;
            }
            continue;
        };
        if fits.seconds >= NEAR_ENOUGH * limit || fits.pitch - low.pitch < 0.0025 {
            break;
        }
        let share = ((low.seconds / limit).logarithm() / (low.seconds / fits.seconds).logarithm() + 0.02).clamp(0.1, 0.9);
        let next = at(rounded(low.pitch * (fits.pitch / low.pitch).power(share)))?;
        if next.seconds <= limit { high = Some(next) } else { low = next }
    }
    Ok(high.ok_or(low))
}

fn with_pitch(options: &DrawOptions, pitch: f64) -> DrawOptions {
    let mut options = options.clone();
    options.picture.set.retain(|(key, _)| key != "pitch");
    options.picture.pitch = Some(pitch);
    options
}

/// Trial drawings at several pitches.
struct Trials<'a> {
    options: &'a DrawOptions,
    task: Task<'a>,
    profile: Profile,
    pens: PenSet,
}

impl<'a> Trials<'a> {
    fn new(options: &'a DrawOptions) -> Result<Self, Failure> {
        let name = options.profile.clone().unwrap_or_default();
        let mut profile: Profile = toolpaths::profile(&name, &options.toolpaths)?;
        let pens = PenSet::read(options.toolpaths.pens.as_deref(), options.pen, Some(&mut profile))?;
        let task = affordable::task(&options.picture, &options.placing, reach_of(Some(&profile)))?;
        Ok(Self { options, task, profile, pens })
    }

    /// Plotting time with this pitch in seconds: drawn and ordered fast, or in a dry run estimated.
    fn seconds_at(&mut self, pitch: f64) -> Result<f64, Failure> {
        if self.options.dry_run {
            return self.estimate(pitch, Care::Quick);
        }
        let mut options = with_pitch(self.options, pitch);
        if options.toolpaths.order == Order::Full {
            options.toolpaths.order = Order::Fast;
        }
        let task = affordable::task(&options.picture, &options.placing, reach_of(Some(&self.profile)))?;
        let (drawing, painting) = drawing_of(&task, &options, Some(&self.profile), &mut self.pens, &Unseen)?;
        let visible = uncovered(&drawing, &painting)?;
        let plot = lower(&visible, InkModel::Ink, self.pens.nibs(), options.toolpaths.tolerance, interrupt())?;
        let job = job::of_paths(plot, Some(&self.profile), &options.toolpaths, &self.pens)
            .map_err(|failure| advice::for_draw(failure, &options, &task, Some(&self.profile)))?;
        Ok(job.report().total.seconds.unwrap_or(0.0))
    }

    fn estimate(&mut self, pitch: f64, care: Care) -> Result<f64, Failure> {
        let settings = self.task.settings_at(pitch).unwrap_or_else(|| self.task.manner.settings.clone());
        let plan = Plan { settings, picture: self.task.layout.picture };
        Ok(self.teller().foretell(&plan, care)?.amounts.plot_seconds())
    }

    /// Corrects a pitch found by quick estimates with a careful one.
    fn refined_by_careful_estimate(&mut self, quick: Trial, most: f64, limit: f64) -> Result<Result<Trial, Trial>, Failure> {
        let careful = self.estimate(quick.pitch, Care::Careful)?;
        let start = self.task.manner.settings.pitch().unwrap_or(quick.pitch);
        if careful <= limit && (careful >= 0.9 * limit || quick.pitch <= start) {
            return Ok(Ok(Trial { seconds: careful, ..quick }));
        }
        let ratio = careful / quick.seconds.max(1e-9);
        search(start, most, NEAR_ENOUGH * limit, |pitch| Ok(ratio * self.estimate(pitch, Care::Quick)?))
    }

    /// The size that keeps to the limit with a pitch, if there is one.
    fn smaller_size(&mut self, pitch: f64, seconds: f64, limit: f64) -> Option<String> {
        self.task.manner.settings = self.task.settings_at(pitch)?;
        smaller_size(&mut self.teller(), seconds, limit)
    }

    fn teller(&mut self) -> Estimator<'_> {
        Estimator { task: &self.task, options: self.options, profile: Some(&self.profile), pens: &mut self.pens }
    }
}

/// Observes a trial: shows nothing, can be interrupted.
struct Unseen;

impl Observer for Unseen {
    fn begin(&self, _: &str) {}
    fn progress(&self, _: f64) {}
    fn picture(&self, _: &str, _: &dyn Fn() -> Picture) {}
    fn warn(&self, _: &str) {}
    fn is_interrupted(&self) -> bool {
        is_interrupted()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pitch_found_keeps_to_the_limit_and_is_near_it() {
        // Times like those of a style of dots and of a style of lines, with a ripple like that of a row of dots dropping out.
        for power in [2.0, 1.3, 1.0] {
            for limit in [3600.0, 7200.0, 30_000.0] {
                let time = |pitch: f64| Ok(40_000.0 * (0.7 / pitch).power(power) + 40.0 * (pitch * 37.0).sine());
                let found = search(0.7, 50.0, limit, time).unwrap().unwrap();
                assert!(found.seconds <= limit && found.seconds > 0.9 * limit, "{power} {limit} {found:?}");
            }
        }
    }

    #[test]
    fn a_pitch_that_fits_stays_and_one_that_cannot_is_told() {
        let time = |pitch: f64| Ok(1000.0 / (pitch * pitch));
        assert_eq!(search(1.0, 5.0, 1000.0, time).unwrap().unwrap(), Trial { pitch: 1.0, seconds: 1000.0 });
        assert_eq!(search(1.0, 5.0, 10.0, time).unwrap().unwrap_err().pitch, 5.0);
    }
}
