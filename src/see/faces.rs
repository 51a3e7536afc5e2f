//! The face detector: boxes and key points over a grid of anchors; boxes of the same face are merged.

use super::SeeError;
use super::networks::{Network, sigmoid, sixteenths, thousandths};
use super::view::{Outside, View, Window};
use crate::elementary::{Elementary as _, angle_of};
use crate::geometry::{Point, Rect, Vec2};
use crate::interrupt::Interrupt;
use crate::parallel::mapped;

/// Least score of a face. On sixteen portraits and the samples, faces with upright heads score 0.88 and more; cats, parrots, a
/// raccoon and a cup score at most 0.60. At 0.6 animals become people, and their drawings lose the background; at 0.9 heads that
/// are tilted or half in shade are missed.
const GATE: f64 = 0.75;
/// Score from which a picture without faces is looked at again, darker, and the least score of a face there. A frowning face with
/// spectacles, without its colours, has 0.74 and then 0.86, and as a drawing in charcoal 0.74 and 0.79. A cat, a raccoon, a quokka, a motorcycle and
/// nine more pictures without people, whole, cut, tilted, light and dark, have at most 0.70 there.
const NEARLY: f64 = 0.68;
const DARKER_GATE: f64 = 0.77;
/// Least score of a box that takes part in the average of a face's boxes.
const CANDIDATE: f64 = 0.5;
/// Boxes with more than this ratio of intersection to union are one face.
const ONE_FACE: f64 = 0.3;
/// A stranger's face is narrower than this fraction of the largest known one: a companion of the same size, missed because of
/// turning away, is not cut out.
const SMALLER: f64 = 2.0 / 3.0;
/// Its middle is at least this far away, in the half sum of both sides.
const BESIDE: f64 = 0.7;
/// A face narrower than this fraction of the longer side calls for a second pass: the detector misses half of those that fill
/// 0.12 of its view and all below 0.08, so there may be others beside it.
const SMALL: f64 = 0.15;
/// A face narrower than this fraction may have companions that are missed: of four people whose faces fill 0.16 of a picture one is found, and
/// all in its tiles. Larger faces leave little room for others, and tiles cut them.
const MEDIUM: f64 = 0.25;
/// Sides of the tiles of the second pass, in longer sides of the picture: finds faces down to 0.05 of it.
const TILES: [f64; 2] = [0.5, 1.0 / 3.0];
/// Least side of a tile in pixels of the picture, twice the detector's own; below it there is no further detail.
const LEAST_TILE: f64 = 256.0;

/// A detected face, in pixels of the upright picture.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub bounds: Rect,
    /// The right eye, the left eye, the nose, the mouth, the right ear, the left ear.
    pub keys: [Point; 6],
    pub score: f64,
}

impl Found {
    /// The angle of the line through the eyes, in radians, clockwise; 0 for an upright head.
    pub(super) fn angle(&self) -> f64 {
        angle_of(self.keys[1] - self.keys[0])
    }

    /// The longer side of its box.
    pub(super) fn side(&self) -> f64 {
        self.bounds.width().max(self.bounds.height())
    }
}

/// How the detector sees a picture.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Exposure {
    AsTaken,
    /// Its values squared.
    Darker,
}

/// The faces found in the picture as a whole, largest first.
pub(super) fn find(detector: &Network, view: &View) -> Result<Vec<Found>, SeeError> {
    let side = view.part.width().max(view.part.height());
    let window = Window::square(view.part.center(), side, 0.0);
    let found = candidates(detector, view, window, Exposure::AsTaken)?;
    let surest = found.iter().map(|found| found.score).fold(0.0, f64::max);
    if (NEARLY..GATE).contains(&surest) {
        return Ok(joined(candidates(detector, view, window, Exposure::Darker)?, DARKER_GATE));
    }
    Ok(joined(found, GATE))
}

/// The boxes of people behind those whose faces are `known`: smaller faces beside theirs with a low score, because they are out
/// of focus, cut by the frame or half hidden.
pub(super) fn strangers(detector: &Network, view: &View, known: &[Found]) -> Result<Vec<Rect>, SeeError> {
    let side = view.part.width().max(view.part.height());
    let widest = known.first().map_or(0.0, |largest| largest.bounds.width());
    let found = joined(candidates(detector, view, Window::square(view.part.center(), side, 0.0), Exposure::AsTaken)?, CANDIDATE);
    let is_stranger =
        |bounds: &Rect| bounds.width() < SMALLER * widest && known.iter().all(|known| is_beside(*bounds, known.bounds));
    Ok(found.into_iter().map(|found| found.bounds).filter(is_stranger).collect())
}

/// True if the boxes' middles are too far apart to be one face.
fn is_beside(a: Rect, b: Rect) -> bool {
    let between = a.center() - b.center();
    let half = 0.5 * (a.size() + b.size());
    (between.x / half.width).hypotenuse(between.y / half.height) > BESIDE
}

/// The known faces and those that a pass over the whole picture misses: small ones, and others beside faces of medium size. Largest first.
pub(super) fn with_missed(
    detector: &Network,
    view: &View,
    known: Vec<Found>,
    interrupt: &Interrupt,
) -> Result<Vec<Found>, SeeError> {
    let longest = view.part.width().max(view.part.height());
    let widest = known.first().map_or(0.0, |largest| largest.bounds.width());
    if widest < SMALL * longest {
        let mut found = known;
        for share in TILES {
            found.extend(in_tiles(detector, view, share * longest, interrupt)?);
        }
        return Ok(joined(found, GATE));
    }
    if widest < MEDIUM * longest {
        let found = joined(in_tiles(detector, view, TILES[0] * longest, interrupt)?, GATE);
        return Ok(with_companions(known, &found));
    }
    Ok(known)
}

/// Candidates in tiles of a side in pixels of the picture that overlap by half; none if the tiles show no more than the whole.
fn in_tiles(detector: &Network, view: &View, side: f64, interrupt: &Interrupt) -> Result<Vec<Found>, SeeError> {
    if side < LEAST_TILE {
        return Ok(Vec::new());
    }
    let (width, height) = (view.part.width(), view.part.height());
    let middles: Vec<(f64, f64)> =
        tile_places(height, side).flat_map(|y| tile_places(width, side).map(move |x| (x, y))).collect();
    let in_tile = |&(x, y): &(f64, f64)| {
        interrupt.check()?;
        let centre = view.part.origin() + Vec2::new(x, y);
        candidates(detector, view, Window::square(centre, side, 0.0), Exposure::AsTaken)
    };
    let found: Vec<Vec<Found>> = mapped(&middles, &in_tile).into_iter().collect::<Result<_, SeeError>>()?;
    Ok(found.concat())
}

/// The known faces, and of those found the ones beside them about as large: what is smaller is a stranger's, or no face. A known face that is
/// much surer among those found is as it is there.
fn with_companions(known: Vec<Found>, found: &[Found]) -> Vec<Found> {
    /// How much higher its score is: by less, sound boxes would move.
    const SURER: f64 = 0.1;
    let surer = |face: Found| {
        let same = found.iter().find(|other| !is_beside(other.bounds, face.bounds) && other.score > face.score + SURER);
        same.cloned().unwrap_or(face)
    };
    let mut faces: Vec<Found> = known.into_iter().map(surer).collect();
    let widest = faces.iter().map(|face| face.bounds.width()).fold(0.0, f64::max);
    let is_companion = |other: &&Found| {
        other.bounds.width() > SMALLER * widest && faces.iter().all(|known| is_beside(other.bounds, known.bounds))
    };
    let companions: Vec<Found> = found.iter().filter(is_companion).cloned().collect();
    faces.extend(companions);
    faces.sort_by(|a, b| b.bounds.area().total_cmp(&a.bounds.area()));
    faces
}

/// Middles of tiles along a side: at most half a tile apart, the first and last tile flush with its ends.
fn tile_places(length: f64, side: f64) -> impl Iterator<Item = f64> {
    let gaps = (2.0 * (length / side - 1.0) - 1e-9).ceil().max(0.0);
    (0..=gaps as usize).map(move |i| if gaps == 0.0 { 0.5 * length } else { 0.5 * side + (length - side) * i as f64 / gaps })
}

/// The detector's boxes with a score of at least [`CANDIDATE`].
fn candidates(detector: &Network, view: &View, window: Window, exposure: Exposure) -> Result<Vec<Found>, SeeError> {
    let side = detector.side as f64;
    let seen = view.through(&window, detector.side, Outside::Grey(0.0));
    let seen = if exposure == Exposure::Darker { seen.map(|rgb| rgb.map(|v| v * v / 255.0)) } else { seen };
    let [boxes, scores] = detector.run(&seen, 1.0 / 127.5, -1.0)?;
    let found = anchors().zip(boxes.chunks_exact(16)).zip(scores).filter_map(|((anchor, numbers), score)| {
        let score = thousandths(sigmoid(score));
        let at = |i: usize| Vec2::new(f64::from(numbers[i]), f64::from(numbers[i + 1])) / side;
        let place = |p: Point| {
            let p = window.place(p.x, p.y);
            Point::new(sixteenths(p.x), sixteenths(p.y))
        };
        let (centre, half) = (anchor + at(0), 0.5 * at(2));
        let bounds = Rect::from_points(place(centre - half), place(centre + half));
        let keys = [4, 6, 8, 10, 12, 14].map(|i| place(anchor + at(i)));
        let is_sound = score >= CANDIDATE && bounds.is_finite() && bounds.area() > 0.0;
        is_sound.then_some(Found { bounds, keys, score })
    });
    Ok(found.collect())
}

/// The middles of the detector's 896 boxes, from 0 to 1: two at each cell of a 16 x 16 grid, then six at each of an 8 x 8 grid.
fn anchors() -> impl Iterator<Item = Point> {
    [(16, 2), (8, 6)].into_iter().flat_map(|(count, each)| {
        let middle = move |i: usize| (i as f64 + 0.5) / count as f64;
        (0..count * count).flat_map(move |i| std::iter::repeat_n(Point::new(middle(i % count), middle(i / count)), each))
    })
}

/// Merges boxes into faces: all that overlap the one with the highest score become their mean weighted by score, with that
/// highest score (weighted non-maximum suppression). Faces from `gate` on, largest first.
fn joined(mut candidates: Vec<Found>, gate: f64) -> Vec<Found> {
    candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut faces = Vec::new();
    while let Some(surest) = candidates.first().cloned().filter(|surest| surest.score >= gate) {
        let (heap, others): (Vec<Found>, Vec<Found>) =
            candidates.into_iter().partition(|other| overlap(other.bounds, surest.bounds) > ONE_FACE);
        candidates = others;
        let weight: f64 = heap.iter().map(|found| found.score).sum();
        let mean =
            |of: &dyn Fn(&Found) -> f64| sixteenths(heap.iter().map(|found| found.score * of(found)).sum::<f64>() / weight);
        let bounds = Rect::new(
            mean(&|found| found.bounds.x0),
            mean(&|found| found.bounds.y0),
            mean(&|found| found.bounds.x1),
            mean(&|found| found.bounds.y1),
        );
        let keys = [0, 1, 2, 3, 4, 5].map(|k| Point::new(mean(&|found| found.keys[k].x), mean(&|found| found.keys[k].y)));
        faces.push(Found { bounds, keys, score: surest.score });
    }
    faces.sort_by(|a, b| b.bounds.area().total_cmp(&a.bounds.area()));
    faces
}

/// Intersection over union.
fn overlap(a: Rect, b: Rect) -> f64 {
    let both = a.intersect(b).area();
    both / (a.area() + b.area() - both)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(x: f64, score: f64) -> Found {
        let bounds = Rect::new(x, 0.0, x + 10.0, 10.0);
        Found { bounds, keys: [bounds.center(); 6], score }
    }

    #[test]
    fn boxes_of_one_face_are_averaged_by_score_and_faint_ones_dropped() {
        let faces = joined(vec![found(0.0, 0.9), found(2.0, 0.6), found(50.0, 0.8), found(90.0, 0.7)], GATE);
        assert_eq!(faces.len(), 2);
        assert_eq!((faces[0].bounds.x0, faces[0].score), (sixteenths(0.8), 0.9));
        assert_eq!(faces[1].bounds.x0, 50.0);
    }

    #[test]
    fn a_smaller_face_beside_is_no_second_guess_at_the_known_one() {
        let known = Rect::new(177.0, 150.0, 540.0, 513.0);
        assert!(is_beside(Rect::new(26.0, 450.0, 216.0, 640.0), known));
        assert!(!is_beside(Rect::new(250.0, 300.0, 440.0, 490.0), known));
    }

    #[test]
    fn a_face_as_large_beside_a_known_one_is_a_companions_and_a_smaller_one_is_not() {
        let of_width = |x: f64, width: f64| Found { bounds: Rect::new(x, 0.0, x + width, width), ..found(x, 0.8) };
        let others = vec![of_width(1.0, 11.0), of_width(40.0, 9.0), of_width(80.0, 5.0)];
        let faces = with_companions(vec![of_width(0.0, 10.0)], &others);
        let places: Vec<f64> = faces.iter().map(|face| face.bounds.x0).collect();
        assert_eq!(places, [0.0, 40.0]);
        let wide = Found { score: 0.75, ..of_width(0.0, 20.0) };
        let sure = Found { score: 0.9, ..of_width(5.0, 10.0) };
        let faces = with_companions(vec![wide], &[sure, of_width(40.0, 9.0)]);
        assert_eq!(faces.iter().map(|face| face.bounds.width()).collect::<Vec<_>>(), [10.0, 9.0]);
    }

    #[test]
    fn there_are_896_anchors_from_the_first_corner_on() {
        let all: Vec<Point> = anchors().collect();
        assert_eq!((all.len(), all[0], all[2]), (896, Point::new(1.0 / 32.0, 1.0 / 32.0), Point::new(3.0 / 32.0, 1.0 / 32.0)));
        assert_eq!((all[512], all[895]), (Point::new(1.0 / 16.0, 1.0 / 16.0), Point::new(15.0 / 16.0, 15.0 / 16.0)));
    }

    #[test]
    fn tiles_reach_both_ends_and_overlap_by_half() {
        let places: Vec<f64> = tile_places(100.0, 40.0).collect();
        assert_eq!((places[0], places[places.len() - 1], places.len()), (20.0, 80.0, 4));
        assert_eq!(tile_places(30.0, 40.0).collect::<Vec<_>>(), [15.0]);
    }
}
