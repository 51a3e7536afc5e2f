//! An SVG's bytes: refused with a reason, or a drawing of finite marks, which is written as an SVG that can be read again.

use super::refusal;
use drypoint::drawing::{Drawing, Mark, Width};
use drypoint::interrupt::Interrupt;
use drypoint::plot::{InkModel, Nibs, Toolpath, lower};
use drypoint::read::{Budget, read_svg_within};
use drypoint::write::{SvgHead, write_svg};

pub fn check(bytes: &[u8]) {
    match read_svg_within(bytes, &mut Budget::of_millions(super::STEPS)) {
        Err(error) => refusal::is_told(&error),
        Ok(imported) => {
            let drawing = imported.drawing();
            is_finite(&drawing);
            let plot = lower(&drawing, InkModel::Lines, &Nibs::all(0.3), 0.02, &Interrupt::never()).expect("nobody interrupts");
            assert!(plot.pens.iter().flat_map(|pen| &pen.paths).flat_map(Toolpath::points).all(|p| p.is_finite()));
            let mut text = Vec::new();
            write_svg(&drawing, &SvgHead::default(), &mut text).expect("memory takes all that is written");
            // What was read with so much work is read again with more.
            let again = read_svg_within(&text, &mut Budget::of_millions(20.0 * super::STEPS));
            assert!(again.is_ok(), "{}: {}", again.unwrap_err(), String::from_utf8_lossy(&text));
        }
    }
}

pub(crate) fn is_finite(drawing: &Drawing) {
    assert!(drawing.page.width.is_finite() && drawing.page.height.is_finite(), "{:?}", drawing.page);
    for mark in drawing.marks() {
        assert!(mark.bounding_box().is_finite(), "{mark:?}");
        let area = mark.area();
        assert!(area.is_finite() && area >= 0.0, "an area of {area}: {mark:?}");
        if let Mark::Stroke(stroke) = mark {
            match stroke.width() {
                Width::Constant(width) => assert!(width.is_finite() && *width >= 0.0, "{mark:?}"),
                Width::Along(widths) => assert!(widths.iter().all(|w| w.is_finite()), "{mark:?}"),
            }
        }
    }
}
