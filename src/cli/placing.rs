//! Position of a drawing on its sheet: mirrored, turned, moved. Shared by `draw` and `plot`.

use super::arguments::{PlacingOptions, Rotate};
use crate::drawing::{Drawing, Page};
use crate::geometry::{Affine, Rect, Vec2};

/// Rotation of a page, and whether it is mirrored first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Turning {
    /// Clockwise rotation: 0, 90, 180 or 270.
    pub degrees: u32,
    pub is_mirrored: bool,
}

impl Turning {
    /// The turning given by the options; `quarter_helps` decides `--rotate auto`.
    pub(super) fn asked(options: &PlacingOptions, quarter_helps: impl FnOnce() -> bool) -> Self {
        let degrees = match options.rotate {
            Rotate::None => 0,
            Rotate::Quarter => 90,
            Rotate::Half => 180,
            Rotate::ThreeQuarters => 270,
            Rotate::Auto => 90 * u32::from(quarter_helps()),
        };
        Self { degrees, is_mirrored: options.mirror }
    }

    /// Width and height after turning.
    pub(super) const fn size(self, (width, height): (f64, f64)) -> (f64, f64) {
        if self.degrees % 180 == 90 { (height, width) } else { (width, height) }
    }

    /// Transform from the upright page to the turned one; the origin of both is the upper left corner.
    pub(super) fn matrix(self, upright: &Page) -> Affine {
        let Page { width, height, .. } = *upright;
        let mirrored = if self.is_mirrored { Affine::new([-1.0, 0.0, 0.0, 1.0, width, 0.0]) } else { Affine::IDENTITY };
        let turned = match self.degrees {
            90 => Affine::new([0.0, 1.0, -1.0, 0.0, height, 0.0]),
            180 => Affine::new([-1.0, 0.0, 0.0, -1.0, width, height]),
            270 => Affine::new([0.0, -1.0, 1.0, 0.0, 0.0, width]),
            _ => Affine::IDENTITY,
        };
        turned * mirrored
    }

    /// The drawing, turned together with its page.
    pub(super) fn turned(self, drawing: Drawing) -> Drawing {
        if self == Self::default() {
            return drawing;
        }
        let (width, height) = self.size((drawing.page.width, drawing.page.height));
        let turned = drawing.transformed(self.matrix(&drawing.page));
        Drawing { page: Page { width, height, ..drawing.page }, ..turned }
    }
}

/// The move of a box by `--at` or `--center`; `reach` is the part of the page that the machine reaches.
pub(super) fn requested_move(options: &PlacingOptions, drawn: Rect, page: &Page, reach: Option<Rect>) -> Vec2 {
    if let Some((x, y)) = options.at {
        return Vec2::new(x, y) - drawn.origin().to_vec2();
    }
    if !options.center {
        return Vec2::ZERO;
    }
    let centring = page.rect().center() - drawn.center();
    centring + move_inside(drawn + centring, reach.map_or(page.rect(), |reach| reach.intersect(page.rect())))
}

/// The shortest move that brings a box inside another. Along an axis where it is too large, it is centred.
pub(super) fn move_inside(inner: Rect, outer: Rect) -> Vec2 {
    let along = |low: f64, high: f64, least: f64, most: f64| {
        if high - low > most - least {
            return 0.5 * (least + most - low - high);
        }
        (least - low).max(0.0) + (most - high).min(0.0)
    };
    Vec2::new(along(inner.x0, inner.x1, outer.x0, outer.x1), along(inner.y0, inner.y1, outer.y0, outer.y1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;

    #[test]
    fn a_turned_page_has_its_corners_where_they_belong() {
        let page = Page::new(100.0, 40.0);
        let at = |degrees: u32, is_mirrored: bool| Turning { degrees, is_mirrored }.matrix(&page) * Point::new(10.0, 5.0);
        assert_eq!(at(0, true), Point::new(90.0, 5.0));
        assert_eq!(at(90, false), Point::new(35.0, 10.0));
        assert_eq!(at(180, false), Point::new(90.0, 35.0));
        assert_eq!(at(270, false), Point::new(5.0, 90.0));
        assert_eq!(at(90, true), Point::new(35.0, 90.0));
        assert_eq!(Turning { degrees: 270, is_mirrored: false }.size((100.0, 40.0)), (40.0, 100.0));
    }

    #[test]
    fn the_middle_is_as_near_as_the_machine_reaches() {
        let page = Page::new(200.0, 300.0);
        let reach = Some(Rect::new(-20.0, 30.0, 180.0, 400.0));
        let centred = PlacingOptions { center: true, ..PlacingOptions::default() };
        let to = |width: f64, height: f64| {
            let drawn = Rect::new(7.0, 9.0, 7.0 + width, 9.0 + height);
            (drawn + requested_move(&centred, drawn, &page, reach)).origin()
        };
        assert_eq!(to(100.0, 100.0), Point::new(50.0, 100.0));
        assert_eq!(to(170.0, 260.0), Point::new(10.0, 30.0));
        assert_eq!(to(190.0, 290.0), Point::new(-5.0, 20.0));
        let at = PlacingOptions { at: Some((5.0, -3.0)), ..PlacingOptions::default() };
        let drawn = Rect::new(7.0, 9.0, 17.0, 19.0);
        assert_eq!((drawn + requested_move(&at, drawn, &page, reach)).origin(), Point::new(5.0, -3.0));
        assert_eq!(requested_move(&PlacingOptions::default(), drawn, &page, reach), Vec2::ZERO);
    }
}
