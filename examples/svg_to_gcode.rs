//! Any SVG as G-code that was checked against a machine:
//! `cargo run --release --example svg_to_gcode -- DRAWING.svg OUT.gcode [PROFILE]`

use drypoint::interrupt::Interrupt;
use drypoint::plot::{InkModel, Job, JobOptions, Nibs, Profile};
use drypoint::read::read_svg;
use drypoint::write::SvgHead;
use std::fs::{File, read};

/// Width of the pen's line, in millimetres.
const NIB: f64 = 0.3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [drawing, out, profile @ ..] = &arguments[..] else {
        return Err("give an SVG, the name of a G-code file, and perhaps a machine's profile".into());
    };
    let machine = Profile::built_in(profile.first().map_or("grbl-servo", String::as_str))?;
    let imported = read_svg(&read(drawing)?)?;

    // Refused if it leaves the machine's reach, needs a pen that is not there or a pause that the machine does not know.
    let options = JobOptions::default();
    let nibs = Nibs::all(NIB);
    let job = Job::of_drawing(
        &imported.drawing(),
        InkModel::Lines,
        &nibs,
        Some(&machine),
        &options,
        &|step| eprintln!("{step}"),
        &Interrupt::never(),
    )?;
    let total = &job.report().total;
    println!("{} paths, {:.1} m of line, {:.0} s", total.paths, total.pen_down_mm / 1000.0, total.seconds.unwrap_or(0.0));
    job.write(&SvgHead::default(), File::create(out)?)?;
    Ok(())
}
