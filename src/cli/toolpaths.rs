//! From a plot to a machine's file: profile, order, mounting, checks, report.

use super::arguments::{Format, Order, ToolpathOptions};
use super::failure::Failure;
use super::output;
use crate::geometry::Point;
use crate::plot::{
    Direction, Effort, Language, Mounting, PenChange, Plot, PlotReport, Profile, built_in, clip_to, mount, report,
};
use crate::write::{SvgHead, write_gcode, write_hpgl, write_svg_plot};
use std::io::Write;

/// Plotting time above which the user is warned.
const LONG_HOURS: f64 = 4.0;

/// The format of an output file.
pub(super) fn format_of(name: &str, format: Option<Format>) -> Result<Format, Failure> {
    if let Some(format) = format {
        return Ok(format);
    }
    let extension = std::path::Path::new(name).extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    match extension.as_str() {
        "svg" => Ok(Format::Svg),
        "hpgl" | "plt" => Ok(Format::Hpgl),
        "gcode" | "nc" | "ngc" => Ok(Format::Gcode),
        "inkml" => Ok(Format::Inkml),
        _ if name == "-" => Err(Failure::Usage("with -o - give the format: --format svg, hpgl, gcode or inkml".to_owned())),
        _ => Err(Failure::Usage(format!(
            "the format of {name} is not known by its extension; use .svg, .hpgl, .plt, .gcode, .nc, .ngc or .inkml, or --format"
        ))),
    }
}

/// A profile by name, or from a file when there is a path or a .toml ending.
pub(super) fn profile(name: &str, options: &ToolpathOptions) -> Result<Profile, Failure> {
    let is_file = name.contains('/') || std::path::Path::new(name).extension().is_some_and(|e| e == "toml");
    let mut profile = if is_file {
        let bytes = output::read(name)?;
        let text =
            String::from_utf8(bytes).map_err(|_| Failure::Work(format!("{name} is not a profile: it is not UTF-8 text")))?;
        Profile::parse(name, &text).map_err(|error| Failure::Work(error.to_string()))?
    } else {
        Profile::parse(name, built_in(name)?)?
    };
    if let Some(speed) = options.speed {
        profile.motion.draw_speed = told_speed(&profile, speed);
    }
    if let Some(speed) = options.travel_speed {
        profile.motion.travel_speed = speed;
    }
    Ok(profile)
}

/// The speed that the machine can be told: HP-GL's in whole centimetres a second within the machine's limit.
fn told_speed(profile: &Profile, speed: f64) -> f64 {
    if profile.language == Language::Gcode {
        return speed;
    }
    let limit = profile.motion.draw_speed_limit.unwrap_or(f64::INFINITY);
    (speed.min(limit) / 10.0).floor().max(1.0) * 10.0
}

/// Refuses a format that the profile's machine does not read.
pub(super) fn check_language(format: Format, profile: Option<&Profile>) -> Result<(), Failure> {
    let needed = match format {
        Format::Inkml if profile.is_some() => {
            return Err(Failure::Usage(
                "InkML holds a drawing's strokes, not a machine's tool paths; leave --profile out".to_owned(),
            ));
        }
        Format::Svg | Format::Inkml => return Ok(()),
        Format::Hpgl => Language::Hpgl,
        Format::Gcode => Language::Gcode,
    };
    match profile {
        None => Err(Failure::Usage("HP-GL and G-code need --profile; `drypoint profiles` lists the plotters".to_owned())),
        Some(profile) if profile.language != needed => {
            let right = if profile.language == Language::Hpgl { ".hpgl or .plt" } else { ".gcode, .nc or .ngc" };
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
    /// Millimetres and touches that --clip cut away.
    pub cut: (f64, usize),
}

/// Orders a plot, lays it on the machine and checks that all of it can be drawn there.
pub(super) fn prepare(mut plot: Plot, profile: Option<&Profile>, options: &ToolpathOptions) -> Result<Prepared, Failure> {
    plot.pens.retain(|pen| !pen.paths.is_empty());
    let mounting = profile.map(|profile| mount(profile, &plot.page)).transpose()?;
    let mut cut = (0.0, 0);
    if options.clip {
        let sheet = plot.page.rect();
        cut = clip_to(&mut plot, mounting.as_ref().map_or(sheet, |m| m.reach_on_page().intersect(sheet)));
        plot.pens.retain(|pen| !pen.paths.is_empty());
    }
    if let (Some(profile), Some(mounting)) = (profile, &mounting) {
        check_pens(&plot, profile)?;
        mounting.check(profile, &plot)?;
    }
    let home = home_of(mounting.as_ref(), &plot);
    let before: Vec<f64> = report(&plot, home, None, None).pens.iter().map(|pen| pen.pen_up_mm).collect();
    let effort = match options.order {
        Order::Full => Effort::Full,
        Order::Fast => Effort::Fast,
        Order::None => Effort::None,
    };
    let direction = if options.keep_direction { Direction::AsDrawn } else { Direction::Either };
    if effort != Effort::None {
        plot.ordered(home, effort, direction, options.merge);
    }
    let report = report(&plot, home, profile.map(|p| &p.motion), Some(&before));
    Ok(Prepared { plot, mounting, report, cut })
}

/// Where the pen starts, on the page: machine zero, else the page's upper left corner.
fn home_of(mounting: Option<&Mounting>, plot: &Plot) -> Point {
    let zero = mounting.map_or(Point::ORIGIN, |m| m.to_machine.inverse() * Point::ORIGIN);
    Point::new(zero.x.clamp(0.0, plot.page.width), zero.y.clamp(0.0, plot.page.height))
}

fn check_pens(plot: &Plot, profile: &Profile) -> Result<(), Failure> {
    if profile.language == Language::Hpgl
        && let Some(pen) = plot.pens.iter().find(|pen| pen.handling.pauses || pen.handling.delay_seconds > 0.0)
    {
        return Err(Failure::Work(format!(
            "layer '{}' asks for a pause or a delay, for which HP-GL has no word; draw the layers one by one with --layers, or take ! and +D from its label",
            pen.name
        )));
    }
    let beyond = plot.pens.iter().find(|pen| pen.number > profile.pens.count);
    match (beyond, profile.pens.change) {
        (Some(pen), PenChange::Machine) => Err(Failure::Work(format!(
            "layer '{}' wants pen {}, but {} holds {}; choose --layers, or give its layer a lower number",
            pen.name, pen.number, profile.name, profile.pens.count
        ))),
        _ => Ok(()),
    }
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
        _ => write_svg_plot(&prepared.plot, head, &mut out),
    })
}

/// Warnings about the machine, shown whatever was asked for.
pub(super) fn warn(prepared: &Prepared, profile: Option<&Profile>, shorter: &str) {
    let (length, touches) = prepared.cut;
    if length > 0.0 || touches > 0 {
        eprintln!("drypoint: warning: --clip cut away {length:.1} mm of line and {touches} touches");
    }
    if let Some(seconds) = prepared.report.total.seconds
        && seconds > LONG_HOURS * 3600.0
    {
        eprintln!("drypoint: warning: this plot takes {}{shorter}", duration(seconds));
    }
    let pens = prepared.plot.pens.len() as u32;
    if let Some(profile) = profile
        && profile.pens.change == PenChange::Pause
        && pens > profile.pens.count
    {
        eprintln!("drypoint: warning: {pens} pens on a machine with {}: the file pauses for each change", profile.pens.count);
    }
}

/// Such as `2 h 14 min, 3 pens, 41.0 m of ink, 6.2 m of travel`.
pub(super) fn summary(report: &PlotReport) -> String {
    let time = report.total.seconds.map(|s| format!("{}, ", duration(s))).unwrap_or_default();
    let pens = if report.pens.len() == 1 { "1 pen".to_owned() } else { format!("{} pens", report.pens.len()) };
    format!(
        "{time}{pens}, {} paths, {:.1} m of ink, {:.1} m of travel ({:.1} m before ordering)",
        report.total.paths,
        report.total.pen_down_mm / 1000.0,
        report.total.pen_up_mm / 1000.0,
        report.total.pen_up_mm_before / 1000.0
    )
}

fn duration(seconds: f64) -> String {
    let minutes = (seconds / 60.0).round() as u64;
    match (minutes / 60, minutes % 60) {
        (0, 0) => format!("{seconds:.0} s"),
        (0, minutes) => format!("{minutes} min"),
        (hours, minutes) => format!("{hours} h {minutes:02} min"),
    }
}

/// Writes to nothing and counts, for `--dry-run`.
pub(super) fn discard(fill: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Result<(), Failure> {
    fill(&mut std::io::sink()).map_err(Failure::writing("nothing"))
}
