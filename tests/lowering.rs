//! One nib lays down the ink that was asked for, and no more.

mod common;

use common::{Sheet, rendered, sample, svg_of};
use drypoint::drawing::{Drawing, Mark};
use drypoint::field::nearest_seed;
use drypoint::plot::{InkModel, Nibs, lower};
use drypoint::raster::Raster;
use drypoint::write::{SvgHead, write_svg_plot};

const PIXELS_PER_MM: f64 = 40.0;

/// Marked pixels of what resvg prints.
fn ink(svg: &str) -> Raster<u8> {
    rendered(svg, PIXELS_PER_MM).map(|white| u8::from(white < 0.5))
}

/// Pixels within `radius` of a marked one.
fn grown(marked: &Raster<u8>, radius: f64) -> Raster<u8> {
    let Some(nearest) = nearest_seed(marked) else { return marked.clone() };
    let width = marked.width();
    Raster::from_fn(width, marked.height(), |x, y| {
        let seed = nearest.get(x, y) as usize;
        let (dx, dy) = ((seed % width) as f64 - x as f64, (seed / width) as f64 - y as f64);
        u8::from(dx.hypot(dy) <= radius)
    })
}

/// The ink that a disc of this radius can reach without leaving it.
fn opened(marked: &Raster<u8>, radius: f64) -> Raster<u8> {
    let eroded = grown(&marked.map(|v| 1 - v), radius).map(|v| 1 - v);
    grown(&eroded, radius)
}

fn share(of: &Raster<u8>, and: &Raster<u8>) -> f64 {
    let both: usize = of.pixels().iter().zip(and.pixels()).filter(|(a, b)| **a != 0 && **b != 0).count();
    both as f64 / of.pixels().iter().filter(|v| **v != 0).count().max(1) as f64
}

/// Covered and spilt fractions of the marks that are at least a nib wide.
fn measure(drawing: &Drawing, nib: f64) -> (f64, f64) {
    let mut wide = drawing.clone();
    for layer in &mut wide.layers {
        layer.marks.retain(|mark| match mark {
            Mark::Dot(dot) => dot.radius >= 0.5 * nib,
            Mark::Stroke(stroke) => stroke.widest() >= nib,
            Mark::Area(_) => true,
        });
    }
    let asked = ink(&svg_of(&wide));
    let plot = lower(&wide, InkModel::Ink, &Nibs::all(nib), 0.01);
    let mut bytes = Vec::new();
    write_svg_plot(&plot, &SvgHead::default(), &mut bytes).unwrap();
    let laid = ink(std::str::from_utf8(&bytes).unwrap());
    let reachable = opened(&asked, 0.5 * nib * PIXELS_PER_MM);
    let outside = asked.map(|v| 1 - v);
    let spilt = share(&laid, &outside) * laid.pixels().iter().filter(|v| **v != 0).count() as f64
        / asked.pixels().iter().filter(|v| **v != 0).count().max(1) as f64;
    (share(&reachable, &laid), spilt)
}

#[test]
fn the_nib_covers_what_it_can_reach_and_spills_little() {
    for (name, mm, set) in [
        ("grace-hopper.jpg", (60.0, 70.3), &[("pitch", "1.2"), ("outline_width", "1mm")][..]),
        ("chelsea.png", (90.0, 59.867), &[("pitch", "1.6"), ("blob", "0.5")]),
    ] {
        let photo = sample(name);
        let drawing = Sheet { set, ..Sheet::new(&photo, mm) }.draw();
        for nib in [0.1, 0.3, 0.5, 0.8] {
            let (covered, spilt) = measure(&drawing, nib);
            println!("{name}, nib {nib}: covered {covered:.4}, spilt {spilt:.4}");
            assert!(covered >= 0.985, "{name}, nib {nib}: covered {covered}");
            assert!(spilt <= 0.03, "{name}, nib {nib}: spilt {spilt}");
        }
    }
}
