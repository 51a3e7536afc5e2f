//! Helpers shared by the acceptance tests: pictures with known tone, and the ink that a drawing lays down.
#![allow(dead_code)]

pub mod samples;

use drypoint::drawing::{Drawing, Page};
use drypoint::geometry::{Point, Rect};
use drypoint::raster::Raster;
use drypoint::source::{Crop, Iris, Landmarks, Limits, MaskRole, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use drypoint::style::{Settings, Silent, find};
use drypoint::write::{SvgHead, write_svg};
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma};
use std::collections::BTreeMap;
use std::io::Cursor;
use std::sync::{Arc, Mutex, OnceLock};

/// A 16-bit sRGB PNG whose pixels have the given linear luminance.
pub fn png_of_light(width: u32, height: u32, light: impl Fn(u32, u32) -> f64) -> Vec<u8> {
    let encode = |linear: f64| if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    let pixels = ImageBuffer::from_fn(width, height, |x, y| Luma([(encode(light(x, y)) * 65535.0).round() as u16]));
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::ImageLuma16(pixels).write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// Nine patches of 20 x 20 mm in three rows, linear luminance 0.1 to 0.9.
pub fn wedge() -> Vec<u8> {
    png_of_light(600, 600, |x, y| 0.1 * f64::from(1 + x / 200 + 3 * (y / 200)))
}

/// The mean face of the engraving's directions, upright, in pixels.
pub fn plain_face(x: f64, y: f64, width: f64) -> Landmarks {
    let table = include_str!("../../src/style/form/canonical_field.txt");
    let numbers = |line: &str| line.split(' ').map(|word| word.parse::<f64>().unwrap()).collect::<Vec<f64>>();
    let point = |p: Vec<f64>| [x + width * p[0], y + width * p[1], 0.0];
    let points: Vec<[f64; 3]> = table.lines().map(|line| point(numbers(line))).collect();
    let eye = |outer: usize, inner: usize| Iris {
        centre: Point::new(0.5 * (points[outer][0] + points[inner][0]), 0.5 * (points[outer][1] + points[inner][1])),
        radius: 0.04 * width,
    };
    let irises = [eye(33, 133), eye(263, 362)];
    Landmarks { points, irises, spectacles: None, pearls: Vec::new() }
}

pub const WEDGE_MM: f64 = 60.0;

/// The inner 16 x 16 mm of a patch of the wedge, and its luminance.
pub fn wedge_patches() -> impl Iterator<Item = (Rect, f64)> {
    (0..9).map(|i| {
        let (x, y) = (20.0 * f64::from(i % 3), 20.0 * f64::from(i / 3));
        (Rect::new(x + 2.0, y + 2.0, x + 18.0, y + 18.0), 0.1 * f64::from(i + 1))
    })
}

/// How a test draws.
pub struct Sheet<'a> {
    pub photo: &'a [u8],
    pub mm: (f64, f64),
    pub tone: ToneTarget,
    pub set: &'a [(&'a str, &'a str)],
    pub masks: &'a [(MaskRole, &'a [u8])],
    pub seed: u64,
}

impl<'a> Sheet<'a> {
    pub fn new(photo: &'a [u8], mm: (f64, f64)) -> Self {
        Self { photo, mm, tone: ToneTarget::Lightness, set: &[], masks: &[], seed: 0 }
    }

    pub fn portrait(&self) -> Portrait {
        let style = find("hedcut").unwrap();
        let photograph = Photograph::decode(self.photo, Limits::default()).unwrap();
        let roles: Vec<MaskRole> = self.masks.iter().map(|(role, _)| *role).collect();
        let placement = Placement::new(Rect::new(0.0, 0.0, self.mm.0, self.mm.1), style.pixels_per_mm(&self.settings(), &roles));
        let page = Page::new(self.mm.0, self.mm.1);
        let crop = Crop::all(&photograph);
        let mut portrait = Portrait::new(&photograph, crop, page, placement, self.tone, ToneCurve::default()).unwrap();
        for (role, bytes) in self.masks {
            let mask = Photograph::decode(bytes, Limits::default()).unwrap();
            portrait.add_mask(*role, &mask, &photograph, crop).unwrap();
        }
        portrait
    }

    pub fn settings(&self) -> Settings {
        let given: Vec<(String, String)> = self.set.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
        Settings::resolve("hedcut", find("hedcut").unwrap().parameters(), &given).unwrap()
    }

    pub fn draw(&self) -> Drawing {
        find("hedcut").unwrap().draw(&self.portrait(), &self.settings(), self.seed, &Silent).unwrap()
    }

    /// The drawing, made once for all tests of a program that ask for the same. Not to be called from a worker of a thread pool: it
    /// may wait for another test.
    pub fn drawn_once(&self) -> Arc<Drawing> {
        static DRAWN: Mutex<BTreeMap<String, Arc<OnceLock<Arc<Drawing>>>>> = Mutex::new(BTreeMap::new());
        let hashed = |bytes: &[u8]| bytes.iter().fold(0_u64, |hash, byte| hash.wrapping_mul(31).wrapping_add(u64::from(*byte)));
        let masks: Vec<_> = self.masks.iter().map(|(role, bytes)| (role, hashed(bytes))).collect();
        let Self { mm, tone, set, seed, .. } = self;
        let key = format!("{} {mm:?} {tone:?} {set:?} {masks:?} {seed}", hashed(self.photo));
        let drawn = Arc::clone(DRAWN.lock().unwrap().entry(key).or_default());
        Arc::clone(drawn.get_or_init(|| Arc::new(self.draw())))
    }
}

pub fn svg_of(drawing: &Drawing) -> String {
    let mut bytes = Vec::new();
    write_svg(drawing, &SvgHead::default(), &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// The drawing as resvg prints it: white fraction of each pixel.
pub fn rendered(svg: &str, pixels_per_mm: f64) -> Raster<f32> {
    let tree = resvg::usvg::Tree::from_str(svg, &resvg::usvg::Options::default()).unwrap();
    let scale = (pixels_per_mm * 25.4 / 96.0) as f32;
    let width = (tree.size().width() * scale).round() as u32;
    let height = (tree.size().height() * scale).round() as u32;
    let mut pixmap = resvg::tiny_skia::Pixmap::new(width, height).unwrap();
    pixmap.fill(resvg::tiny_skia::Color::WHITE);
    resvg::render(&tree, resvg::tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    let white = pixmap.pixels().iter().map(|p| f32::from(p.green()) / 255.0).collect();
    Raster::from_vec(width as usize, height as usize, white)
}

/// Mean of a raster inside a rectangle in millimetres.
pub fn mean_in(raster: &Raster<f32>, rect: Rect, pixels_per_mm: f64) -> f64 {
    let range = |low: f64, high: f64| (low * pixels_per_mm).round() as usize..(high * pixels_per_mm).round() as usize;
    let (mut sum, mut count) = (0.0, 0.0);
    for y in range(rect.y0, rect.y1) {
        for x in range(rect.x0, rect.x1) {
            sum += f64::from(raster.get(x, y));
            count += 1.0;
        }
    }
    sum / count
}

/// Centres of all dots.
pub fn dots(drawing: &Drawing) -> Vec<Point> {
    drawing
        .marks()
        .filter_map(|mark| if let drypoint::drawing::Mark::Dot(dot) = mark { Some(dot.centre) } else { None })
        .collect()
}

/// Reports a skipped check and the reason; fails if the gate forbids skipping.
pub fn skip(reason: &str) {
    assert!(std::env::var_os("DRYPOINT_NOTHING_SKIPS").is_none(), "skipped where nothing may be: {reason}");
    println!("skipped: {reason}");
}

pub fn sample(name: &str) -> Vec<u8> {
    std::fs::read(format!("{}/samples/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}
