//! Tool paths as SVG: for a plotter's own program, or as a picture of what a nib draws.

use super::{Orders, SvgDialect};
use crate::geometry::BezPath;
use crate::plot::{PenPaths, Plot, Toolpath};
use crate::write::{Names, SvgHead, decimal, document, finish, layer_group, lines_group, path_data, thousandths};
use std::fmt::Write as _;
use std::io;
use svg::Node;
use svg::node::Blob;

/// Writes the tool paths of a plot as lines of the pen's width.
pub(in crate::plot) fn write_picture(plot: &Plot, head: &SvgHead, out: &mut dyn io::Write) -> io::Result<()> {
    write_toolpaths(plot, head, None, out, |_, pen| format!("{} {}", pen.number, pen.name))
}

/// The same for a plotter's own program, which takes orders from the layers' names: `!` waits, the number is the pen's, `+S` sets the
/// speed in percent and `+D` waits for milliseconds. The metadata say which machine's percent these are.
pub(super) fn write(dialect: SvgDialect, orders: &Orders<'_>, out: &mut dyn io::Write) -> io::Result<()> {
    let Orders { plot, profile, head, .. } = *orders;
    let percent = |speed: f64| ((speed / dialect.speed_of_percent).round() as i64).clamp(1, 110);
    let machine = serde_json::json!({
        "profile": profile.name,
        "mm_s_of_percent": dialect.speed_of_percent,
        "usual_percent": percent(profile.motion.draw_speed),
    });
    write_toolpaths(plot, head, Some(&machine.to_string()), out, |i, pen| {
        let waits = pen.handling.pauses || (i > 0 && plot.pens[i - 1].number != pen.number);
        let mut label = format!("{}{} {}", if waits { "!" } else { "" }, pen.number, pen.name.replace(['+', '!', '%'], " "));
        let _ = write!(label, " +S{}", percent(pen.handling.speed(profile.motion.draw_speed)));
        if pen.handling.delay_seconds > 0.0 {
            let _ = write!(label, " +D{}", (pen.handling.delay_seconds * 1000.0).round());
        }
        label
    })
}

fn write_toolpaths(
    plot: &Plot,
    head: &SvgHead,
    machine: Option<&str>,
    out: &mut dyn io::Write,
    label: impl Fn(usize, &PenPaths) -> String,
) -> io::Result<()> {
    let places = plot.pens.iter().filter_map(|pen| pen.paths.first().map(Toolpath::first));
    let names = Names::new(head, places.flat_map(|p| [p.x, p.y]));
    let mut document = document(&plot.page, head, machine, &names);
    for (i, pen) in plot.pens.iter().enumerate() {
        let name = names.of_layer(i);
        let mut group = layer_group(&name, &label(i, pen), pen.colour);
        let mut lines = String::new();
        for path in &pen.paths {
            let mut curve = BezPath::new();
            curve.move_to(path.first());
            // A touch is a line of no length: with round ends it shows as the nib's dot.
            path.points()[1..].iter().for_each(|p| curve.line_to(*p));
            if path.is_touch() {
                curve.line_to(path.first());
            }
            lines.push_str("<path d=\"");
            path_data(&mut lines, &curve);
            lines.push_str("\"/>\n");
        }
        let mut width = String::new();
        decimal(&mut width, thousandths(pen.nib), 3);
        group.append(lines_group(&format!("{name}-toolpaths"), &width, pen.colour).add(Blob::new(lines)));
        document.append(group);
    }
    finish(&document, out)
}
