//! The people without the background: three runs of a coarse network where people are expected, unanimity and colours elsewhere,
//! then the photograph's own edges.

use super::SeeError;
use super::colours::Colours;
use super::head::Head;
use super::looks::PersonMaps;
use super::networks::Network;
use super::shaded_gaps::with_shaded_gaps;
use super::small_people::with_small_people;
use super::unseen_black::without_unseen_black;
use super::view::{Outside, View, Window, on_view};
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Rect};
use crate::raster::{Raster, components, dilate, erode, guided_enlargement};

/// Thresholds on the network's probability: background up to the first, person from the second, smooth between. From 0.5 to 1 a
/// dark jacket on a dark ground is lost (intersection over union on the astronaut: 0.972 with 0.4 and 0.9, 0.969 with 0.5 and 1).
const DOUBT: [f32; 2] = [0.4, 0.9];
/// Pixels around a piece that are kept for the soft edge.
const SOFT: usize = 3;

/// Longer side in pixels of the decision grid, the same as the network's.
const GRID: usize = 256;
/// Radius of the guided filter's windows in pixels of that grid: hair's edges come out clean at 1 % of the longer side; at 3 %
/// the background's own edges leak in.
const REACH: usize = 2;
/// The guided filter's `eps`, for values 0 to 1: edges of a hundredth count.
const EPS: f64 = 1e-4;

/// Share of each pixel of the view that belongs to a person whose face was found, 0 to 255. `strangers` are the detector's boxes
/// of people behind, who are background.
pub(super) fn subject(
    network: &Network,
    view: &View,
    faces: &[Vec<[f64; 3]>],
    strangers: &[Rect],
) -> Result<Raster<u8>, SeeError> {
    let heads: Vec<Head> = faces.iter().map(|points| Head::new(points)).collect();
    let whole = everybody(network, view, &heads, strangers)?;
    let fine = with_small_people(whole, view, &heads, |view, heads| everybody(network, view, heads, strangers))?;
    let person = without_crumbs(&pieces_with_a_face(&fine, view, &heads));
    let person = with_shaded_gaps(person, view, &heads);
    Ok(if is_face_alone(&person, view, &heads) { person.map(|_| u8::MAX) } else { person })
}

/// Share of each pixel of a view that belongs to anybody who looks like these people.
fn everybody(network: &Network, view: &View, heads: &[Head], strangers: &[Rect]) -> Result<Raster<u8>, SeeError> {
    let longest = view.pixels.width().max(view.pixels.height());
    let share = |length: usize| (length * GRID.min(longest)).div_ceil(longest);
    let size = [share(view.pixels.width()), share(view.pixels.height())];
    let small = view.resampled_to(&Window::stretched(view.part), size, Outside::Repeated);
    let looks = PersonMaps::new(network, view, heads, size)?;
    let decided = Decision::new(view.part, heads, strangers, &looks).made(&Colours::new(&small));
    let decided = without_unseen_black(&decided, &small, view.part, heads);
    let guide = small.map(|colour| colour.map(|v| v / 255.0));
    Ok(guided_enlargement(&view.pixels, &guide, &decided, REACH, EPS).map(|v| (255.0 * v).round() as u8))
}

/// True if the network saw nobody around the faces, as in a picture that one face fills: a face that floats on paper is no portrait, and all of the
/// picture is taken for the person.
fn is_face_alone(person: &Raster<u8>, view: &View, heads: &[Head]) -> bool {
    /// Least area of people in areas of their faces without the rims: of 50 portraits they have 1.9 and more, a face alone 1.
    const LEAST: f64 = 1.4;
    let (width, height) = (person.width(), person.height());
    let faces = sure_faces(heads, view.part, width, height);
    let count = |of: &Raster<u8>, from: u8| of.pixels().iter().filter(|v| **v >= from).count() as f64;
    heads.iter().any(|head| head.is_close_up(view.part)) && count(person, SOLID) < LEAST * count(&faces, 1)
}

/// All faces without their rims, on a grid of `columns` by `rows` over a picture.
fn sure_faces(heads: &[Head], picture: Rect, columns: usize, rows: usize) -> Raster<u8> {
    heads
        .iter()
        .fold(Raster::filled(columns, rows, 0), |all, head| all.zip_map(&head.sure(picture, columns, rows), |a: u8, b| a.max(b)))
}

/// Inputs of the decision, on the grid.
struct Decision {
    /// The faces without their rims.
    sure: Raster<u8>,
    /// How much people are expected, 0 to 1.
    expected: Raster<f32>,
    /// How surely it is a skull or an ear, 0 to 1.
    skull: Raster<f32>,
    /// The network's probability: the median where people are expected, the minimum elsewhere.
    said: Raster<f32>,
    middle: Raster<f32>,
    least: Raster<f32>,
}

impl Decision {
    fn new(picture: Rect, heads: &[Head], strangers: &[Rect], looks: &PersonMaps) -> Self {
        let (columns, rows) = (looks.least.width(), looks.least.height());
        let place = |x: usize, y: usize| on_view(picture, (columns, rows), (x, y));
        let sure = sure_faces(heads, picture, columns, rows);
        let most = |of: fn(&Head, Point) -> f64| {
            Raster::from_fn(columns, rows, |x, y| heads.iter().map(|head| of(head, place(x, y)) as f32).fold(0.0, f32::max))
        };
        let (expected, skull) = (most(Head::expectation_at), most(Head::skull_at));
        // Known people take precedence over strangers.
        let cheeks: Vec<Raster<u8>> = heads.iter().map(|head| head.with_cheeks(picture, columns, rows)).collect();
        let own = Raster::from_fn(columns, rows, |x, y| {
            let is_known = cheeks.iter().any(|cheeks| cheeks.get(x, y) != 0);
            let is_strange = !is_known && strangers.iter().any(|bounds| is_in_head(*bounds, place(x, y)));
            if is_strange { expected.get(x, y) } else { 1.0 }
        });
        let least = looks.least.zip_map(&own, |v, own| v * own);
        let middle = looks.middle.zip_map(&own, |v, own| v * own);
        let said = Raster::from_fn(columns, rows, |x, y| between(least.get(x, y), middle.get(x, y), expected.get(x, y)));
        Self { sure, expected, skull, said, middle, least }
    }

    /// The decision, 0 to 1, by the network and by colours sampled where it is clear.
    fn made(&self, colours: &Colours) -> Raster<f32> {
        /// Colours are sampled this far, in pixels of the grid, inside the first decision's subject and background: wisps of hair
        /// with a flag between them belong to neither.
        const INSIDE: [usize; 2] = [2, 1];
        /// Number of rounds of sampling colours and deciding again.
        const ROUNDS: usize = 2;
        let mut decided = self.said.map(sharpened_probability);
        let mut certain = self.least.map(|v| u8::from(v > 0.97));
        for _ in 0..ROUNDS {
            let inside = erode(&certain, INSIDE[0]).zip_map(&self.sure, Ord::max);
            let outside = erode(&decided.map(|v| u8::from(v < 0.4)), INSIDE[1]);
            decided = self.filled(&self.weighed(&colours.log_ratio(&inside, &outside)));
            certain = certain.zip_map(&decided, |certain, v| certain * u8::from(v > 0.9));
        }
        decided
    }

    /// The network's probabilities, raised or lowered by colours.
    fn weighed(&self, colours: &Raster<f32>) -> Raster<f32> {
        /// The network's probabilities are kept at least this far from 0 and 1.
        const CERTAIN: f32 = 0.01;
        /// From the first log ratio of colours on, the network's minimum gives way to its median, fully at the second; beyond
        /// that the colours raise the odds by the factor `FOR` per unit, for at most `MOST_FOR` units. Without this, curls at
        /// necks are lost where nobody is expected.
        const SUPPORT: [f32; 2] = [1.0, 2.0];
        const FOR: f32 = 1.5;
        const MOST_FOR: f32 = 2.0;
        /// Below this probability by the network colours cannot raise the odds.
        const NOBODY: f32 = 0.05;
        /// What is added to the log odds in the skull and its ears, which the network and colours lose before walls of their colour. On
        /// 34 people: at 0 four ears of three of them are lost, at 3 the light above fair hair is hair.
        const SKULL: f32 = 1.5;
        Raster::from_fn(self.said.width(), self.said.height(), |x, y| {
            if self.sure.get(x, y) != 0 {
                return 1.0;
            }
            let (colour, expected) = (colours.get(x, y), self.expected.get(x, y));
            let support = ((colour - SUPPORT[0]) / (SUPPORT[1] - SUPPORT[0])).clamp(0.0, 1.0);
            let said = between(self.least.get(x, y), self.middle.get(x, y), expected.max(support));
            let is_for = if said > NOBODY { FOR * (colour - SUPPORT[1]).clamp(0.0, MOST_FOR) } else { 0.0 };
            let is_for = is_for + SKULL * self.skull.get(x, y);
            let said = said.clamp(CERTAIN, 1.0 - CERTAIN);
            let odds = said / (1.0 - said) * (is_for + against(colour, expected)).exponential();
            sharpened_probability(odds / (1.0 + odds))
        })
    }

    /// Fills holes where the network sees a person: an area of the background's colour that does not touch the background is a
    /// collar, a patch or a lens.
    fn filled(&self, decided: &Raster<f32>) -> Raster<f32> {
        /// From this share of person on a pixel cannot be a hole.
        const WHOLE: f32 = 0.9;
        let (labels, count) = components(&decided.map(|v| u8::from(v < WHOLE)));
        let mut is_open = vec![false; count + 1];
        for (&label, &said) in labels.pixels().iter().zip(self.said.pixels()) {
            is_open[label as usize] |= said <= DOUBT[0];
        }
        let whole = self.said.zip_map(decided, |said, decided| decided.max(sharpened_probability(said)));
        let fills = labels.map(|label| label != 0 && !is_open[label as usize]);
        Raster::from_fn(whole.width(), whole.height(), |x, y| if fills.get(x, y) { whole.get(x, y) } else { decided.get(x, y) })
    }
}

/// Weight of the colours' log ratio relative to the network's log odds, and the most that colours can lower a pixel's log odds;
/// the network at its most certain gives 4.6. With a weight of 1 red flag stays beside hair, at 1.6 white collars on white walls
/// are lost.
const WEIGHT: f32 = 1.25;
const MOST_AGAINST: f32 = 4.5;
/// Log ratio by which colours must favour a pixel where nobody is expected. On sixteen portraits and six samples: at 0 the lights
/// beside a face and the shadow of a head stay, at 3 the corners of hats are lost.
const DEMANDED: f32 = 2.0;

/// What colours add to a pixel's log odds where they speak against it, 0 or less.
fn against(colour: f32, expected: f32) -> f32 {
    (WEIGHT * (colour - DEMANDED * (1.0 - expected))).clamp(-MOST_AGAINST, 0.0)
}

/// Linear interpolation from `a` at 0 to `b` at 1.
fn between(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// Half width and half height of a stranger's head in sides of the detector's box, and its height above the box's middle.
const STRANGER: [f64; 2] = [0.62, 0.8];
const STRANGER_RAISED: f64 = 0.12;

/// True if a point is in the head of a stranger.
fn is_in_head(bounds: Rect, place: Point) -> bool {
    let from = place - bounds.center();
    let (across, down) = (from.x / bounds.width(), from.y / bounds.height() + STRANGER_RAISED);
    (across / STRANGER[0]).hypotenuse(down / STRANGER[1]) < 1.0
}

/// Maps a probability to 0 below [`DOUBT`], to 1 above it, smoothly between.
fn sharpened_probability(v: f32) -> f32 {
    let t = ((v - DOUBT[0]) / (DOUBT[1] - DOUBT[0])).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// From this mask value on pixels are connected into pieces.
const SOLID: u8 = 89;

/// Only the pieces that contain a face: what the network took for a person elsewhere is dropped.
fn pieces_with_a_face(person: &Raster<u8>, view: &View, heads: &[Head]) -> Raster<u8> {
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

/// An island smaller than this share of the largest piece, at half a mask's value, is a crumb: outlined it would be a blot beside the
/// head, as portrait 10's of 1/25000. Larger shares were not tried: hands and tips of hats that stand apart must stay.
const CRUMB: f64 = 1.0 / 1500.0;

/// The mask without islands that would be drawn as blots, and without the faint pixels around them. Those at the edge of a larger piece
/// are wisps of its hair and stay.
fn without_crumbs(person: &Raster<u8>) -> Raster<u8> {
    let (labels, count) = components(&person.map(|v| u8::from(v > 127)));
    let mut areas = vec![0_usize; count + 1];
    labels.pixels().iter().filter(|label| **label != 0).for_each(|label| areas[*label as usize] += 1);
    let least = areas.iter().max().map_or(0.0, |largest| CRUMB * *largest as f64);
    let is_large = |label: u32| label != 0 && areas[label as usize] as f64 >= least;
    if (1..=count as u32).all(is_large) {
        return person.clone();
    }
    let beside = dilate(&labels.map(|label| u8::from(is_large(label))), SOFT);
    let mut is_crumb: Vec<bool> = (0..=count as u32).map(|label| label != 0 && !is_large(label)).collect();
    for (&label, &beside) in labels.pixels().iter().zip(beside.pixels()) {
        is_crumb[label as usize] &= beside == 0;
    }
    let near = dilate(&labels.map(|label| u8::from(is_crumb[label as usize])), SOFT);
    Raster::from_fn(person.width(), person.height(), |x, y| {
        let is_faint = near.get(x, y) != 0 && beside.get(x, y) == 0;
        if is_faint { 0 } else { person.get(x, y) }
    })
}

#[cfg(test)]
mod tests {
    use super::super::head::tests::face;
    use super::*;

    #[test]
    fn a_stranger_beside_the_head_is_background_and_the_head_is_not() {
        let heads = [Head::new(&face(150.0, 110.0, 0.0))];
        let everywhere = || Raster::filled(150, 125, 1.0_f32);
        let looks = PersonMaps { middle: everywhere(), least: everywhere() };
        let decision = Decision::new(Rect::new(0.0, 0.0, 300.0, 250.0), &heads, &[Rect::new(10.0, 110.0, 70.0, 170.0)], &looks);
        assert_eq!((decision.said.get(20, 68), decision.least.get(20, 68)), (0.0, 0.0));
        assert_eq!((decision.said.get(75, 55), decision.said.get(140, 20)), (1.0, 1.0));
    }

    #[test]
    fn a_strangers_box_that_reaches_over_a_cheek_leaves_the_cheek() {
        let heads = [Head::new(&face(150.0, 130.0, -30.0))];
        let everywhere = || Raster::filled(150, 125, 1.0_f32);
        let looks = PersonMaps { middle: everywhere(), least: everywhere() };
        let decision = Decision::new(Rect::new(0.0, 0.0, 300.0, 250.0), &heads, &[Rect::new(20.0, 110.0, 110.0, 200.0)], &looks);
        assert_eq!(decision.said.get(48, 66), 1.0, "beside the outline");
        assert!(decision.said.get(20, 78) < 0.5, "the stranger");
    }

    #[test]
    fn a_face_alone_is_no_portrait_and_a_head_is() {
        let heads = [Head::new(&face(150.0, 110.0, 0.0))];
        let view = View::new(Raster::filled(300, 250, [128_u8; 3]), Rect::new(0.0, 0.0, 300.0, 250.0));
        let sure = heads[0].sure(view.part, 300, 250);
        assert!(is_face_alone(&sure.map(|v| 255 * v), &view, &heads));
        assert!(!is_face_alone(&dilate(&sure, 15).map(|v| 255 * v), &view, &heads));
    }

    #[test]
    fn holes_are_filled_and_bays_are_not() {
        // A person on the left; the background's colour is in a patch inside and in a bay at the edge.
        let said = Raster::from_fn(40, 30, |x, _| if x < 20 { 1.0 } else { 0.0 });
        let is_vetoed = |x: usize, y: usize| (5..9).contains(&x) && (5..9).contains(&y) || x > 14 && (20..24).contains(&y);
        let decided = Raster::from_fn(40, 30, |x, y| if is_vetoed(x, y) { 0.0 } else { said.get(x, y) });
        let decision = Decision {
            sure: Raster::filled(40, 30, 0),
            expected: said.clone(),
            skull: said.clone(),
            middle: said.clone(),
            least: said.clone(),
            said,
        };
        let after = decision.filled(&decided);
        assert_eq!((after.get(6, 6), after.get(17, 21), after.get(2, 2)), (1.0, 0.0, 1.0));
    }

    #[test]
    fn a_crumb_beside_a_person_goes_and_a_hand_stays() {
        let person = Raster::from_fn(200, 100, |x, y| match (x, y) {
            (0..100, _) | (140..150, 60..70) => 255,
            (105..107, 10..12) => 200,
            (100..109, 8..14) => 100,
            _ => 0,
        });
        let after = without_crumbs(&person);
        assert_eq!((after.get(105, 10), after.get(104, 9), after.get(108, 12)), (0, 0, 0));
        assert_eq!((after.get(99, 10), after.get(101, 10), after.get(145, 65)), (255, 100, 255));
    }
}
