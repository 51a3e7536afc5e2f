//! The rest of a file and what was drawn before it are the whole drawing's ink, and nothing else.

mod common;

use common::{Sheet, sample};
use drypoint::drawing::{Drawing, Layer};
use drypoint::geometry::{Point, polyline_length};
use drypoint::interrupt::Interrupt;
use drypoint::plot::{Direction, Effort, InkModel, Nibs, Plot, Profile, lower, mount};
use drypoint::read::{Strokes, read_gcode, read_gcode_heights, read_hpgl};
use drypoint::resume::{Stop, resume_gcode, resume_hpgl};
use drypoint::write::{write_gcode, write_hpgl};
use std::collections::HashSet;

/// A small portrait with three pens, ordered.
fn plot() -> Plot {
    let photo = sample("bust-light.png");
    let drawing = Sheet { set: &[("pitch", "2.2")], ..Sheet::new(&photo, (60.0, 80.0)) }.draw();
    let marks: Vec<_> = drawing.marks().cloned().collect();
    let third = marks.len() / 3;
    let layers = [(1, &marks[..third]), (2, &marks[third..2 * third]), (3, &marks[2 * third..])];
    let layers = layers.into_iter().map(|(pen, marks)| Layer { marks: marks.to_vec(), ..Layer::new("part", pen) });
    let drawing = Drawing { layers: layers.collect(), ..drawing.clone() };
    let mut plot = lower(&drawing, InkModel::Ink, &Nibs::all(0.3), 0.02, &Interrupt::never()).unwrap();
    plot.ordered(Point::ORIGIN, Effort::Fast, Direction::Either, 0.05);
    plot
}

/// Cells of 0.05 mm that the pen passes over, by pen.
fn inked(strokes: &Strokes, units_per_mm: f64) -> HashSet<(u32, i64, i64)> {
    let cell = 0.05 * units_per_mm;
    let mut cells = HashSet::new();
    for (pen, points) in &strokes.paths {
        let mut mark = |p: Point| {
            cells.insert((*pen, (p.x / cell).round() as i64, (p.y / cell).round() as i64));
        };
        points.iter().for_each(|p| mark(*p));
        for pair in points.windows(2) {
            let steps = (pair[0].distance(pair[1]) / (0.25 * cell)).ceil().max(1.0) as usize;
            (0..=steps).for_each(|i| mark(pair[0].lerp(pair[1], i as f64 / steps as f64)));
        }
    }
    cells
}

/// Cells of one set that have none of the other's beside them.
fn missing(of: &HashSet<(u32, i64, i64)>, from: &HashSet<(u32, i64, i64)>) -> usize {
    let has = |&(pen, x, y): &(u32, i64, i64)| (-1..=1).any(|dx| (-1..=1).any(|dy| from.contains(&(pen, x + dx, y + dy))));
    of.iter().filter(|cell| !has(cell)).count()
}

fn check(what: &str, whole: &Strokes, before: &Strokes, rest: &Strokes, units_per_mm: f64) {
    let (all, done, left) = (inked(whole, units_per_mm), inked(before, units_per_mm), inked(rest, units_per_mm));
    let together: HashSet<_> = done.union(&left).copied().collect();
    assert_eq!(missing(&all, &together), 0, "{what}: ink is lost");
    assert_eq!(missing(&together, &all), 0, "{what}: ink is drawn that is not the drawing's");
    // A few millimetres are drawn again, not more: three, and what is left of a vertex or an arc.
    let length = |strokes: &Strokes| -> f64 { strokes.paths.iter().map(|(_, points)| polyline_length(points)).sum() };
    let again = (length(before) + length(rest) - length(whole)) / units_per_mm;
    assert!((-0.01..20.0).contains(&again), "{what}: {again} mm twice");
}

/// Evenly spread over a range, in no order.
fn spread(i: usize, count: usize) -> usize {
    ((i as f64 * 0.618_033_988_75).fract() * count as f64) as usize
}

#[test]
fn g_code_goes_on_at_any_line() {
    let plot = plot();
    for name in ["grbl-servo", "grbl-z"] {
        let profile = Profile::built_in(name).unwrap();
        let dialect = profile.gcode.clone().unwrap();
        let mut bytes = Vec::new();
        write_gcode(&plot, &profile, &mount(&profile, &plot.page).unwrap(), &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let read = |text: &str| match dialect.height {
            Some(height) => read_gcode_heights(text, height.up, height.down).unwrap(),
            None => read_gcode(text, dialect.pen_up.as_deref().unwrap(), dialect.pen_down.as_deref().unwrap()).unwrap(),
        };
        let lines: Vec<&str> = text.lines().collect();
        for i in 1..=50 {
            let line = 1 + spread(i, lines.len());
            let rest = resume_gcode(&text, Stop::Line(line), 3.0).unwrap();
            let before = lines[..line - 1].join("\n") + "\n";
            // A pen number is told by its comment, which both parts hold.
            let [whole, before, rest] = [&text, &before, &rest].map(|text| {
                let mut strokes = read(text);
                strokes.paths.iter_mut().for_each(|(pen, _)| *pen = 0);
                strokes
            });
            assert!(rest.ends_up, "{name}, line {line}");
            check(&format!("{name}, line {line}"), &whole, &before, &rest, profile.units_per_mm);
        }
    }
}

#[test]
fn hp_gl_goes_on_at_any_byte() {
    let plot = plot();
    let profile = Profile::built_in("hp7475a").unwrap();
    let mut bytes = Vec::new();
    write_hpgl(&plot, &profile, &mount(&profile, &plot.page).unwrap(), &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    for i in 1..=50 {
        let byte = spread(i, text.len());
        let rest = resume_hpgl(&text, Stop::Byte(byte), 120.0).unwrap();
        let [whole, before, rest] = [&text, &taken(&text[..byte]), &rest].map(|text| read_hpgl(text).unwrap());
        assert!(rest.ends_up, "byte {byte}");
        check(&format!("byte {byte}"), &whole, &before, &rest, profile.units_per_mm);
    }
}

/// What a plotter has done of a file that broke off: whole instructions, and the whole points of a list.
fn taken(text: &str) -> String {
    let (whole, tail) = text.rsplit_once(';').unwrap_or(("", ""));
    let mut numbers: Vec<&str> = tail.get(2..).unwrap_or("").split(',').collect();
    numbers.pop();
    numbers.truncate(numbers.len() & !1);
    let points = if tail.starts_with('P') && !numbers.is_empty() {
        format!("{}{};", &tail[..2], numbers.join(","))
    } else {
        String::new()
    };
    format!("{whole};{points}")
}

#[test]
fn nothing_is_drawn_before_the_place_to_go_on_from() {
    let plot = plot();
    let profile = Profile::built_in("grbl-servo").unwrap();
    let mut bytes = Vec::new();
    write_gcode(&plot, &profile, &mount(&profile, &plot.page).unwrap(), &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    for i in 1..=50 {
        let line = 20 + spread(i, text.lines().count() - 20);
        let rest = resume_gcode(&text, Stop::Line(line), 3.0).unwrap();
        let up = rest.lines().position(|line| line == "M3 S300").unwrap();
        let first_down = rest.lines().position(|line| line == "M3 S700").unwrap_or(usize::MAX);
        let first_move = rest.lines().position(|line| line.starts_with("G0 X")).unwrap();
        assert!(up < first_move && first_move < first_down, "line {line}");
        assert!(
            rest.lines().take(first_down.min(60)).all(|line| !line.starts_with("G1 ") && !line.starts_with("G2 ")),
            "line {line}"
        );
    }
}
