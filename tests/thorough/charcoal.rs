//! Charcoal's guarantees, measured.

use crate::common;

use common::{mean_in, png_of_light, rendered, sample, svg_of, wedge, wedge_patches};
use drypoint::drawing::{Drawing, Layer, Mark, Page, Stroke};
use drypoint::field::{FacialFeature, HoughFilter, HoughForm, histogram_modes};
use drypoint::geometry::{BezPath, Point, Rect};
use drypoint::plot::write_inkml;
use drypoint::raster::Raster;
use drypoint::source::{Crop, Limits, MaskRole, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use drypoint::style::{Observer, Picture, Settings, Silent, find};
use image::{DynamicImage, ImageBuffer, ImageFormat, Rgb};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::io::Cursor;
use std::sync::Mutex;

/// A photograph with its masks and drawing settings.
struct Sitting<'a> {
    photo: &'a [u8],
    mm: (f64, f64),
    tone: ToneTarget,
    set: &'a [(&'a str, &'a str)],
    masks: &'a [(MaskRole, Vec<u8>)],
}

impl<'a> Sitting<'a> {
    fn new(photo: &'a [u8], mm: (f64, f64)) -> Self {
        Self { photo, mm, tone: ToneTarget::Lightness, set: &[], masks: &[] }
    }

    fn settings(&self) -> Settings {
        let given: Vec<(String, String)> = self.set.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
        Settings::resolve("charcoal", find("charcoal").unwrap().parameters(), &given).unwrap()
    }

    fn portrait(&self) -> Portrait {
        let photograph = Photograph::decode(self.photo, Limits::default()).unwrap();
        let picture = Rect::new(0.0, 0.0, self.mm.0, self.mm.1);
        let resolution = find("charcoal").unwrap().resolution(&self.settings(), &[], picture);
        let (crop, page) = (Crop::all(&photograph), Page::new(self.mm.0, self.mm.1));
        let placement = Placement::new(picture, resolution);
        let mut portrait = Portrait::new(&photograph, crop, page, placement, self.tone, ToneCurve::default()).unwrap();
        for (role, bytes) in self.masks {
            let mask = Photograph::decode(bytes, Limits::default()).unwrap();
            portrait.add_mask(*role, &mask, &photograph, crop).unwrap();
        }
        portrait
    }

    fn draw(&self, observer: &dyn Observer) -> Drawing {
        find("charcoal").unwrap().draw(&self.portrait(), &self.settings(), 0, observer).unwrap()
    }
}

/// Collects the feature labels, their tones and all warnings.
#[derive(Default)]
struct Notes {
    features: Mutex<Option<Raster<i32>>>,
    tones: Mutex<Option<Raster<f32>>>,
    warnings: Mutex<Vec<String>>,
}

impl Observer for Notes {
    fn begin(&self, _: &str) {}
    fn progress(&self, _: f64) {}
    fn picture(&self, name: &str, make: &dyn Fn() -> Picture) {
        if name == "features"
            && let Picture::Labels(labels) = make()
        {
            *self.features.lock().unwrap() = Some(labels);
        }
        if name == "feature-tones"
            && let Picture::Grey(tones) = make()
        {
            *self.tones.lock().unwrap() = Some(tones);
        }
    }
    fn warn(&self, message: &str) {
        self.warnings.lock().unwrap().push(message.to_owned());
    }
    fn is_interrupted(&self) -> bool {
        false
    }
}

/// Parallel lines one pixel wide, `spacing` pixels apart, at an angle; then a fraction of the pixels is flipped.
fn line_drawing(size: usize, degrees: f64, spacing: f64, flipped: f64, seed: u64) -> Raster<u8> {
    let normal = (degrees + 90.0).to_radians();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let pixels = (0..size * size).map(|i| {
        let (x, y) = ((i % size) as f64, (i / size) as f64);
        let offset = (x * normal.cos() + y * normal.sin()).rem_euclid(spacing);
        u8::from(offset < 1.0) ^ u8::from(random.random_range(0.0..1.0) < flipped)
    });
    Raster::from_vec(size, size, pixels.collect())
}

#[test]
fn hough_orientation_is_right_on_lines_and_in_noise() {
    let size = 100;
    let filter = HoughFilter::new(HoughForm::Round, 10, 36);
    let region = Raster::filled(size, size, 1_u8);
    for (flipped, most) in [(0.0, 1.0), (0.2, 2.0)] {
        for spacing in [5.0, 8.0, 11.0] {
            let (mut sum, mut count) = (0.0, 0.0);
            for step in 0..36 {
                let degrees = f64::from(step) * 5.0;
                let lines = line_drawing(size, degrees, spacing, flipped, step as u64);
                let field = filter.orientations(&lines, &region).smoothed(15.0);
                for (x, y) in (30..70).step_by(4).flat_map(|y| (30..70).step_by(4).map(move |x| (x, y))) {
                    let found = field.angle(f64::from(x) + 0.5, f64::from(y) + 0.5).unwrap().to_degrees();
                    let off = (found - degrees).rem_euclid(180.0);
                    sum += off.min(180.0 - off);
                    count += 1.0;
                }
            }
            let mean = sum / count;
            println!("Hough, {:.0} % flipped, lines {spacing} px apart: {mean:.2} degrees", 100.0 * flipped);
            assert!(mean <= most, "{flipped} {spacing}: {mean}");
        }
    }
}

/// A sample of a normal distribution.
fn normal(random: &mut ChaCha8Rng) -> f64 {
    let (u, v): (f64, f64) = (random.random_range(1e-12..1.0), random.random_range(0.0..std::f64::consts::TAU));
    (-2.0 * u.ln()).sqrt() * v.cos()
}

/// Two to five Gaussians as the issue states them: means, widths, weights.
fn mixture(random: &mut ChaCha8Rng) -> Vec<(f64, f64, f64)> {
    loop {
        let count = random.random_range(2..=5);
        let mut parts: Vec<(f64, f64, f64)> = (0..count)
            .map(|_| (random.random_range(20.0..235.0), random.random_range(3.0..8.0), random.random_range(0.1..1.0)))
            .collect();
        parts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let total: f64 = parts.iter().map(|p| p.2).sum();
        for part in &mut parts {
            part.2 /= total;
        }
        let apart = parts.windows(2).all(|w| w[1].0 - w[0].0 >= 5.0 * w[0].1.max(w[1].1));
        if apart && parts.iter().all(|p| p.2 >= 0.1) {
            return parts;
        }
    }
}

#[test]
fn scale_space_gives_back_the_modes() {
    let mut right = 0;
    for trial in 0..100 {
        let mut random = ChaCha8Rng::seed_from_u64(trial);
        let parts = mixture(&mut random);
        let mut histogram = vec![0_u32; 256];
        for _ in 0..20_000 {
            let mut pick: f64 = random.random_range(0.0..1.0);
            let part = parts.iter().find(|p| {
                pick -= p.2;
                pick < 0.0
            });
            let (mean, sigma, _) = part.unwrap_or(&parts[0]);
            let grey = (mean + sigma * normal(&mut random)).round().clamp(0.0, 255.0);
            histogram[grey as usize] += 1;
        }
        let modes = histogram_modes(&histogram, 200);
        let matches = modes.len() == parts.len() && modes.iter().zip(&parts).all(|(m, p)| (m.at - p.0).abs() <= 3.0);
        right += usize::from(matches);
        if !matches {
            println!("trial {trial}: {parts:.1?} gave {:.1?}", modes.iter().map(|m| m.at).collect::<Vec<_>>());
        }
    }
    println!("scale space: {right} of 100");
    assert!(right >= 95, "{right}");
}

/// The photograph lit from the left: light falls to half at the right border.
fn side_lit(photo: &[u8]) -> Vec<u8> {
    let picture = image::load_from_memory(photo).unwrap().to_rgba8();
    let width = f64::from(picture.width());
    let lit = |value: u8, share: f64| {
        let v = f64::from(value) / 255.0;
        let linear = if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) } * share;
        let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
        (encoded * 255.0).round() as u8
    };
    let pixels = ImageBuffer::from_fn(picture.width(), picture.height(), |x, y| {
        let share = 1.0 - 0.5 * f64::from(x) / width;
        let p = picture.get_pixel(x, y);
        Rgb([lit(p[0], share), lit(p[1], share), lit(p[2], share)])
    });
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::ImageRgb8(pixels).write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// Boxes of the features in the photograph's pixels, in the order of their labels.
type Boxes = [[f64; 4]; 6];

const ASTRONAUT: Boxes = [
    [186.0, 84.0, 214.0, 96.0],
    [236.0, 88.0, 267.0, 100.0],
    [190.0, 94.0, 215.0, 109.0],
    [234.0, 95.0, 261.0, 110.0],
    [203.0, 120.0, 247.0, 137.0],
    [201.0, 137.0, 252.0, 157.0],
];
/// The brows are seen through the upper rim of the glasses, which hides most of them.
const HOPPER: Boxes = [
    [178.0, 158.0, 252.0, 185.0],
    [276.0, 153.0, 347.0, 181.0],
    [196.0, 177.0, 247.0, 202.0],
    [282.0, 174.0, 334.0, 200.0],
    [234.0, 225.0, 298.0, 254.0],
    [222.0, 264.0, 312.0, 298.0],
];

fn bust_boxes() -> Boxes {
    let text = String::from_utf8(sample("bust-features.txt")).unwrap();
    FacialFeature::ALL.map(|feature| {
        // "eye" must not match "eyebrow": a number follows the name.
        let is_its_own = |line: &&str| line.strip_prefix(feature.name()).is_some_and(|rest| rest.starts_with(' '));
        let line = text.lines().find(is_its_own).unwrap();
        let numbers: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        [numbers[0], numbers[1], numbers[2], numbers[3]]
    })
}

/// Number of the six features whose middle is inside its box, grown by an eighth of its size on each side.
fn features_in_place(name: &str, notes: &Notes, boxes: &Boxes, scale: f64) -> usize {
    let labels = notes.features.lock().unwrap();
    let Some(labels) = labels.as_ref() else {
        println!("{name}: no face");
        return 0;
    };
    let mut right = 0;
    for (i, wanted) in boxes.iter().enumerate() {
        let (mut x, mut y, mut count) = (0.0, 0.0, 0.0);
        for (k, _) in labels.pixels().iter().enumerate().filter(|(_, label)| **label == i as i32 + 1) {
            x += (k % labels.width()) as f64 + 0.5;
            y += (k / labels.width()) as f64 + 0.5;
            count += 1.0;
        }
        let (x, y) = (x / count / scale, y / count / scale);
        let (mx, my) = ((wanted[2] - wanted[0]) / 8.0, (wanted[3] - wanted[1]) / 8.0);
        let is_inside = x >= wanted[0] - mx && x <= wanted[2] + mx && y >= wanted[1] - my && y <= wanted[3] + my;
        if !is_inside {
            println!("{name}: {} at {x:.0}, {y:.0}, not in {wanted:?}", FacialFeature::ALL[i].name());
        }
        right += usize::from(is_inside);
    }
    right
}

const QUICK: &[(&str, &str)] = &[("background", "off"), ("shading", "off"), ("grain", "2mm")];

#[test]
fn features_of_the_busts_are_found_in_both_lights() {
    let masks = [
        (MaskRole::Subject, sample("bust-mask-subject.png")),
        (MaskRole::Hair, sample("bust-mask-hair.png")),
        (MaskRole::Face, sample("bust-mask-face.png")),
    ];
    for name in ["bust-light.png", "bust-brown.png", "bust-dark.png"] {
        for (light, photo) in [("normal", sample(name)), ("side", side_lit(&sample(name)))] {
            let notes = Notes::default();
            Sitting { masks: &masks, set: QUICK, ..Sitting::new(&photo, (90.0, 120.0)) }.draw(&notes);
            let right = features_in_place(name, &notes, &bust_boxes(), 1.0);
            println!("{name}, {light} light: {right} of 6 features");
            assert_eq!(right, 6, "{name}, {light} light");
        }
    }
}

/// The number of features in place without a face mask, in both lights.
fn portrait_features(name: &str, mm: (f64, f64), mask: Vec<u8>, boxes: &Boxes) -> Vec<usize> {
    let masks = [(MaskRole::Subject, mask)];
    let count = |(light, photo): (&str, Vec<u8>)| {
        let notes = Notes::default();
        Sitting { masks: &masks, set: QUICK, ..Sitting::new(&photo, mm) }.draw(&notes);
        let right = features_in_place(name, &notes, boxes, 600.0 / 512.0);
        println!("{name}, {light} light: {right} of 6 features");
        right
    };
    [("normal", sample(name)), ("side", side_lit(&sample(name)))].map(count).to_vec()
}

#[test]
fn features_behind_glasses_are_found_without_a_face_mask() {
    let right = portrait_features("grace-hopper.jpg", (90.0, 105.469), sample("grace-hopper-subject.png"), &HOPPER);
    assert_eq!(right, [6, 6]);
}

#[test]
fn features_under_a_fringe_are_found_without_a_face_mask() {
    let right = portrait_features("astronaut.jpg", (90.0, 90.0), sample_alpha("astronaut-cutout.png"), &ASTRONAUT);
    assert_eq!(right, [6, 6]);
}

/// A picture's alpha as a mask.
fn sample_alpha(name: &str) -> Vec<u8> {
    let picture = image::load_from_memory(&sample(name)).unwrap().to_rgba8();
    let alpha = ImageBuffer::from_fn(picture.width(), picture.height(), |x, y| image::Luma([picture.get_pixel(x, y)[3]]));
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::ImageLuma8(alpha).write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

const TONE_ONLY: &[(&str, &str)] = &[("brighten", "0"), ("features", "off"), ("background", "off"), ("shading", "off")];

/// Only the named layer of a drawing.
fn only(drawing: &Drawing, name: &str) -> Drawing {
    Drawing { page: drawing.page, layers: drawing.layers.iter().filter(|layer| layer.name == name).cloned().collect() }
}

#[test]
fn the_tone_layer_has_the_tone_of_the_wedge() {
    let photo = wedge();
    let sitting = Sitting { tone: ToneTarget::Linear, set: TONE_ONLY, ..Sitting::new(&photo, (60.0, 60.0)) };
    let fine = 40.0;
    let white = rendered(&svg_of(&only(&sitting.draw(&Silent), "tone")), fine);
    for (patch, tone) in wedge_patches() {
        let error = mean_in(&white, patch, fine) - tone;
        println!("tone layer, {tone:.1}: {error:+.4}");
        assert!(error.abs() <= 0.03, "tone {tone}: {error}");
    }
}

#[test]
fn the_grain_does_not_repeat() {
    let grain = 0.5;
    let photo = png_of_light(200, 200, |_, _| 0.5);
    let set: Vec<(&str, &str)> = TONE_ONLY.iter().copied().chain([("grain", "0.5mm")]).collect();
    let sitting = Sitting { tone: ToneTarget::Linear, set: &set, ..Sitting::new(&photo, (60.0, 60.0)) };
    let scale = 12.0;
    let white = rendered(&svg_of(&only(&sitting.draw(&Silent), "tone")), scale);
    let mean = white.pixels().iter().map(|v| f64::from(*v)).sum::<f64>() / white.len() as f64;
    let size = 420;
    let correlation = |dx: usize, dy: usize| {
        let mut sum = 0.0;
        for (x, y) in (0..size).flat_map(|y| (0..size).map(move |x| (x + 10, y + 10))) {
            sum += (f64::from(white.get(x, y)) - mean) * (f64::from(white.get(x + dx, y + dy)) - mean);
        }
        sum / (size * size) as f64
    };
    let variance = correlation(0, 0);
    let from = (3.0 * grain * scale).ceil() as usize;
    let mut worst = (0.0, 0, 0);
    for step in from..270 {
        for (dx, dy) in [(step, 0), (0, step), (step * 2 / 3, step * 2 / 3)] {
            let value = (correlation(dx, dy) / variance).abs();
            if dx.max(dy) >= from && value > worst.0 {
                worst = (value, dx, dy);
            }
        }
    }
    println!("grain: greatest autocorrelation beyond 3 grains {:.3} at {}, {} px", worst.0, worst.1, worst.2);
    assert!(worst.0 < 0.2, "{worst:?}");
}

#[test]
fn background_strokes_stay_off_the_subject() {
    let photo = png_of_light(300, 300, |x, y| if in_disc(x, y) { 0.3 } else { 0.6 });
    let mask = png_of_light(300, 300, |x, y| if in_disc(x, y) { 1.0 } else { 0.0 });
    let drawing = Sitting { masks: &[(MaskRole::Subject, mask)], ..Sitting::new(&photo, (90.0, 90.0)) }.draw(&Silent);
    let background = only(&drawing, "background");
    assert!(background.marks().count() > 20);
    for mark in background.marks() {
        let Mark::Stroke(stroke) = mark else { panic!("background is strokes") };
        let (points, widths) = stroke.sampled(0.1);
        for (p, width) in points.iter().zip(widths) {
            let inside = 30.0 - p.distance(Point::new(45.0, 45.0));
            assert!(inside + 0.5 * width <= 0.5 * BACKGROUND_NIB, "{p:?}: {inside} inside, {width} wide");
        }
    }
}

/// Maximum width of a background stroke: seven tenths of the stick's 0.42 mm.
const BACKGROUND_NIB: f64 = 0.294;

/// Clothing is shaded in a ring, whose inner border is concave: strokes stay inside on both sides.
#[test]
fn shading_stays_in_its_region() {
    let ring = |x: u32, y: u32| (60.0..120.0).contains(&(f64::from(x) - 149.5).hypot(f64::from(y) - 149.5));
    let photo = png_of_light(300, 300, |x, y| if ring(x, y) { 0.02 } else { 0.9 });
    let mask = png_of_light(300, 300, |x, y| if ring(x, y) { 1.0 } else { 0.0 });
    let masks = [(MaskRole::Clothing, mask)];
    let drawing = Sitting { masks: &masks, ..Sitting::new(&photo, (90.0, 90.0)) }.draw(&Silent);
    let shading = only(&drawing, "shading");
    assert!(shading.marks().count() > 50);
    for mark in shading.marks() {
        let Mark::Stroke(stroke) = mark else { panic!("shading is strokes") };
        let (points, widths) = stroke.sampled(0.1);
        for (p, width) in points.iter().zip(widths) {
            let r = p.distance(Point::new(45.0, 45.0));
            let outside = (18.0 - r).max(r - 36.0);
            assert!(outside + 0.5 * width <= 0.5 * 0.42, "{p:?}: {outside} outside, {width} wide");
        }
    }
}

/// The strokes of a bust's eyes, nose and mouth stay where there is ink to draw, those of its brows inside the brows.
#[test]
fn features_strokes_stay_in_them() {
    let masks = [
        (MaskRole::Subject, sample("bust-mask-subject.png")),
        (MaskRole::Hair, sample("bust-mask-hair.png")),
        (MaskRole::Face, sample("bust-mask-face.png")),
    ];
    let notes = Notes::default();
    let photo = sample("bust-brown.png");
    let sitting = Sitting { masks: &masks, set: QUICK, ..Sitting::new(&photo, (90.0, 120.0)) };
    let drawing = sitting.draw(&notes);
    let (labels, tones) = (notes.features.into_inner().unwrap().unwrap(), notes.tones.into_inner().unwrap().unwrap());
    let pixel = 90.0 / labels.width() as f64;
    // Faint ink, and the brows: they are blurred by a pixel before they are cut out.
    let is_drawn = |x: isize, y: isize| tones.clamped(x, y) < 0.85 || matches!(labels.clamped(x, y), 1 | 2);
    let (mut count, mut farthest) = (0, f64::NEG_INFINITY);
    for mark in only(&drawing, "features").marks() {
        let Mark::Stroke(stroke) = mark else { panic!("features are strokes") };
        count += 1;
        let (points, widths) = stroke.sampled(0.1);
        for (p, width) in points.iter().zip(widths) {
            let (x, y) = (p.x / pixel, p.y / pixel);
            let off = |at: f64, cell: isize| (cell as f64 - at).max(at - cell as f64 - 1.0).max(0.0);
            let (cx, cy) = (x.floor() as isize, y.floor() as isize);
            let cells = (-4..=4).flat_map(|dy| (-4..=4).map(move |dx| (cx + dx, cy + dy))).filter(|c| is_drawn(c.0, c.1));
            let outside = cells.map(|c| off(x, c.0).hypot(off(y, c.1))).fold(f64::INFINITY, f64::min) * pixel;
            farthest = farthest.max(outside + 0.5 * width);
        }
    }
    println!("{count} strokes of the features, ink at most {farthest:.3} mm outside");
    assert!(count > 100 && farthest <= 0.5 * 0.42, "{count} {farthest}");
}

/// Two discs: the mask keeps one's edge and drops the other's; a line in the mask that is not in the picture is drawn too.
#[test]
fn the_keep_mask_chooses_edges_and_adds_its_own() {
    let disc = |x: u32, y: u32, cx: f64| (f64::from(x) - cx).hypot(f64::from(y) - 80.0);
    let photo = png_of_light(300, 300, |x, y| if disc(x, y, 80.0) < 45.0 || disc(x, y, 220.0) < 45.0 { 0.1 } else { 0.8 });
    let is_line = |x: u32, y: u32| (240..242).contains(&y) && (60..240).contains(&x);
    let mask = png_of_light(300, 300, |x, y| if (disc(x, y, 80.0) - 45.0).abs() < 1.5 || is_line(x, y) { 1.0 } else { 0.0 });
    let set = [("background", "off"), ("shading", "off"), ("sketch_offset", "0mm")];
    let subject = png_of_light(300, 300, |_, _| 1.0);
    let masks = [(MaskRole::Edges, mask), (MaskRole::Subject, subject)];
    let drawing = Sitting { masks: &masks, set: &set, ..Sitting::new(&photo, (90.0, 90.0)) }.draw(&Silent);
    let (mut on_disc, mut on_line) = (0.0, 0.0);
    for mark in only(&drawing, "edges").marks() {
        let Mark::Stroke(stroke) = mark else { panic!("edges are strokes") };
        let (points, _) = stroke.sampled(0.1);
        for p in points {
            let to_disc = (p.distance(Point::new(24.15, 24.15)) - 13.5).abs();
            let to_line = (p.y - 72.3).abs();
            assert!(to_disc < 1.0 || to_line < 0.6, "{p:?} is neither on the kept edge nor on the drawn line");
            on_disc += 0.1 * f64::from(u8::from(to_disc < 1.0));
            on_line += 0.1 * f64::from(u8::from(to_line < 0.6));
        }
    }
    println!("kept edge {on_disc:.0} mm, drawn line {on_line:.0} mm");
    assert!(on_disc > 75.0 && on_line > 45.0, "{on_disc} {on_line}");
}

#[test]
fn skin_points_can_be_given() {
    let masks = [(MaskRole::Subject, sample("bust-mask-subject.png")), (MaskRole::Face, sample("bust-mask-face.png"))];
    let set: Vec<(&str, &str)> = QUICK.iter().copied().chain([("skin", "30,45;35,45;46,29;57,45;62,43")]).collect();
    let (photo, notes) = (side_lit(&sample("bust-light.png")), Notes::default());
    Sitting { masks: &masks, set: &set, ..Sitting::new(&photo, (90.0, 120.0)) }.draw(&notes);
    assert_eq!(features_in_place("bust-light.png", &notes, &bust_boxes(), 1.0), 6);
    let wrong = [("skin".to_owned(), "30,45;35".to_owned())];
    assert!(Settings::resolve("charcoal", find("charcoal").unwrap().parameters(), &wrong).is_err());
}

fn in_disc(x: u32, y: u32) -> bool {
    (f64::from(x) - 149.5).hypot(f64::from(y) - 149.5) < 100.0
}

/// Layers keep to their regions: no smudge under hair and background, and no stroke twice.
#[test]
fn nothing_is_drawn_twice() {
    let masks = [
        (MaskRole::Subject, sample("bust-mask-subject.png")),
        (MaskRole::Hair, sample("bust-mask-hair.png")),
        (MaskRole::Face, sample("bust-mask-face.png")),
    ];
    let photo = sample("bust-brown.png");
    let sitting = Sitting { masks: &masks, ..Sitting::new(&photo, (90.0, 120.0)) };
    let drawing = sitting.draw(&Silent);
    let hair = &sitting.portrait().masks[&MaskRole::Hair];
    let scale = hair.width() as f64 / 90.0;
    let (mut in_hair, mut all) = (0.0, 0.0);
    for mark in only(&drawing, "tone").marks() {
        let middle = mark.bounding_box().center();
        all += mark.area();
        if hair.sample(middle.x * scale, middle.y * scale) > 0.99 {
            in_hair += mark.area();
        }
    }
    println!("smudge in the hair: {in_hair:.2} of {all:.0} mm2");
    assert!(in_hair < 0.01 * all);
    let mut curves: Vec<String> = drawing
        .marks()
        .filter_map(|mark| if let Mark::Stroke(stroke) = mark { Some(stroke.curve().to_svg()) } else { None })
        .collect();
    let count = curves.len();
    curves.sort_unstable();
    curves.dedup();
    assert_eq!(curves.len(), count);
    assert!(count > 300, "{count}");
}

#[test]
fn missing_masks_are_a_warning_and_a_drawing() {
    let photo = png_of_light(160, 120, |x, y| 0.1 + 0.8 * f64::from((x / 9 + y / 7) % 5) / 4.0);
    let notes = Notes::default();
    let drawing = Sitting { set: QUICK, ..Sitting::new(&photo, (40.0, 30.0)) }.draw(&notes);
    assert!(drawing.marks().count() > 50);
    let warnings = notes.warnings.lock().unwrap().join("\n");
    for role in ["subject", "hair", "face"] {
        assert!(warnings.contains(&format!("a mask of the role {role}")), "{warnings}");
    }
}

#[test]
fn seeds_repeat_and_differ() {
    let photo = sample("bust-light.png");
    let masks = [(MaskRole::Subject, sample("bust-mask-subject.png")), (MaskRole::Hair, sample("bust-mask-hair.png"))];
    let sitting = Sitting { masks: &masks, set: QUICK, ..Sitting::new(&photo, (45.0, 60.0)) };
    let draw = |seed| svg_of(&find("charcoal").unwrap().draw(&sitting.portrait(), &sitting.settings(), seed, &Silent).unwrap());
    let single = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert!(draw(1) == single.install(|| draw(1)), "one thread draws otherwise");
    assert!(draw(1) != draw(2));
}

const INKML: &str = "http://www.w3.org/2003/InkML";

/// A drawing with two layers of two strokes each.
fn two_layers() -> Drawing {
    let stroke = |path: &str, pressure: Vec<f64>, times: Vec<f64>| {
        let widths = pressure.iter().map(|p| 0.5 * p).collect();
        let stroke = Stroke::swelling(BezPath::from_svg(path).unwrap(), widths).unwrap();
        Mark::Stroke(stroke.with_pressure(pressure).and_then(|stroke| stroke.with_times(times)).unwrap())
    };
    let mut layers = vec![Layer::new("hair & beard", 1), Layer::new("edges", 2)];
    layers[0].marks.push(stroke("M1,2 L10.125,2.5 L12,7", vec![0.25, 1.0, 0.5], vec![0.5, 0.75, 1.0]));
    layers[1].marks.push(stroke("M3,3 L-0.5,8", vec![0.1, 0.9], vec![2.0, 2.5]));
    Drawing { page: Page::new(90.0, 120.0), layers }
}

#[test]
fn inkml_reads_back() {
    let mut bytes = Vec::new();
    write_inkml(&two_layers(), "A <sketch>", &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let root = document.root_element();
    assert!(root.has_tag_name((INKML, "ink")));
    assert!(root.descendants().filter(roxmltree::Node::is_element).all(|node| node.tag_name().namespace() == Some(INKML)));
    let named = |name: &str| root.descendants().filter(|n| n.has_tag_name((INKML, name))).collect::<Vec<_>>();
    let channels: Vec<(&str, &str)> =
        named("channel").iter().map(|c| (c.attribute("name").unwrap(), c.attribute("units").unwrap())).collect();
    assert_eq!(channels, [("X", "mm"), ("Y", "mm"), ("F", "dev"), ("T", "ms")]);
    assert_eq!(named("timestamp").len(), 1);
    let id = |node: &roxmltree::Node<'_, '_>| {
        node.attribute(("http://www.w3.org/XML/1998/namespace", "id")).map(|id| format!("#{id}"))
    };
    let brushes: Vec<String> = named("brush").iter().filter_map(id).collect();
    let used: Vec<&str> = named("traceGroup").iter().map(|g| g.attribute("brushRef").unwrap()).collect();
    assert_eq!(used, brushes);
    let traces: Vec<Vec<Vec<f64>>> = named("trace")
        .iter()
        .map(|trace| {
            let points = trace.text().unwrap().split(',');
            points.map(|p| p.split_whitespace().map(|v| v.parse().unwrap()).collect()).collect()
        })
        .collect();
    let expected = [
        vec![vec![1.0, 2.0, 250.0, 500.0], vec![10.125, 2.5, 1000.0, 750.0], vec![12.0, 7.0, 500.0, 1000.0]],
        vec![vec![3.0, 3.0, 100.0, 2000.0], vec![-0.5, 8.0, 900.0, 2500.0]],
    ];
    assert_eq!(traces, expected);
}

#[test]
fn a_sketch_s_inkml_has_a_trace_for_each_stroke() {
    let photo = sample("bust-light.png");
    let masks = [(MaskRole::Subject, sample("bust-mask-subject.png")), (MaskRole::Hair, sample("bust-mask-hair.png"))];
    let mut drawing = Sitting { masks: &masks, set: QUICK, ..Sitting::new(&photo, (45.0, 60.0)) }.draw(&Silent);
    drawing.layers.retain(|layer| layer.name != "tone");
    let mut bytes = Vec::new();
    write_inkml(&drawing, "", &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let traces: Vec<roxmltree::Node<'_, '_>> = document.descendants().filter(|n| n.has_tag_name((INKML, "trace"))).collect();
    assert_eq!(traces.len(), drawing.marks().count());
    let mut before = 0;
    for trace in &traces {
        for point in trace.text().unwrap().split(',') {
            let values: Vec<&str> = point.split_whitespace().collect();
            let (force, time): (i64, i64) = (values[2].parse().unwrap(), values[3].parse().unwrap());
            assert!((0..=1000).contains(&force) && time >= before, "{point} after {before}");
            before = time;
        }
    }
}

/// The light bust with its hair replaced by skin, lit from one side (`shade` from the lit side to the other, in encoded light),
/// with a highlight on the forehead.
fn shaved_bust(shade: (f64, f64), gleam: f64) -> Vec<u8> {
    use image::{ImageFormat, Rgb};
    let open = |name: &str| image::load_from_memory(&sample(name)).unwrap();
    let (mut bust, hair, face) =
        (open("bust-light.png").to_rgb8(), open("bust-mask-hair.png").to_luma8(), open("bust-mask-face.png").to_luma8());
    let in_face = || face.enumerate_pixels().filter(|(.., v)| v.0[0] > 200);
    let skin: [f64; 3] = [0, 1, 2].map(|channel| {
        let mut values: Vec<u8> = in_face().map(|(x, y, _)| bust.get_pixel(x, y).0[channel]).collect();
        values.sort_unstable();
        f64::from(values[values.len() / 2])
    });
    let (left, right) =
        hair.enumerate_pixels().filter(|(.., v)| v.0[0] > 127).fold((u32::MAX, 0), |(l, r), (x, ..)| (l.min(x), r.max(x)));
    let top = in_face().map(|(_, y, _)| y).min().unwrap();
    let (width, middle) = (f64::from(right - left), 0.5 * f64::from(left + right));
    // Includes single strands that hang out of the mask.
    let is_near = |x: u32, y: u32| {
        let step = |v: u32, by: i64, most: u32| (i64::from(v) + by).clamp(0, i64::from(most) - 1) as u32;
        let reach = [-14, -7, 0, 7, 14_i64];
        reach
            .iter()
            .any(|dx| reach.iter().any(|dy| hair.get_pixel(step(x, *dx, hair.width()), step(y, *dy, hair.height())).0[0] > 60))
    };
    for (x, y, _) in hair.enumerate_pixels().filter(|(x, y, _)| is_near(*x, *y)) {
        let across = (f64::from(x) - f64::from(left)) / width;
        let away = (f64::from(x) - middle).hypot(f64::from(y) - f64::from(top)) / (0.22 * width);
        let share = shade.0 + (shade.1 - shade.0) * across + gleam * (-away * away).exp();
        // Skin in shade is a little redder.
        let redder = [1.0, 1.0 - 0.1 * (1.0 - share).max(0.0), 1.0 - 0.2 * (1.0 - share).max(0.0)];
        let pixel = [0, 1, 2].map(|i| (skin[i] * share * redder[i]).clamp(0.0, 255.0) as u8);
        bust.put_pixel(x, y, Rgb(pixel));
    }
    let mut bytes = std::io::Cursor::new(Vec::new());
    bust.write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

const NO_EVIDENCE: &str = "too like the skin";

#[test]
fn a_shaved_head_gets_no_wig_and_the_user_hears_of_it() {
    for (shade, gleam) in [((1.0, 0.68), 0.0), ((1.05, 0.72), 0.12), ((0.95, 0.85), 0.3)] {
        let photo = shaved_bust(shade, gleam);
        if let Some(folder) = std::env::var_os("DRYPOINT_SHOW") {
            std::fs::write(std::path::Path::new(&folder).join(format!("shaved-{gleam}.png")), &photo).unwrap();
        }
        let masks = [(MaskRole::Subject, sample("bust-mask-subject.png"))];
        let notes = Notes::default();
        let drawing = Sitting { masks: &masks, set: QUICK, ..Sitting::new(&photo, (45.0, 60.0)) }.draw(&notes);
        let warnings = notes.warnings.lock().unwrap().join("\n");
        assert!(drawing.layers.iter().all(|layer| layer.name != "hair"), "{shade:?} {gleam}: a wig");
        assert!(warnings.contains("a mask of the role hair"), "{shade:?} {gleam}: {warnings}");
    }
}

#[test]
fn the_busts_hair_is_found_without_a_mask() {
    for name in ["bust-light.png", "bust-brown.png", "bust-dark.png"] {
        let photo = sample(name);
        let masks = [(MaskRole::Subject, sample("bust-mask-subject.png"))];
        let notes = Notes::default();
        let drawing = Sitting { masks: &masks, set: QUICK, ..Sitting::new(&photo, (45.0, 60.0)) }.draw(&notes);
        let warnings = notes.warnings.lock().unwrap().join("\n");
        assert!(drawing.layers.iter().any(|layer| layer.name == "hair"), "{name}: {warnings}");
        assert!(!warnings.contains(NO_EVIDENCE), "{name}: {warnings}");
    }
}
