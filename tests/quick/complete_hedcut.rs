//! The complete hedcut (Bruehl 2023, section 0.1.1): skin in dots, hair in strokes along it, clothing in hatches as wide as its
//! tone, finer dots in eyes, nose and mouth.

use crate::any_style::Order;
use crate::common;

use common::{png_of_light, rendered, sample, svg_of};
use drypoint::drawing::{Drawing, Layer, Mark, Stroke, Width};
use drypoint::geometry::Point;
use drypoint::raster::Raster;
use drypoint::source::{MaskRole, Portrait};
use std::sync::OnceLock;

const BUSTS: [&str; 3] = ["bust-light.png", "bust-brown.png", "bust-dark.png"];
const MASKS: [(MaskRole, &str); 5] = [
    (MaskRole::Subject, "bust-mask-subject.png"),
    (MaskRole::Hair, "bust-mask-hair.png"),
    (MaskRole::Clothing, "bust-mask-clothing.png"),
    (MaskRole::Detail, "bust-mask-detail.png"),
    (MaskRole::Face, "bust-mask-face.png"),
];
const PITCH: f64 = 0.6;
const PIXELS_PER_MM: f64 = 20.0;

/// A bust with its regions, drawn 60 mm wide.
struct Bust {
    portrait: Portrait,
    drawing: Drawing,
}

/// The busts as they are drawn by default, once for all tests.
fn outlined() -> &'static [Bust] {
    static DRAWN: OnceLock<Vec<Bust>> = OnceLock::new();
    DRAWN.get_or_init(|| busts("on").collect())
}

fn busts(outline: &str) -> impl Iterator<Item = Bust> {
    BUSTS.into_iter().map(move |name| {
        let photo = sample(name);
        let masks = MASKS.map(|(role, file)| (role, sample(file)));
        let image = image::load_from_memory(&photo).unwrap();
        let height = 60.0 * f64::from(image.height()) / f64::from(image.width());
        let mut order = Order::new("hedcut", &photo, (60.0, height), &[("pitch", "0.6mm"), ("outline", outline)]);
        order.masks = masks.iter().map(|(role, bytes)| (*role, &bytes[..])).collect();
        Bust { portrait: order.portrait(), drawing: order.draw() }
    })
}

impl Bust {
    /// A mask's value at a point of the page.
    fn at(&self, role: MaskRole, p: Point) -> f32 {
        let scale = self.portrait.placement.columns as f64 / 60.0;
        self.portrait.masks[&role].sample(p.x * scale, p.y * scale)
    }

    /// True if all places within a pitch are in (1) or out of (0) a region.
    fn is_deep(&self, role: MaskRole, p: Point, side: f32) -> bool {
        let around = [(0.0, 0.0), (PITCH, 0.0), (-PITCH, 0.0), (0.0, PITCH), (0.0, -PITCH)];
        around.iter().all(|(x, y)| (self.at(role, Point::new(p.x + x, p.y + y)) - side).abs() < 0.1)
    }

    fn layer(&self, name: &str) -> &Layer {
        self.drawing.layers.iter().find(|layer| layer.name == name).unwrap_or_else(|| panic!("no layer {name}"))
    }

    fn dots(&self) -> Vec<Point> {
        let dot = |mark: &Mark| if let Mark::Dot(dot) = mark { Some(dot.centre) } else { None };
        self.drawing.marks().filter_map(dot).collect()
    }
}

fn strokes(layer: &Layer) -> impl Iterator<Item = &Stroke> {
    layer.marks.iter().filter_map(|mark| if let Mark::Stroke(stroke) = mark { Some(stroke) } else { None })
}

#[test]
fn dots_are_on_skin_strokes_in_hair_and_hatches_on_clothing() {
    for bust in outlined() {
        let dots = bust.dots();
        let inside = |role: MaskRole| dots.iter().filter(|p| bust.is_deep(role, **p, 1.0)).count();
        let strays = inside(MaskRole::Hair) + inside(MaskRole::Clothing);
        assert!(strays * 200 < dots.len(), "{strays} of {} dots deep in other parts", dots.len());
        assert!(inside(MaskRole::Face) > 500, "{} dots in the face", inside(MaskRole::Face));
        for (name, role) in [("hair", MaskRole::Hair), ("clothing", MaskRole::Clothing)] {
            let nodes: Vec<Point> = strokes(bust.layer(name)).flat_map(|stroke| stroke.sampled(0.3).0).collect();
            let outside = nodes.iter().filter(|p| bust.is_deep(role, **p, 0.0)).count();
            assert!(outside * 200 <= nodes.len(), "{name}: {outside} of {} outside", nodes.len());
        }
    }
}

#[test]
fn hair_strokes_taper() {
    for bust in outlined() {
        let is_tapered = |stroke: &&Stroke| {
            let Width::Along(widths) = stroke.width() else { return false };
            let middle = widths[widths.len() / 2];
            widths[0] < middle && widths[widths.len() - 1] < middle
        };
        let all = strokes(bust.layer("hair")).count();
        let tapered = strokes(bust.layer("hair")).filter(is_tapered).count();
        assert!(all > 100 && tapered * 10 >= all * 9, "{tapered} of {all}");
    }
}

#[test]
fn eyes_nose_and_mouth_have_denser_dots() {
    for bust in outlined() {
        let density = |role: MaskRole| {
            let region = &bust.portrait.masks[&role];
            let is_skin = |p: Point| role == MaskRole::Detail || bust.at(MaskRole::Detail, p) < 0.1;
            let dots = bust.dots().into_iter().filter(|p| bust.is_deep(role, *p, 1.0) && is_skin(*p)).count();
            let scale = bust.portrait.placement.columns as f64 / 60.0;
            let places = (0..region.height()).flat_map(|y| (0..region.width()).map(move |x| (x as f64, y as f64)));
            let places = places.map(|(x, y)| Point::new(x / scale, y / scale));
            dots as f64 / places.filter(|p| bust.is_deep(role, *p, 1.0) && is_skin(*p)).count() as f64
        };
        let times = density(MaskRole::Detail) / density(MaskRole::Face);
        assert!(times > 1.8, "{times:.2} times as dense");
    }
}

/// A picture that is one region all over.
fn region_of(role: MaskRole, light: impl Fn(f64, f64) -> f64) -> Drawing {
    let photo = png_of_light(400, 400, |x, y| light(f64::from(x) / 10.0, f64::from(y) / 10.0));
    let all = png_of_light(400, 400, |_, _| 1.0);
    let mut order = Order::new("hedcut", &photo, (40.0, 40.0), &[("pitch", "0.6mm"), ("outline", "off")]);
    order.masks = vec![(role, &all)];
    order.draw()
}

#[test]
fn hair_strokes_follow_the_hair() {
    for degrees in [0.0, 35.0, 90.0, 140.0_f64] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let hair = region_of(MaskRole::Hair, |x, y| 0.25 + 0.2 * (4.0 * (x * sin - y * cos)).sin());
        let (mut along, mut all) = (0.0, 0.0);
        for stroke in strokes(&hair.layers[0]) {
            for pair in stroke.sampled(0.3).0.windows(2) {
                let step = pair[1] - pair[0];
                let off = (step.x * sin - step.y * cos).abs().atan2((step.x * cos + step.y * sin).abs());
                all += step.hypot();
                along += if off.to_degrees() <= 15.0 { step.hypot() } else { 0.0 };
            }
        }
        assert!(all > 200.0 && along > 0.9 * all, "{degrees}: {along:.0} of {all:.0} mm");
    }
}

#[test]
fn hatches_widen_with_the_ink() {
    let cloth = region_of(MaskRole::Clothing, |x, _| (1.0 - x / 42.0).powi(2));
    let mut bins = [(0.0, 0); 8];
    for stroke in cloth.layers.iter().flat_map(strokes) {
        let (points, widths) = stroke.sampled(0.3);
        for (p, width) in points.iter().zip(widths) {
            let bin = &mut bins[((p.x / 5.0) as usize).min(7)];
            *bin = (bin.0 + width, bin.1 + 1);
        }
    }
    let means: Vec<f64> = bins[1..].iter().map(|(sum, count)| sum / f64::from(*count)).collect();
    assert!(means.windows(2).all(|pair| pair[1] > pair[0]), "{means:?}");
    assert!(means[6] > 3.0 * means[0], "{means:?}");
}

/// Ink and the tone asked for within two pitches of a border between parts.
#[test]
fn borders_between_parts_keep_their_tone() {
    // Outlines are drawn over the tone.
    for bust in busts("off") {
        let white = rendered(&svg_of(&bust.drawing), PIXELS_PER_MM);
        for role in [MaskRole::Hair, MaskRole::Clothing] {
            let (asked, drawn) = band_means(&bust, role, &white);
            assert!((asked - drawn).abs() <= 0.05, "{role:?}: {drawn:.3} for {asked:.3}");
        }
    }
}

fn band_means(bust: &Bust, role: MaskRole, white: &Raster<f32>) -> (f64, f64) {
    let ink = bust.portrait.ink();
    let scale = bust.portrait.placement.columns as f64 / 60.0;
    let (mut asked, mut drawn, mut count) = (0.0, 0.0, 0.0);
    for y in 0..white.height() {
        for x in 0..white.width() {
            let p = Point::new((x as f64 + 0.5) / PIXELS_PER_MM, (y as f64 + 0.5) / PIXELS_PER_MM);
            let steps = [-2.0 * PITCH, 2.0 * PITCH];
            let around = steps.iter().flat_map(|s| [Point::new(p.x + s, p.y), Point::new(p.x, p.y + s)]);
            let sides: Vec<f32> = around.map(|q| bust.at(role, q)).collect();
            let is_band = sides.iter().any(|v| *v > 0.5) && sides.iter().any(|v| *v < 0.5);
            if is_band && bust.portrait.subject.sample(p.x * scale, p.y * scale) > 0.99 {
                asked += f64::from(ink.sample(p.x * scale, p.y * scale));
                drawn += 1.0 - f64::from(white.get(x, y));
                count += 1.0;
            }
        }
    }
    (asked / count, drawn / count)
}

#[test]
fn parts_in_dots_is_the_drawing_without_their_masks() {
    let photo = sample("bust-brown.png");
    let hair = sample("bust-mask-hair.png");
    let mut order = Order::new("hedcut", &photo, (30.0, 40.0), &[("pitch", "0.6mm"), ("parts", "dots")]);
    let without = order.draw();
    order.masks = vec![(MaskRole::Hair, &hair)];
    assert_eq!(order.draw(), without);
    order.set.pop();
    assert_ne!(order.draw(), without);
}
