//! The complete hedcut (Bruehl 2023, section 0.1.1): skin in dots, hair in strokes along it, clothing in hatches as wide as its
//! tone, finer dots in eyes, nose and mouth.

use crate::any_style::Order;
use crate::common;

use common::{png_of_light, rendered, sample, svg_of};
use drypoint::drawing::{Colour, Drawing, Layer, Mark, Stroke, Width};
use drypoint::geometry::{Point, Vec2, polyline_length};
use drypoint::raster::{Raster, dilate, gaussian_blur, gaussian_gradient, structure_tensor};
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
    DRAWN.get_or_init(|| BUSTS.map(|name| bust_with(name, &[])).into_iter().collect())
}

fn bust_with(name: &str, set: &[(&str, &str)]) -> Bust {
    let photo = sample(name);
    let masks = MASKS.map(|(role, file)| (role, sample(file)));
    let image = image::load_from_memory(&photo).unwrap();
    let height = 60.0 * f64::from(image.height()) / f64::from(image.width());
    let mut order = Order::new("hedcut", &photo, (60.0, height), &[&[("pitch", "0.6mm")], set].concat());
    order.masks = masks.iter().map(|(role, bytes)| (*role, &bytes[..])).collect();
    Bust { portrait: order.portrait(), drawing: order.draw() }
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

/// The subject alone, in two tones: all ink is black, and none lies farther outside than half a pitch.
#[test]
fn ink_is_black_and_on_the_subject_alone() {
    for bust in outlined() {
        assert!(bust.drawing.layers.iter().all(|layer| layer.ink.colour() == Colour::BLACK));
        assert!(bust.drawing.marks().all(|mark| mark.colour().is_none()));
        let white = rendered(&svg_of(&bust.drawing), PIXELS_PER_MM);
        let scale = bust.portrait.placement.columns as f64 / 60.0 / PIXELS_PER_MM;
        let person = bust.portrait.subject.map(|v| u8::from(v > 0.05));
        let near = dilate(&person, (0.5 * PITCH * scale * PIXELS_PER_MM).ceil() as usize).map(f32::from);
        let places = (0..white.height()).flat_map(|y| (0..white.width()).map(move |x| (x, y)));
        let beside = places.filter(|(x, y)| near.sample(*x as f64 * scale, *y as f64 * scale) < 0.5 && white.get(*x, *y) < 0.9);
        assert_eq!(beside.count(), 0, "inked pixels beside the person");
    }
}

/// Tone by the size of dots and the width of lines: in the darkest third of each they are larger than in the lightest.
#[test]
fn darker_places_have_larger_dots_and_wider_lines() {
    for bust in outlined() {
        let ink = bust.portrait.ink();
        let scale = bust.portrait.placement.columns as f64 / 60.0;
        let growth = |mut sizes: Vec<(Point, f64)>| {
            let tone = |p: Point| ink.sample(p.x * scale, p.y * scale);
            sizes.sort_by(|a, b| tone(a.0).total_cmp(&tone(b.0)));
            let mean = |part: &[(Point, f64)]| part.iter().map(|(_, size)| size).sum::<f64>() / part.len() as f64;
            let third = sizes.len() / 3;
            mean(&sizes[2 * third..]) / mean(&sizes[..third])
        };
        let is_skin = |p: Point| bust.at(MaskRole::Face, p) > 0.5 && bust.at(MaskRole::Detail, p) < 0.1;
        let dot = |mark: &Mark| if let Mark::Dot(dot) = mark { Some((dot.centre, dot.radius)) } else { None };
        let dots = growth(bust.drawing.marks().filter_map(dot).filter(|(p, _)| is_skin(*p)).collect());
        let along = |name: &str| {
            let sampled = strokes(bust.layer(name)).map(|stroke| stroke.sampled(0.3));
            growth(sampled.flat_map(|(points, widths)| points.into_iter().zip(widths)).collect())
        };
        let [hair, clothing] = ["hair", "clothing"].map(along);
        println!("dots {dots:.2}, hair {hair:.2}, clothing {clothing:.2} times as wide");
        assert!(dots > 1.1 && hair > 1.0 && clothing > 1.15, "{dots:.2} {hair:.2} {clothing:.2}");
    }
}

/// Dots in rows along the features: the nearest neighbour of a dot beside the silhouette lies along it.
#[test]
fn dots_lie_along_the_silhouette() {
    for bust in outlined() {
        let outlines: Vec<(Point, Vec2)> = strokes(bust.layer("outline"))
            .flat_map(|stroke| {
                let points = stroke.sampled(0.1).0;
                points.windows(2).map(|pair| (pair[0], pair[1] - pair[0])).collect::<Vec<_>>()
            })
            .filter(|(_, along)| along.hypot() > 1e-6)
            .collect();
        let dots = bust.dots();
        let nearest =
            |p: Point| outlines.iter().min_by(|a, b| a.0.distance_squared(p).total_cmp(&b.0.distance_squared(p))).unwrap();
        let (mut along, mut all) = (0, 0);
        for p in &dots {
            let (line, tangent) = nearest(*p);
            let is_beside = bust.at(MaskRole::Face, *p) > 0.5 && bust.at(MaskRole::Detail, *p) < 0.1;
            if is_beside && line.distance(*p) < 2.0 * PITCH {
                let others = dots.iter().filter(|q| *q != p);
                let next = others.min_by(|a, b| a.distance_squared(*p).total_cmp(&b.distance_squared(*p))).unwrap();
                let step = *next - *p;
                all += 1;
                along += usize::from(step.dot(*tangent).abs() > 30.0_f64.to_radians().cos() * step.hypot() * tangent.hypot());
            }
        }
        println!("{along} of {all} dots beside the outline follow it");
        assert!(all > 50 && along * 2 > all, "{along} of {all}; a third by chance");
    }
}

/// No dots in the highlights, here the lightest twentieth of each face, and dots in all other skin that is not black.
#[test]
fn highlights_are_bare() {
    for (bust, name) in outlined().iter().zip(BUSTS) {
        let scale = bust.portrait.placement.columns as f64 / 60.0;
        let ink = gaussian_blur(&bust.portrait.ink(), (0.5 * PITCH * scale) as f32);
        let rows = (0..ink.height()).step_by(4);
        let places = rows.flat_map(|y| (0..ink.width()).step_by(4).map(move |x| Point::new(x as f64 / scale, y as f64 / scale)));
        let is_skin = |p: &Point| bust.is_deep(MaskRole::Face, *p, 1.0) && bust.at(MaskRole::Detail, *p) < 0.1;
        let mut skin: Vec<(f32, Point)> = places.filter(is_skin).map(|p| (ink.sample(p.x * scale, p.y * scale), p)).collect();
        skin.sort_by(|a, b| a.0.total_cmp(&b.0));
        let bare = skin[skin.len() / 20].0;
        // A step is a fiftieth of white to black.
        let steps = format!("{}", 50.0 * bare);
        let dots = bust_with(name, &[("levels", "50"), ("highlight_steps", &steps)]).dots();
        let share = |part: &[(f32, Point)], reach: f64| {
            let dotted = part.iter().filter(|(_, p)| dots.iter().any(|dot| dot.distance(*p) < reach)).count();
            dotted as f64 / part.len() as f64
        };
        let from = skin.partition_point(|(ink, _)| *ink < bare + 0.15);
        let to = skin.partition_point(|(ink, _)| *ink < 0.7);
        let [light, rest] = [share(&skin[..skin.len() / 40], 0.3 * PITCH), share(&skin[from..to], PITCH)];
        println!("{name}: below {bare:.2} {light:.2} of the places have dots, {rest:.2} of the others");
        assert!(light < 0.03 && rest > 0.97, "{name}: {light} {rest}");
    }
}

/// The outline in strokes that swell.
#[test]
fn outlines_swell() {
    for bust in outlined() {
        let swells = |stroke: &Stroke| {
            let Width::Along(widths) = stroke.width() else { return false };
            let [least, most] = [f64::min, f64::max].map(|of| widths.iter().copied().reduce(of).unwrap_or(0.0));
            most > 1.5 * least
        };
        let length = |is_so: &dyn Fn(&Stroke) -> bool| {
            let lines = strokes(bust.layer("outline")).filter(|stroke| is_so(stroke));
            lines.map(|stroke| polyline_length(&stroke.sampled(0.2).0)).sum::<f64>()
        };
        let [swelling, all] = [length(&swells), length(&|_| true)];
        println!("{swelling:.0} of {all:.0} mm of outline swell");
        assert!(all > 50.0 && swelling > 0.8 * all, "{swelling} of {all}");
    }
}

/// Along the locks that the photograph shows, where it shows any.
#[test]
fn hair_strokes_of_the_busts_follow_their_locks() {
    for bust in outlined() {
        let scale = bust.portrait.placement.columns as f64 / 60.0;
        // Without the hair's own border, which is no lock.
        let hair = &bust.portrait.masks[&MaskRole::Hair];
        let blurred = |raster: &Raster<f32>| gaussian_blur(&raster.zip_map(hair, |v, hair| v * hair), (PITCH * scale) as f32);
        let around = blurred(&bust.portrait.lightness).zip_map(&blurred(hair), |sum, hair| sum / hair.max(1e-6));
        let locks = bust.portrait.lightness.zip_map(&around, |v, mean| v - mean).zip_map(hair, |v, hair| v * hair);
        let tensor = structure_tensor(&[gaussian_gradient(&locks, (0.15 * PITCH * scale) as f32)]).unwrap();
        let tensor = tensor.zip_map(hair, |t, hair| if hair > 0.9 { t } else { [0.0; 3] });
        let sigma = (PITCH * scale) as f32;
        let [xx, xy, yy] = [0, 1, 2].map(|i: usize| gaussian_blur(&tensor.map(|t| t[i]), sigma));
        let (mut along, mut all) = (0.0, 0.0);
        for stroke in strokes(bust.layer("hair")) {
            for pair in stroke.sampled(0.3).0.windows(2) {
                let middle = pair[0].midpoint(pair[1]);
                let [xx, xy, yy] = [&xx, &xy, &yy].map(|plane| f64::from(plane.sample(middle.x * scale, middle.y * scale)));
                let coherence = ((xx - yy).powi(2) + 4.0 * xy * xy).sqrt() / (xx + yy).max(1e-12);
                if coherence < 0.5 || !bust.is_deep(MaskRole::Hair, middle, 1.0) {
                    continue;
                }
                let across = 0.5 * (2.0 * xy).atan2(xx - yy);
                let step = pair[1] - pair[0];
                let off = (step.x * across.cos() + step.y * across.sin()).abs() / step.hypot().max(1e-12);
                all += step.hypot();
                along += if off.asin() <= 15_f64.to_radians() { step.hypot() } else { 0.0 };
            }
        }
        println!("{along:.0} of {all:.0} mm of hair within 15 degrees of the locks");
        assert!(all > 100.0 && along >= 0.9 * all, "{along:.0} of {all:.0} mm");
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
    for bust in BUSTS.map(|name| bust_with(name, &[("outline", "off")])) {
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
