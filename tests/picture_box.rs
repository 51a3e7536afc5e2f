//! All ink stays inside the box asked for, in every style, by half a line's width too; and the tone at its border is kept.

#[path = "common/any_style.rs"]
mod any_style;
mod common;

use any_style::{Order, ink_outline};
use common::{mean_in, png_of_light, rendered, sample, svg_of};
use drypoint::drawing::Page;
use drypoint::geometry::Rect;
use drypoint::interrupt::Interrupt;
use drypoint::plot::{InkModel, Nibs, lower};
use kurbo::Shape;

const PICTURE: Rect = Rect::new(7.0, 9.0, 37.0, 44.156);

/// Each style as it is and with all that adds marks of another kind.
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
            // The nib's middle too, so that no machine whose reach is the box refuses it.
            let plot = lower(&drawing, InkModel::Ink, &Nibs::all(0.3), 0.02, &Interrupt::never()).unwrap();
            for p in plot.pens.iter().flat_map(|pen| &pen.paths).flat_map(|path| &path.points) {
                assert!(PICTURE.inflate(0.02, 0.02).contains(*p), "{style} {set:?}: {p:?}");
            }
        }
    }
}

/// A strip of a pitch along each side has the tone of the middle.
#[test]
fn the_tone_at_the_border_is_kept() {
    let photo = png_of_light(200, 200, |_, _| 0.3);
    let pitch = 1.0;
    for (style, set, most) in [
        ("grid", &[("size_max", "0"), ("lines", "off")][..], 0.05),
        ("grid", &[("size_max", "0"), ("hatching", "along"), ("lines", "off")], 0.05),
        ("engrave", &[("look", "hatch"), ("displacement", "0")], 0.05),
        ("engrave", &[("look", "net"), ("displacement", "0"), ("angle", "30")], 0.06),
        ("glass", &[("colors", "mono"), ("line", "0.4"), ("transform", "rotation")], 0.08),
    ] {
        let set: Vec<(&str, &str)> = set.iter().copied().chain([("pitch", "1")]).collect();
        let white = rendered(&svg_of(&Order::new(style, &photo, (40.0, 40.0), &set).draw()), 20.0);
        let middle = mean_in(&white, Rect::new(8.0, 8.0, 32.0, 32.0), 20.0);
        let sides = [
            Rect::new(4.0, 0.0, 36.0, pitch),
            Rect::new(4.0, 40.0 - pitch, 36.0, 40.0),
            Rect::new(0.0, 4.0, pitch, 36.0),
            Rect::new(40.0 - pitch, 4.0, 40.0, 36.0),
        ];
        let tones = sides.map(|side| mean_in(&white, side, 20.0));
        println!("{style} {set:?}: middle {middle:.3}, sides {tones:.3?}");
        let mean = tones.iter().sum::<f64>() / 4.0;
        assert!((mean - middle).abs() <= most, "{style} {set:?}: {middle} and {tones:?}");
    }
}
