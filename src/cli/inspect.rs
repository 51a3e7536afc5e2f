//! `drypoint inspect`: reports what is in a drawing.

use super::arguments::InspectOptions;
use super::failure::Failure;
use super::interruption::interrupt;
use super::label_speeds::fit_to_machine;
use super::messages::{self, warning};
use super::plot::MORE_WORK;
use super::remedies::advised;
use super::{output, toolpaths};
use crate::drawing::{Colour, Handling, Mark, Page};
use crate::geometry::{Affine, Point, Rect, Vec2};
use crate::plot::{
    Dialect, InkModel, Language, Mounting, Nibs, PenPaths, Plot, PlotReport, Profile, Strokes, Toolpath, built_in_names, home_of,
    lower, mount, report,
};
use crate::read::{Budget, read_svg_within};
use serde_json::{Value, json};
use std::fmt::Write;

pub(super) fn run(options: &InspectOptions) -> Result<(), Failure> {
    let shown = if options.file == "-" { "stdin" } else { &options.file };
    let profile = options.profile.as_deref().map(|name| toolpaths::plain_profile(name, &[])).transpose()?;
    let mut budget = Budget::of_millions(options.most_work);
    let bytes = output::read(&options.file, budget.most_bytes(), MORE_WORK)?;
    let value = if is_encoded(&bytes) {
        inspect_svg(shown, &bytes, profile.as_ref(), &mut budget)?
    } else {
        inspect_text(shown, &bytes, profile, &mut budget)?
    };
    if !options.json {
        return output::to_stdout(in_words(&value).as_bytes());
    }
    let mut value = value;
    value["warnings"] = json!(messages::warnings());
    output::print_json(&value)
}

/// True if a file begins as gzip or UTF-16. Of the formats read, only SVG may.
fn is_encoded(bytes: &[u8]) -> bool {
    matches!(bytes, [0x1f, 0x8b, ..] | [0xff, 0xfe, ..] | [0xfe, 0xff, ..])
}

fn inspect_text(shown: &str, bytes: &[u8], profile: Option<Profile>, budget: &mut Budget) -> Result<Value, Failure> {
    let text =
        std::str::from_utf8(bytes).map_err(|_| Failure::Work(format!("{shown} is not SVG, HP-GL or G-code: it is not text")))?;
    Ok(match language_of(shown, text) {
        Some(Language::Svg) => inspect_svg(shown, bytes, profile.as_ref(), budget)?,
        Some(language) => {
            let profile = profile.map_or_else(|| usual_profile(language, text), Ok)?;
            if profile.language() != language {
                return Err(Failure::Usage(format!("{shown} is {}, which {} does not read", language.title(), profile.name)));
            }
            let motion = profile.read(text, budget).map_err(|error| Failure::Work(format!("{shown}: {}", advised(&error))))?;
            inspect_motion(language.key(), &motion, &profile)?
        }
        None => return Err(Failure::Work(format!("{shown} is not SVG, HP-GL or G-code"))),
    })
}

/// The language of a file: as its text begins, an SVG's whatever its name, else as its name ends.
fn language_of(name: &str, text: &str) -> Option<Language> {
    let begins = Language::of_text(text);
    let name = name.to_ascii_lowercase();
    let ends = |language: &Language| language.extensions().iter().any(|extension| name.ends_with(&format!(".{extension}")));
    let by_name = Language::ALL.into_iter().filter(|language| *language != Language::Svg).find(ends);
    begins.filter(|language| *language == Language::Svg).or(by_name).or(begins)
}

/// The profile by which a file is read when none was given.
pub(super) fn usual_profile(language: Language, text: &str) -> Result<Profile, Failure> {
    match language {
        Language::Hpgl => Ok(Profile::built_in("hp7475a")?),
        Language::Gcode | Language::Svg => gcode_profile(text),
    }
}

/// The built-in profile named in the file, else one whose pen commands the file uses.
fn gcode_profile(text: &str) -> Result<Profile, Failure> {
    let named = text.lines().take(3).find_map(|line| line.trim_start_matches(['(', ';', ' ']).strip_prefix("drypoint "));
    let name = named.and_then(|rest| rest.split(" for ").nth(1)).map(|name| name.trim_end_matches(')'));
    if let Some(profile) = name.and_then(|name| Profile::built_in(name).ok()) {
        return Ok(profile);
    }
    for name in built_in_names() {
        let profile = Profile::built_in(name)?;
        let Dialect::Gcode(gcode) = &profile.dialect else { continue };
        let down = gcode.pen_down.as_deref().filter(|_| profile.height().is_none());
        if down.is_some_and(|down| text.lines().any(|line| line.trim() == down)) {
            return Ok(profile);
        }
    }
    Err(Failure::Work("no built-in profile matches the pen commands of this G-code; pass --profile".to_owned()))
}

fn inspect_svg(name: &str, bytes: &[u8], profile: Option<&Profile>, budget: &mut Budget) -> Result<Value, Failure> {
    let mut imported = read_svg_within(bytes, budget).map_err(|error| Failure::about(name)(&advised(&error)))?;
    if let Some(profile) = profile {
        fit_to_machine(&mut imported, profile);
    }
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
    if !imported.dropped.is_empty() {
        warning!("left out or read otherwise: {}", imported.dropped.summary());
    }
    if let Some(recipe) = &imported.recipe {
        value["recipe"] = serde_json::from_str(recipe).unwrap_or(Value::Null);
    }
    if let Some(profile) = profile {
        let model = if imported.recipe.is_some() && !imported.is_toolpaths { InkModel::Ink } else { InkModel::Lines };
        let plot = lower(&imported.drawing(), model, &Nibs::all(0.3), 0.02, interrupt())?;
        let mounting = mount(profile, &plot.page);
        if let Err(error) = &mounting {
            warning!("no plotting time: {error}");
        }
        let mounting = mounting.ok();
        let home = home_of(mounting.as_ref(), &plot);
        value["plot"] = json!(report(&plot, home, mounting.as_ref().map(|mounting| (profile, mounting)), None, interrupt())?);
    }
    Ok(value)
}

/// Reports motion in machine units in millimetres.
fn inspect_motion(format: &str, motion: &Strokes, profile: &Profile) -> Result<Value, Failure> {
    let bounds = motion.visited.iter().map(|p| Rect::from_points(*p, *p)).reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
    let mm = |p: Point| (p.to_vec2() / profile.units_per_mm).to_point();
    let mut plot = Plot { page: Page::new(1.0, 1.0), pens: Vec::new() };
    for run in motion.paths.chunk_by(|a, b| a.0 == b.0) {
        let number = run[0].0;
        plot.pens.push(PenPaths {
            number,
            name: format!("pen {number}"),
            colour: Colour::BLACK,
            nib: 0.0,
            handling: Handling::default(),
            paths: run.iter().filter_map(|(_, path)| Toolpath::new(path.iter().map(|p| mm(*p)).collect())).collect(),
        });
    }
    // The file has machine coordinates, and an HP-GL file ends at the far corner of the reach.
    let to_machine = Affine::scale(profile.units_per_mm);
    let mounting = Mounting::new(profile, to_machine, bounds);
    let size: Vec2 = mm(Point::new(bounds.x1, bounds.y1)) - mm(Point::new(bounds.x0, bounds.y0));
    let drawn = motion.paths.iter().flat_map(|(_, path)| path).map(|p| Rect::from_points(mm(*p), mm(*p)));
    let drawn = drawn.reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
    Ok(json!({
        "format": format,
        "profile": profile.name,
        "bounds_units": [bounds.x0, bounds.y0, bounds.x1, bounds.y1],
        "moves_over_mm": [size.x, size.y],
        "draws_over_mm": [drawn.width(), drawn.height()],
        "pauses": motion.pauses,
        "ends_with_pen_up": motion.ends_up,
        "plot": told(&report(&plot, Point::ORIGIN, Some((profile, &mounting)), None, interrupt())?),
    }))
}

/// The report without what a machine's file does not contain: nibs, and amounts from before lowering and ordering.
fn told(report: &PlotReport) -> Value {
    let mut value = json!(report);
    let strip = |amounts: &mut Value| {
        if let Some(map) = amounts.as_object_mut() {
            map.retain(|key, _| !["nib_mm", "covered_fraction", "spill_fraction", "pen_up_mm_before"].contains(&key.as_str()));
        }
    };
    value["pens"].as_array_mut().into_iter().flatten().for_each(strip);
    strip(&mut value["total"]);
    value
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
