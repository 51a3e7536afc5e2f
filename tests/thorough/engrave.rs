//! The engraving's guarantees: lines never cross, follow the depth, and print the tone.
#![cfg(feature = "cli")]

mod regions;

use crate::common;

use assert_cmd::Command;
use common::{mean_in, png_of_light, rendered, sample, svg_of};
use drypoint::drawing::{Drawing, Layer, Mark, Page, Stroke};
use drypoint::geometry::{BezPath, Point, Rect, distance_to_segment, flatten, polyline_length, resample};
use drypoint::raster::{Raster, gaussian_blur};
use drypoint::source::{Crop, DepthSense, Limits, MaskRole, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use drypoint::style::{Observer, Picture, Settings, Silent, find};
use image::{DynamicImage, ImageFormat, RgbImage};
use std::collections::{HashMap, HashSet};
use std::io::Cursor;
use std::sync::Mutex;

/// The pitch of all these sheets, coarser than the default, so that a working pixel is a tenth of a millimetre.
const PITCH: f64 = 0.6;
/// The style works at six pixels per pitch.
const PIXEL: f64 = PITCH / 6.0;
/// Least distance between lines that the default keeps.
const MIN_GAP: f64 = 0.25 * PITCH;
const WHOLE: &[(&str, &str)] = &[("look", "hatch"), ("thinnest", "0")];

struct Sheet<'a> {
    photo: &'a [u8],
    mm: (f64, f64),
    tone: ToneTarget,
    set: Vec<(String, String)>,
    masks: Vec<(MaskRole, Vec<u8>)>,
    depth: Option<Vec<u8>>,
}

impl<'a> Sheet<'a> {
    fn new(photo: &'a [u8], mm: (f64, f64), set: &[(&str, &str)]) -> Self {
        let pitch = [("pitch".to_owned(), PITCH.to_string())];
        let set = pitch.into_iter().chain(set.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned()))).collect();
        Self { photo, mm, tone: ToneTarget::Linear, set, masks: Vec::new(), depth: None }
    }

    fn settings(&self) -> Settings {
        Settings::resolve("engrave", find("engrave").unwrap().parameters(), &self.set).unwrap()
    }

    fn portrait(&self) -> Portrait {
        let photograph = Photograph::decode(self.photo, Limits::default()).unwrap();
        let pixels_per_mm = find("engrave").unwrap().pixels_per_mm(&self.settings(), &[]);
        let placement = Placement::new(Rect::new(0.0, 0.0, self.mm.0, self.mm.1), pixels_per_mm);
        let (page, crop) = (Page::new(self.mm.0, self.mm.1), Crop::all(&photograph));
        let mut portrait = Portrait::new(&photograph, crop, page, placement, self.tone, ToneCurve::default()).unwrap();
        for (role, bytes) in &self.masks {
            let mask = Photograph::decode(bytes, Limits::default()).unwrap();
            portrait.add_mask(*role, &mask, &photograph, crop).unwrap();
        }
        if let Some(bytes) = &self.depth {
            let depth = Photograph::decode(bytes, Limits::default()).unwrap();
            portrait.add_depth(&depth, DepthSense::NearWhite, &photograph, crop).unwrap();
        }
        portrait
    }

    fn draw(&self, portrait: &Portrait) -> Drawing {
        find("engrave").unwrap().draw(portrait, &self.settings(), 0, &Silent).unwrap()
    }
}

fn strokes(layer: &Layer) -> Vec<&Stroke> {
    layer.marks.iter().filter_map(|mark| if let Mark::Stroke(stroke) = mark { Some(stroke) } else { None }).collect()
}

fn points(curve: &BezPath) -> Vec<Point> {
    flatten(curve, 0.001).remove(0).0
}

/// Distance of two segments, 0 when they meet.
fn segment_distance(a: [Point; 2], b: [Point; 2]) -> f64 {
    let side = |s: [Point; 2], p: Point| (s[1] - s[0]).cross(p - s[0]);
    let parts = |s: [Point; 2], t: [Point; 2]| side(s, t[0]) * side(s, t[1]) <= 0.0;
    let is_degenerate = side(a, b[0]) == 0.0 && side(a, b[1]) == 0.0;
    if !is_degenerate && parts(a, b) && parts(b, a) {
        return 0.0;
    }
    let ends = [(a[0], b), (a[1], b), (b[0], a), (b[1], a)];
    ends.into_iter().map(|(p, s)| distance_to_segment(p, s[0], s[1])).fold(f64::INFINITY, f64::min)
}

/// A segment with the index of its line.
type Leg = (usize, [Point; 2]);

/// Least distance between any two lines of a set, by an exact test of all segments that share a cell; larger distances count as
/// one cell.
fn least_distance(lines: &[Vec<Point>], cell: f64) -> (f64, Point) {
    let mut cells: HashMap<(i64, i64), Vec<Leg>> = HashMap::new();
    for (k, line) in lines.iter().enumerate() {
        for pair in line.windows(2) {
            let around = Rect::from_points(pair[0], pair[1]).inflate(cell, cell);
            for x in (around.x0 / cell).floor() as i64..=(around.x1 / cell).floor() as i64 {
                for y in (around.y0 / cell).floor() as i64..=(around.y1 / cell).floor() as i64 {
                    cells.entry((x, y)).or_default().push((k, [pair[0], pair[1]]));
                }
            }
        }
    }
    let mut least = (cell, Point::ORIGIN);
    for segments in cells.values() {
        for (i, (k, a)) in segments.iter().enumerate() {
            for (j, b) in &segments[i + 1..] {
                if k != j && segment_distance(*a, *b) < least.0 {
                    least = (segment_distance(*a, *b), a[0]);
                }
            }
        }
    }
    least
}

fn assert_apart(drawing: &Drawing, what: &str) {
    for layer in &drawing.layers {
        let lines: Vec<Vec<Point>> = strokes(layer).iter().map(|s| points(s.curve())).collect();
        let (least, place) = least_distance(&lines, 1.2 * MIN_GAP);
        assert!(least >= MIN_GAP - 0.001, "{what}, {}: two lines are {least:.4} mm apart at {place:?}", layer.name);
    }
}

/// Deterministic pseudo-random numbers from 0 to 1.
fn hash(seed: u64, i: u64) -> f64 {
    let mut v = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ i.wrapping_mul(0xbf58_476d_1ce4_e5b9);
    v = (v ^ (v >> 30)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((v ^ (v >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn lines_never_cross_on_smooth_depth() {
    assert_never_crossing(0..200);
}

#[test]
fn lines_never_cross_on_noise() {
    assert_never_crossing(200..250);
}

/// Random depth maps: smooth for seeds below 200, noise from there on.
fn assert_never_crossing(seeds: std::ops::Range<u64>) {
    let photo = png_of_light(60, 60, |x, y| 0.15 + 0.6 * f64::from(x + y) / 120.0);
    for seed in seeds {
        let phi = 20.0 * PITCH * hash(seed, 1);
        let angle = 180.0 * hash(seed, 2) - 90.0;
        let is_noisy = seed >= 200;
        let smoothing = if is_noisy && seed % 2 == 0 { "0" } else { "0.36" };
        let (phi, angle) = (phi.to_string(), angle.to_string());
        let set = [("displacement", &*phi), ("angle", &*angle), ("look", "crosshatch"), ("smoothing", smoothing)];
        let sheet = Sheet::new(&photo, (9.0, 9.0), &set);
        let mut portrait = sheet.portrait();
        let noise = Raster::from_fn(portrait.placement.columns, portrait.placement.rows, |x, y| {
            hash(seed + 1000, (y * 4096 + x) as u64) as f32
        });
        let depth = if is_noisy { noise } else { stretched(&gaussian_blur(&noise, 4.0 + 10.0 * hash(seed, 3) as f32)) };
        portrait.depth = Some(depth.map(|d| d.clamp(0.001, 1.0)));
        assert_apart(&sheet.draw(&portrait), &format!("depth {seed}, displacement {phi}"));
    }
}

/// Stretched to 0 to 1.
fn stretched(raster: &Raster<f32>) -> Raster<f32> {
    let (low, high) = raster.pixels().iter().fold((1.0_f32, 0.0_f32), |(l, h), &v| (l.min(v), h.max(v)));
    raster.map(|v| (v - low) / (high - low))
}

#[test]
fn lines_show_a_hemisphere_s_form() {
    let (size, radius, phi) = (48.0, 20.0, 7.0 * PITCH);
    let photo = png_of_light(48, 48, |_, _| 0.5);
    let text = phi.to_string();
    let set: Vec<_> = WHOLE.iter().copied().chain([("displacement", &*text), ("smoothing", "0")]).collect();
    let sheet = Sheet::new(&photo, (size, size), &set);
    let mut portrait = sheet.portrait();
    let nearness = |p: Point| {
        let r = p.distance(Point::new(0.5 * size, 0.5 * size));
        (1.0 - (r / radius).powi(2)).max(0.0).sqrt()
    };
    portrait.depth = Some(Raster::from_fn(portrait.placement.columns, portrait.placement.rows, |x, y| {
        nearness(Point::new((x as f64 + 0.5) * PIXEL, (y as f64 + 0.5) * PIXEL)).max(1e-4) as f32
    }));
    let drawing = sheet.draw(&portrait);
    // Heights of base line k at x as drawn: of the line whose base height minus its displacement there passes nearest.
    let mut heights: HashMap<(i64, i64), f64> = HashMap::new();
    let (mut worst, mut count) = (0.0_f64, 0);
    let is_fair = |p: Point| p.distance(Point::new(0.5 * size, 0.5 * size)) < 0.8 * radius;
    for stroke in strokes(&drawing.layers[0]) {
        let line = points(stroke.curve());
        for i in 0..480 {
            let x = 0.1 * f64::from(i);
            let Some(y) = height_at(&line, x) else { continue };
            let base = |k: i64| -(k as f64) * PITCH;
            let moved = |k: i64| base(k) - phi * nearness(Point::new(x, base(k)));
            let k = (-90..0).min_by(|a, b| (moved(*a) - y).abs().total_cmp(&(moved(*b) - y).abs())).unwrap();
            if is_fair(Point::new(x, base(k))) {
                let displacement = phi * nearness(Point::new(x, base(k)));
                worst = worst.max((moved(k) - y).abs() / displacement);
                count += 1;
                heights.insert((k, i64::from(i)), y);
            }
        }
    }
    println!("form: displacement within {worst:.4} at {count} places");
    assert!(count > 10_000 && worst <= 0.02, "{worst} at {count}");
    let mut steepest = 0.0_f64;
    for (&(k, i), &y) in &heights {
        let (Some(next), Some(aside)) = (heights.get(&(k + 1, i)), heights.get(&(k, i + 1))) else { continue };
        // What the lines show: the slope along comes from the line itself, the slope across from its distance to the next.
        let slope_x = -(aside - y) / 0.1 * radius / phi;
        let slope_up = ((y - next) / PITCH - 1.0) * PITCH / PITCH * radius / phi;
        let p = Point::new(0.1 * i as f64 + 0.05, -(k as f64 + 0.5) * PITCH);
        let z = radius * nearness(p);
        let true_normal = [(p.x - 0.5 * size) / radius, -(p.y - 0.5 * size) / radius, z / radius];
        let read = [-slope_x, -slope_up, 1.0];
        let length = (read[0] * read[0] + read[1] * read[1] + 1.0).sqrt();
        let cos = (0..3).map(|j| true_normal[j] * read[j]).sum::<f64>() / length;
        steepest = steepest.max(cos.clamp(-1.0, 1.0).acos().to_degrees());
    }
    println!("form: normals within {steepest:.2} degrees");
    assert!(steepest <= 5.0, "{steepest}");
}

fn height_at(line: &[Point], x: f64) -> Option<f64> {
    let i = line.partition_point(|p| p.x < x);
    (i > 0 && i < line.len()).then(|| {
        let (a, b) = (line[i - 1], line[i]);
        a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x)
    })
}

/// The tone error of each of ten patches, tone 0.05 to 0.95.
fn wedge_errors(look: &str) -> Vec<f64> {
    let photo = png_of_light(600, 240, |x, y| 0.05 + 0.1 * f64::from(x / 120 + 5 * (y / 120)));
    let sheet = Sheet::new(&photo, (60.0, 24.0), &[("look", look)]);
    let mut portrait = sheet.portrait();
    portrait.depth = Some(portrait.tone.map(|_| 0.5));
    let drawing = sheet.draw(&portrait);
    assert_apart(&drawing, look);
    let scale = 60.0;
    let white = rendered(&svg_of(&drawing), scale);
    (0..10)
        .map(|i| {
            let (x, y) = (12.0 * f64::from(i % 5) + 1.2, 12.0 * f64::from(i / 5) + 1.2);
            mean_in(&white, Rect::new(x, y, x + 9.6, y + 9.6), scale) - (0.05 + 0.1 * f64::from(i))
        })
        .collect()
}

#[test]
fn the_wedge_has_its_tone_hatched_crossed_and_engraved() {
    for look in ["hatch", "crosshatch", "engraving", "net"] {
        let errors = wedge_errors(look);
        println!("wedge, {look}: {errors:.4?}");
        assert!(errors.iter().all(|e| e.abs() <= 0.02), "{look}: {errors:?}");
    }
}

#[test]
fn samples_keep_their_tone_and_their_lines_apart() {
    let bust = Some("bust-mask-subject.png");
    for (name, size, mask, depth) in [
        ("astronaut.jpg", (60.0, 60.0), None, None),
        ("astronaut-cutout.png", (60.0, 60.0), None, None),
        ("grace-hopper.jpg", (60.0, 70.313), Some("grace-hopper-subject.png"), None),
        ("chelsea.png", (60.0, 39.911), None, None),
        ("coffee.png", (60.0, 40.0), None, None),
        ("raccoon.jpg", (60.0, 45.0), None, None),
        ("bust-light.png", (60.0, 80.0), bust, Some("bust-depth.png")),
        ("bust-brown.png", (60.0, 80.0), bust, Some("bust-depth.png")),
        ("bust-dark.png", (60.0, 80.0), bust, Some("bust-depth.png")),
    ] {
        let photo = sample(name);
        let sheet = Sheet {
            tone: ToneTarget::Lightness,
            masks: mask.map(|mask| (MaskRole::Subject, sample(mask))).into_iter().collect(),
            depth: depth.map(sample),
            ..Sheet::new(&photo, size, &[])
        };
        let portrait = sheet.portrait();
        let drawing = sheet.draw(&portrait);
        assert_apart(&drawing, name);
        let error = tone_error(&drawing, &portrait);
        println!("{name}: mean difference of tone {error:.4}");
        assert!(error <= 0.05, "{name}: {error}");
    }
}

/// Mean absolute difference inside the subject between printed and target tone, both blurred by 1.5 pitches.
fn tone_error(drawing: &Drawing, portrait: &Portrait) -> f64 {
    let (columns, rows) = (portrait.placement.columns, portrait.placement.rows);
    let white = rendered(&svg_of(drawing), 40.0);
    let (fx, fy) = (white.width() as f64 / columns as f64, white.height() as f64 / rows as f64);
    let printed = Raster::from_fn(columns, rows, |x, y| {
        mean_in(&white, Rect::new(x as f64 * fx, y as f64 * fy, (x + 1) as f64 * fx, (y + 1) as f64 * fy), 1.0) as f32
    });
    let known = portrait.depth.clone().unwrap_or_else(|| portrait.tone.map(|_| 1.0));
    let wanted = portrait.ink().zip_map(&known, |ink, known| if known > 0.0 { 1.0 - ink } else { 1.0 });
    let blur = |raster: &Raster<f32>| gaussian_blur(raster, 9.0);
    let difference = blur(&printed).zip_map(&blur(&wanted), |a, b| (a - b).abs());
    let (mut sum, mut count) = (0.0, 0.0);
    for ((d, s), k) in difference.pixels().iter().zip(portrait.subject.pixels()).zip(known.pixels()) {
        if *s >= 0.5 && *k > 0.0 {
            sum += f64::from(*d);
            count += 1.0;
        }
    }
    sum / count
}

#[test]
fn white_on_black_and_light_from_depth_alone() {
    let depth = sample("bust-depth.png");
    let set = [("tone_from", "depth"), ("ground", "black")];
    let sheet = Sheet { depth: Some(depth.clone()), ..Sheet::new(&depth, (45.0, 60.0), &set) };
    let drawing = sheet.draw(&sheet.portrait());
    assert_eq!(drawing.page.paper.to_string(), "#000000");
    assert!(drawing.marks().all(|mark| mark.colour().is_some_and(|c| c.to_string() == "#ffffff")));
    let ink: f64 = drawing.layers.iter().map(Layer::ink_mm2).sum();
    println!("{ink:.0} mm2 of white on {:.0} mm2", 45.0 * 60.0);
    assert!(ink > 300.0);
}

#[test]
fn a_style_without_use_for_depth_refuses_it() {
    let folder = env!("CARGO_MANIFEST_DIR");
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
        command
            .current_dir(folder)
            .args(["draw", "samples/bust-light.png", "--dry-run", "-o", "x.svg"])
            .args(arguments)
            .output()
            .unwrap()
    };
    let refused = run(&["--depth", "samples/bust-depth.png"]);
    let message = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2), "{message}");
    assert!(message.contains("hedcut does not use a depth map; it is for engrave"), "{message}");
    let other_size = run(&["--style", "engrave", "--depth", "samples/coffee.png"]);
    assert_eq!(other_size.status.code(), Some(1));
    assert!(String::from_utf8(other_size.stderr).unwrap().contains("600 x 400 px"));
}

#[test]
fn the_same_bytes_on_any_number_of_threads() {
    let photo = sample("bust-light.png");
    let sheet =
        Sheet { depth: Some(sample("bust-depth.png")), ..Sheet::new(&photo, (30.0, 40.0), &[("regions", "superpixels")]) };
    let portrait = sheet.portrait();
    let drawn = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| svg_of(&sheet.draw(&portrait)))
    };
    assert_eq!(drawn(1), drawn(3));
}
