//! Hidden-part removal: what lies under opaque ink of another colour is not drawn, as a pen cannot paint over it.

use crate::drawing::{Area, Colour, Dot, Drawing, Mark, Mixing, Painted, Stroke, Width};
use crate::geometry::{BezPath, Rect, Region};
use crate::interrupt::{Interrupt, Interrupted};
use crate::parallel::mapped;
use kurbo::Shape;
use std::sync::OnceLock;

/// Flattening tolerance of outlines that are cut, in millimetres.
const TOLERANCE: f64 = 0.005;

/// Which marks hide what lies below them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hides {
    /// Dots, areas and strokes hide ink of other colours, and white hides all.
    OtherColours,
    /// Fills hide every line below them, whatever their colour; strokes hide nothing.
    AllLines,
    /// Only marks of layers that are [`Mixing::Paint`] hide, and only other colours.
    PaintOnOtherColours,
}

/// Removes the hidden parts of a drawing. The visible parts of paint no longer overlap other colours, so with
/// [`Hides::PaintOnOtherColours`] they need no order and lose their group. `painting` names every mark once, the lowest first;
/// marks that it does not name are removed.
pub fn occluded(drawing: &Drawing, painting: &[Painted], hides: Hides, interrupt: &Interrupt) -> Result<Drawing, Interrupted> {
    occluded_where(drawing, painting, hides, |_, _| true, interrupt)
}

/// As [`occluded`], but only for the marks selected by `is_wanted(layer, mark)`. The others still hide them and are left out.
pub fn occluded_where(
    drawing: &Drawing,
    painting: &[Painted],
    hides: Hides,
    is_wanted: impl Fn(usize, usize) -> bool,
    interrupt: &Interrupt,
) -> Result<Drawing, Interrupted> {
    let mut covers = Covers::new(drawing);
    let is_paint = hides == Hides::PaintOnOtherColours;
    let mut wanted: Vec<Wanted<'_>> = Vec::new();
    for painted in painting.iter().rev() {
        match painted {
            Painted::White(outline) => covers.add(Outline::White(outline), None),
            &Painted::Mark { layer, mark } => {
                let Some((layer_of, the_mark)) = drawing.layers.get(layer).and_then(|l| Some((l, l.marks.get(mark)?))) else {
                    continue;
                };
                let colour = the_mark.colour().unwrap_or(layer_of.ink.colour());
                if is_wanted(layer, mark) {
                    wanted.push(Wanted { place: (layer, mark), mark: the_mark, colour, above: covers.all.len() });
                }
                let is_cover = match hides {
                    Hides::OtherColours => true,
                    Hides::AllLines => !matches!(the_mark, Mark::Stroke(_)),
                    Hides::PaintOnOtherColours => layer_of.mixing == Mixing::Paint,
                };
                if is_cover {
                    covers.add(Outline::Mark(the_mark), Some(colour));
                }
            }
        }
    }
    let cut = |wanted: &Wanted<'_>| {
        interrupt.check()?;
        let mut visible = covers.visible(wanted, hides, interrupt);
        if is_paint && drawing.layers[wanted.place.0].mixing == Mixing::Paint {
            visible.iter_mut().for_each(ungroup);
        }
        Ok((wanted.place, visible))
    };
    let cut: Vec<((usize, usize), Vec<Mark>)> = mapped(&wanted, &cut).into_iter().collect::<Result<_, Interrupted>>()?;
    let mut left: Vec<Vec<(usize, Vec<Mark>)>> = drawing.layers.iter().map(|_| Vec::new()).collect();
    cut.into_iter().for_each(|((layer, mark), visible)| left[layer].push((mark, visible)));
    let mut result = drawing.clone();
    for (layer, mut marks) in result.layers.iter_mut().zip(left) {
        marks.sort_by_key(|(index, _)| *index);
        layer.marks = marks.into_iter().flat_map(|(_, marks)| marks).collect();
    }
    Ok(result)
}

/// A mark whose visible parts are wanted.
struct Wanted<'a> {
    /// Its layer, and its number there.
    place: (usize, usize),
    mark: &'a Mark,
    colour: Colour,
    /// Number of covers above it.
    above: usize,
}

/// Opaque outlines, from the top down.
struct Covers<'a> {
    bounds: Rect,
    cells: Vec<Vec<u32>>,
    all: Vec<Cover<'a>>,
}

/// The source of a cover's outline.
enum Outline<'a> {
    White(&'a BezPath),
    Mark(&'a Mark),
}

struct Cover<'a> {
    of: Outline<'a>,
    /// Computed when first needed.
    outline: OnceLock<BezPath>,
    bounds: Rect,
    /// None for white.
    colour: Option<Colour>,
}

impl Cover<'_> {
    fn outline(&self) -> &BezPath {
        match self.of {
            Outline::White(outline) => outline,
            Outline::Mark(mark) => self.outline.get_or_init(|| outline_of(mark)),
        }
    }
}

/// Removes a mark's group, so that it may be drawn at any time.
fn ungroup(mark: &mut Mark) {
    if let Mark::Stroke(stroke) = mark {
        stroke.group = None;
    }
}

/// Cells per side of the grid in which covers are looked up.
const CELLS: usize = 96;

impl<'a> Covers<'a> {
    fn new(drawing: &Drawing) -> Self {
        let bounds = drawing.bounding_box().unwrap_or(drawing.page.rect());
        Self { bounds, cells: vec![Vec::new(); CELLS * CELLS], all: Vec::new() }
    }

    fn add(&mut self, of: Outline<'a>, colour: Option<Colour>) {
        let bounds = match of {
            Outline::White(outline) => outline.bounding_box(),
            Outline::Mark(mark) => mark.bounding_box(),
        };
        if !bounds.is_finite() || bounds.area() <= 0.0 {
            return;
        }
        let index = self.all.len() as u32;
        self.cells_of(bounds).for_each(|cell| self.cells[cell].push(index));
        self.all.push(Cover { of, outline: OnceLock::new(), bounds, colour });
    }

    fn cells_of(&self, rect: Rect) -> impl Iterator<Item = usize> + use<> {
        let at = |v: f64, low: f64, extent: f64| (((v - low) / extent.max(1e-9) * CELLS as f64).max(0.0) as usize).min(CELLS - 1);
        let columns = at(rect.x0, self.bounds.x0, self.bounds.width())..=at(rect.x1, self.bounds.x0, self.bounds.width());
        let rows = at(rect.y0, self.bounds.y0, self.bounds.height())..=at(rect.y1, self.bounds.y0, self.bounds.height());
        rows.flat_map(move |row| columns.clone().map(move |column| row * CELLS + column))
    }

    /// The outlines above a mark with this box that hide its colour, as one path.
    fn over(&self, wanted: &Wanted<'_>, bounds: Rect, hides: Hides) -> BezPath {
        let hidden_by = |cover: &Cover<'_>| hides == Hides::AllLines || cover.colour != Some(wanted.colour);
        // Each cell lists its covers in order.
        let above = |cell: usize| self.cells[cell].iter().copied().take_while(|cover| (*cover as usize) < wanted.above);
        let mut found: Vec<u32> = self.cells_of(bounds).flat_map(above).collect();
        found.sort_unstable();
        found.dedup();
        let covers = found.into_iter().map(|i| &self.all[i as usize]).filter(|c| c.bounds.overlaps(bounds) && hidden_by(c));
        covers.flat_map(|cover| cover.outline().iter()).collect()
    }

    /// The visible parts of a mark.
    fn visible(&self, wanted: &Wanted<'_>, hides: Hides, interrupt: &Interrupt) -> Vec<Mark> {
        /// Strokes wider than this are cut as areas, narrower ones along their centre lines, in millimetres: a pen's width.
        const WIDE: f64 = 0.8;
        let mark = wanted.mark;
        let bounds = mark.bounding_box();
        if !bounds.is_finite() {
            return vec![mark.clone()];
        }
        let over = self.over(wanted, bounds, hides);
        if over.is_empty() {
            return vec![mark.clone()];
        }
        let cover = Region::new(&over, TOLERANCE);
        match mark {
            Mark::Stroke(stroke) if hides == Hides::AllLines || stroke.widest() <= WIDE => {
                uncovered_stroke(stroke, &cover, interrupt)
            }
            _ => uncovered_area(mark, &cover),
        }
    }
}

/// The pieces of a stroke whose centre line is not covered, with their original widths.
fn uncovered_stroke(stroke: &Stroke, cover: &Region, interrupt: &Interrupt) -> Vec<Mark> {
    let (points, widths) = stroke.sampled(sampling(stroke));
    let pieces = cover.outside_of_line(&points, interrupt);
    if let [whole] = &pieces[..]
        && whole.len() == points.len()
        && whole.iter().zip(&points).all(|((p, _), q)| p == q)
    {
        return vec![Mark::Stroke(stroke.clone())];
    }
    pieces
        .into_iter()
        .filter_map(|piece| {
            let mut curve = BezPath::new();
            piece.iter().enumerate().for_each(|(i, (p, _))| if i == 0 { curve.move_to(*p) } else { curve.line_to(*p) });
            let visible = match stroke.width() {
                Width::Constant(width) => Stroke::even(curve, *width),
                Width::Along(_) => Stroke::swelling(curve, piece.iter().map(|&(_, at)| between(&widths, at)).collect())?,
            };
            Some(Mark::Stroke(visible.like(stroke)))
        })
        .collect()
}

/// Sample spacing in millimetres, fine enough for the curve and its widths.
fn sampling(stroke: &Stroke) -> f64 {
    (0.5 * stroke.widest()).clamp(0.05, 0.5)
}

fn between(values: &[f64], at: f64) -> f64 {
    let i = (at as usize).min(values.len() - 1);
    let next = values[(i + 1).min(values.len() - 1)];
    values[i] + (next - values[i]) * (at - i as f64)
}

/// The visible part of a dot, an area or a wide stroke, as an area; the mark itself if nothing of it is covered.
fn uncovered_area(mark: &Mark, cover: &Region) -> Vec<Mark> {
    let outline = outline_of(mark);
    let before = Region::new(&outline, TOLERANCE);
    let rest = cover.outside_of_area(&before);
    let (area, whole) = (rest.area().abs(), outline.area().abs());
    if area >= whole * (1.0 - 1e-4) {
        return vec![mark.clone()];
    }
    if area <= 1e-4 { Vec::new() } else { vec![Mark::Area(Area { outline: rest, colour: mark.colour() })] }
}

/// A mark's inked outline.
fn outline_of(mark: &Mark) -> BezPath {
    match mark {
        Mark::Dot(dot) => Dot::path(dot),
        Mark::Area(area) => area.outline.clone(),
        Mark::Stroke(stroke) => stroke.ink_outline(TOLERANCE),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Ink, Layer, Page};
    use crate::geometry::Point;

    const RED: Colour = Colour { r: 255, g: 0, b: 0 };

    fn line(text: &str) -> Mark {
        Mark::Stroke(Stroke::even(BezPath::from_svg(text).unwrap(), 0.2))
    }

    fn disc(radius: f64) -> Mark {
        Mark::Dot(Dot::circle(Point::new(10.0, 10.0), radius))
    }

    fn drawing(layers: &[(Colour, Vec<Mark>)]) -> Drawing {
        let layers = (1..).zip(layers).map(|(pen, (colour, marks))| Layer {
            ink: Ink::Colour(*colour),
            marks: marks.clone(),
            ..Layer::new("layer", pen)
        });
        Drawing { page: Page::new(20.0, 20.0), layers: layers.collect() }
    }

    fn drawn(drawing: &Drawing) -> f64 {
        drawing.marks().map(|mark| if let Mark::Stroke(stroke) = mark { stroke.length() } else { 0.0 }).sum()
    }

    #[test]
    fn a_line_under_another_colour_is_cut_and_one_under_its_own_is_not() {
        for (colour, hides, length) in [
            (RED, Hides::OtherColours, 10.0),
            (Colour::BLACK, Hides::OtherColours, 20.0),
            (Colour::BLACK, Hides::AllLines, 10.0),
            (RED, Hides::PaintOnOtherColours, 20.0),
        ] {
            let drawing = drawing(&[(Colour::BLACK, vec![line("M0,10 H20")]), (colour, vec![disc(5.0)])]);
            let seen = occluded(&drawing, &drawing.painting_order(), hides, &Interrupt::never()).unwrap();
            assert!((drawn(&seen) - length).abs() < 0.02, "{hides:?}: {}", drawn(&seen));
            assert_eq!(seen.layers[1].marks.len(), 1);
        }
    }

    #[test]
    fn white_hides_and_what_is_above_stays() {
        let drawing = drawing(&[(Colour::BLACK, vec![line("M0,10 H20"), disc(2.0)])]);
        let white = Painted::White(BezPath::from_svg("M10,0 H20 V20 H10 Z").unwrap());
        let mark = |mark| Painted::Mark { layer: 0, mark };
        let seen = occluded(&drawing, &[mark(0), white, mark(1)], Hides::OtherColours, &Interrupt::never()).unwrap();
        assert!((drawn(&seen) - 10.0).abs() < 0.02, "{}", drawn(&seen));
        assert_eq!(seen.layers[0].marks[1], disc(2.0));
    }

    #[test]
    fn areas_are_cut_exactly() {
        let drawing = drawing(&[(Colour::BLACK, vec![disc(5.0)]), (RED, vec![disc(3.0)])]);
        let seen = occluded(&drawing, &drawing.painting_order(), Hides::OtherColours, &Interrupt::never()).unwrap();
        let ring = std::f64::consts::PI * 16.0;
        assert!((seen.layers[0].ink_mm2() - ring).abs() < 0.1, "{}", seen.layers[0].ink_mm2());
        let all = [drawing.painting_order(), vec![Painted::White(disc_path(9.0))]].concat();
        let all = occluded(&drawing, &all, Hides::OtherColours, &Interrupt::never()).unwrap();
        assert_eq!(all.marks().count(), 0);
    }

    fn disc_path(radius: f64) -> BezPath {
        outline_of(&disc(radius))
    }
}
