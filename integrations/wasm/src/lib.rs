//! drypoint for JavaScript: a photograph's bytes in, an SVG's text out.
//!
//! WebAssembly has one thread here, and no files, clock or serial ports; what draws needs none of them.

use drypoint::drawing::Page;
use drypoint::geometry::Rect;
use drypoint::interrupt::Interrupt;
use drypoint::press::{PrintFormat, PrintJob};
use drypoint::source::{Crop, Limits, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use drypoint::style::{STYLES, Settings, Silent, find};
use drypoint::write::SvgHead;
use std::error::Error;
use wasm_bindgen::prelude::*;

/// Draws a photograph (JPEG, PNG, WebP, TIFF, BMP or GIF) as SVG, `width` millimetres wide and as high as it is.
///
/// `settings` holds the style's parameters, one `name=value` per line, as `drypoint styles NAME` lists them.
#[wasm_bindgen]
pub fn draw(photograph: &[u8], style: &str, settings: &str, width: f64, seed: u32) -> Result<String, JsError> {
    drawn(photograph, style, settings, width, seed).map_err(|error| JsError::new(&error.to_string()))
}

/// The same for Rust.
pub fn drawn(photograph: &[u8], style: &str, settings: &str, width: f64, seed: u32) -> Result<String, Box<dyn Error>> {
    if !(1.0..=2000.0).contains(&width) {
        return Err(format!("the width is {width} mm; it must be from 1 to 2000").into());
    }
    let names = || STYLES.iter().map(|style| style.name()).collect::<Vec<_>>().join(", ");
    let style = find(style).ok_or_else(|| format!("there is no style '{style}'; there are {}", names()))?;
    let settings = Settings::resolve(style.name(), style.parameters(), &pairs(settings)?)?;
    let photograph = Photograph::decode(photograph, Limits::default())?;
    let height = width * f64::from(photograph.height()) / f64::from(photograph.width());
    let picture = Rect::new(0.0, 0.0, width, height);
    let placement = Placement::new(picture, style.resolution(&settings, &[], picture));
    let (crop, page, curve) = (Crop::all(&photograph), Page::new(width, height), ToneCurve::default());
    let portrait = Portrait::new(&photograph, crop, page, placement, ToneTarget::Lightness, curve)?;
    let drawing = style.draw(&portrait, &settings, u64::from(seed), &Silent)?;
    let mut svg = Vec::new();
    PrintJob::new(&drawing, None, &Interrupt::never())?.write(PrintFormat::Svg, &SvgHead::default(), &mut svg)?;
    Ok(String::from_utf8(svg)?)
}

fn pairs(settings: &str) -> Result<Vec<(String, String)>, String> {
    let lines = settings.lines().map(str::trim).filter(|line| !line.is_empty());
    let pair = |line: &str| {
        let (key, value) = line.split_once('=').ok_or_else(|| format!("'{line}' is no setting; write it as name=value"))?;
        Ok((key.trim().to_owned(), value.trim().to_owned()))
    };
    lines.map(pair).collect()
}
