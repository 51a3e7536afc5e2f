//! What would bring a drawing onto its machine, in the options of the command that refuses it.

use super::arguments::{DrawOptions, PlotFit, PlotOptions};
use super::failure::Failure;
use super::layout::Layout;
use crate::plot::{MountingError, Room};

/// Least part of its scale that a drawing is offered.
const LEAST_SCALE: f64 = 0.01;

/// A refusal of `plot`, whose drawing was turned by so many degrees.
pub(super) fn for_plot(failure: Failure, options: &PlotOptions, degrees: u32) -> Failure {
    match failure {
        Failure::Misfit(error @ MountingError::PageTooLarge { .. }) => {
            Failure::Work(format!("{error}; choose one of them with --page, and --fit page"))
        }
        Failure::Misfit(error @ (MountingError::OutOfReach { room, .. } | MountingError::OffSheet { room, .. })) => {
            Failure::Work(format!("{error}: {}, or cut it with --clip", plot_remedy(&room, options, degrees)))
        }
        other => other,
    }
}

fn plot_remedy(room: &Room, options: &PlotOptions, degrees: u32) -> String {
    let without = if options.placing.at.is_some() { "without --at: " } else { "" };
    if options.fit == PlotFit::Page {
        return "leave a larger --margin".to_owned();
    }
    if room.is_enough() {
        return format!("{without}--center");
    }
    // With --page the sheet stays as it lies; without, it is turned with the drawing.
    let fits_turned = if options.page.is_some() { room.is_enough_across() } else { room.is_enough_turned() };
    if fits_turned {
        return format!("turned by 90 degrees it would fit, {without}{} --center", other_turn(degrees));
    }
    let share = (room.free.0 / room.drawn.0).min(room.free.1 / room.drawn.1);
    let scale = (options.scale.unwrap_or(1.0) * share * 1000.0).floor() / 1000.0;
    if scale < LEAST_SCALE {
        return "choose a larger --page".to_owned();
    }
    format!("{without}--fit page, or --scale {scale} --center")
}

/// The turn that lies across.
const fn other_turn(degrees: u32) -> &'static str {
    if degrees % 180 == 90 { "--rotate 0" } else { "--rotate 90" }
}

/// A refusal of `draw`.
pub(super) fn for_draw(failure: Failure, options: &DrawOptions, layout: &Layout) -> Failure {
    match failure {
        Failure::Misfit(error @ MountingError::PageTooLarge { .. }) => Failure::Work(if options.picture.page.is_some() {
            format!("{error}; choose one of them with --page")
        } else {
            format!("{error}; choose a --size that one of them holds")
        }),
        Failure::Misfit(
            error @ (MountingError::OutOfReach { room, excess, .. } | MountingError::OffSheet { room, excess, .. }),
        ) => Failure::Work(format!("{error}: {}, or cut it with --clip", draw_remedy(&room, excess, options, layout))),
        other => other,
    }
}

fn draw_remedy(room: &Room, excess: f64, options: &DrawOptions, layout: &Layout) -> String {
    let has_sheet = options.picture.page.is_some();
    if options.placing.at.is_some() && room.is_enough() {
        return "put it elsewhere with --at, or leave --at away".to_owned();
    }
    let placed = layout.placed();
    let limit = if has_sheet { room.free } else { room.reach };
    let is_too_large = !is_within((placed.width(), placed.height()), limit);
    let fits_turned = if has_sheet { room.is_enough_across() } else { room.is_enough_turned() };
    if is_too_large && fits_turned {
        return format!("turned by 90 degrees it would fit, with {}", other_turn(layout.turning.degrees));
    }
    // A sheet of the picture's own size grows with its margin.
    let margin = (options.picture.margin.unwrap_or(0.0) + excess).ceil();
    if !has_sheet && !is_too_large && is_within((room.drawn.0 + margin, room.drawn.1 + margin), room.reach) {
        return format!("--margin {margin}mm makes the sheet larger than the drawing");
    }
    let share = share_that_fits((placed.width(), placed.height()), room.drawn, limit, excess);
    let (width, height) = ((layout.picture.width() * share).floor(), (layout.picture.height() * share).floor());
    if width < 1.0 || height < 1.0 {
        return "choose a larger --page".to_owned();
    }
    format!("make it smaller, with --size {width}x{height}mm")
}

fn is_within(inner: (f64, f64), outer: (f64, f64)) -> bool {
    inner.0 <= outer.0 && inner.1 <= outer.1
}

/// How much smaller a picture's box must be so that what is drawn of it stays within limits; ink that reaches over the box does so
/// at every size.
fn share_that_fits(picture: (f64, f64), drawn: (f64, f64), limit: (f64, f64), excess: f64) -> f64 {
    let share = |side: f64, drawn: f64, limit: f64| {
        let over = (drawn - side).max(0.0);
        let room = if drawn <= limit { side } else { limit - over };
        (room / side).clamp(0.0, 1.0)
    };
    if is_within(drawn, limit) {
        // It would fit elsewhere, but stays in the middle: what is gained lies half on either side.
        return (1.0 - 2.0 * excess / picture.0.min(picture.1)).max(0.0);
    }
    // And a little for rounding.
    0.999 * share(picture.0, drawn.0, limit.0).min(share(picture.1, drawn.1, limit.1))
}
