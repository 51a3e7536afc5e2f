//! All ink, including half a line's width, stays inside the requested box, and the tone at its border is kept.
#![cfg(feature = "cli")]

use crate::any_style;
use crate::common;

use any_style::{Order, ink_outline};
use common::{mean_in, png_of_light, rendered, sample, svg_of};
use drypoint::drawing::Page;
use drypoint::geometry::Rect;
use drypoint::interrupt::Interrupt;
use drypoint::plot::{InkModel, Nibs, Toolpath, lower};
use drypoint::style::{Request, Silent, find};
use kurbo::Shape;

const PICTURE: Rect = Rect::new(7.0, 9.0, 37.0, 44.156);

/// Each style with defaults, and with everything that adds other kinds of marks.
const LOOKS: &[(&str, &[(&str, &str)])] = &[
    ("hedcut", &[]),
    ("hedcut", &[("lines", "canny"), ("outline_length", "0"), ("outline_width", "0.8"), ("blob", "0.6")]),
    ("grid", &[]),
    ("grid", &[("size_max", "0"), ("overlap", "paper"), ("line_widest", "2")]),
    ("grid", &[("primitive", "tile-lines")]),
    ("grid", &[("dot_shape", "1"), ("size_max", "5")]),
    ("engrave", &[]),
    ("engrave", &[("look", "net"), ("angle", "33"), ("regions", "superpixels"), ("overlap", "0.5"), ("outline", "on")]),
    ("engrave", &[("look", "stipple"), ("angle", "-71"), ("ground", "black")]),
    ("charcoal", &[("sketch_offset", "3")]),
    ("glass", &[("hairs", "0.5")]),
    ("glass", &[("colors", "mono"), ("line", "1")]),
    ("glass", &[("pattern", "discrete"), ("transform", "spiral")]),
    ("glass", &[("transform", "translation"), ("taper", "0")]),
];

#[test]
fn ink_stays_in_the_picture_in_every_style_at_every_pitch() {
    let photo = sample("grace-hopper.jpg");
    let room = PICTURE.inflate(1e-6, 1e-6);
    for (style, set) in LOOKS {
        for pitch in ["0.4", "0.6", "1.7", "3"] {
            let set: Vec<(&str, &str)> = set.iter().copied().chain([("pitch", pitch)]).collect();
            let order = Order { page: Page::new(50.0, 60.0), picture: PICTURE, ..Order::new(style, &photo, (50.0, 60.0), &set) };
            let (drawing, _) = order.try_draw();
            let drawing = drawing.unwrap_or_else(|error| panic!("{style} {set:?}: {error}"));
            assert!(drawing.marks().count() > 10, "{style} {set:?}");
            for mark in drawing.marks() {
                let bounds = ink_outline(mark, 1e-3).bounding_box();
                assert!(room.union(bounds) == room, "{style} {set:?}: {bounds:?}\n{mark:?}");
            }
            // The nib's middle stays inside too, except for a spiral's rounding, so that no machine whose reach is the box
            // refuses it.
            let plot = lower(&drawing, InkModel::Ink, &Nibs::all(0.3), 0.02, &Interrupt::never()).unwrap();
            for p in plot.pens.iter().flat_map(|pen| &pen.paths).flat_map(Toolpath::points) {
                assert!(PICTURE.inflate(0.1, 0.1).contains(*p), "{style} {set:?}: {p:?}");
            }
        }
    }
}

/// The ink in a strip along each side is the same before and after the ink is confined.
#[test]
fn the_tone_at_the_border_is_kept() {
    let photo = png_of_light(200, 200, |_, _| 0.3);
    let picture = Rect::new(5.0, 5.0, 45.0, 45.0);
    for (style, set) in [
        ("grid", &[("size_max", "0"), ("lines", "off")][..]),
        ("grid", &[("size_max", "0"), ("hatching", "along"), ("lines", "off")]),
        ("glass", &[("colors", "mono"), ("line", "0.4"), ("transform", "rotation")]),
    ] {
        let set: Vec<(&str, &str)> = set.iter().copied().chain([("pitch", "1")]).collect();
        let order = Order { page: Page::new(50.0, 50.0), picture, ..Order::new(style, &photo, (50.0, 50.0), &set) };
        let (portrait, settings) = (order.portrait(), order.settings());
        let request = Request { portrait: &portrait, settings: &settings, seed: 0, observer: &Silent };
        let sketch = find(style).unwrap().sketch(&request).unwrap();
        let [before, after] = [sketch, order.draw()].map(|drawing| rendered(&svg_of(&drawing), 20.0));
        // 0.5 mm along each side, and nothing beyond.
        let sides = [
            Rect::new(8.0, 5.0, 42.0, 5.5),
            Rect::new(8.0, 44.5, 42.0, 45.0),
            Rect::new(5.0, 8.0, 5.5, 42.0),
            Rect::new(44.5, 8.0, 45.0, 42.0),
        ];
        for side in sides {
            let (was, is) = (mean_in(&before, side, 20.0), mean_in(&after, side, 20.0));
            println!("{style} {set:?}: {was:.3} before, {is:.3} held");
            assert!((is - was).abs() <= 0.03, "{style} {set:?}, {side:?}: {was} and {is}");
        }
        assert!(mean_in(&after, Rect::new(0.0, 0.0, 50.0, 4.9), 20.0) > 0.9999, "{style}");
    }
}

/// A machine with the reach of the sheet accepts every style at the default margins.
#[test]
fn no_style_is_refused_at_default_margins() {
    let folder = tempfile::tempdir().unwrap();
    for (style, set) in [("hedcut", "outline=on"), ("grid", "lines=on"), ("glass", "colors=mono")] {
        for pitch in ["0.6mm", "1.3mm"] {
            let photo = format!("{}/samples/grace-hopper.jpg", env!("CARGO_MANIFEST_DIR"));
            let output = folder.path().join("out.gcode");
            let mut command = assert_cmd::Command::cargo_bin("drypoint").unwrap();
            command.args([
                "draw",
                &photo,
                "--style",
                style,
                "--set",
                set,
                "--pitch",
                pitch,
                "--size",
                "40x47mm",
                "--profile",
                "grbl-servo",
            ]);
            let result = command.args(["--order", "fast", "-o"]).arg(&output).output().unwrap();
            assert!(result.status.success(), "{style} {pitch}: {}", String::from_utf8_lossy(&result.stderr));
        }
    }
}

#[test]
fn an_engraving_is_not_refused_at_default_margins() {
    let folder = tempfile::tempdir().unwrap();
    let photo = format!("{}/samples/grace-hopper.jpg", env!("CARGO_MANIFEST_DIR"));
    let mut command = assert_cmd::Command::cargo_bin("drypoint").unwrap();
    command.current_dir(folder.path()).args(["draw", &photo, "--style", "engrave", "--size", "40x47mm"]);
    let result = command.args(["--profile", "grbl-servo", "--order", "fast", "-o", "out.gcode"]).output().unwrap();
    assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
}
