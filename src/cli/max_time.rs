//! `--max-time`: the smallest pitch whose plot takes no longer, found by drawing and timing.

use super::advice;
use super::arguments::{DrawOptions, Order};
use super::draw::{Task, drawing_of, reach_of, uncovered};
use super::failure::Failure;
use super::pens::PenSet;
use super::progress::is_interrupted;
use super::toolpaths::{self, LONG_HOURS, Prepared, duration};
use super::warnings;
use crate::plot::{InkModel, Profile, lower};
use crate::style::{Kind, Observer, Picture};

/// Time that a warning names the pitch of, in seconds.
const USUAL_LIMIT: f64 = 2.0 * 3600.0;
/// Share of the time allowed that is near enough: the last trials would gain a pitch that no eye tells apart.
const NEAR_ENOUGH: f64 = 0.97;
/// Drawings made at most; each about halves what is not known of the pitch.
const MOST_TRIALS: usize = 12;

/// A pitch in millimetres and the plotting time that it gives, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Trial {
    pitch: f64,
    seconds: f64,
}

/// The options with the smallest pitch, from the one asked for upwards, whose plot takes at most `limit` seconds.
pub(super) fn within(options: &DrawOptions, limit: f64) -> Result<DrawOptions, Failure> {
    if options.picture.photo == "-" {
        return Err(Failure::Usage("--max-time draws several times: give the photograph as a file, not as -".to_owned()));
    }
    let (start, most) = pitches(options)?;
    let found = search(start, most, limit, |pitch| seconds_at(options, pitch))?;
    let chosen = found.map_err(|last| {
        Failure::Work(format!(
            "--max-time {}: even with --pitch {}mm the plot takes {}; make it smaller with --size",
            duration(limit),
            last.pitch,
            duration(last.seconds)
        ))
    })?;
    if !options.reporting.quiet {
        let why = if chosen.pitch > start { "chosen" } else { "as asked for" };
        eprintln!("pitch {} mm ({why}): about {} of {}", chosen.pitch, duration(chosen.seconds), duration(limit));
    }
    Ok(with_pitch(options, chosen.pitch))
}

/// What a warning of a long plot adds: the pitch that takes two hours, from one trial more.
pub(super) fn advice(options: &DrawOptions, prepared: &[Prepared]) -> String {
    let seconds: f64 = prepared.iter().filter_map(|one| one.report.total.seconds).sum();
    let usual = "; a larger --pitch makes it shorter".to_owned();
    if seconds <= LONG_HOURS * 3600.0 || options.picture.photo == "-" {
        return usual;
    }
    let Ok((pitch, most)) = pitches(options) else { return usual };
    let guess = rounded((pitch * (seconds / USUAL_LIMIT).sqrt()).min(most));
    let Some(second) = seconds_at(options, guess).ok().filter(|other| guess > pitch && *other < seconds) else { return usual };
    let power = (seconds / second).ln() / (guess / pitch).ln();
    let wanted = rounded(pitch * (seconds / USUAL_LIMIT).powf(1.0 / power));
    if wanted > most {
        return format!("; with the largest --pitch, {most}mm, it would still take more than {}", duration(USUAL_LIMIT));
    }
    format!("; --pitch {wanted:.2}mm would take about {}, and --max-time 2h chooses it", duration(USUAL_LIMIT))
}

/// Says so when a finished plot takes longer than its trial, which is ordered by another way, promised.
pub(super) fn warn_if_longer(prepared: &[Prepared], limit: Option<f64>) {
    let seconds: f64 = prepared.iter().filter_map(|one| one.report.total.seconds).sum();
    if let Some(limit) = limit.filter(|limit| seconds > *limit) {
        warnings::warn(&format!("the plot takes {}, longer than --max-time {}", duration(seconds), duration(limit)));
    }
}

/// The pitch that is asked for, and the style's greatest.
fn pitches(options: &DrawOptions) -> Result<(f64, f64), Failure> {
    let task = Task::new(&options.picture, |_| None)?;
    let pitch = task.settings.number("pitch");
    let kind = task.style.parameters().iter().find(|parameter| parameter.name == "pitch").map(|parameter| parameter.kind);
    Ok((pitch, if let Some(Kind::Length { most, .. }) = kind { most } else { pitch }))
}

/// Thousandths of a millimetre, upwards, so that the pitch that is named is the pitch that was drawn.
fn rounded(pitch: f64) -> f64 {
    (pitch * 1000.0 - 1e-6).ceil() / 1000.0
}

/// The smallest pitch that keeps to the limit, or the trial of the greatest if none does: brackets it, then narrows the bracket
/// on the power law between its ends.
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
            // Dots and lines thin out with the square of the pitch at most, so that the guess is a lower one: a little more.
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
        let share = ((low.seconds / limit).ln() / (low.seconds / fits.seconds).ln() + 0.02).clamp(0.1, 0.9);
        let next = at(rounded(low.pitch * (fits.pitch / low.pitch).powf(share)))?;
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

/// How long the plot with this pitch takes, ordered fast.
fn seconds_at(options: &DrawOptions, pitch: f64) -> Result<f64, Failure> {
    let mut options = with_pitch(options, pitch);
    if options.toolpaths.order == Order::Full {
        options.toolpaths.order = Order::Fast;
    }
    let name = options.profile.clone().unwrap_or_default();
    let mut profile: Profile = toolpaths::profile(&name, &options.toolpaths)?;
    let mut pens = PenSet::read(options.toolpaths.pens.as_deref(), options.pen, Some(&mut profile))?;
    let task = Task::placed(&options.picture, &options.placing, reach_of(Some(&profile)))?;
    let drawing = drawing_of(&task, &options, Some(&profile), &mut pens, &Unseen)?;
    let plot = lower(&uncovered(&drawing), InkModel::Ink, pens.nibs(), options.toolpaths.tolerance);
    let prepared = toolpaths::prepare(plot, Some(&profile), &options.toolpaths, &pens)
        .map_err(|failure| advice::for_draw(failure, &options, &task.layout))?;
    Ok(prepared.report.total.seconds.unwrap_or(0.0))
}

/// Trials are not shown, but can be interrupted.
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
        // Time as a style of dots and as one of lines would have it, with steps where a row of dots falls out.
        for power in [2.0, 1.3, 1.0] {
            for limit in [3600.0, 7200.0, 30_000.0] {
                let time = |pitch: f64| Ok(40_000.0 * (0.7 / pitch).powf(power) + 40.0 * (pitch * 37.0).sin());
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
