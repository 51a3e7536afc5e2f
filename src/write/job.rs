//! Writes a checked job in its machine's language.

use super::{SvgHead, write_gcode, write_hpgl, write_svg_plot, write_svg_plotter};
use crate::plot::{Job, Language};
use std::io::{self, Write};

/// Writes a job: HP-GL, G-code or SVG as its machine reads it; without a machine, its tool paths as SVG. `head` is written to SVG
/// only.
pub fn write_job(job: &Job<'_>, head: &SvgHead, out: &mut impl Write) -> io::Result<()> {
    let Some((machine, mounting)) = job.machine().zip(job.mounting()) else {
        return write_svg_plot(job.plot(), head, out);
    };
    match machine.language {
        Language::Hpgl => write_hpgl(job.plot(), machine, mounting, out),
        Language::Gcode => write_gcode(job.plot(), machine, mounting, out),
        Language::Svg => write_svg_plotter(job.plot(), machine, head, out),
    }
}
