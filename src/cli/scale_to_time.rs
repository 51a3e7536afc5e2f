//! `plot --max-time`: the largest scale whose plot takes no longer, found by trial plots.

use super::arguments::{Order, PlotFit, PlotOptions};
use super::failure::Failure;
use super::interruption::{interrupt, is_interrupted};
use super::job;
use super::messages::say;
use super::pens::PenSet;
use super::toolpaths::duration;
use crate::drawing::Drawing;
use crate::geometry::Affine;
use crate::plot::{InkModel, Profile, lower};

/// Smallest size tried, in percent of the drawing's size; below that it is a blot.
const LEAST_PERCENT: u32 = 10;

/// Settings of the trial plots.
pub(super) struct Trials<'a> {
    /// Maximum plotting time in seconds.
    pub limit: f64,
    pub model: InkModel,
    pub profile: &'a Profile,
    pub pens: &'a PenSet,
    pub options: &'a PlotOptions,
}

/// A drawing within the time limit, and its scale factor.
#[derive(Debug)]
pub(super) struct Scaled {
    pub drawing: Drawing,
    pub scale: f64,
}

/// The drawing, if needed scaled down about its middle, so that its plot keeps to the time limit. A size set by `--scale` or `--fit`
/// is refused instead of changed.
pub(super) fn scaled_to(drawing: &Drawing, trials: &Trials<'_>) -> Result<Scaled, Failure> {
    let whole = seconds_at(drawing, trials)?;
    let (limit, options) = (trials.limit, trials.options);
    let found = if whole <= limit {
        Some((100, whole))
    } else {
        largest_percent(limit, |percent| seconds_at(&scaled(drawing, percent), trials))?
    };
    let Some((percent, seconds)) = found else {
        return Err(Failure::Work(format!(
            "--max-time {}: the plot takes {}, and too long even at {LEAST_PERCENT} % of its size; choose --layers, or a higher --speed",
            duration(limit),
            duration(whole)
        )));
    };
    let is_sized = options.scale.is_some() || options.fit == PlotFit::Page;
    if percent < 100 && is_sized {
        return Err(Failure::Work(format!(
            "--max-time {}: the plot takes {} at the size set by {}; at {} % of it, it would take {}: {}",
            duration(limit),
            duration(whole),
            if options.fit == PlotFit::Page { "--fit page" } else { "--scale" },
            percent,
            duration(seconds),
            options.scale.filter(|_| options.fit != PlotFit::Page).map_or_else(
                || "leave out --fit, and --max-time chooses the size, or use a larger --margin".to_owned(),
                |scale| format!("--scale {}", (scale * f64::from(percent) * 1000.0).floor() / 100_000.0)
            )
        )));
    }
    if !options.reporting.quiet {
        let size =
            if percent == 100 { "at its own size".to_owned() } else { format!("made smaller, to {percent} % about its middle") };
        say!("{size}: about {} of {}", duration(seconds), duration(limit));
    }
    Ok(Scaled { drawing: scaled(drawing, percent), scale: f64::from(percent) / 100.0 })
}

/// The largest percentage below 100 that takes at most `limit` seconds, with its time.
fn largest_percent(limit: f64, mut seconds: impl FnMut(u32) -> Result<f64, Failure>) -> Result<Option<(u32, f64)>, Failure> {
    let (mut too_long, mut found) = (100, None);
    let mut low = LEAST_PERCENT;
    while low < too_long {
        // The time of most drawings grows between linearly and quadratically with their size, so bisection works well.
        let percent = low.midpoint(too_long);
        let taken = seconds(percent)?;
        if taken <= limit {
            (found, low) = (Some((percent, taken)), percent + 1);
        } else {
            too_long = percent;
        }
    }
    Ok(found)
}

fn scaled(drawing: &Drawing, percent: u32) -> Drawing {
    match drawing.bounding_box() {
        Some(bounds) if percent != 100 => {
            let middle = bounds.center().to_vec2();
            let matrix = Affine::translate(middle) * Affine::scale(f64::from(percent) / 100.0) * Affine::translate(-middle);
            drawing.transformed(matrix)
        }
        _ => drawing.clone(),
    }
}

/// Plotting time in seconds, ordered fast.
fn seconds_at(drawing: &Drawing, trials: &Trials<'_>) -> Result<f64, Failure> {
    if is_interrupted() {
        return Err(Failure::Interrupted);
    }
    let mut options = trials.options.toolpaths.clone();
    if options.order == Order::Full {
        options.order = Order::Fast;
    }
    let plot = lower(drawing, trials.model, trials.pens.nibs(), options.tolerance, interrupt())?;
    let job = job::of_paths(plot, Some(trials.profile), &options, trials.pens)?;
    Ok(job.report().total.seconds.unwrap_or(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_found_is_the_largest_that_keeps_to_the_time() {
        let time = |percent: u32| Ok(10.0 + 0.5 * f64::from(percent * percent));
        for limit in [70.0, 500.0, 2000.0, 4900.0] {
            let (percent, seconds) = largest_percent(limit, time).unwrap().unwrap();
            assert!(seconds <= limit && time(percent + 1).unwrap() > limit, "{limit}: {percent}");
        }
        assert_eq!(largest_percent(50.0, time).unwrap(), None);
    }
}
