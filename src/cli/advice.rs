//! Advice for a drawing that does not fit its machine: the options of the refusing command that would make it fit.

use super::arguments::{DrawOptions, PictureOptions, PlacingOptions, PlotFit, PlotOptions, Rotate};
use super::failure::Failure;
use super::layout::Layout;
use super::task::Task;
use crate::plot::{MountingError, Profile, Room};

/// Smallest `--scale` that is suggested.
const LEAST_SCALE: f64 = 0.01;

/// Adds advice to a refusal of `plot`; `degrees` is how far the drawing was turned.
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

/// Adds advice to a refusal of `calibrate`.
pub(super) fn for_test_sheet(failure: Failure) -> Failure {
    match failure {
        Failure::Misfit(error) => Failure::Work(format!("{error}; choose another --page")),
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
    // With --page the sheet keeps its orientation; without, it turns with the drawing.
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

/// The rotation option at right angles to the current rotation.
const fn other_turn(degrees: u32) -> &'static str {
    if degrees % 180 == 90 { "--rotate 0" } else { "--rotate 90" }
}

/// Adds advice to a refusal of `draw`.
pub(super) fn for_draw(failure: Failure, options: &DrawOptions, task: &Task<'_>, profile: Option<&Profile>) -> Failure {
    match (failure, profile) {
        (Failure::Misfit(error @ MountingError::PageTooLarge { .. }), _) => {
            let what = if options.picture.page.is_some() {
                "choose one of them with --page"
            } else {
                "choose a --size that fits on one of them"
            };
            Failure::Work(format!("{error}; {what}"))
        }
        (
            Failure::Misfit(
                error @ (MountingError::OutOfReach { room, excess, .. } | MountingError::OffSheet { room, excess, .. }),
            ),
            Some(profile),
        ) => {
            let remedy =
                draw_remedy(&room, excess, options, &|picture, placing| task.would_fit(picture, placing, profile), &task.layout);
            Failure::Work(format!("{error}: {remedy}, or cut it with --clip"))
        }
        (other, _) => other,
    }
}

/// True if a picture with these options would lie within the machine's reach.
type WouldFit<'a> = dyn Fn(&PictureOptions, &PlacingOptions) -> bool + 'a;

fn draw_remedy(room: &Room, excess: f64, options: &DrawOptions, would_fit: &WouldFit<'_>, layout: &Layout) -> String {
    let (picture, placing) = (&options.picture, &options.placing);
    if placing.at.is_some() && would_fit(picture, &PlacingOptions { at: None, ..placing.clone() }) {
        return "choose another --at, or leave it out".to_owned();
    }
    if would_fit(picture, placing) {
        // Ink extends beyond the picture's box. Without --page, the sheet grows with its margin.
        let margin = (picture.margin.unwrap_or(0.0) + excess).ceil();
        let what = if picture.page.is_some() { "the picture smaller" } else { "the sheet larger than the drawing" };
        return format!("--margin {margin}mm makes {what}");
    }
    let rotate = if layout.turning.degrees % 180 == 90 { Rotate::None } else { Rotate::Quarter };
    if would_fit(picture, &PlacingOptions { rotate, ..placing.clone() }) {
        return format!("turned by 90 degrees it would fit, with {}", other_turn(layout.turning.degrees));
    }
    let size = |percent: u32| {
        let share = f64::from(percent) / 100.0;
        ((layout.picture.width() * share).floor(), (layout.picture.height() * share).floor())
    };
    let fits = |percent: &u32| {
        let size = Some(size(*percent)).filter(|size| size.0 >= 1.0 && size.1 >= 1.0);
        size.is_some() && would_fit(&PictureOptions { size, ..picture.clone() }, placing)
    };
    match (1..100).rev().find(fits).map(size) {
        Some((width, height)) => format!("make it smaller, with --size {width}x{height}mm"),
        None => format!("choose a larger --page; {:.1} x {:.1} mm can be drawn on this one", room.free.0, room.free.1),
    }
}
