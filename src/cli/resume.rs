//! `drypoint resume`: the rest of a machine's file.

use super::arguments::ResumeOptions;
use super::failure::Failure;
use super::output;
use crate::resume::{Stop, resume_gcode, resume_hpgl};

/// Plotter units a millimetre, near enough for how much is drawn again.
const HPGL_UNITS_PER_MM: f64 = 40.0;
/// A file of many days' drawing, in bytes. Short instructions take thirty times their length in memory.
const MOST_BYTES: u64 = 1 << 26;

pub(super) fn run(options: &ResumeOptions) -> Result<(), Failure> {
    let stop = match (options.line, options.byte, options.path) {
        (Some(line), None, None) => Stop::Line(line),
        (None, Some(byte), None) => Stop::Byte(byte),
        (None, None, Some(path)) => Stop::Path(path),
        _ => return Err(Failure::Usage("say where the machine stopped: --line N, --byte N or --path N".to_owned())),
    };
    let shown = if options.file == "-" { "stdin" } else { &options.file };
    let text = String::from_utf8(output::read(&options.file, MOST_BYTES, "")?)
        .map_err(|_| Failure::Work(format!("{shown} is neither HP-GL nor G-code: it is not plain text")))?;
    let rest = if is_hpgl(&text) {
        resume_hpgl(&text, stop, options.again * HPGL_UNITS_PER_MM)
    } else {
        resume_gcode(&text, stop, options.again)
    };
    let rest = rest.map_err(|error| Failure::Work(format!("{shown}: {error}")))?;
    output::write(&options.output, |out| out.write_all(rest.as_bytes()))?;
    if !options.quiet && options.output != "-" {
        eprintln!("{}: {} of {} bytes are left to send", options.output, rest.len(), text.len());
    }
    Ok(())
}

/// HP-GL begins with `IN;`, after escape sequences for the interface at most.
fn is_hpgl(text: &str) -> bool {
    text.trim_start().starts_with('\u{1b}') || text.trim_start().starts_with("IN")
}
