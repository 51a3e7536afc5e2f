//! The overlay: what was found, drawn over the photograph.

use crate::elementary::unit_at;
use crate::geometry::{Point, Rect, resample};
use crate::raster::Raster;
use crate::source::{Crop, Landmarks, Photograph, SourceError, Spectacles, outlines};
use image::{Rgb, RgbImage};

/// Maximum longer side of the overlay, in pixels: enough detail for eyes, and small enough for any viewer.
const LONGEST: f64 = 1600.0;
/// The colour laid over the background, and the fraction of the photograph that shows through.
const BACKGROUND: [f32; 3] = [20.0, 160.0, 60.0];
const SHOWS: f32 = 0.25;
/// Half the width of a line, as a fraction of the overlay's longer side.
const LINE: f64 = 0.0008;

/// A face to draw.
pub(super) struct Overlaid<'a> {
    pub landmarks: &'a Landmarks,
    /// The detector's box, if known.
    pub bounds: Option<Rect>,
}

/// The photograph with a tinted background and the lines of each face. `subject` is 255 inside and has the photograph's proportions.
pub(super) fn overlay(
    photograph: &Photograph,
    subject: Option<&Raster<u8>>,
    faces: &[Overlaid<'_>],
) -> Result<RgbImage, SourceError> {
    let size = [photograph.width(), photograph.height()];
    let scale = (LONGEST / f64::from(size[0].max(size[1]))).min(1.0);
    let [columns, rows] = size.map(|side| (f64::from(side) * scale).round().max(1.0) as usize);
    let mut pixels = photograph.encoded(Crop::all(photograph), columns, rows)?;
    if let Some(subject) = subject {
        let subject = subject.map(|v| f32::from(v) / 255.0);
        let (x_step, y_step) = (subject.width() as f64 / columns as f64, subject.height() as f64 / rows as f64);
        pixels = Raster::from_fn(columns, rows, |x, y| {
            let inside = subject.sample((x as f64 + 0.5) * x_step, (y as f64 + 0.5) * y_step);
            let shows = inside + (1.0 - inside) * SHOWS;
            let colour = pixels.get(x, y);
            let channel = |k: usize| (shows * f32::from(colour[k]) + (1.0 - shows) * BACKGROUND[k]).round() as u8;
            [channel(0), channel(1), channel(2)]
        });
    }
    for face in faces {
        draw_face(&mut pixels, face, scale);
    }
    Ok(RgbImage::from_fn(columns as u32, rows as u32, |x, y| Rgb(pixels.get(x as usize, y as usize))))
}

fn draw_face(pixels: &mut Raster<[u8; 3]>, face: &Overlaid<'_>, scale: f64) {
    let lines: [(&[usize], bool, [u8; 3]); 9] = [
        (&outlines::OVAL, true, [255, 0, 0]),
        (&outlines::LEFT_EYE, true, [0, 255, 0]),
        (&outlines::RIGHT_EYE, true, [0, 255, 0]),
        (&outlines::LEFT_BROW, true, [255, 255, 0]),
        (&outlines::RIGHT_BROW, true, [255, 255, 0]),
        (&outlines::LIPS, true, [255, 0, 255]),
        (&outlines::MOUTH, true, [255, 0, 255]),
        (&outlines::NOSE, false, [0, 200, 255]),
        (&outlines::NOSE_WINGS, false, [0, 200, 255]),
    ];
    for (indices, is_closed, colour) in lines {
        let mut line = face.landmarks.line(indices);
        if is_closed {
            line.extend(line.first().copied());
        }
        draw_line(pixels, &line, scale, colour);
    }
    for line in face.landmarks.spectacles.iter().flat_map(Spectacles::lines) {
        draw_line(pixels, &line, scale, [255, 128, 0]);
    }
    for pearl in &face.landmarks.pearls {
        draw_line(pixels, &circle(pearl.center, pearl.radius), scale, [255, 255, 255]);
    }
    for iris in face.landmarks.irises {
        draw_line(pixels, &circle(iris.centre, iris.radius), scale, [0, 255, 255]);
        draw_line(pixels, &[iris.centre, iris.centre], scale, [0, 255, 255]);
    }
    let Some(b) = face.bounds else { return };
    let corners = [(b.x0, b.y0), (b.x1, b.y0), (b.x1, b.y1), (b.x0, b.y1), (b.x0, b.y0)].map(Point::from);
    draw_line(pixels, &corners, scale, [255, 255, 255]);
}

fn circle(centre: Point, radius: f64) -> Vec<Point> {
    let place = |i: i32| centre + radius * unit_at(f64::from(i) * std::f64::consts::TAU / 32.0);
    (0..=32).map(place).collect()
}

/// Draws a line given in pixels of the photograph.
fn draw_line(pixels: &mut Raster<[u8; 3]>, line: &[Point], scale: f64, colour: [u8; 3]) {
    let half = (LINE * pixels.width().max(pixels.height()) as f64).max(0.5);
    let line: Vec<Point> = line.iter().map(|p| (p.to_vec2() * scale).to_point()).collect();
    let places = if line.windows(2).all(|ends| ends[0] == ends[1]) { line } else { resample(&line, 0.5) };
    for p in places {
        let span = |v: f64| ((v - half).round() as isize)..=((v + half).round() as isize - 1).max((v - half).round() as isize);
        for (x, y) in span(p.y).flat_map(|y| span(p.x).map(move |x| (x, y))) {
            if pixels.contains(x, y) {
                pixels.set(x as usize, y as usize, colour);
            }
        }
    }
}
