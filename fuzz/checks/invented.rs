//! Drawings invented from bytes: few marks on a small sheet, of every kind, with the coincidences that break geometry (points that
//! meet, widths of 0, loops, retraced lines) more often than chance would bring them.

use arbitrary::{Result, Unstructured};
use drypoint::drawing::{Area, Colour, Dot, Drawing, Ends, Handling, Ink, Layer, Mark, Mixing, Page, Stroke, Width};
use drypoint::geometry::{BezPath, Point, Rect};
use kurbo::Shape;

/// Marks of a drawing; each costs at most some milliseconds at the finest nib.
const MOST_MARKS: usize = 12;
const MOST_LAYERS: usize = 3;
const MOST_SEGMENTS: usize = 8;

/// A sheet of 5 to 60 mm with up to three layers.
pub(crate) fn drawing(u: &mut Unstructured<'_>) -> Result<Drawing> {
    let page = Page::new(length(u, 5.0, 60.0)?, length(u, 5.0, 60.0)?);
    let layers = (0..u.int_in_range(1..=MOST_LAYERS)?).map(|i| layer(u, i, page)).collect::<Result<_>>()?;
    Ok(Drawing { page, layers })
}

fn layer(u: &mut Unstructured<'_>, number: usize, page: Page) -> Result<Layer> {
    let pen = u.int_in_range(1..=3)?;
    let mut layer = Layer::new(&format!("layer <{number}> & \"more\" %+!"), pen);
    layer.ink = Ink::Colour(colour(u)?);
    layer.mixing = if u.arbitrary()? { Mixing::Add } else { Mixing::Paint };
    if u.ratio(1, 8)? {
        layer.handling = Handling {
            pauses: u.arbitrary()?,
            speed_percent: if u.arbitrary()? { Some(length(u, 1.0, 200.0)?) } else { None },
            delay_seconds: length(u, 0.0, 5.0)?,
        };
    }
    for _ in 0..u.int_in_range(0..=MOST_MARKS)? {
        layer.marks.push(mark(u, page)?);
    }
    Ok(layer)
}

fn mark(u: &mut Unstructured<'_>, page: Page) -> Result<Mark> {
    let own = if u.ratio(1, 4)? { Some(colour(u)?) } else { None };
    Ok(match u.int_in_range(0..=3)? {
        0 => Mark::Dot(Dot { colour: own, ..dot(u, page)? }),
        1 => Mark::Area(Area { outline: outline(u, page)?, colour: own }),
        _ => Mark::Stroke(stroke(u, page)?.with_colour(own)),
    })
}

fn dot(u: &mut Unstructured<'_>, page: Page) -> Result<Dot> {
    let (centre, radius) = (place(u, page)?, length(u, 0.0, 4.0)?);
    let blob = if u.ratio(1, 4)? {
        let mut path = kurbo::Ellipse::new(centre, (radius, radius * length(u, 0.2, 1.0)?), length(u, 0.0, 3.0)?).to_path(0.01);
        path.close_path();
        Some(Box::new(path))
    } else {
        None
    };
    Ok(Dot { outline: blob, ..Dot::circle(centre, radius) })
}

fn stroke(u: &mut Unstructured<'_>, page: Page) -> Result<Stroke> {
    let curve = curve(u, page)?;
    let nodes = curve.segments().count() + 1;
    let width = if u.arbitrary()? {
        Width::Constant(length(u, 0.0, 3.0)?)
    } else {
        Width::Along((0..nodes).map(|_| length(u, 0.0, 3.0)).collect::<Result<_>>()?)
    };
    let mut stroke = Stroke::even(curve, 0.0).with_width(width).expect("a width for each node");
    stroke.ends = if u.arbitrary()? { Ends::Round } else { Ends::Flat };
    if u.ratio(1, 8)? {
        let pressure = (0..nodes).map(|_| length(u, 0.0, 1.0)).collect::<Result<_>>()?;
        let times = (0..nodes).map(|i| i as f64 * 0.1).collect();
        stroke = stroke.with_pressure(pressure).and_then(|stroke| stroke.with_times(times)).expect("one for each node");
    }
    stroke.group = if u.ratio(1, 8)? { Some(u.int_in_range(0..=2)?) } else { None };
    Ok(stroke)
}

/// One subpath of lines and cubics, sometimes closed.
fn curve(u: &mut Unstructured<'_>, page: Page) -> Result<BezPath> {
    let start = place(u, page)?;
    let mut at = start;
    let mut path = BezPath::new();
    path.move_to(start);
    for _ in 0..u.int_in_range(1..=MOST_SEGMENTS)? {
        // Back to the start, in place, or anywhere.
        let to = match u.int_in_range(0..=9)? {
            0 => start,
            1 => at,
            _ => place(u, page)?,
        };
        if u.arbitrary()? {
            path.line_to(to);
        } else {
            path.curve_to(place(u, page)?, if u.arbitrary()? { to } else { place(u, page)? }, to);
        }
        at = to;
    }
    if u.ratio(1, 4)? {
        path.close_path();
    }
    Ok(path)
}

/// One or two closed subpaths.
fn outline(u: &mut Unstructured<'_>, page: Page) -> Result<BezPath> {
    let mut path = BezPath::new();
    for _ in 0..u.int_in_range(1..=2)? {
        let mut ring = curve(u, page)?;
        if !matches!(ring.elements().last(), Some(kurbo::PathEl::ClosePath)) {
            ring.close_path();
        }
        path.extend(ring);
    }
    Ok(path)
}

/// On the sheet or a little off it: on a grid of whole millimetres, on its border, or anywhere.
fn place(u: &mut Unstructured<'_>, page: Page) -> Result<Point> {
    Ok(Point::new(along(u, page.width)?, along(u, page.height)?))
}

fn along(u: &mut Unstructured<'_>, size: f64) -> Result<f64> {
    let byte = f64::from(u.arbitrary::<u8>()?);
    Ok(match u.int_in_range(0..=7)? {
        0 => 0.0,
        1 => size,
        2 | 3 => (byte / 255.0 * size).round(),
        4 => -0.1 * size + byte / 255.0 * 1.2 * size,
        5 => 0.5 * size + 1e-9 * byte,
        _ => f64::from(u.arbitrary::<u16>()?) / 65535.0 * size,
    })
}

/// From `least` to `most`, the ends more often than chance would have them.
pub(crate) fn length(u: &mut Unstructured<'_>, least: f64, most: f64) -> Result<f64> {
    let byte = u.arbitrary::<u8>()?;
    Ok(least + (most - least) * (f64::from(byte.saturating_sub(8)) / 239.0).min(1.0))
}

fn colour(u: &mut Unstructured<'_>) -> Result<Colour> {
    let known = [Colour::BLACK, Colour { r: 200, g: 30, b: 30 }, Colour { r: 20, g: 40, b: 200 }, Colour::WHITE];
    Ok(*u.choose(&known)?)
}

/// A rectangle on the sheet.
pub(crate) fn window(u: &mut Unstructured<'_>, page: Page) -> Result<Rect> {
    Ok(Rect::from_points(place(u, page)?, place(u, page)?))
}
