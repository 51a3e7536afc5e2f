//! `drypoint inspect`: what is in a drawing.

use super::arguments::{InspectOptions, Order, ToolpathOptions};
use super::failure::Failure;
use super::{output, toolpaths};
use crate::drawing::{Colour, Handling, Mark, Page};
use crate::geometry::{Point, Rect, Vec2};
use crate::plot::{InkModel, Language, Nibs, PenPaths, Plot, Profile, Toolpath, built_in, built_in_names, lower, report};
use crate::read::{Strokes, read_gcode, read_hpgl, read_svg};
use serde_json::{Value, json};
use std::fmt::Write;

pub(super) fn run(options: &InspectOptions) -> Result<(), Failure> {
    let shown = if options.file == "-" { "stdin" } else { &options.file };
    let profile = options.profile.as_deref().map(|name| toolpaths::profile(name, &no_overrides())).transpose()?;
    let bytes = output::read(&options.file)?;
    let text = std::str::from_utf8(&bytes)
        .map_err(|_| Failure::Work(format!("{shown} is neither SVG, HP-GL nor G-code: it is not text")))?;
    let value = match kind_of(shown, text) {
        Kind::Svg => inspect_svg(shown, text, profile.as_ref())?,
        Kind::Hpgl => {
            let motion = read_hpgl(text).map_err(|error| Failure::Work(format!("{shown}: {error}")))?;
            let profile = profile.map_or_else(|| Profile::parse("hp7475a", built_in("hp7475a")?), Ok)?;
            if profile.language != Language::Hpgl {
                return Err(Failure::Usage(format!("{shown} is HP-GL, which {} does not read", profile.name)));
            }
            inspect_motion("hpgl", &motion, &profile)
        }
        Kind::Gcode => {
            let profile = profile.map_or_else(|| gcode_profile(text), Ok)?;
            let dialect = profile
                .gcode
                .as_ref()
                .ok_or_else(|| Failure::Usage(format!("{shown} is G-code, which {} does not read", profile.name)))?;
            let motion = read_gcode(text, &dialect.pen_up, &dialect.pen_down)
                .map_err(|error| Failure::Work(format!("{shown}: {error}")))?;
            inspect_motion("gcode", &motion, &profile)
        }
        Kind::Unknown => return Err(Failure::Work(format!("{shown} is neither SVG, HP-GL nor G-code"))),
    };
    if options.json { output::print_json(&value) } else { output::to_stdout(in_words(&value).as_bytes()) }
}

enum Kind {
    Svg,
    Hpgl,
    Gcode,
    Unknown,
}

fn kind_of(name: &str, text: &str) -> Kind {
    let start = text.trim_start_matches(['\u{feff}', ' ', '\n', '\r', '\t']);
    let has = |extensions: &[&str]| extensions.iter().any(|e| name.to_ascii_lowercase().ends_with(e));
    if start.starts_with('<') {
        Kind::Svg
    } else if has(&[".gcode", ".nc", ".ngc"]) || start.starts_with(['G', 'M', '(', '%']) {
        Kind::Gcode
    } else if has(&[".hpgl", ".plt"]) || start.starts_with("IN") || start.starts_with('\u{1b}') {
        Kind::Hpgl
    } else {
        Kind::Unknown
    }
}

/// The built-in profile whose pen commands the file uses.
fn gcode_profile(text: &str) -> Result<Profile, Failure> {
    for name in built_in_names() {
        let profile = Profile::parse(name, built_in(name)?)?;
        let is_its = profile.gcode.as_ref().is_some_and(|d| text.lines().any(|line| line.trim() == d.pen_down));
        if profile.language == Language::Gcode && is_its {
            return Ok(profile);
        }
    }
    Err(Failure::Work("this G-code moves its pen in no way that a built-in profile does; name yours with --profile".to_owned()))
}

fn inspect_svg(name: &str, text: &str, profile: Option<&Profile>) -> Result<Value, Failure> {
    let imported = read_svg(text.as_bytes()).map_err(|error| Failure::about(name)(&error))?;
    let layers: Vec<Value> = imported
        .layers
        .iter()
        .map(|l| {
            let [dots, strokes, areas] = l.counts();
            let length: f64 = l.layer.marks.iter().map(|m| if let Mark::Stroke(s) = m { s.length() } else { 0.0 }).sum();
            json!({ "name": l.layer.name, "pen": l.layer.pen, "ink": l.layer.ink.to_string(), "dots": dots, "strokes": strokes, "areas": areas, "ink_mm2": l.layer.ink_mm2(), "stroke_mm": length })
        })
        .collect();
    let mut value = json!({ "format": "svg", "page_mm": [imported.page.width, imported.page.height], "layers": layers, "dropped": imported.dropped });
    if let Some(recipe) = &imported.recipe {
        value["recipe"] = serde_json::from_str(recipe).unwrap_or(Value::Null);
    }
    if let Some(profile) = profile {
        let model = if imported.recipe.is_some() && !imported.is_toolpaths { InkModel::Ink } else { InkModel::Lines };
        let plot = lower(&imported.drawing(), model, &Nibs::all(0.3), 0.02);
        value["plot"] = json!(report(&plot, Point::ORIGIN, Some(&profile.motion), None));
    }
    Ok(value)
}

/// Motion in machine units as a report in millimetres.
fn inspect_motion(format: &str, motion: &Strokes, profile: &Profile) -> Value {
    let bounds = motion.visited.iter().map(|p| Rect::from_points(*p, *p)).reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
    let mm = |p: Point| (p.to_vec2() / profile.units_per_mm).to_point();
    let mut plot = Plot { page: Page::new(1.0, 1.0), pens: Vec::new() };
    for (number, path) in &motion.paths {
        if plot.pens.last().is_none_or(|pen| pen.number != *number) {
            plot.pens.push(PenPaths {
                number: *number,
                name: format!("pen {number}"),
                colour: Colour::BLACK,
                nib: 0.0,
                handling: Handling::default(),
                paths: Vec::new(),
            });
        }
        let points = path.iter().map(|p| mm(*p)).collect();
        plot.pens.last_mut().expect("one was pushed").paths.push(Toolpath::new(points));
    }
    let size: Vec2 = mm(Point::new(bounds.x1, bounds.y1)) - mm(Point::new(bounds.x0, bounds.y0));
    json!({
        "format": format,
        "profile": profile.name,
        "bounds_units": [bounds.x0, bounds.y0, bounds.x1, bounds.y1],
        "moves_over_mm": [size.x, size.y],
        "pauses": motion.pauses,
        "ends_with_pen_up": motion.ends_up,
        "plot": report(&plot, Point::ORIGIN, Some(&profile.motion), None),
    })
}

/// The report as indented lines.
fn in_words(value: &Value) -> String {
    let mut text = String::new();
    lines(&mut text, value, 0);
    text
}

fn lines(text: &mut String, value: &Value, depth: usize) {
    let Value::Object(map) = value else { return };
    for (key, value) in map {
        let indent = "  ".repeat(depth);
        match value {
            Value::Object(_) => {
                let _ = writeln!(text, "{indent}{key}:");
                lines(text, value, depth + 1);
            }
            Value::Array(items) if items.iter().any(Value::is_object) => {
                for item in items {
                    let _ = writeln!(text, "{indent}{key}:");
                    lines(text, item, depth + 1);
                }
            }
            Value::Array(items) => {
                let shown: Vec<String> = items.iter().map(scalar).collect();
                let _ = writeln!(text, "{indent}{key}: {}", shown.join(", "));
            }
            other => {
                let _ = writeln!(text, "{indent}{key}: {}", scalar(other));
            }
        }
    }
}

fn scalar(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => {
            number.as_f64().filter(|n| n.fract() != 0.0).map_or_else(|| number.to_string(), |n| format!("{n:.2}"))
        }
        other => other.to_string(),
    }
}

fn no_overrides() -> ToolpathOptions {
    ToolpathOptions {
        seam: super::arguments::SeamOption::Nearest,
        duplicates: super::arguments::DuplicatesOption::Drop,
        reverse: false,
        start_corner: None,
        order_seed: 0,
        tolerance: 0.02,
        order: Order::None,
        keep_direction: false,
        merge: 0.0,
        clip: false,
        speed: None,
        travel_speed: None,
    }
}
