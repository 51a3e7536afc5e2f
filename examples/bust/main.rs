//! Renders a human bust with known ground truth: three pictures of it, with the depth, the region masks and the feature boxes
//! that a style would otherwise have to guess.
//!
//! Usage: `cargo run --release --example bust -- OUTDIR`
//!
//! Every style is tuned on portraits, and a portrait from a camera comes without a right answer:
//! nobody knows its depth, or where exactly hair ends and forehead begins. The bust is made of
//! analytic surfaces (signed distance functions), so the same ray that yields a colour also yields
//! the region it hit and how far away it is. One geometry is lit once and coloured three times,
//! with a light, a brown and a dark skin, so that a style which only works on one of them shows.
//!
//! Written to `OUTDIR`, all 600 x 800 pixels:
//!
//! - `bust-light`, `bust-brown`, `bust-dark`: sRGB, PNG or, where that grows too large, JPEG;
//! - `bust-depth.png`: 16 bit, white is near, 0 is background;
//! - `bust-mask-{subject,face,hair,clothing,detail}.png`: 8 bit, white is inside;
//! - `bust-features.txt`: one `name x0 y0 x1 y1` per line, left meaning left in the picture and
//!   the second corner being exclusive.
//!
//! Lengths are decimetres, so a head is 2.3 high. The origin lies between the eyes, x points right
//! in the picture, y up and z at the camera. All noise is hashed from fixed seeds and every pixel
//! depends on its own position alone: two runs write the same bytes.

use std::error::Error;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{GrayImage, ImageBuffer, Luma, Rgb, RgbImage};
use rayon::prelude::*;

mod colour;
mod figure;
mod light;
mod space;

use colour::LOOKS;
use figure::{Part, eye_opening};
use light::{Hit, Pixel, render_pixel};
use space::smoothstep;

const WIDTH: u32 = 600;
const HEIGHT: u32 = 800;
/// Pictures larger than this as PNG are written as JPEG.
const PNG_LIMIT: usize = 350_000;
const JPEG_QUALITY: u8 = 92;

fn main() -> Result<(), Box<dyn Error>> {
    let directory = PathBuf::from(std::env::args_os().nth(1).ok_or("usage: bust OUTDIR")?);
    fs::create_dir_all(&directory)?;
    let pixels: Vec<Pixel> =
        (0..WIDTH * HEIGHT).into_par_iter().map(|index| render_pixel(index % WIDTH, index / WIDTH)).collect();
    for (index, look) in LOOKS.iter().enumerate() {
        save_picture(&directory.join(look.name), &pixels, index)?;
    }
    save_depth(&directory.join("bust-depth.png"), &pixels)?;
    let save_region = |name: &str, share: fn(&Pixel) -> f32| {
        let level = |x, y| Luma([byte(share(at(&pixels, x, y)))]);
        save_mask(&directory, name, &GrayImage::from_fn(WIDTH, HEIGHT, level))
    };
    save_region("subject", |pixel| pixel.subject)?;
    save_region("face", |pixel| pixel.face)?;
    save_region("hair", |pixel| pixel.hair)?;
    save_region("clothing", |pixel| pixel.clothing)?;
    let boxes = feature_boxes(&pixels);
    save_mask(&directory, "detail", &detail_mask(&boxes))?;
    let mut text = String::new();
    for (name, [x0, y0, x1, y1]) in FEATURE_NAMES.iter().zip(boxes) {
        writeln!(text, "{name} {x0} {y0} {x1} {y1}")?;
    }
    fs::write(directory.join("bust-features.txt"), text)?;
    Ok(())
}

const FEATURE_NAMES: [&str; 6] = ["left eyebrow", "right eyebrow", "left eye", "right eye", "nose", "mouth"];

fn feature_bit(hit: &Hit) -> u8 {
    let right = u8::from(hit.head.x > 0.0);
    let p = hit.head.mirrored();
    match hit.part {
        Part::Brow => 1 << right,
        // The corners of the eye, outside the ball, belong to it too.
        Part::Eye => 4 << right,
        Part::Face if p.z > 0.5 && eye_opening(p) < 0.004 => 4 << right,
        Part::Nose => 16,
        Part::Lips => 32,
        _ => 0,
    }
}

fn at(pixels: &[Pixel], x: u32, y: u32) -> &Pixel {
    &pixels[(y * WIDTH + x) as usize]
}

fn feature_boxes(pixels: &[Pixel]) -> [[u32; 4]; 6] {
    let mut boxes = [[u32::MAX, u32::MAX, 0, 0]; 6];
    for (y, row) in (0..).zip(pixels.chunks(WIDTH as usize)) {
        for (x, pixel) in (0..).zip(row) {
            for (bit, [x0, y0, x1, y1]) in boxes.iter_mut().enumerate() {
                if pixel.features & (1 << bit) != 0 {
                    (*x0, *y0) = (x.min(*x0), y.min(*y0));
                    (*x1, *y1) = ((x + 1).max(*x1), (y + 1).max(*y1));
                }
            }
        }
    }
    boxes
}

/// Soft blobs: one round each eye with its brow, one round the mouth.
fn detail_mask(boxes: &[[u32; 4]; 6]) -> GrayImage {
    let joined = |a: usize, b: usize| {
        let least = |corner: usize| boxes[a][corner].min(boxes[b][corner]);
        let most = |corner: usize| boxes[a][corner].max(boxes[b][corner]);
        [least(0), least(1), most(2), most(3)]
    };
    let blobs = [joined(0, 2), joined(1, 3), boxes[5]];
    GrayImage::from_fn(WIDTH, HEIGHT, |x, y| {
        let inside = blobs.iter().map(|blob| {
            let [x0, y0, x1, y1] = blob.map(|edge| edge as f32);
            let across = (2.0 * x as f32 + 1.0 - x0 - x1) / (x1 - x0);
            let down = (2.0 * y as f32 + 1.0 - y0 - y1) / (y1 - y0);
            // 1 within the ellipse through the corners of the box, fading out beyond it.
            smoothstep(2.0, 1.3, across.hypot(down))
        });
        Luma([byte(inside.fold(0.0, f32::max))])
    })
}

fn byte(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// Linear light to sRGB, highlights rolled off like on film instead of clipped.
fn encode(linear: f32) -> u8 {
    let knee = 0.6;
    let over = (linear - knee).max(0.0) / (1.0 - knee);
    let rolled = linear.clamp(0.0, knee) + (1.0 - knee) * (1.0 - (-over).exp());
    let gamma = 1.055 * rolled.powf(1.0 / 2.4) - 0.055;
    byte(gamma.max(rolled.min(0.003_130_8) * 12.92))
}

fn save_picture(stem: &Path, pixels: &[Pixel], look: usize) -> Result<(), Box<dyn Error>> {
    let picture = RgbImage::from_fn(WIDTH, HEIGHT, |x, y| {
        let colour = at(pixels, x, y).colours[look];
        Rgb([encode(colour.x), encode(colour.y), encode(colour.z)])
    });
    let mut png = Vec::new();
    picture.write_with_encoder(smallest_png(&mut png))?;
    if png.len() <= PNG_LIMIT {
        fs::write(stem.with_extension("png"), png)?;
    } else {
        let file = BufWriter::new(File::create(stem.with_extension("jpg"))?);
        picture.write_with_encoder(JpegEncoder::new_with_quality(file, JPEG_QUALITY))?;
    }
    Ok(())
}

fn save_depth(path: &Path, pixels: &[Pixel]) -> Result<(), Box<dyn Error>> {
    let visible = || pixels.iter().filter(|pixel| pixel.subject >= 0.5);
    let near = visible().map(|pixel| pixel.depth).fold(f32::MIN, f32::max);
    let far = visible().map(|pixel| pixel.depth).fold(f32::MAX, f32::min);
    let map = ImageBuffer::<Luma<u16>, _>::from_fn(WIDTH, HEIGHT, |x, y| {
        let pixel = at(pixels, x, y);
        // The farthest part of the subject stays well apart from the background.
        let level = 0.1 + 0.9 * (pixel.depth - far) / (near - far);
        let covered = if pixel.subject >= 0.5 { level } else { 0.0 };
        Luma([(covered * f32::from(u16::MAX)).round() as u16])
    });
    let mut png = Vec::new();
    map.write_with_encoder(smallest_png(&mut png))?;
    Ok(fs::write(path, png)?)
}

fn smallest_png(bytes: &mut Vec<u8>) -> PngEncoder<&mut Vec<u8>> {
    PngEncoder::new_with_quality(bytes, CompressionType::Best, FilterType::Adaptive)
}

fn save_mask(directory: &Path, name: &str, mask: &GrayImage) -> Result<(), Box<dyn Error>> {
    mask.save(directory.join(format!("bust-mask-{name}.png")))?;
    Ok(())
}
