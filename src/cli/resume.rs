//! `drypoint resume`: writes the rest of a machine's file.

use super::arguments::ResumeOptions;
use super::failure::Failure;
use super::messages::say;
use super::output;
use super::remedies::advised;
use crate::drawing::Layer;
use crate::plot::{Language, ResumeError, StopPlace as Stop};
use crate::read::read_svg;

/// A file of many days' drawing, in bytes. Short instructions take thirty times their length in memory.
const MOST_BYTES: u64 = 1 << 26;

pub(super) fn run(options: &ResumeOptions) -> Result<(), Failure> {
    let stop = match (options.line, options.byte, options.path) {
        (Some(line), None, None) => Stop::Line(line),
        (None, Some(byte), None) => Stop::Byte(byte),
        (None, None, Some(path)) => Stop::Path(path),
        _ => return Err(Failure::Usage("give the place where the machine stopped: --line N, --byte N or --path N".to_owned())),
    };
    let shown = if options.file == "-" { "stdin" } else { &options.file };
    let text = String::from_utf8(output::read(&options.file, MOST_BYTES, "")?)
        .map_err(|_| Failure::Work(format!("{shown} is not HP-GL or G-code: it is not plain text")))?;
    let language = Language::of_text(&text).unwrap_or(Language::Gcode);
    let rest = language.resume(&text, stop, options.again).map_err(|error| match error {
        ResumeError::OwnProgram => Failure::Work(svg_advice(shown, &text)),
        error => Failure::Work(format!("{shown}: {}", advised(&error))),
    })?;
    output::write(&options.output, |out| out.write_all(rest.as_bytes()))?;
    if !options.quiet && options.output != "-" {
        say!("{}: {} of {} bytes are left to send", options.output, rest.len(), text.len());
    }
    Ok(())
}

/// The message for an SVG: only the program that drives the machine knows where it stopped.
fn svg_advice(shown: &str, text: &str) -> String {
    let imported = read_svg(text.as_bytes()).ok();
    let profile = imported.as_ref().and_then(|svg| Some(svg.speeds.as_ref()?.machine.clone()));
    let layers: Vec<&Layer> = imported.iter().flat_map(|svg| &svg.layers).map(|layer| &layer.layer).collect();
    let named: Vec<String> = layers.iter().map(|layer| format!("{} {}", layer.pen, layer.name)).collect();
    let left: Vec<String> = layers.iter().skip(1).map(|layer| layer.pen.to_string()).collect();
    let from_layer = if left.is_empty() {
        String::new()
    } else {
        format!(
            ". To plot only the remaining layers, name them, out of {}: drypoint plot {shown} --layers {} --profile {} -o rest.svg",
            named.join(", "),
            left.join(","),
            profile.as_deref().unwrap_or("axidraw-v3")
        )
    };
    format!(
        "{shown} is an SVG: the machine is driven by a program of its own, and only that program knows where it stopped. Resume there: the \
         AxiDraw extension for Inkscape has a tab Resume, and axicli --mode res_plot continues with the file that it wrote when \
         paused{from_layer}"
    )
}
