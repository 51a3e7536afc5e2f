//! The colour sheet, photographed many times by a simulated camera and read by the library. `DRYPOINT_MANY=1` takes 200 photographs,
//! otherwise a tenth.

use crate::photographed::{Chance, Light, photographed};
use drypoint::colour::sheet::{Known, PenSheet, Picture, SheetMark, SheetShape, read_sheet};
use drypoint::colour::{ColourPen, Lab, Opacity, drawing_order, known_pens};
use drypoint::geometry::Point;
use drypoint::raster::Raster;
use image::codecs::jpeg::JpegEncoder;
use rayon::prelude::*;
use resvg::tiny_skia::{Color, FillRule, LineCap, Mask, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, Transform};

const PAGE: [f64; 2] = [148.0, 210.0];
const PIXELS_PER_MM: f64 = 11.0;
/// Pens of one box differ at least this much, and the darkest has at most this L*.
const UNLIKE: f64 = 8.0;
const DARK: f64 = 35.0;
/// How far a pen's ink may lie off, in millimetres.
const OFF: f64 = 0.3;

/// A box of pens as one may own, light ones first.
fn pen_box(chance: &mut Chance) -> Vec<ColourPen> {
    let known: Vec<ColourPen> = known_pens()
        .into_iter()
        .filter(|pen| pen.opacity == Opacity::Transparent)
        .map(|pen| ColourPen::new(pen.name, 0.3, pen.colour))
        .filter(|pen| pen.lab().difference(Lab { l: 100.0, a: 0.0, b: 0.0 }) > UNLIKE)
        .collect();
    let dark: Vec<&ColourPen> = known.iter().filter(|pen| pen.lab().l < DARK).collect();
    let count = 2 + chance.below(7);
    let mut pens = vec![dark[chance.below(dark.len())].clone()];
    while pens.len() < count {
        let next = &known[chance.below(known.len())];
        if pens.iter().all(|pen| pen.lab().difference(next.lab()) > UNLIKE) {
            pens.push(next.clone());
        }
    }
    pens.iter_mut().for_each(|pen| pen.width_mm = [0.2, 0.3, 0.4, 0.5, 0.8][chance.below(5)]);
    drawing_order(&pens).into_iter().map(|pen| pens[pen].clone()).collect()
}

fn circle(path: &mut PathBuilder, centre: Point, radius: f64) {
    path.push_circle(centre.x as f32, centre.y as f32, radius as f32);
}

fn drawn(mask: &mut Pixmap, mark: &SheetMark, nib: f64, place: Transform) {
    let mut path = PathBuilder::new();
    match &mark.shape {
        SheetShape::Rect(r) => path.push_rect(Rect::from_ltrb(r.x0 as f32, r.y0 as f32, r.x1 as f32, r.y1 as f32).unwrap()),
        SheetShape::Disc { centre, radius } => circle(&mut path, *centre, *radius),
        SheetShape::Ring { centre, outer, inner } => {
            [outer, inner].into_iter().for_each(|radius| circle(&mut path, *centre, *radius));
        }
        SheetShape::Line(points) => {
            path.move_to(points[0].x as f32, points[0].y as f32);
            points[1..].iter().for_each(|p| path.line_to(p.x as f32, p.y as f32));
        }
    }
    let path: Path = path.finish().unwrap();
    let mut ink = Paint::default();
    ink.set_color(Color::BLACK);
    if matches!(mark.shape, SheetShape::Line(_)) {
        let stroke = Stroke { width: nib as f32, line_cap: LineCap::Round, ..Stroke::default() };
        mask.stroke_path(&path, &ink, &stroke, place, None::<&Mask>);
    } else {
        mask.fill_path(&path, &ink, FillRule::EvenOdd, place, None::<&Mask>);
    }
}

/// The sheet in ink: each filters what lies below it.
fn inked(pens: &[ColourPen], marks: &[SheetMark], chance: &mut Chance) -> Light {
    let [width, height] = PAGE.map(|side| (side * PIXELS_PER_MM) as usize);
    let mut pixels = vec![[1.0_f32; 3]; width * height];
    for (i, pen) in pens.iter().enumerate() {
        let off = [0; 2].map(|_: i32| (PIXELS_PER_MM * chance.between(-OFF, OFF)) as f32);
        let place = Transform::from_scale(PIXELS_PER_MM as f32, PIXELS_PER_MM as f32).post_translate(off[0], off[1]);
        let mut mask = Pixmap::new(width as u32, height as u32).unwrap();
        marks.iter().filter(|mark| mark.pen == i).for_each(|mark| drawn(&mut mask, mark, pen.width_mm, place));
        for (light, ink) in pixels.iter_mut().zip(mask.pixels()) {
            let covered = f32::from(ink.alpha()) / 255.0;
            (0..3).for_each(|c| light[c] *= 1.0 - covered * (1.0 - pen.colour[c] as f32));
        }
    }
    Light { width, height, pixels }
}

/// Differences of the pens' colours from the truth, CIEDE2000; infinite if the photograph cannot be read.
fn errors(seed: u64) -> Vec<f64> {
    let chance = &mut Chance::new(seed);
    let pens = pen_box(chance);
    let nibs: Vec<f64> = pens.iter().map(|pen| pen.width_mm).collect();
    let sheet = PenSheet::new(PAGE, 7.0, &nibs, pens.len() - 1).unwrap();
    let photograph = photographed(&inked(&pens, &sheet.marks(), chance), 1.0, chance);
    let mut bytes = Vec::new();
    let quality = 70 + chance.below(28) as u8;
    photograph.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, quality)).unwrap();
    let photograph = image::load_from_memory(&bytes).unwrap().to_rgb8();
    let (width, height) = (photograph.width() as usize, photograph.height() as usize);
    let raster = Raster::from_vec(width, height, photograph.pixels().map(|pixel| pixel.0).collect());
    match read_sheet(Picture::Encoded(&raster), &Known { nibs: &nibs, paper: None, grey: None }) {
        Ok(reading) => {
            let read = reading.pens.iter().map(|pen| pen.solid.lab);
            read.zip(&pens).map(|([l, a, b], pen)| Lab { l, a, b }.difference(pen.lab())).collect()
        }
        Err(error) => {
            println!("{seed}: {error}");
            vec![f64::INFINITY; pens.len()]
        }
    }
}

#[test]
fn pens_are_measured_from_photographs() {
    let photographs = if std::env::var_os("DRYPOINT_MANY").is_some() { 200 } else { 20 };
    let errors: Vec<Vec<f64>> = (0..photographs).into_par_iter().map(errors).collect();
    let unread = errors.iter().filter(|errors| errors[0].is_infinite()).count();
    let whole = errors.iter().filter(|errors| errors.iter().all(|e| *e <= 2.0)).count();
    let mut all = errors.concat();
    all.sort_by(f64::total_cmp);
    let at = |share: f64| all[(share * (all.len() - 1) as f64) as usize];
    let near = all.iter().filter(|e| **e <= 2.0).count() as f64 / all.len() as f64;
    println!(
        "{photographs} photographs, {unread} not read, {} pens: median {:.2}, 95 % within {:.2}, at most {:.2}; {:.1} % of the pens within 2, \
         all pens of {whole} photographs",
        all.len(),
        at(0.5),
        at(0.95),
        at(1.0),
        100.0 * near
    );
    assert!(near >= 0.95, "only {near} within 2");
}
