//! Sheets and boxes: the position of the picture on the page.

use super::arguments::{Fit, PictureOptions, PlacingOptions};
use super::crop::covering;
use super::failure::Failure;
use super::placing::{Turning, move_inside, requested_move};
use crate::drawing::Page;
use crate::geometry::{Rect, parse_drawn_size};
use crate::plot::{Profile, mount};
use crate::source::{Crop, Landmarks};

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

/// Default box of a picture without a sheet, in millimetres.
const USUAL_BOX: (f64, f64) = (90.0, 120.0);
/// Least side of a picture, in millimetres.
const LEAST_SIDE: f64 = 0.5;
/// Default margin with `--page`, in millimetres.
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
    /// The sheet before turning, as the style sees it.
    pub page: Page,
    /// The picture on the upright sheet.
    pub picture: Rect,
    pub crop: Crop,
    /// How sheet and picture are turned and mirrored when drawn.
    pub turning: Turning,
}

impl Layout {
    /// Width and height of the turned sheet.
    pub(super) const fn sheet(&self) -> (f64, f64) {
        self.turning.size((self.page.width, self.page.height))
    }

    /// The picture's box on the turned sheet.
    pub(super) fn placed(&self) -> Rect {
        self.turning.matrix(&self.page).transform_rect_bbox(self.picture)
    }
}

/// Lays the picture out, a crop in which there are `faces`. `reach` gives the part of a page that a machine can draw; it limits the default box.
pub(super) fn lay_out(
    options: &PictureOptions,
    placing: &PlacingOptions,
    (crop, faces): (Crop, &[Landmarks]),
    reach: impl Fn(&Page) -> Option<Rect>,
) -> Result<Layout, Failure> {
    let with = |turning: Turning| Sheet::new(options, placing, turning, &reach)?.lay_out(options, placing, (crop, faces));
    let upright = Turning { degrees: 0, is_mirrored: placing.mirror };
    let quarter_helps = || match (with(upright), with(Turning { degrees: 90, ..upright })) {
        (Ok(upright), Ok(turned)) => turned.picture.area() > 1.001 * upright.picture.area(),
        (Err(_), turned) => turned.is_ok(),
        _ => false,
    };
    with(Turning::asked(placing, quarter_helps))
}

/// The sheet that the turned picture lies on.
struct Sheet {
    turning: Turning,
    /// The turned sheet, if `--page` is given.
    page: Option<Page>,
    margin: f64,
    /// The part of the sheet that the machine reaches.
    reached: Rect,
    /// The part of `reached` inside the margin.
    free: Rect,
}

impl Sheet {
    fn new(
        options: &PictureOptions,
        placing: &PlacingOptions,
        turning: Turning,
        reach: impl Fn(&Page) -> Option<Rect>,
    ) -> Result<Self, Failure> {
        let page = options.page.as_deref().map(sheet).transpose()?.map(|(width, height)| Page::new(width, height));
        if page.is_none() && placing.at.is_some() {
            return Err(Failure::Usage("--at is a position on a sheet; give the sheet with --page".to_owned()));
        }
        let margin = options.margin.unwrap_or(if page.is_some() { USUAL_MARGIN } else { 0.0 });
        let rect = page.map_or(Rect::ZERO, |page| page.rect());
        let reached = page.and_then(|page| reach(&page)).map_or(rect, |reach| rect.intersect(reach));
        // The part that the machine cannot reach counts as margin.
        let free = Rect { x0: margin, y0: margin, x1: rect.x1 - margin, y1: rect.y1 - margin };
        let free = Rect {
            x0: free.x0.max(reached.x0),
            y0: free.y0.max(reached.y0),
            x1: free.x1.min(reached.x1),
            y1: free.y1.min(reached.y1),
        };
        Ok(Self { turning, page, margin, reached, free })
    }

    /// The box that the upright picture is fitted into.
    fn frame(&self, options: &PictureOptions) -> Result<(f64, f64), Failure> {
        let frame = match (options.size, self.page) {
            (Some(size), _) => size,
            (None, Some(_)) => self.turning.size((self.free.width(), self.free.height())),
            (None, None) => USUAL_BOX,
        };
        if frame.0 <= 0.0 || frame.1 <= 0.0 {
            return Err(Failure::Usage(format!("a margin of {} mm leaves nothing of the sheet; make it smaller", self.margin)));
        }
        let turned = self.turning.size(frame);
        if let Some(Page { width, height, .. }) = self.page
            && (turned.0 > width || turned.1 > height)
        {
            let fits_turned = turned.1 <= width && turned.0 <= height;
            return Err(Failure::Usage(format!(
                "--size {}x{} mm is larger than the sheet of {width} x {height} mm{}",
                frame.0,
                frame.1,
                if fits_turned { "; it fits turned, with --rotate auto" } else { "" }
            )));
        }
        Ok(frame)
    }

    fn lay_out(
        &self,
        options: &PictureOptions,
        placing: &PlacingOptions,
        (crop, faces): (Crop, &[Landmarks]),
    ) -> Result<Layout, Failure> {
        let frame = self.frame(options)?;
        let crop = if options.fit == Fit::Cover { covering(crop, frame, faces) } else { crop };
        let scale = (frame.0 / crop.width).min(frame.1 / crop.height);
        let (width, height) = (crop.width * scale, crop.height * scale);
        if width < LEAST_SIDE || height < LEAST_SIDE {
            // Work, not usage: another photograph may be fine.
            return Err(Failure::Work(format!(
                "the picture would be {width:.2} x {height:.2} mm; use another --crop, or a larger --size"
            )));
        }
        let turned = self.turning.size((width, height));
        let page = self.page.unwrap_or(Page::new(turned.0 + 2.0 * self.margin, turned.1 + 2.0 * self.margin));
        let placed = self.place(placing, turned, &page);
        let upright = self.turning.size((page.width, page.height));
        let upright = Page { width: upright.0, height: upright.1, ..page };
        let picture = self.turning.matrix(&upright).inverse().transform_rect_bbox(placed);
        Ok(Layout { page: upright, picture, crop, turning: self.turning })
    }

    /// The turned picture's box on the sheet: at the position given, else in the middle of the free part, moved within the machine's
    /// reach if it fits.
    fn place(&self, placing: &PlacingOptions, size: (f64, f64), page: &Page) -> Rect {
        if self.page.is_none() {
            return Rect::from_center_size(page.rect().center(), size);
        }
        let usual = Rect::from_center_size(self.free.center(), size);
        let asked = usual + requested_move(placing, usual, page, Some(self.reached));
        if placing.at.is_some() { asked } else { asked + move_inside(asked, self.reached) }
    }
}

/// A notice if the picture leaves more than a twentieth of a side of its `--size` box empty.
pub(super) fn empty_box_notice(options: &PictureOptions, layout: &Layout) -> Option<String> {
    let (width, height) = options.size.filter(|_| options.fit == Fit::Contain)?;
    let picture = layout.picture;
    let is_empty = picture.width() < 0.95 * width || picture.height() < 0.95 * height;
    is_empty.then(|| {
        let (w, h) = (picture.width(), picture.height());
        format!("the picture is {w:.1} x {h:.1} mm in its box of {width} x {height} mm; --fit cover fills the box and cuts the photograph")
    })
}

/// A function that gives the part of a page that the machine reaches.
pub(super) fn reach_of(profile: Option<&Profile>) -> impl Fn(&Page) -> Option<Rect> {
    move |page| Some(mount(profile?, page).ok()?.reach_on_page())
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
