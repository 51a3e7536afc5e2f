//! A drawing as resvg prints it, and the mapping from the photograph to it.

use drypoint::geometry::{Point, Rect};
use drypoint::raster::Raster;
use drypoint::source::{Crop, Limits, Photograph};
use image::{DynamicImage, ImageFormat, RgbImage};
use serde_json::Value;
use std::io::Cursor;
use std::path::Path;
use std::process::Command;

/// The SVG that the command draws.
pub fn drawn(photo: &Path, options: &[&str], place: &Path) -> String {
    let out = place.join("drawing.svg");
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    command.arg("draw").arg(photo).args(options).args(["-q", "-o"]).arg(&out);
    let output = command.output().expect("the command starts");
    assert!(output.status.success(), "{}: {}", photo.display(), String::from_utf8_lossy(&output.stderr));
    std::fs::read_to_string(out).expect("it was written")
}

/// A printed drawing.
pub struct Print {
    pub pixels: Raster<[u8; 3]>,
    pub pixels_per_mm: f64,
    /// The part of the photograph that was drawn.
    pub crop: Crop,
    /// Its position on the page, in millimetres.
    pub picture: Rect,
    /// The style's pitch in millimetres, if it has one.
    pub pitch: Option<f64>,
}

impl Print {
    pub fn new(svg: &str, pixels_per_mm: f64) -> Self {
        let tree = resvg::usvg::Tree::from_str(svg, &resvg::usvg::Options::default()).expect("the drawing is sound");
        let recipe = recipe(svg);
        let four = |key: &str| [0, 1, 2, 3].map(|i| recipe[key][i].as_f64().expect("the recipe says where the picture lies"));
        let [x, y, width, height] = four("crop_px");
        let [left, top, wide, high] = four("picture_mm");
        Self {
            pixels: rendered(&tree, (pixels_per_mm * 25.4 / 96.0) as f32),
            pixels_per_mm,
            crop: Crop { x, y, width, height },
            picture: Rect::new(left, top, left + wide, top + high),
            pitch: recipe["set"]["pitch"].as_str().and_then(millimetres),
        }
    }

    /// Maps a point of the photograph to pixels of the print.
    pub fn place(&self, p: Point) -> Point {
        let x = self.picture.x0 + (p.x - self.crop.x) / self.crop.width * self.picture.width();
        let y = self.picture.y0 + (p.y - self.crop.y) / self.crop.height * self.picture.height();
        Point::new(x * self.pixels_per_mm, y * self.pixels_per_mm)
    }

    /// Pixels of the print per pixel of the photograph.
    pub fn scale(&self) -> f64 {
        self.picture.width() * self.pixels_per_mm / self.crop.width
    }

    pub fn photograph(&self) -> Photograph {
        let (width, height) = (self.pixels.width() as u32, self.pixels.height() as u32);
        let picture = RgbImage::from_raw(width, height, self.pixels.pixels().concat()).expect("a raster's pixels fill it");
        let mut bytes = Cursor::new(Vec::new());
        DynamicImage::ImageRgb8(picture).write_to(&mut bytes, ImageFormat::Png).expect("it can be written");
        Photograph::decode(bytes.get_ref(), Limits::default()).expect("it was just written")
    }

    /// The inked fraction of each pixel, in black drawings.
    pub fn ink(&self) -> Raster<f32> {
        self.pixels.map(|[_, green, _]| 1.0 - f32::from(green) / 255.0)
    }
}

fn recipe(svg: &str) -> Value {
    let document = resvg::usvg::roxmltree::Document::parse(svg).expect("the drawing is sound");
    let texts = document.descendants().filter(resvg::usvg::roxmltree::Node::is_text).filter_map(|node| node.text());
    let mut recipes = texts.filter_map(|text| serde_json::from_str(text.trim()).ok());
    recipes.next().expect("the drawing holds its recipe")
}

fn millimetres(text: &str) -> Option<f64> {
    text.trim_end_matches("mm").trim().parse().ok()
}

fn rendered(tree: &resvg::usvg::Tree, scale: f32) -> Raster<[u8; 3]> {
    let pixels = |length: f32| (length * scale).round() as u32;
    let (width, height) = (pixels(tree.size().width()), pixels(tree.size().height()));
    let mut pixmap = resvg::tiny_skia::Pixmap::new(width, height).expect("a drawing has a size");
    pixmap.fill(resvg::tiny_skia::Color::WHITE);
    resvg::render(tree, resvg::tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    let colours = pixmap.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect();
    Raster::from_vec(width as usize, height as usize, colours)
}
