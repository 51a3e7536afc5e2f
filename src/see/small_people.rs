//! Small people in a large picture: the person network sees the whole in 256 pixels, where a small head is a few and its hair none. Each
//! is looked at again from closer.

use super::SeeError;
use super::head::Head;
use super::view::{View, on_view};
use crate::geometry::{Point, Rect, Vec2};
use crate::raster::Raster;

/// A head is small if its face is narrower than this, in longer sides of the picture.
const SMALL: f64 = 0.15;
/// Extent of a closer look around the middle of the head, in widths of the face: to either side, above and below.
const BESIDE: f64 = 2.3;
const ABOVE: f64 = 1.8;
const BELOW: f64 = 2.8;
/// The share of that extent over which the closer look gives way to the whole: bodies go on beyond it.
const FADE: f64 = 0.25;
/// Most heads that are looked at again, the largest: of a crowd nobody has hair to draw.
const MOST: usize = 12;

/// What was seen from closer: the columns and rows of the view, and the share of people there.
struct Closer<'a> {
    head: &'a Head,
    first: [usize; 2],
    people: Raster<u8>,
}

/// The people of a view with those who are small seen from closer; `seen` tells the people of a view, whose first head is the one that is
/// looked at.
pub(super) fn with_small_people(
    whole: Raster<u8>,
    view: &View,
    heads: &[Head],
    seen: impl Fn(&View, &[Head]) -> Result<Raster<u8>, SeeError>,
) -> Result<Raster<u8>, SeeError> {
    let longest = view.part.width().max(view.part.height());
    let mut small: Vec<&Head> = heads.iter().filter(|head| head.width < SMALL * longest).collect();
    small.sort_by(|a, b| b.width.total_cmp(&a.width));
    let closer = small.into_iter().take(MOST).map(|head| closer(view, head, heads, &seen));
    let closer: Vec<Closer<'_>> = closer.collect::<Result<_, _>>()?;
    Ok(if closer.is_empty() { whole } else { joined(&whole, view, &closer) })
}

fn closer<'a>(
    view: &View,
    head: &'a Head,
    heads: &'a [Head],
    seen: &impl Fn(&View, &[Head]) -> Result<Raster<u8>, SeeError>,
) -> Result<Closer<'a>, SeeError> {
    let (centre, width, step) = (head.centre, head.width, view.step());
    let around =
        Rect::new(centre.x - BESIDE * width, centre.y - ABOVE * width, centre.x + BESIDE * width, centre.y + BELOW * width);
    let around = around - view.part.origin().to_vec2();
    let range = |from: f64, to: f64, step: f64, count: usize| {
        let from = ((from / step).floor().max(0.0) as usize).min(count - 1);
        from..((to / step).ceil().max(0.0) as usize).clamp(from + 1, count)
    };
    let columns = range(around.x0, around.x1, step.x, view.pixels.width());
    let rows = range(around.y0, around.y1, step.y, view.pixels.height());
    let at = |column: usize, row: usize| view.part.origin() + Vec2::new(column as f64 * step.x, row as f64 * step.y);
    let part = Rect::from_points(at(columns.start, rows.start), at(columns.end, rows.end));
    let near = View::new(view.pixels.part(&columns, &rows), part);
    let others = heads.iter().filter(|other| !std::ptr::eq(*other, head) && part.contains(other.centre));
    let around: Vec<Head> = std::iter::once(head).chain(others).cloned().collect();
    Ok(Closer { head, first: [columns.start, rows.start], people: seen(&near, &around)? })
}

/// The people of the whole, and those of each closer look near its head. What one of them sees is a person: a closer look does not know a
/// neighbour's body from the ground.
fn joined(whole: &Raster<u8>, view: &View, closer: &[Closer<'_>]) -> Raster<u8> {
    let (columns, rows) = (whole.width(), whole.height());
    Raster::from_fn(columns, rows, |x, y| {
        let place = on_view(view.part, (columns, rows), (x, y));
        let near = closer.iter().filter_map(|look| {
            let [column, row] = [x.checked_sub(look.first[0])?, y.checked_sub(look.first[1])?];
            let is_inside = column < look.people.width() && row < look.people.height();
            is_inside.then(|| (nearness(look.head, place) * f64::from(look.people.get(column, row))).round() as u8)
        });
        near.fold(whole.get(x, y), u8::max)
    })
}

/// 1 around a head, falling to 0 at the border of its closer look.
fn nearness(head: &Head, place: Point) -> f64 {
    let from = (place - head.centre) / head.width;
    let down = from.y / if from.y < 0.0 { ABOVE } else { BELOW };
    let out = (from.x.abs() / BESIDE).max(down.abs());
    ((1.0 - out) / FADE).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::super::head::tests::face;
    use super::*;
    use std::cell::RefCell;

    fn picture(width: f64) -> View {
        View::new(Raster::filled(400, 300, [128_u8; 3]), Rect::new(0.0, 0.0, width, 0.75 * width))
    }

    #[test]
    fn a_small_head_is_seen_again_from_closer_and_what_the_whole_sees_stays() {
        // The same face fills a third of one picture and a twelfth of the other.
        let heads = [Head::new(&face(150.0, 110.0, 0.0))];
        let parts = RefCell::new(Vec::new());
        let everybody = |view: &View, _: &[Head]| {
            parts.borrow_mut().push(view.part);
            Ok(view.pixels.map(|_| 255_u8))
        };
        let nobody = || Raster::filled(400, 300, 0_u8);
        let close = picture(3.0 * heads[0].width);
        assert_eq!(with_small_people(nobody(), &close, &heads, everybody).expect("it was seen"), nobody());
        assert!(parts.borrow().is_empty());
        let far = picture(12.0 * heads[0].width);
        let step = far.step().x;
        let whole = Raster::from_fn(400, 300, |x, _| if x > 390 { 200_u8 } else { 0 });
        let after = with_small_people(whole, &far, &heads, everybody).expect("it was seen");
        let at = |p: Point| after.get((p.x / step) as usize, (p.y / step) as usize);
        let (centre, width) = (heads[0].centre, heads[0].width);
        assert!(parts.borrow()[0].width() < 5.0 * width);
        assert_eq!(
            [at(centre), at(centre + Vec2::new(0.0, 1.2 * width)), at(centre + Vec2::new(4.0 * width, 0.0))],
            [255, 255, 0]
        );
        assert_eq!(after.get(395, 5), 200);
    }
}
