//! Line directions on the mean face, carried to a given face.
//!
//! The directions were laid down once, by hand, along chains of the mesh's points on the mean of eight faces (frame: x from ear to ear,
//! length 1, y from forehead to chin): arches over brow and nose, hollows below the eyes, bows from nose to ear and around the chin. Each
//! is one signed angle, so that no singular point can arise inside a face: eyes and mouth are lenses, over and under which lines part.

use crate::elementary::Elementary as _;
use crate::geometry::{Point, Vec2};
use crate::source::{Landmarks, POINTS};
use crate::style::head::Head;
use std::sync::LazyLock;

/// One line for each point of the mesh: x, y, and the angle of the lines from +x towards +y, in degrees.
const TABLE: &str = include_str!("canonical_field.txt");
/// Neighbours by which the map from the mean face is fitted around each point.
const NEIGHBOURS: usize = 12;
/// Weight of the head's own frame in that map, where neighbours lie in a line.
const FRAME_WEIGHT: f64 = 1e-6;
/// Steepest direction on a face in radians from the line between the ears: steeper ones would turn over in turned heads.
const STEEPEST: f64 = 1.35;

/// A point of the mean face with the direction there and its nearest points.
struct CanonicalPoint {
    place: Vec2,
    angle: f64,
    /// Indices and weights.
    near: Vec<(usize, f64)>,
}

static CANONICAL: LazyLock<Vec<CanonicalPoint>> = LazyLock::new(|| {
    let rows = TABLE.lines().map(|line| {
        let mut numbers = line.split_ascii_whitespace().map(|word| word.parse().unwrap_or(0.0));
        [(); 3].map(|()| numbers.next().unwrap_or(0.0))
    });
    let rows: Vec<[f64; 3]> = rows.collect();
    let place = |[x, y, _]: [f64; 3]| Vec2::new(x, y);
    let point = |row: &[f64; 3]| {
        let mut near: Vec<(usize, f64)> =
            rows.iter().enumerate().map(|(j, other)| (j, (place(*other) - place(*row)).hypot2())).collect();
        near.sort_by(|a, b| a.1.total_cmp(&b.1));
        near.truncate(NEIGHBOURS);
        let farthest = near[near.len() - 1].1;
        near.iter_mut().for_each(|(_, away)| *away = (-*away / (0.5 * farthest + 1e-9)).exponential());
        CanonicalPoint { place: place(*row), angle: row[2].to_radians(), near }
    };
    rows.iter().map(point).collect()
});

/// The places of a face's points and the angle of the lines there from the line between its ears, in radians, anticlockwise against
/// the page's y (towards the chin is positive).
pub(super) fn directions(face: &Landmarks, head: &Head) -> Vec<(Point, f64)> {
    (0..POINTS.min(CANONICAL.len()))
        .map(|i| {
            let canonical = &CANONICAL[i];
            let [along, down] = map_about(face, head, i);
            let (sin, cos) = canonical.angle.sine_and_cosine();
            let line = along * cos + down * sin;
            let angle = line.dot(head.down).angle_over(line.dot(head.across));
            (face.point(i), angle.clamp(-STEEPEST, STEEPEST))
        })
        .collect()
}

/// The linear map from the mean face around a point, by weighted least squares: the images of its two axes.
fn map_about(face: &Landmarks, head: &Head, i: usize) -> [Vec2; 2] {
    let canonical = &CANONICAL[i];
    let here = face.point(i);
    let (mut xx, mut xy, mut yy) = (FRAME_WEIGHT, 0.0, FRAME_WEIGHT);
    let (mut x, mut y) = (head.across * (FRAME_WEIGHT * head.width), head.down * (FRAME_WEIGHT * head.width));
    for (j, weight) in &canonical.near {
        let from = CANONICAL[*j].place - canonical.place;
        let to = face.point(*j) - here;
        let w = weight * weight;
        (xx, xy, yy) = (xx + w * from.x * from.x, xy + w * from.x * from.y, yy + w * from.y * from.y);
        (x, y) = (x + to * (w * from.x), y + to * (w * from.y));
    }
    let determinant = xx * yy - xy * xy;
    [(x * yy - y * xy) / determinant, (y * xx - x * xy) / determinant]
}

#[cfg(test)]
pub(in crate::style) mod tests {
    use super::*;
    use crate::drawing::Page;
    use crate::geometry::Rect;
    use crate::source::{Crop, Iris, Limits, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
    use image::{DynamicImage, GrayImage, ImageFormat, Luma};
    use std::io::Cursor;

    /// A grey square of 60 mm with the mean face in its middle, 36 mm wide, turned by an angle. `grey` is the photograph at a place
    /// in millimetres.
    pub(in crate::style) fn mean_portrait(pixels_per_mm: f64, turn: f64, grey: impl Fn(Point) -> u8) -> Portrait {
        let at = |x: u32, y: u32| Luma([grey(Point::new(0.25 * f64::from(x), 0.25 * f64::from(y)))]);
        let mut png = Cursor::new(Vec::new());
        DynamicImage::ImageLuma8(GrayImage::from_fn(240, 240, at)).write_to(&mut png, ImageFormat::Png).unwrap();
        let photograph = Photograph::decode(png.get_ref(), Limits::default()).unwrap();
        let placement = Placement::new(Rect::new(0.0, 0.0, 60.0, 60.0), pixels_per_mm);
        let (page, crop) = (Page::new(60.0, 60.0), Crop::all(&photograph));
        let mut portrait =
            Portrait::new(&photograph, crop, page, placement, ToneTarget::Lightness, ToneCurve::default()).unwrap();
        portrait.add_faces(&[mean_face(Point::new(120.0, 120.0), 144.0, turn)], &photograph, crop).unwrap();
        portrait
    }

    /// The mean face itself, turned by an angle.
    fn mean_face(middle: Point, width: f64, turn: f64) -> Landmarks {
        let (sin, cos) = turn.sine_and_cosine();
        let points = CANONICAL.iter().map(|point| {
            let p = point.place * width;
            [middle.x + p.x * cos - p.y * sin, middle.y + p.x * sin + p.y * cos, 0.0]
        });
        let iris = Iris { centre: middle, radius: 1.0 };
        Landmarks { points: points.collect(), irises: [iris; 2], spectacles: None, pearls: Vec::new() }
    }

    #[test]
    fn the_mean_face_has_its_own_directions_however_it_is_turned() {
        assert_eq!(CANONICAL.len(), POINTS);
        for turn in [0.0, 0.4, -0.7] {
            let face = mean_face(Point::new(200.0, 200.0), 100.0, turn);
            for (i, (_, angle)) in directions(&face, &Head::new(&face)).iter().enumerate() {
                assert!((angle - CANONICAL[i].angle).abs() < 0.02, "point {i}: {angle} {}", CANONICAL[i].angle);
            }
        }
    }
}
