//! Profile, format, preview, warnings and summary of a machine's file.

use super::arguments::{Format, ToolpathOptions};
use super::claims;
use super::failure::Failure;
use super::layer_files::LayerFile;
use super::messages::{say, warning};
use super::output;
use super::words::counted;
use crate::plot::{Cut, Job, Language, PenChange, PenReport, PlotReport, Profile, built_in};
use crate::write::SvgHead;
use std::collections::BTreeSet;

/// Plotting time above which the user is warned, in hours.
pub(super) const LONG_HOURS: f64 = 4.0;

/// A profile by name, or from a file if `name` has a `/` or the extension .toml; `set` overrides its keys.
pub(super) fn plain_profile(name: &str, set: &[(String, String)]) -> Result<Profile, Failure> {
    let is_file = name.contains('/') || std::path::Path::new(name).extension().is_some_and(|e| e == "toml");
    if !is_file {
        return Ok(Profile::parse_with(name, built_in(name)?, set)?);
    }
    Profile::parse_with(name, &output::read_settings(name)?, set).map_err(|error| Failure::Work(error.to_string()))
}

/// The profile with the speeds and the dwell given by the options.
pub(super) fn profile(name: &str, options: &ToolpathOptions) -> Result<Profile, Failure> {
    let mut profile = plain_profile(name, &options.set_profile)?;
    let fastest = [profile.motion.fastest_drawing(), profile.motion.fastest_travel()];
    if let Some(speed) = options.speed {
        let key = if profile.motion.draw_speed_limit.is_some() { "draw_speed_limit" } else { "travel_speed" };
        check_speed(("--speed", speed), "draws", fastest[0], key, &profile)?;
        profile.motion.draw_speed = speed;
        profile.motion.draw_speed = profile.nearest_speed(speed);
    }
    if let Some(speed) = options.travel_speed {
        let key = if profile.motion.travel_speed_limit.is_some() { "travel_speed_limit" } else { "travel_speed" };
        check_speed(("--travel-speed", speed), "travels", fastest[1], key, &profile)?;
        profile.motion.travel_speed = speed;
        profile.feed_travel();
    }
    if let Some(seconds) = options.dwell {
        if !profile.can_dwell() && seconds > 0.0 {
            return Err(Failure::Usage(format!("--dwell: {} has no command for a wait at each touch", profile.name)));
        }
        profile.motion.touch_seconds = seconds;
    }
    Ok(profile)
}

/// Refuses options that only a machine can follow, where none was given.
pub(super) fn check_machine_options(options: &ToolpathOptions) -> Result<(), Failure> {
    let given = [
        ("--preview", options.preview.is_some()),
        ("--dry-time", options.dry_time.is_some()),
        ("--speed", options.speed.is_some()),
        ("--travel-speed", options.travel_speed.is_some()),
        ("--dwell", options.dwell.is_some()),
        ("--set-profile", !options.set_profile.is_empty()),
        ("--frame", options.frame),
        ("--pause-every", options.pause_every.is_some()),
    ];
    match given.into_iter().find(|(_, is_given)| *is_given) {
        Some((option, _)) => Err(Failure::Usage(format!("{option} is for a machine; it needs --profile"))),
        None => Ok(()),
    }
}

/// Refuses a speed above the machine's maximum; `key` is the profile's key for it.
fn check_speed((option, speed): (&str, f64), does: &str, fastest: f64, key: &str, profile: &Profile) -> Result<(), Failure> {
    if speed <= fastest {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{option} {speed}: {} {does} at {fastest} mm/s at most; for a faster machine --set-profile motion.{key}={speed}",
        profile.name
    )))
}

/// Writes a job in its machine's language, or as a picture of its tool paths.
pub(super) fn write(name: &str, format: Format, job: &Job<'_>, head: &SvgHead) -> Result<(), Failure> {
    let own = job.machine().map(Profile::language);
    output::write(name, |out| match format.language() {
        _ if format == Format::Json => job.write_marks(out),
        Some(Language::Svg) if own != Some(Language::Svg) => job.write_picture(head, out),
        _ => job.write(head, out),
    })
}

/// Checks that each file has its own preview, and that no output is an input or another output.
pub(super) fn check_preview(output: &str, options: &ToolpathOptions) -> Result<(), Failure> {
    match &options.preview {
        Some(preview) if output.contains("{layer}") && !preview.contains("{layer}") => Err(Failure::Usage(
            "-o writes one file per layer, but --preview only one picture; put {layer} into its name too".to_owned(),
        )),
        // The file names are only known once the layers are.
        _ if output.contains("{layer}") => Ok(()),
        preview => claims::check_distinct([output].into_iter().chain(preview.as_deref())),
    }
}

/// Refuses files per layer if two of them are the same file, or one is an input.
pub(super) fn check_layer_files(files: &[LayerFile<'_>], options: &ToolpathOptions) -> Result<(), Failure> {
    let preview = |file: &LayerFile<'_>| Some(preview_name(options.preview.as_ref()?, Some(&file.layer)));
    let previews: Vec<String> = files.iter().filter_map(preview).collect();
    claims::check_distinct(files.iter().map(|file| file.name.as_str()).chain(previews.iter().map(String::as_str)))
}

fn preview_name(name: &str, layer: Option<&str>) -> String {
    layer.map_or_else(|| name.to_owned(), |layer| name.replace("{layer}", layer))
}

/// Writes the preview, if requested; `{layer}` in its name is replaced as in the output's.
pub(super) fn write_preview_of(job: &Job<'_>, options: &ToolpathOptions, layer: Option<&str>) -> Result<(), Failure> {
    let Some(name) = &options.preview else { return Ok(()) };
    let name = preview_name(name, layer);
    if let Some(registration) = options.preview_registration {
        return output::write(&name, |out| job.write_proof(registration, out));
    }
    output::write(&name, |out| job.write_preview(options.preview_travel, out))
}

/// Prints warnings about the plot, even with `--quiet`. `shorter` is the advice for a long plot; `None` if it was already given.
pub(super) fn warn(job: &Job<'_>, shorter: Option<&str>) {
    let Cut { length, touches } = job.cut();
    if length > 0.0 || touches > 0 {
        warning!("--clip cut away {length:.1} mm of line and {}", counted(touches, "touch"));
    }
    if job.duplicates() > 0 {
        let paths = counted(job.duplicates(), "path");
        say!("drypoint: {paths} repeating an earlier one left out; --duplicates keep draws them all");
    }
    if let (Some(seconds), Some(shorter)) = (job.report().total.seconds, shorter)
        && seconds > LONG_HOURS * 3600.0
    {
        warning!("this plot takes {}{shorter}", duration(seconds));
    }
    let Some(profile) = job.machine() else { return };
    let numbers: BTreeSet<u32> = job.plot().pens.iter().map(|pen| pen.number).collect();
    if profile.pens.change == PenChange::Pause && numbers.len() as u32 > profile.pens.count {
        let (pens, count) = (counted(numbers.len(), "pen"), profile.pens.count);
        warning!("{pens} on a machine with {count}; the file pauses for each change");
    }
    for number in numbers {
        let drawn: f64 = job.report().pens.iter().filter(|pen| pen.pen == number).map(|pen| pen.pen_down_mm / 1000.0).sum();
        if let Some(life) = profile.life_of(number).filter(|life| drawn > *life) {
            warning!("pen {number} draws {drawn:.1} m and lasts {life} m; --pause-every {life}m waits for a new one");
        }
    }
}

/// A summary such as `2 h 14 min, 3 pens, 41.0 m of ink, 6.2 m of travel`.
pub(super) fn summary(report: &PlotReport) -> String {
    let time = report.total.seconds.map(|s| format!("{}, ", duration(s))).unwrap_or_default();
    // A pen may be used several times.
    let numbers: BTreeSet<u32> = report.pens.iter().map(|pen| pen.pen).collect();
    format!(
        "{time}{}, {}, {:.1} m of ink, {:.1} m of travel ({:.1} m before ordering)",
        counted(numbers.len(), "pen"),
        counted(report.total.paths, "path"),
        report.total.pen_down_mm / 1000.0,
        report.total.pen_up_mm / 1000.0,
        report.total.pen_up_mm_before / 1000.0
    )
}

/// The reports of several files combined: each file's pens, and the total. Coverage is only reported for a single file.
pub(super) fn combined_report<'a>(jobs: impl IntoIterator<Item = &'a Job<'a>>) -> Option<PlotReport> {
    let add = |mut sum: PlotReport, next: PlotReport| {
        let (total, more) = (&mut sum.total, next.total);
        total.paths += more.paths;
        total.pen_down_mm += more.pen_down_mm;
        total.pen_up_mm += more.pen_up_mm;
        total.pen_up_mm_before += more.pen_up_mm_before;
        total.pen_lifts += more.pen_lifts;
        total.seconds = total.seconds.zip(more.seconds).map(|(one, other)| one + other);
        (total.covered_fraction, total.spill_fraction) = (None, None);
        sum.pens.extend(next.pens);
        sum
    };
    jobs.into_iter().map(|job| job.report().clone()).reduce(add)
}

/// A line per pen: time, ink and lifts, and in brackets their values before ordering.
pub(super) fn pen_lines(job: &Job<'_>) -> Vec<String> {
    let amounts = |pen: &PenReport| {
        let time = pen.seconds.map(|s| format!("{}, ", duration(s))).unwrap_or_default();
        format!("{time}{:.2} m of ink, {}", pen.pen_down_mm / 1000.0, counted(pen.pen_lifts, "lift"))
    };
    let pens = job.report().pens.iter().zip(&job.unordered().pens);
    pens.map(|(after, before)| {
        format!("  pen {} {}: {} (before ordering: {})", after.pen, after.name, amounts(after), amounts(before))
    })
    .collect()
}

pub(super) fn duration(seconds: f64) -> String {
    let minutes = (seconds / 60.0).round() as u64;
    match (minutes / 60, minutes % 60) {
        (0, 0) => format!("{seconds:.0} s"),
        (0, minutes) => format!("{minutes} min"),
        (hours, minutes) => format!("{hours} h {minutes:02} min"),
    }
}
