//! Sheets and boxes: where the picture lies on the page.

use super::arguments::{CropNumber, Fit, PictureOptions};
use super::failure::Failure;
use crate::drawing::Page;
use crate::geometry::{Rect, parse_drawn_size};
use crate::source::{Crop, Photograph, fill_box};

/// Named sheets, portrait, in millimetres (ISO 216; ANSI/ASME Y14.1).
const SHEETS: [(&str, f64, f64); 10] = [
    ("a6", 105.0, 148.0),
    ("a5", 148.0, 210.0),
    ("a4", 210.0, 297.0),
    ("a3", 297.0, 420.0),
    ("a2", 420.0, 594.0),
    ("a1", 594.0, 841.0),
    ("a0", 841.0, 1189.0),
    ("letter", 215.9, 279.4),
    ("legal", 215.9, 355.6),
    ("tabloid", 279.4, 431.8),
];

/// The box of a picture without a sheet.
const USUAL_BOX: (f64, f64) = (90.0, 120.0);
/// Least side of a picture, in millimetres.
const LEAST_SIDE: f64 = 0.5;
/// Margin kept on a named sheet.
const USUAL_MARGIN: f64 = 10.0;

/// A sheet by name or size.
pub(super) fn sheet(text: &str) -> Result<(f64, f64), Failure> {
    let lower = text.to_ascii_lowercase();
    let (name, is_landscape) = match lower.strip_suffix("-landscape") {
        Some(name) => (name, true),
        None => (lower.strip_suffix("-portrait").unwrap_or(&lower), false),
    };
    if let Some(&(_, width, height)) = SHEETS.iter().find(|(sheet, ..)| *sheet == name) {
        return Ok(if is_landscape { (height, width) } else { (width, height) });
    }
    let names: Vec<&str> = SHEETS.iter().map(|(name, ..)| *name).collect();
    let refuse = || {
        Failure::Usage(format!(
            "--page {text} is no sheet; there are {}, each also with -landscape, or give WxH such as 200x250mm",
            names.join(", ")
        ))
    };
    let (width, height) = parse_drawn_size(text).map_err(|_| refuse())?;
    let sound = |mm: f64| (1.0..=100_000.0).contains(&mm);
    if sound(width) && sound(height) { Ok((width, height)) } else { Err(refuse()) }
}

/// The page, the picture's box on it and the part of the photograph that fills it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Layout {
    pub page: Page,
    pub picture: Rect,
    pub crop: Crop,
}

/// Lays the picture out; `reach` is what a machine can draw of a page, which bounds the box that nobody chose.
pub(super) fn lay_out(
    options: &PictureOptions,
    photograph: &Photograph,
    reach: impl Fn(&Page) -> Option<Rect>,
) -> Result<Layout, Failure> {
    let sheet = options.page.as_deref().map(sheet).transpose()?;
    let margin = options.margin.unwrap_or(if sheet.is_some() { USUAL_MARGIN } else { 0.0 });
    // On a machine's own sheet, with no margin asked for, what the machine cannot reach is margin too.
    let free = sheet.filter(|_| options.margin.is_none()).and_then(|(width, height)| {
        let page = Page::new(width, height);
        reach(&page).map(|reach| page.rect().inset(-margin).intersect(reach))
    });
    let frame = match (options.size, sheet) {
        (Some(size), _) => size,
        (None, Some(_)) if free.is_some() => free.map_or((0.0, 0.0), |free| (free.width(), free.height())),
        (None, Some((width, height))) => (width - 2.0 * margin, height - 2.0 * margin),
        (None, None) => USUAL_BOX,
    };
    if frame.0 <= 0.0 || frame.1 <= 0.0 {
        return Err(Failure::Usage(format!("a margin of {margin} mm leaves nothing of the sheet; make it smaller")));
    }
    if let Some((width, height)) = sheet
        && (frame.0 > width || frame.1 > height)
    {
        return Err(Failure::Usage(format!(
            "--size {}x{} mm is larger than the sheet of {width} x {height} mm",
            frame.0, frame.1
        )));
    }
    let mut crop = crop_of(options, photograph).within(photograph).map_err(|error| Failure::about(&options.photo)(&error))?;
    if options.fit == Fit::Cover {
        crop = fill_box(crop, frame.0, frame.1);
    }
    let scale = (frame.0 / crop.width).min(frame.1 / crop.height);
    let (width, height) = (crop.width * scale, crop.height * scale);
    if width < LEAST_SIDE || height < LEAST_SIDE {
        return Err(Failure::Usage(format!(
            "the picture would be {width:.2} x {height:.2} mm; use another --crop, or a larger --size"
        )));
    }
    let (page_width, page_height) = sheet.unwrap_or((width + 2.0 * margin, height + 2.0 * margin));
    let page = Page::new(page_width, page_height);
    let centre = free.map_or(page.rect().center(), |free| free.center());
    Ok(Layout { page, picture: Rect::from_center_size(centre, (width, height)), crop })
}

/// What to say when a box that was asked for stays empty by more than a twentieth of a side.
pub(super) fn unfilled(options: &PictureOptions, layout: &Layout) -> Option<String> {
    let (width, height) = options.size.filter(|_| options.fit == Fit::Contain)?;
    let picture = layout.picture;
    let is_empty = picture.width() < 0.95 * width || picture.height() < 0.95 * height;
    is_empty.then(|| {
        let (w, h) = (picture.width(), picture.height());
        format!("the picture is {w:.1} x {h:.1} mm in its box of {width} x {height} mm; --fit cover fills the box and cuts the photograph")
    })
}

fn crop_of(options: &PictureOptions, photograph: &Photograph) -> Crop {
    let whole = Crop::all(photograph);
    let Some([x, y, w, h]) = options.crop else { return whole };
    let pixels = |number: CropNumber, of: f64| match number {
        CropNumber::Pixels(pixels) => pixels,
        CropNumber::Percent(percent) => percent / 100.0 * of,
    };
    Crop { x: pixels(x, whole.width), y: pixels(y, whole.height), width: pixels(w, whole.width), height: pixels(h, whole.height) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheets() {
        assert_eq!(sheet("a4").unwrap(), (210.0, 297.0));
        assert_eq!(sheet("A4-landscape").unwrap(), (297.0, 210.0));
        assert_eq!(sheet("8x10in").unwrap(), (203.2, 254.0));
        assert_eq!(sheet("96x192px").unwrap(), (25.4, 50.8));
        for wrong in ["a9", "0x10", "-5x10", "10", "NaNx3"] {
            assert!(sheet(wrong).is_err(), "{wrong}");
        }
    }
}
