//! What a machine will do, as a picture: sheet, reach, ink at nib width, pen-up travel, start and park.

use super::number::{decimal, thousandths};
use crate::geometry::{Point, Rect};
use crate::plot::{Mounting, Plot};
use std::fmt::Write as _;
use std::io;

/// Writes the preview of a plot that starts at `home` on the page. Everything but the ink stands in layers whose names begin with
/// `%`, which plotters' programs and `inspect` pass over.
pub fn write_preview(plot: &Plot, mounting: Option<&Mounting>, home: Point, out: &mut impl io::Write) -> io::Result<()> {
    let sheet = plot.page.rect();
    let reach = mounting.map_or(sheet, Mounting::reach_on_page);
    let park = mounting.map_or(home, |m| m.to_machine.inverse() * m.park);
    let marked = Rect::from_points(home, park).inflate(3.0, 3.0);
    let view = sheet.union(reach).union(marked).inflate(2.0, 2.0);
    let mut text =
        String::from("<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"");
    let (width, height) = (number(view.width()), number(view.height()));
    let _ = writeln!(
        text,
        " width=\"{width}mm\" height=\"{height}mm\" viewBox=\"{} {} {width} {height}\">",
        number(view.x0),
        number(view.y0)
    );
    layer(&mut text, "% sheet", &rectangle(sheet, &format!("fill=\"{}\" stroke=\"#888\" stroke-width=\".2\"", plot.page.paper)));
    let dashes = "fill=\"none\" stroke=\"#d40\" stroke-width=\".3\" stroke-dasharray=\"3 2\"";
    layer(&mut text, "% machine", &rectangle(reach, dashes));
    for pen in &plot.pens {
        let lines: String = pen.paths.iter().map(|path| polyline(&path.points)).collect();
        let style = format!("stroke=\"{}\" stroke-width=\"{}\"", pen.colour, number(pen.nib));
        let name = escaped(&format!("{} {}", pen.number, pen.name));
        let group = format!("<g fill=\"none\" {style} stroke-linecap=\"round\" stroke-linejoin=\"round\">\n{lines}</g>\n");
        layer(&mut text, &name, &group);
        out.write_all(text.as_bytes())?;
        text.clear();
    }
    let travel = format!("<g fill=\"none\" stroke=\"#08c\" stroke-width=\".1\">\n{}</g>\n", travel(plot, home, park));
    layer(&mut text, "% travel", &travel);
    let mark = |p: Point, colour: &str, id: &str| {
        format!(
            "<circle id=\"{id}\" cx=\"{}\" cy=\"{}\" r=\"2\" fill=\"none\" stroke=\"{colour}\" stroke-width=\".5\"/>\n",
            number(p.x),
            number(p.y)
        )
    };
    layer(&mut text, "% start and park", &(mark(home, "#0a0", "start") + &mark(park, "#a00", "park")));
    text.push_str("</svg>\n");
    out.write_all(text.as_bytes())
}

fn layer(text: &mut String, label: &str, content: &str) {
    let _ = write!(text, "<g inkscape:groupmode=\"layer\" inkscape:label=\"{label}\">\n{content}</g>\n");
}

fn rectangle(rect: Rect, style: &str) -> String {
    let [x, y, width, height] = [rect.x0, rect.y0, rect.width(), rect.height()].map(number);
    format!("<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" {style}/>\n")
}

fn polyline(points: &[Point]) -> String {
    let mut text = format!("<path d=\"M{} {}", number(points[0].x), number(points[0].y));
    // A touch is a line of no length, which round ends show.
    let again = if points.len() == 1 { points } else { &points[1..] };
    for p in again {
        let _ = write!(text, "L{} {}", number(p.x), number(p.y));
    }
    text + "\"/>\n"
}

/// Every way that the pen goes in the air.
fn travel(plot: &Plot, home: Point, park: Point) -> String {
    let mut at = home;
    let mut text = String::new();
    for (i, pen) in plot.pens.iter().enumerate() {
        let waits = i > 0 && (pen.number != plot.pens[i - 1].number || pen.handling.pauses);
        if waits {
            text += &polyline(&[at, park]);
            at = park;
        }
        for path in &pen.paths {
            let ends = path.ends();
            if at != ends.start {
                text += &polyline(&[at, ends.start]);
            }
            at = ends.end;
        }
    }
    text + &polyline(&[at, park])
}

fn number(mm: f64) -> String {
    let mut text = String::new();
    decimal(&mut text, thousandths(mm), 3);
    text
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
