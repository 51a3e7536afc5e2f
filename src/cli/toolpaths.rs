//! From a plot to a machine's file: profile, order, mounting, checks, report.

use super::arguments::{DuplicatesOption, Format, Order, PreviewTravel, SeamOption, StartCorner, ToolpathOptions};
use super::claims;
use super::failure::Failure;
use super::interruption::interrupt;
use super::layer_files::LayerFile;
use super::messages::{say, warning};
use super::output;
use super::pens::PenSet;
use super::words::counted;
use crate::geometry::{Point, Rect};
use crate::plot::{
    Course, Direction, DrawingCorner, Duplicates, Effort, Language, Mounting, PenChange, PenReport, Plot, PlotReport, Profile,
    Seam, Sequence, Travel, add_registration, built_in, clip_to, let_dry, mount, pause_every, report, rest_touches,
};
use crate::write::{ShownTravel, SvgHead, write_gcode, write_hpgl, write_preview, write_svg_plot, write_svg_plotter};
use std::collections::BTreeSet;

/// Plotting time above which the user is warned.
pub(super) const LONG_HOURS: f64 = 4.0;

/// The format of an output file.
pub(super) fn format_of(name: &str, format: Option<Format>) -> Result<Format, Failure> {
    if let Some(format) = format {
        return Ok(format);
    }
    let extension = std::path::Path::new(name).extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    match extension.as_str() {
        "svg" => Ok(Format::Svg),
        "pdf" => Ok(Format::Pdf),
        "hpgl" | "plt" => Ok(Format::Hpgl),
        "gcode" | "nc" | "ngc" => Ok(Format::Gcode),
        "inkml" => Ok(Format::Inkml),
        _ if name == "-" => Err(Failure::Usage("with -o - give the format: --format svg, pdf, hpgl, gcode or inkml".to_owned())),
        _ => Err(Failure::Usage(format!(
            "the format of {name} is not known by its extension; use .svg, .pdf, .hpgl, .plt, .gcode, .nc, .ngc or .inkml, or --format"
        ))),
    }
}

/// A profile by name, or from a file when there is a path or a .toml ending, with keys set over it.
pub(super) fn plain_profile(name: &str, set: &[(String, String)]) -> Result<Profile, Failure> {
    let is_file = name.contains('/') || std::path::Path::new(name).extension().is_some_and(|e| e == "toml");
    if !is_file {
        return Ok(Profile::parse_with(name, built_in(name)?, set)?);
    }
    Profile::parse_with(name, &output::read_settings(name)?, set).map_err(|error| Failure::Work(error.to_string()))
}

/// The profile with what the options say of its speeds.
pub(super) fn profile(name: &str, options: &ToolpathOptions) -> Result<Profile, Failure> {
    let mut profile = plain_profile(name, &options.set_profile)?;
    let fastest = [profile.motion.fastest_drawing(), profile.motion.fastest_travel()];
    if let Some(speed) = options.speed {
        let key = if profile.motion.draw_speed_limit.is_some() { "draw_speed_limit" } else { "travel_speed" };
        check_speed(("--speed", speed), "draws", fastest[0], key, &profile)?;
        profile.motion.draw_speed = told_speed(&profile, speed);
    }
    if let Some(speed) = options.travel_speed {
        let key = if profile.motion.travel_speed_limit.is_some() { "travel_speed_limit" } else { "travel_speed" };
        check_speed(("--travel-speed", speed), "travels", fastest[1], key, &profile)?;
        profile.motion.travel_speed = speed;
        // G0 runs at the machine's own rate; a speed that was asked for needs a feed.
        if let Some(gcode) = profile.gcode.as_mut().filter(|gcode| gcode.travel == Travel::Rapid) {
            gcode.travel = Travel::Feed;
        }
    }
    if let Some(seconds) = options.dwell {
        if profile.language != Language::Gcode && seconds > 0.0 {
            return Err(Failure::Usage(format!("--dwell: {} has no word for a wait at each touch", profile.name)));
        }
        profile.motion.touch_seconds = seconds;
    }
    Ok(profile)
}

/// Refuses a speed above the machine's own greatest; `key` is where the profile says it.
fn check_speed((option, speed): (&str, f64), does: &str, fastest: f64, key: &str, profile: &Profile) -> Result<(), Failure> {
    if speed <= fastest {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{option} {speed}: {} {does} at {fastest} mm/s at most; for a faster machine --set-profile motion.{key}={speed}",
        profile.name
    )))
}

/// The speed that the machine can be told: HP-GL's in whole centimetres a second.
fn told_speed(profile: &Profile, speed: f64) -> f64 {
    if profile.language == Language::Hpgl { (speed / 10.0).floor().max(1.0) * 10.0 } else { speed }
}

/// Refuses a format that the profile's machine does not read.
pub(super) fn check_language(format: Format, profile: Option<&Profile>) -> Result<(), Failure> {
    let needed = match format {
        Format::Pdf if profile.is_some() => {
            return Err(Failure::Usage(
                "PDF is for print, not for a plotter; leave out --profile, or write its own format".to_owned(),
            ));
        }
        Format::Inkml if profile.is_some() => {
            return Err(Failure::Usage(
                "InkML holds a drawing's strokes, not a machine's tool paths; leave --profile out".to_owned(),
            ));
        }
        Format::Svg | Format::Pdf | Format::Inkml => return Ok(()),
        Format::Hpgl => Language::Hpgl,
        Format::Gcode => Language::Gcode,
    };
    match profile {
        None => Err(Failure::Usage("HP-GL and G-code need --profile; `drypoint profiles` lists the plotters".to_owned())),
        Some(profile) if profile.language != needed => {
            let right = match profile.language {
                Language::Hpgl => ".hpgl or .plt",
                Language::Gcode => ".gcode, .nc or .ngc",
                Language::Svg => ".svg",
            };
            Err(Failure::Usage(format!("{} reads another language than this file's format; write {right}", profile.name)))
        }
        Some(_) => Ok(()),
    }
}

/// A plot that is ready to be written.
pub(super) struct Prepared {
    pub plot: Plot,
    pub mounting: Option<Mounting>,
    pub report: PlotReport,
    /// The same before ordering.
    pub unordered: PlotReport,
    /// Millimetres and touches that --clip cut away.
    pub cut: (f64, usize),
    /// Where the pen starts, on the page.
    pub home: Point,
    /// Repeated paths that are not drawn again.
    pub duplicates: usize,
}

/// Orders a plot, lays it on the machine and checks that all of it can be drawn there.
pub(super) fn prepare(
    mut plot: Plot,
    profile: Option<&Profile>,
    options: &ToolpathOptions,
    pens: &PenSet,
) -> Result<Prepared, Failure> {
    if profile.is_none() && (options.frame || options.pause_every.is_some()) {
        return Err(Failure::Usage("--frame and --pause-every tell a machine to wait: they need --profile".to_owned()));
    }
    plot.pens.retain(|pen| !pen.paths.is_empty());
    let mut mounting = profile.map(|profile| mount(profile, &plot.page)).transpose()?;
    let drawable = mounting.as_ref().map_or(plot.page.rect(), |m| m.drawable(&plot.page));
    let mut cut = (0.0, 0);
    if options.clip {
        cut = clip_to(&mut plot, drawable);
        plot.pens.retain(|pen| !pen.paths.is_empty());
    }
    if let (Some(profile), Some(mounting)) = (profile, &mut mounting) {
        mounting.tolerance = options.tolerance;
        mounting.frame = if options.frame { bounds_of(&plot) } else { None };
        check_pens(&plot, profile, options)?;
        mounting.check(profile, &plot)?;
    }
    let home = home_of(mounting.as_ref(), &plot);
    let machine = profile.zip(mounting.as_ref());
    let unordered = report(&plot, home, machine, None, interrupt())?;
    let before: Vec<f64> = unordered.pens.iter().map(|pen| pen.pen_up_mm).collect();
    let duplicates = plot.put_in_order(home, &sequence(options), interrupt())?;
    if options.registration {
        add_registration(&mut plot, drawable);
    }
    let usual = profile.map_or(0.0, |profile| profile.motion.touch_seconds);
    rest_touches(&mut plot, |pen| pens.dwell(pen).unwrap_or(usual));
    if let Some(seconds) = options.dry_time {
        let Some(profile) = profile else {
            return Err(Failure::Usage("--dry-time reckons with a machine's speeds: it needs --profile".to_owned()));
        };
        let waited = let_dry(&mut plot, seconds, home, &profile.motion, interrupt())?;
        if waited > 0.0 && profile.language != Language::Gcode {
            return Err(Failure::Work(format!(
                "--dry-time {seconds}: the machine would have to wait {} in all, for which its language has no word; ask for less",
                duration(waited)
            )));
        }
    }
    let report = report(&plot, home, machine, Some(&before), interrupt())?;
    if let Some(length) = options.pause_every {
        pause_every(&mut plot, length);
    }
    Ok(Prepared { plot, mounting, report, unordered, cut, home, duplicates })
}

fn bounds_of(plot: &Plot) -> Option<Rect> {
    let points = plot.pens.iter().flat_map(|pen| &pen.paths).flat_map(|path| &path.points);
    points.map(|p| Rect::from_points(*p, *p)).reduce(|a, b| a.union(b))
}

/// The order that was asked for.
fn sequence(options: &ToolpathOptions) -> Sequence {
    let corner = |corner: StartCorner| match corner {
        StartCorner::TopLeft => DrawingCorner::TopLeft,
        StartCorner::TopRight => DrawingCorner::TopRight,
        StartCorner::BottomLeft => DrawingCorner::BottomLeft,
        StartCorner::BottomRight => DrawingCorner::BottomRight,
    };
    Sequence {
        effort: match options.order {
            Order::Full => Effort::Full,
            Order::Fast | Order::Random => Effort::Fast,
            Order::None => Effort::None,
        },
        direction: if options.keep_direction { Direction::AsDrawn } else { Direction::Either },
        merge: options.merge,
        duplicates: match options.duplicates {
            DuplicatesOption::Drop => Duplicates::Drop,
            DuplicatesOption::Keep => Duplicates::Keep,
        },
        seam: match options.seam {
            SeamOption::Nearest => Seam::Nearest,
            SeamOption::Drawn => Seam::Drawn,
            SeamOption::Top => Seam::Top,
            SeamOption::Bottom => Seam::Bottom,
            SeamOption::Left => Seam::Left,
            SeamOption::Right => Seam::Right,
            SeamOption::Corner => Seam::Corner,
        },
        course: match options.order {
            Order::Random => Course::Shuffled(options.order_seed),
            _ if options.reverse => Course::Backwards,
            _ => Course::Forwards,
        },
        start: options.start_corner.map(corner),
    }
}

/// Where the pen starts, on the page: machine zero, else the page's upper left corner.
pub(super) fn home_of(mounting: Option<&Mounting>, plot: &Plot) -> Point {
    let zero = mounting.map_or(Point::ORIGIN, |m| m.to_machine.inverse() * Point::ORIGIN);
    Point::new(zero.x.clamp(0.0, plot.page.width), zero.y.clamp(0.0, plot.page.height))
}

/// Whether a file can make the machine wait for its user.
fn can_wait(profile: &Profile) -> bool {
    match profile.language {
        Language::Gcode => profile.gcode.as_ref().is_some_and(|gcode| gcode.pause.is_some()),
        Language::Hpgl => false,
        Language::Svg => true,
    }
}

/// Every pen is there, or the machine can wait until it is; what asks for a wait gets it.
fn check_pens(plot: &Plot, profile: &Profile, options: &ToolpathOptions) -> Result<(), Failure> {
    let name = &profile.name;
    if profile.language == Language::Hpgl
        && let Some(pen) = plot.pens.iter().find(|pen| pen.handling.pauses || pen.handling.delay_seconds > 0.0)
    {
        return Err(Failure::Work(format!(
            "layer '{}' asks for a pause or a delay, for which HP-GL has no word; draw the layers one by one with --layers, or take ! and +D from its label",
            pen.name
        )));
    }
    if let Some(pen) = plot.pens.iter().find(|pen| pen.number > profile.pens.count)
        && profile.pens.change == PenChange::Machine
    {
        return Err(Failure::Work(format!(
            "layer '{}' wants pen {}, but {name} holds {}; choose --layers, or give its layer a lower number or a slot with --pens",
            pen.name, pen.number, profile.pens.count
        )));
    }
    if options.frame && profile.language == Language::Svg {
        return Err(Failure::Usage(format!("--frame: {name} is driven by its own program, which has that")));
    }
    if can_wait(profile) {
        return Ok(());
    }
    let asks = |what: &str| Err(Failure::Work(format!("{what} needs a pause, and {name} has no word for one")));
    if options.frame {
        return asks("--frame");
    }
    if options.pause_every.is_some() {
        return asks("--pause-every");
    }
    let changes = plot.pens.windows(2).any(|pair| pair[0].number != pair[1].number);
    if plot.pens.iter().any(|pen| pen.handling.pauses) || (changes && profile.pens.change == PenChange::Pause) {
        return Err(Failure::Work(format!(
            "a change of pen needs a pause, and {name} has no word for one; write one file for each layer: -o 'name-{{layer}}.gcode'"
        )));
    }
    Ok(())
}

/// Writes a prepared plot.
pub(super) fn write(
    name: &str,
    format: Format,
    prepared: &Prepared,
    profile: Option<&Profile>,
    head: &SvgHead,
) -> Result<(), Failure> {
    output::write(name, |mut out| match (format, profile, &prepared.mounting) {
        (Format::Hpgl, Some(profile), Some(mounting)) => write_hpgl(&prepared.plot, profile, mounting, &mut out),
        (Format::Gcode, Some(profile), Some(mounting)) => write_gcode(&prepared.plot, profile, mounting, &mut out),
        (Format::Svg, Some(profile), _) if profile.language == Language::Svg => {
            write_svg_plotter(&prepared.plot, profile, head, &mut out)
        }
        _ => write_svg_plot(&prepared.plot, head, &mut out),
    })
}

/// One preview for each file, or for the one; no output is an input or another output.
pub(super) fn check_preview(output: &str, options: &ToolpathOptions) -> Result<(), Failure> {
    match &options.preview {
        Some(preview) if output.contains("{layer}") && !preview.contains("{layer}") => Err(Failure::Usage(
            "-o writes one file for each layer, and --preview one picture: put {layer} into its name too".to_owned(),
        )),
        // Which files those are is known with the layers.
        _ if output.contains("{layer}") => Ok(()),
        preview => claims::are_distinct([output].into_iter().chain(preview.as_deref())),
    }
}

/// Refuses files for each layer of which two are one, or one is an input.
pub(super) fn check_layer_files(files: &[LayerFile], options: &ToolpathOptions) -> Result<(), Failure> {
    let preview = |file: &LayerFile| Some(preview_name(options.preview.as_ref()?, Some(&file.layer)));
    let previews: Vec<String> = files.iter().filter_map(preview).collect();
    claims::are_distinct(files.iter().map(|file| file.name.as_str()).chain(previews.iter().map(String::as_str)))
}

fn preview_name(name: &str, layer: Option<&str>) -> String {
    layer.map_or_else(|| name.to_owned(), |layer| name.replace("{layer}", layer))
}

/// Writes the picture of what the machine will do, where one is asked for; `{layer}` in its name stands for the same as in the
/// output's.
pub(super) fn write_preview_of(prepared: &Prepared, options: &ToolpathOptions, layer: Option<&str>) -> Result<(), Failure> {
    let Some(name) = &options.preview else { return Ok(()) };
    let name = preview_name(name, layer);
    let start = prepared.mounting.as_ref().map_or(prepared.home, |mounting| mounting.to_machine.inverse() * Point::ORIGIN);
    let travel = match options.preview_travel {
        PreviewTravel::Off => ShownTravel::Off,
        PreviewTravel::Faint => ShownTravel::Faint,
        PreviewTravel::Full => ShownTravel::Full,
    };
    output::write(&name, |mut out| write_preview(&prepared.plot, prepared.mounting.as_ref(), start, travel, &mut out))
}

/// Warnings about the machine, shown whatever was asked for; `shorter` says what makes a long plot shorter, unless that was said
/// before.
pub(super) fn warn(prepared: &Prepared, profile: Option<&Profile>, shorter: Option<&str>) {
    let (length, touches) = prepared.cut;
    if length > 0.0 || touches > 0 {
        warning!("--clip cut away {length:.1} mm of line and {}", counted(touches, "touch"));
    }
    if prepared.duplicates > 0 {
        let paths = counted(prepared.duplicates, "path");
        say!("drypoint: {paths} repeating an earlier one left out; --duplicates keep draws them all");
    }
    if let (Some(seconds), Some(shorter)) = (prepared.report.total.seconds, shorter)
        && seconds > LONG_HOURS * 3600.0
    {
        warning!("this plot takes {}{shorter}", duration(seconds));
    }
    let Some(profile) = profile else { return };
    let numbers: std::collections::BTreeSet<u32> = prepared.plot.pens.iter().map(|pen| pen.number).collect();
    if profile.pens.change == PenChange::Pause && numbers.len() as u32 > profile.pens.count {
        let (pens, count) = (counted(numbers.len(), "pen"), profile.pens.count);
        warning!("{pens} on a machine with {count}: the file pauses for each change");
    }
    for number in numbers {
        let drawn: f64 = prepared.report.pens.iter().filter(|pen| pen.pen == number).map(|pen| pen.pen_down_mm / 1000.0).sum();
        if let Some(life) = profile.life_of(number).filter(|life| drawn > *life) {
            warning!("pen {number} draws {drawn:.1} m and lasts {life} m; --pause-every {life}m waits for a new one");
        }
    }
}

/// Such as `2 h 14 min, 3 pens, 41.0 m of ink, 6.2 m of travel`.
pub(super) fn summary(report: &PlotReport) -> String {
    let time = report.total.seconds.map(|s| format!("{}, ", duration(s))).unwrap_or_default();
    // A pen may come back for another part.
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

/// The report of several files as one: each file's pens, and all together. What is covered is told for one file only.
pub(super) fn of_all<'a>(prepared: impl IntoIterator<Item = &'a Prepared>) -> Option<PlotReport> {
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
    prepared.into_iter().map(|one| one.report.clone()).reduce(add)
}

/// A line for each pen: time, ink and lifts, and in brackets what they were before ordering.
pub(super) fn pen_lines(prepared: &Prepared) -> Vec<String> {
    let amounts = |pen: &PenReport| {
        let time = pen.seconds.map(|s| format!("{}, ", duration(s))).unwrap_or_default();
        format!("{time}{:.2} m of ink, {}", pen.pen_down_mm / 1000.0, counted(pen.pen_lifts, "lift"))
    };
    let pens = prepared.report.pens.iter().zip(&prepared.unordered.pens);
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
