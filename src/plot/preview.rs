//! Preview of a plot as SVG: sheet, machine reach, ink at nib width, pen-up travel, start and park.

use crate::drawing::Colour;
use crate::geometry::{Point, Rect};
use crate::plot::{Mounting, PenPaths, Plot};
use crate::write::{decimal, thousandths};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io;

/// How pen-up travel is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShownTravel {
    /// Not at all.
    Off,
    /// As pale lines under the ink, which do not hide a drawing of tens of thousands of paths.
    #[default]
    Faint,
    /// As clear lines under the ink.
    Full,
}

impl ShownTravel {
    /// SVG stroke attributes. All travel is a single path, so that faint lines stay pale where many cross.
    const fn style(self) -> &'static str {
        match self {
            Self::Off => "",
            Self::Faint => "stroke=\"#0088cc\" stroke-opacity=\".4\" stroke-width=\".1\"",
            Self::Full => "stroke=\"#0088cc\" stroke-width=\".12\"",
        }
    }
}

/// Writes the preview of a plot that starts at `home` on the page. Travel lies under the ink, and each pen has a distinct colour.
/// Everything but the ink is in layers whose names begin with `%`, which plotter programs and `inspect` skip.
pub(super) fn write_preview(
    plot: &Plot,
    mounting: Option<&Mounting>,
    home: Point,
    travel: ShownTravel,
    out: &mut dyn io::Write,
) -> io::Result<()> {
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
    let table = rectangle(view, "fill=\"#e8e8e8\"");
    let paper = rectangle(sheet, &format!("fill=\"{}\" stroke=\"#888\" stroke-width=\".2\"", plot.page.paper));
    layer(&mut text, "% sheet", &(table + &paper));
    let dashes = "fill=\"none\" stroke=\"#d40\" stroke-width=\".3\" stroke-dasharray=\"3 2\"";
    layer(&mut text, "% machine", &rectangle(reach, dashes));
    if travel != ShownTravel::Off {
        let ways = format!("<path fill=\"none\" {} d=\"{}\"/>\n", travel.style(), ways(plot, home, park));
        layer(&mut text, "% travel", &ways);
    }
    let shown = shown_colours(plot);
    for pen in &plot.pens {
        layer(&mut text, &escaped(&format!("{} {}", pen.number, pen.name)), &ink(pen, shown[&pen.number]));
        out.write_all(text.as_bytes())?;
        text.clear();
    }
    layer(&mut text, "% start and park", &(mark(home, 1.5, "#0a0", "start") + &mark(park, 2.5, "#a00", "park")));
    text.push_str("</svg>\n");
    out.write_all(text.as_bytes())
}

/// Minimum colour difference (CIE L*a*b*) at which lines of a nib's width are distinct at a glance: black and navy are 81 apart,
/// black and a grey of 20 % 21.
const TOLD_APART: f64 = 25.0;
/// Hues for pens whose own colours are too similar: Okabe and Ito, Color Universal Design (2008), which colour-blind readers can
/// distinguish too; without its yellow and black, which are paper and ink.
const HUES: [Colour; 6] = [
    Colour { r: 0, g: 114, b: 178 },
    Colour { r: 213, g: 94, b: 0 },
    Colour { r: 0, g: 158, b: 115 },
    Colour { r: 204, g: 121, b: 167 },
    Colour { r: 230, g: 159, b: 0 },
    Colour { r: 86, g: 180, b: 233 },
];

/// Each pen's shown colour by pen number: its own, or another hue if its own is close to the paper's or an earlier pen's.
fn shown_colours(plot: &Plot) -> BTreeMap<u32, Colour> {
    let nearest =
        |colour: Colour, others: &[Colour]| others.iter().map(|other| colour.difference(*other)).fold(f64::INFINITY, f64::min);
    let dark = HUES.map(|Colour { r, g, b }| Colour { r: r / 2, g: g / 2, b: b / 2 });
    let own: Vec<Colour> = plot.pens.iter().map(|pen| pen.colour).collect();
    let mut shown = BTreeMap::new();
    let mut taken = vec![plot.page.paper];
    for pen in &plot.pens {
        if shown.contains_key(&pen.number) {
            continue;
        }
        let mut colour = pen.colour;
        if nearest(colour, &taken) < TOLD_APART {
            // Far from the colours shown already and from the other pens' own colours.
            let all = [&taken[..], &own].concat();
            let free = HUES.into_iter().chain(dark).max_by(|a, b| nearest(*a, &all).total_cmp(&nearest(*b, &all)));
            colour = free.unwrap_or(colour);
        }
        shown.insert(pen.number, colour);
        taken.push(colour);
    }
    shown
}

/// The lines of one pen, at nib width.
pub(super) fn ink(pen: &PenPaths, colour: Colour) -> String {
    let told = if colour == pen.colour { String::new() } else { format!("<desc>its own colour is {}</desc>\n", pen.colour) };
    let lines = pen.paths.iter().fold(String::new(), |mut lines, path| {
        let _ = writeln!(lines, "<path d=\"{}\"/>", polyline(path.points()));
        lines
    });
    let style = format!("stroke=\"{colour}\" stroke-width=\"{}\"", number(pen.nib));
    format!("<g fill=\"none\" {style} stroke-linecap=\"round\" stroke-linejoin=\"round\">\n{told}{lines}</g>\n")
}

/// A ring marker. Those of start and park differ in size, since they often coincide.
fn mark(p: Point, radius: f64, colour: &str, id: &str) -> String {
    let [x, y, r] = [p.x, p.y, radius].map(number);
    format!("<circle id=\"{id}\" cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\".5\"/>\n")
}

pub(super) fn layer(text: &mut String, label: &str, content: &str) {
    let _ = write!(text, "<g inkscape:groupmode=\"layer\" inkscape:label=\"{label}\">\n{content}</g>\n");
}

pub(super) fn rectangle(rect: Rect, style: &str) -> String {
    let [x, y, width, height] = [rect.x0, rect.y0, rect.width(), rect.height()].map(number);
    format!("<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" {style}/>\n")
}

/// Path data of one line.
fn polyline(points: &[Point]) -> String {
    let mut text = format!("M{} {}", number(points[0].x), number(points[0].y));
    // A touch is a line of zero length, which round ends make visible.
    let again = if points.len() == 1 { points } else { &points[1..] };
    for p in again {
        let _ = write!(text, "L{} {}", number(p.x), number(p.y));
    }
    text
}

/// All pen-up travel, as path data.
fn ways(plot: &Plot, home: Point, park: Point) -> String {
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

pub(super) fn number(mm: f64) -> String {
    let mut text = String::new();
    decimal(&mut text, thousandths(mm), 3);
    text
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Handling, Page};
    use crate::plot::Toolpath;

    const GREY: Colour = Colour { r: 40, g: 40, b: 40 };

    /// One line of each pen.
    fn plot_of(colours: &[(u32, Colour)]) -> Plot {
        let pen = |&(number, colour): &(u32, Colour)| PenPaths {
            number,
            name: format!("pen {number}"),
            colour,
            nib: 0.3,
            handling: Handling::default(),
            paths: vec![Toolpath::through(Point::new(10.0, 10.0), [Point::new(20.0, f64::from(number))])],
        };
        Plot { page: Page::new(100.0, 100.0), pens: colours.iter().map(pen).collect() }
    }

    fn preview(plot: &Plot, travel: ShownTravel) -> String {
        let mut bytes = Vec::new();
        write_preview(plot, None, Point::ORIGIN, travel, &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn travel_lies_under_the_ink_is_thin_or_left_out() {
        let plot = plot_of(&[(1, Colour::BLACK)]);
        for travel in [ShownTravel::Faint, ShownTravel::Full] {
            let text = preview(&plot, travel);
            assert!(text.find("% travel").unwrap() < text.find("1 pen 1").unwrap(), "{text}");
        }
        assert!(preview(&plot, ShownTravel::Faint).contains("stroke-opacity"));
        assert!(!preview(&plot, ShownTravel::Off).contains("travel"));
    }

    #[test]
    fn pens_can_be_told_apart_and_keep_their_own_colours_where_those_do() {
        let red = Colour { r: 200, g: 0, b: 0 };
        let all = [(1, Colour::BLACK), (2, Colour::BLACK), (3, red), (4, GREY), (5, Colour::WHITE), (2, Colour::BLACK)];
        let shown = shown_colours(&plot_of(&all));
        assert_eq!((shown[&1], shown[&3], shown.len()), (Colour::BLACK, red, 5));
        let seen: Vec<Colour> = shown.into_values().chain([Colour::WHITE]).collect();
        for (i, colour) in seen.iter().enumerate() {
            assert!(seen[..i].iter().all(|other| colour.difference(*other) > TOLD_APART), "{seen:?}");
        }
        assert!(preview(&plot_of(&all), ShownTravel::Faint).contains("<desc>its own colour is #000000</desc>"));
    }
}
