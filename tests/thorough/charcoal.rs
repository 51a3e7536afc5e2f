//! Charcoal's guarantees, measured.

mod features;
mod fields;
mod inkml;

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

const QUICK: &[(&str, &str)] = &[("background", "off"), ("shading", "off"), ("grain", "2mm")];

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
