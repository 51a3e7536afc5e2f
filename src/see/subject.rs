//! The people without the background: the median of three looks of a coarse network, then the photograph's own edges.

use super::SeeError;
use super::networks::Network;
use super::sight::outlines::OVAL;
use super::view::{Outside, View, Window};
use crate::geometry::{Point, Rect};
use crate::raster::{Raster, components, dilate, filled_polygon, guided_filter};

/// Side of the padded look in longer sides of the picture, and the grey round it: the network expects the head away from the frame.
const PADDED: f64 = 1.25;
const PADDING: f32 = 127.0;
/// Reach of the look round a head, in widths of the face: to either side, and above the forehead.
const HEAD_SIDE: f64 = 1.7;
const HEAD_TOP: f64 = 1.0;
/// A close-up: the face wider than this part of the picture, or the top of the head, so many heights of the face above the forehead,
/// out of it. There the padded look and the plain one each lose pieces, and neither adds any.
const CLOSE_UP: f64 = 0.5;
const CROWN: f64 = 0.3;
/// A face turned to the side is narrower than its head: its width counts at least this part of its height.
const LEAST_WIDTH: f64 = 0.6;
/// Radius of the guided filter in longer sides, and its least in pixels: hair's edges come out clean at 1 %; at 3 % the background's
/// own edges leak in.
const REACH: f64 = 0.01;
const LEAST_REACH: usize = 4;
/// Its `eps`, values 0 to 1: edges of a hundredth count.
const EPS: f64 = 1e-4;
/// The network's doubt: up to the first it is background, from the second person, smooth between. The flags beside heads, shadows on
/// walls and blurred lights of sixteen portraits lie between 0.3 and 0.8; from 0.5 to 1 a dark jacket on a dark ground goes with them
/// (intersection over union on the astronaut: 0.970 without, 0.972 with 0.4 and 0.9, 0.969 with 0.5 and 1).
const DOUBT: [f32; 2] = [0.4, 0.9];
/// What is at least so much person hangs together.
const SOLID: u8 = 89;
/// Pixels round it that are kept for the soft edge.
const SOFT: usize = 3;

/// A face's place, by which looks are chosen.
struct Head {
    oval: Vec<Point>,
    centre: Point,
    forehead: Point,
    width: f64,
    crown: f64,
}

impl Head {
    fn new(points: &[[f64; 3]]) -> Self {
        let at = |i: usize| Point::new(points[i][0], points[i][1]);
        let (forehead, chin, right, left) = (at(10), at(152), at(234), at(454));
        let up = forehead - chin;
        Self {
            oval: OVAL.map(at).to_vec(),
            centre: right.midpoint(left),
            forehead,
            width: (left - right).hypot().max(LEAST_WIDTH * up.hypot()),
            crown: forehead.y + CROWN * up.y,
        }
    }

    fn is_close_up(&self, picture: Rect) -> bool {
        self.width > CLOSE_UP * picture.width() || self.crown < picture.y0
    }

    /// The part of the picture that the look round this head shows, down to the lower border.
    fn surroundings(&self, picture: Rect) -> Rect {
        let reach = HEAD_SIDE * self.width;
        let wanted = Rect::new(self.centre.x - reach, self.forehead.y - HEAD_TOP * self.width, self.centre.x + reach, picture.y1);
        wanted.intersect(picture)
    }
}

/// How much of each pixel of the view belongs to a person whose face was found, 0 to 255.
pub(super) fn subject(network: &Network, view: &View, faces: &[Vec<[f64; 3]>]) -> Result<Raster<u8>, SeeError> {
    let heads: Vec<Head> = faces.iter().map(|points| Head::new(points)).collect();
    let decided = looks(network, view, &heads)?.map(|v| {
        let t = ((v - DOUBT[0]) / (DOUBT[1] - DOUBT[0])).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    });
    let coarse = with_ovals(&decided, view, &heads);
    let (width, height) = (view.pixels.width(), view.pixels.height());
    let guide = view.pixels.map(|colour| colour.map(|v| f32::from(v) / 255.0));
    let radius = ((REACH * width.max(height) as f64) as usize).max(LEAST_REACH);
    let fine = guided_filter(&guide, &coarse, radius, EPS).map(|v| (255.0 * v).round() as u8);
    Ok(with_a_face(&fine, view, &heads))
}

/// The network's opinion of every pixel, from several looks.
fn looks(network: &Network, view: &View, heads: &[Head]) -> Result<Raster<f32>, SeeError> {
    let picture = view.part;
    let whole = look(network, view, Window::stretched(picture), Outside::Repeated)?;
    let side = PADDED * picture.width().max(picture.height());
    let left = 0.5 * (picture.x0 + picture.x1 - side);
    // All of the room is above: bodies go on below the frame.
    let room = Rect::new(left, picture.y1 - side, left + side, picture.y1);
    let padded = look(network, view, Window::stretched(room), Outside::Grey(PADDING))?;
    if heads.first().is_some_and(|head| head.is_close_up(picture)) {
        return Ok(whole.zip_map(&padded, f32::max));
    }
    let mut near = whole.clone();
    let mut seen = whole.map(|_| false);
    for head in heads {
        let part = head.surroundings(picture);
        let round = look(network, view, Window::stretched(part), Outside::Repeated)?;
        let is_shown = Raster::from_fn(near.width(), near.height(), |x, y| part.contains(view.place(x, y)));
        for (i, &shown) in is_shown.pixels().iter().enumerate().filter(|(_, shown)| **shown) {
            let before = if seen.pixels()[i] { near.pixels()[i] } else { 0.0 };
            near.pixels_mut()[i] = round.pixels()[i].max(before);
            seen.pixels_mut()[i] = shown;
        }
    }
    let median = |a: f32, b: f32, c: f32| a.max(b).min(a.min(b).max(c));
    Ok(Raster::from_fn(near.width(), near.height(), |x, y| median(whole.get(x, y), padded.get(x, y), near.get(x, y))))
}

/// What the network says of a window that is an upright box, on the view's grid, in steps of 8 bits.
fn look(network: &Network, view: &View, window: Window, outside: Outside) -> Result<Raster<f32>, SeeError> {
    let side = network.side;
    let [numbers] = network.run(&view.through(&window, side, outside), 1.0 / 255.0, 0.0)?;
    if numbers.len() != side * side {
        return Err(SeeError::Network { network: "selfie_segmentation", reason: "its mask has another size".to_owned() });
    }
    let steps = numbers.into_iter().map(|v| (255.0 * v.clamp(0.0, 1.0)).round() / 255.0).collect();
    let coarse = Raster::from_vec(side, side, steps);
    Ok(Raster::from_fn(view.pixels.width(), view.pixels.height(), |x, y| {
        let from = view.place(x, y) - window.origin;
        coarse.sample(from.x / window.across.x * side as f64, from.y / window.down.y * side as f64)
    }))
}

/// The faces themselves are person, whatever the network says.
fn with_ovals(person: &Raster<f32>, view: &View, heads: &[Head]) -> Raster<f32> {
    let step = view.step();
    heads.iter().fold(person.clone(), |person, head| {
        let from = |p: &Point| *p - view.part.origin();
        let oval: Vec<[f64; 2]> = head.oval.iter().map(|p| [from(p).x / step.x, from(p).y / step.y]).collect();
        let inside = filled_polygon(person.width(), person.height(), &oval);
        person.zip_map(&inside, |v, inside| v.max(f32::from(inside)))
    })
}

/// Only the pieces that hold a face: what the network took for a person elsewhere goes.
fn with_a_face(person: &Raster<u8>, view: &View, heads: &[Head]) -> Raster<u8> {
    let (labels, _) = components(&person.map(|v| u8::from(v > SOLID)));
    let step = view.step();
    let held: Vec<u32> = heads
        .iter()
        .map(|head| {
            let from = head.centre - view.part.origin();
            labels.clamped((from.x / step.x) as isize, (from.y / step.y) as isize)
        })
        .filter(|label| *label != 0)
        .collect();
    let kept = dilate(&labels.map(|label| u8::from(held.contains(&label))), SOFT);
    person.zip_map(&kept, |v, kept| v * kept)
}
