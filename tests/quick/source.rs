//! Every kind of photograph is read correctly: formats, depths, profiles, alpha, orientation.

use crate::common;

use drypoint::drawing::Page;
use drypoint::geometry::Rect;
use drypoint::source::{Crop, Limits, MaskRole, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use image::codecs::png::PngEncoder;
use image::{DynamicImage, ExtendedColorType, ImageBuffer, ImageEncoder, ImageFormat, Luma, LumaA, Rgb, Rgba};
use moxcms::ColorProfile;
use std::io::Cursor;

const CMYK_PROFILE: &str = "/usr/share/color/icc/ghostscript/default_cmyk.icc";

fn encoded(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

fn data(name: &str) -> Vec<u8> {
    std::fs::read(format!("{}/tests/data/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// One working pixel per pixel of the picture.
fn portrait(bytes: &[u8]) -> Portrait {
    let photograph = Photograph::decode(bytes, Limits::default()).unwrap();
    let (width, height) = (f64::from(photograph.width()), f64::from(photograph.height()));
    let placement = Placement::new(Rect::new(0.0, 0.0, width, height), 1.0);
    let page = Page::new(width, height);
    Portrait::new(&photograph, Crop::all(&photograph), page, placement, ToneTarget::Linear, ToneCurve::default()).unwrap()
}

/// A ramp of grey from 0 to 255 in 64 columns.
fn ramp() -> DynamicImage {
    DynamicImage::ImageLuma8(ImageBuffer::from_fn(64, 16, |x, _| Luma([(x * 4) as u8])))
}

fn linear(value: f64) -> f64 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

fn assert_is_ramp(name: &str, bytes: &[u8], tolerance: f64) {
    let portrait = portrait(bytes);
    for x in [2_usize, 20, 33, 50, 61] {
        let expected = linear(x as f64 * 4.0 / 255.0);
        let found = f64::from(portrait.tone.get(x, 8));
        assert!((found - expected).abs() <= tolerance, "{name}, column {x}: {found} for {expected}");
    }
}

#[test]
fn every_format_by_its_content() {
    let grey = ramp();
    for (name, format, picture) in [
        ("PNG", ImageFormat::Png, grey.clone()),
        ("PNG 16", ImageFormat::Png, DynamicImage::ImageLuma16(grey.to_luma16())),
        ("PNG RGB", ImageFormat::Png, DynamicImage::ImageRgb8(grey.to_rgb8())),
        ("PNG RGB 16", ImageFormat::Png, DynamicImage::ImageRgb16(grey.to_rgb16())),
        ("PNG grey and alpha", ImageFormat::Png, DynamicImage::ImageLumaA8(grey.to_luma_alpha8())),
        ("WebP", ImageFormat::WebP, DynamicImage::ImageRgb8(grey.to_rgb8())),
        ("TIFF", ImageFormat::Tiff, grey.clone()),
        ("BMP", ImageFormat::Bmp, DynamicImage::ImageRgb8(grey.to_rgb8())),
        ("GIF", ImageFormat::Gif, DynamicImage::ImageRgba8(grey.to_rgba8())),
        ("JPEG", ImageFormat::Jpeg, grey.clone()),
    ] {
        assert_is_ramp(name, &encoded(&picture, format), if format == ImageFormat::Jpeg { 0.02 } else { 0.002 });
    }
    assert_is_ramp("progressive JPEG", &data("progressive.jpg"), 0.02);
}

#[test]
fn palettes_and_single_bits() {
    for (depth, levels) in [(png::BitDepth::One, 2_u8), (png::BitDepth::Two, 4), (png::BitDepth::Four, 16)] {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 16, 4);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(depth);
        encoder.set_palette((0..levels).flat_map(|i| [255 - i * (255 / (levels - 1)); 3]).collect::<Vec<u8>>());
        let bits = depth as usize;
        // Every pixel has the palette's last entry, black, except the first eight, which are white.
        let row: Vec<u8> = (0..16 * bits / 8).map(|i| if i < bits { 0 } else { 0xff }).collect();
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&row.repeat(4)).unwrap();
        writer.finish().unwrap();
        let portrait = portrait(&bytes);
        assert!(portrait.tone.get(2, 2) > 0.99 && portrait.tone.get(13, 2) < 0.01, "{depth:?}");
    }
}

#[test]
fn alpha_is_the_subject_and_the_picture_lies_on_white() {
    let picture = ImageBuffer::from_fn(40, 20, |x, _| LumaA([0_u8, if x < 20 { 255 } else { 0 }]));
    let portrait = portrait(&encoded(&DynamicImage::ImageLumaA8(picture), ImageFormat::Png));
    assert!(portrait.subject.get(5, 10) > 0.99 && portrait.subject.get(34, 10) < 0.01);
    assert!(portrait.tone.get(5, 10) < 0.01 && portrait.tone.get(34, 10) > 0.99);
    let half = ImageBuffer::from_pixel(8, 8, Rgba([0_u8, 0, 0, 128]));
    let tone = f64::from(self::portrait(&encoded(&DynamicImage::ImageRgba8(half), ImageFormat::Png)).tone.get(4, 4));
    assert!((tone - (1.0 - 128.0 / 255.0)).abs() < 0.002, "half of the light of the paper: {tone}");
}

#[test]
fn the_exif_turn_is_applied_before_masks_and_crops() {
    // 40 x 20 px, left half black, to be turned a quarter clockwise: 20 x 40 px, upper half black.
    let portrait = portrait(&data("turned.jpg"));
    assert_eq!((portrait.placement.columns, portrait.placement.rows), (20, 40));
    assert!(portrait.tone.get(10, 5) < 0.02 && portrait.tone.get(10, 34) > 0.98);
    let photograph = Photograph::decode(&data("turned.jpg"), Limits::default()).unwrap();
    let mask = |w, h| Photograph::decode(&encoded(&DynamicImage::new_luma8(w, h), ImageFormat::Png), Limits::default()).unwrap();
    let crop = Crop::all(&photograph);
    let mut turned = portrait.clone();
    assert!(turned.add_mask(MaskRole::Subject, &mask(20, 40), &photograph, crop).is_ok());
    assert!(turned.add_mask(MaskRole::Subject, &mask(40, 20), &photograph, crop).is_err());
}

#[test]
fn an_embedded_profile_is_honoured() {
    let green = |profile: Option<ColorProfile>| {
        let mut bytes = Vec::new();
        let mut encoder = PngEncoder::new(&mut bytes);
        if let Some(profile) = profile {
            encoder.set_icc_profile(profile.encode().unwrap()).unwrap();
        }
        encoder.write_image(&[60_u8, 160, 60].repeat(64), 8, 8, ExtendedColorType::Rgb8).unwrap();
        portrait(&bytes).light.get(4, 4)
    };
    let plain = green(None);
    let close = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.004);
    assert!(close(green(Some(ColorProfile::new_srgb())), plain));
    // The same numbers in a wider colour space are a stronger green: less red, more green.
    for wide in [ColorProfile::new_adobe_rgb(), ColorProfile::new_display_p3()] {
        let [red, green, _] = green(Some(wide));
        assert!(red < plain[0] - 0.005 && green >= plain[1] - 0.02, "{red} {green} {plain:?}");
    }
}

#[test]
fn a_grey_profile_is_honoured() {
    let mut bytes = Vec::new();
    let mut encoder = PngEncoder::new(&mut bytes);
    encoder.set_icc_profile(ColorProfile::new_gray_with_gamma(1.0).encode().unwrap()).unwrap();
    encoder.write_image(&[128_u8; 64], 8, 8, ExtendedColorType::L8).unwrap();
    let tone = f64::from(portrait(&bytes).tone.get(4, 4));
    assert!((tone - 128.0 / 255.0).abs() < 0.01, "linear numbers are light: {tone}");
}

#[test]
fn cmyk_without_a_profile_is_taken_as_ideal_inks_with_a_warning() {
    let bytes = data("cmyk.jpg");
    let photograph = Photograph::decode(&bytes, Limits::default()).unwrap();
    assert!(photograph.info.warnings[0].contains("CMYK without a profile"));
    let light = portrait(&bytes).light;
    assert!(light.get(5, 8)[0] > 0.97 && light.get(40, 8)[0] < 0.03 && light.get(40, 8)[2] > 0.9);
}

#[test]
fn cmyk_goes_through_its_profile() {
    let Ok(profile) = std::fs::read(CMYK_PROFILE) else {
        return common::skip(&format!("no CMYK profile at {CMYK_PROFILE} (Debian's libgs-common brings one)"));
    };
    // The profile in APP2 segments after the start of the image.
    let plain = data("cmyk.jpg");
    let mut bytes = plain[..2].to_vec();
    let parts: Vec<&[u8]> = profile.chunks(60_000).collect();
    for (i, part) in parts.iter().enumerate() {
        bytes.extend([0xff, 0xe2]);
        bytes.extend(u16::try_from(part.len() + 16).unwrap().to_be_bytes());
        bytes.extend(b"ICC_PROFILE\0");
        bytes.extend([i as u8 + 1, parts.len() as u8]);
        bytes.extend(*part);
    }
    bytes.extend(&plain[2..]);
    let photograph = Photograph::decode(&bytes, Limits::default()).unwrap();
    assert!(photograph.info.warnings.is_empty());
    let light = portrait(&bytes).light;
    let (paper, grey, cyan) = (light.get(5, 8), light.get(24, 8), light.get(40, 8));
    assert!(paper.iter().all(|v| *v > 0.9), "{paper:?}");
    assert!(grey.iter().all(|v| (0.1..0.5).contains(v)), "{grey:?}");
    // A press's cyan is much darker than the screen's, whose green and blue are full.
    assert!(cyan[0] < 0.2 && (0.2..0.7).contains(&cyan[1]) && cyan[2] < 0.95, "{cyan:?}");
}

#[test]
fn reducing_keeps_the_mean_light() {
    let picture = ImageBuffer::from_fn(600, 400, |x, y| if (x + y) % 2 == 0 { Rgb([255_u8; 3]) } else { Rgb([0; 3]) });
    let bytes = encoded(&DynamicImage::ImageRgb8(picture), ImageFormat::Png);
    let photograph = Photograph::decode(&bytes, Limits::default()).unwrap();
    let placement = Placement::new(Rect::new(0.0, 0.0, 60.0, 40.0), 1.0);
    let crop = Crop::all(&photograph);
    let portrait =
        Portrait::new(&photograph, crop, Page::new(60.0, 40.0), placement, ToneTarget::Linear, ToneCurve::default()).unwrap();
    for (x, y) in [(0, 0), (30, 20), (59, 39)] {
        assert!((portrait.tone.get(x, y) - 0.5).abs() < 0.03, "a chequerboard is half its light: {}", portrait.tone.get(x, y));
    }
}
