//! The rest of a file and the part drawn before it add up to the whole drawing's ink, and nothing else, on every machine.
#![cfg(feature = "cli")]

use crate::common;
use crate::machine_file;

use assert_cmd::Command;
use common::{Sheet, sample};
use drypoint::drawing::{Colour, Drawing, Handling, Layer, Page};
use drypoint::geometry::{Point, Vec2, polyline_length};
use drypoint::interrupt::Interrupt;
use drypoint::order::{Direction, Effort};
use drypoint::plot::{
    InkModel, Language, Nibs, PenChange, PenPaths, Plot, Profile, StopPlace, Strokes, Toolpath, built_in_names, lower,
};
use machine_file::read_back;
use std::collections::BTreeSet;

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
    plot.order_paths(Point::ORIGIN, Effort::Fast, Direction::Either, 0.05);
    plot
}

/// What is drawn, and the cells of 0.05 mm around it, row by row; a cell has a bit for each pen.
struct Whole {
    strokes: Strokes,
    units_per_mm: f64,
    first: [i64; 2],
    columns: usize,
    cells: Vec<u8>,
}

impl Whole {
    /// Cells free of ink around the whole.
    const ROOM: i64 = 40;

    fn new(strokes: Strokes, units_per_mm: f64) -> Self {
        let mut whole = Self { strokes, units_per_mm, first: [0; 2], columns: 0, cells: Vec::new() };
        let places = || whole.strokes.paths.iter().flat_map(|(_, points)| points).map(|p| whole.cell(*p));
        let first = places().fold([i64::MAX; 2], |a, b| [a[0].min(b[0]), a[1].min(b[1])]).map(|v| v - Self::ROOM);
        let last = places().fold([i64::MIN; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])]).map(|v| v + Self::ROOM);
        let [columns, rows] = [0, 1].map(|i| (last[i] - first[i] + 1) as usize);
        (whole.first, whole.columns, whole.cells) = (first, columns, vec![0; columns * rows]);
        whole.cells = whole.inked(&whole.strokes);
        whole
    }

    fn cell(&self, p: Point) -> [i64; 2] {
        [p.x, p.y].map(|v| (v / (0.05 * self.units_per_mm)).round() as i64)
    }

    /// The cells that the pens pass over.
    fn inked(&self, strokes: &Strokes) -> Vec<u8> {
        let mut cells = vec![0; self.cells.len()];
        for (pen, points) in &strokes.paths {
            let mut mark = |p: Point| {
                let [column, row] = [0, 1].map(|i| usize::try_from(self.cell(p)[i] - self.first[i]).unwrap());
                assert!(column < self.columns, "ink at {p:?} is not the drawing's");
                cells[row * self.columns + column] |= 1 << pen;
            };
            points.iter().for_each(|p| mark(*p));
            for pair in points.windows(2) {
                let steps = (pair[0].distance(pair[1]) / (0.0125 * self.units_per_mm)).ceil().max(1.0) as usize;
                (0..=steps).for_each(|i| mark(pair[0].lerp(pair[1], i as f64 / steps as f64)));
            }
        }
        cells
    }

    /// Cells of the first with ink of a pen that the second has neither there nor beside it.
    fn missing(&self, of: &[u8], from: &[u8]) -> usize {
        let inner = self.columns + 1..of.len() - self.columns - 1;
        inner
            .filter(|&at| {
                let rows = [at - self.columns, at, at + self.columns];
                of[at] != 0 && of[at] & !rows.iter().fold(0, |bits, row| bits | from[row - 1] | from[*row] | from[row + 1]) != 0
            })
            .count()
    }

    fn check(&self, what: &str, before: &Strokes, rest: &Strokes) {
        let together: Vec<u8> = self.inked(before).iter().zip(self.inked(rest)).map(|(a, b)| a | b).collect();
        assert_eq!(self.missing(&self.cells, &together), 0, "{what}: ink is lost");
        assert_eq!(self.missing(&together, &self.cells), 0, "{what}: ink is drawn that is not the drawing's");
        // A few millimetres are drawn again, no more: three, and the rest of a vertex or an arc.
        let length = |strokes: &Strokes| -> f64 { strokes.paths.iter().map(|(_, points)| polyline_length(points)).sum() };
        let again = (length(before) + length(rest) - length(&self.strokes)) / self.units_per_mm;
        assert!((-0.01..20.0).contains(&again), "{what}: {again} mm twice");
    }
}

/// Indices spread evenly over a range, out of order.
fn spread(i: usize, count: usize) -> usize {
    ((i as f64 * 0.618_033_988_75).fract() * count as f64) as usize
}

#[test]
fn g_code_goes_on_at_any_line() {
    let plot = plot();
    for name in ["grbl-servo", "grbl-z"] {
        let profile = Profile::built_in(name).unwrap();
        let text = machine_file::written(&plot, &profile).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        // A pen's number stands in a comment, which both parts keep.
        let unnumbered = |text: &str| {
            let mut strokes = read_back(text, &profile);
            strokes.paths.iter_mut().for_each(|(pen, _)| *pen = 0);
            strokes
        };
        let whole = Whole::new(unnumbered(&text), profile.units_per_mm);
        for i in 1..=50 {
            let line = 1 + spread(i, lines.len());
            let rest = Language::Gcode.resume(&text, StopPlace::Line(line), 3.0).unwrap();
            let before = lines[..line - 1].join("\n") + "\n";
            let [before, rest] = [&before, &rest].map(|text| unnumbered(text));
            assert!(rest.ends_up, "{name}, line {line}");
            whole.check(&format!("{name}, line {line}"), &before, &rest);
        }
    }
}

#[test]
fn hp_gl_goes_on_at_any_byte() {
    let plot = plot();
    let profile = Profile::built_in("hp7475a").unwrap();
    let text = machine_file::written(&plot, &profile).unwrap();
    let whole = Whole::new(read_back(&text, &profile), profile.units_per_mm);
    for i in 1..=50 {
        let byte = spread(i, text.len());
        let rest = Language::Hpgl.resume(&text, StopPlace::Byte(byte), 3.0).unwrap();
        let [before, rest] = [&taken(&text[..byte]), &rest].map(|text| read_back(text, &profile));
        assert!(rest.ends_up, "byte {byte}");
        whole.check(&format!("byte {byte}"), &before, &rest);
    }
}

/// The part of an interrupted file that a plotter has executed: whole instructions, and the whole points of a list.
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
    let text = machine_file::written(&plot, &profile).unwrap();
    for i in 1..=50 {
        let line = 20 + spread(i, text.lines().count() - 20);
        let rest = Language::Gcode.resume(&text, StopPlace::Line(line), 3.0).unwrap();
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

/// Three pens with two lines and a touch each, so that a machine with one holder pauses twice; one pen on a machine that cannot
/// pause.
fn three_layers(profile: &Profile) -> Plot {
    let cannot_wait = profile.language() == Language::Gcode && !profile.can_pause();
    let pen = |number: u32| {
        let (y, turn) = (8.0 * f64::from(number), 0.2 * f64::from(number));
        let arc = (0..30).map(|i| Point::new(40.0, y) + Vec2::from_angle(turn + 0.1 * f64::from(i)) * 5.0).collect();
        let line = [(5.0, y), (15.0, y + 1.0), (25.0, y), (28.0, y + 3.0)].map(|(x, y)| Point::new(x, y)).to_vec();
        let mut paths: Vec<Toolpath> = [line, vec![Point::new(32.0, y)], arc].into_iter().filter_map(Toolpath::new).collect();
        if profile.swell.is_some() {
            paths[0] = paths[0].clone().with_heights(vec![-0.1, -1.1, -0.5, -0.3]).unwrap();
        }
        let handling = Handling { delay_seconds: if number == 3 { 0.4 } else { 0.0 }, ..Handling::default() };
        let handling = if profile.language() == Language::Gcode { handling } else { Handling::default() };
        PenPaths { number, name: format!("layer {number}; is M0"), colour: Colour::BLACK, nib: 0.3, handling, paths }
    };
    let pens = if cannot_wait { vec![pen(1)] } else { (1..=3).map(pen).collect() };
    Plot { page: Page::new(60.0, 40.0), pens }
}

fn written(profile: &Profile) -> String {
    machine_file::written(&three_layers(profile), profile).unwrap()
}

/// Pens, pauses, position and pen of the rest match those of the whole.
fn assert_rest(what: &str, whole: &Strokes, before: &Strokes, rest: &Strokes, profile: &Profile) {
    Whole::new(whole.clone(), profile.units_per_mm).check(what, before, rest);
    assert!(rest.ends_up, "{what}");
    assert_eq!(rest.visited.last(), whole.visited.last(), "{what}: it ends elsewhere");
    // Each pen except the first is asked for once, and no pen without anything left to draw.
    let pens: BTreeSet<u32> = rest.paths.iter().map(|(pen, _)| *pen).collect();
    let waits = if profile.pens.change == PenChange::Pause { pens.iter().filter(|pen| **pen > 1).count() } else { 0 };
    assert_eq!(rest.pauses, waits, "{what}: pens {pens:?}");
}

#[test]
fn every_machine_goes_on_with_its_pens_pauses_and_place() {
    for name in built_in_names() {
        let profile = Profile::built_in(name).unwrap();
        let text = written(&profile);
        match profile.language() {
            Language::Gcode => {
                let lines: Vec<&str> = text.lines().collect();
                let whole = read_back(&text, &profile);
                for line in 1..=lines.len() {
                    let rest = Language::Gcode.resume(&text, StopPlace::Line(line), 3.0).unwrap();
                    let before = read_back(&(lines[..line - 1].join("\n") + "\n"), &profile);
                    assert_rest(&format!("{name}, line {line}"), &whole, &before, &read_back(&rest, &profile), &profile);
                }
            }
            Language::Hpgl => {
                let whole = read_back(&text, &profile);
                for byte in 0..text.len() {
                    let rest = Language::Hpgl.resume(&text, StopPlace::Byte(byte), 3.0).unwrap();
                    let before = read_back(&taken(&text[..byte]), &profile);
                    assert_rest(&format!("{name}, byte {byte}"), &whole, &before, &read_back(&rest, &profile), &profile);
                }
            }
            _ => {}
        }
    }
}

/// Runs the program on a file from standard input, so that no name reveals its kind; status, stdout and stderr.
fn drypoint(arguments: &[&str], file: &str) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let output = command.args(arguments).write_stdin(file.to_owned()).output().unwrap();
    let said = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), said(output.stdout), said(output.stderr))
}

fn inspected(name: &str, profile: &Profile, file: &str) -> serde_json::Value {
    // HP-GL does not say for which machine it is.
    let more: &[&str] = if profile.language() == Language::Gcode { &[] } else { &["--profile", name] };
    let (status, json, said) = drypoint(&[&["inspect", "-", "--json"], more].concat(), file);
    assert_eq!(status, 0, "{name}: {said}");
    serde_json::from_str(&json).unwrap()
}

#[test]
fn every_machine_s_file_is_inspected_and_resumed_by_its_text_alone() {
    for name in built_in_names() {
        let profile = Profile::built_in(name).unwrap();
        let text = written(&profile);
        let pens = three_layers(&profile).pens.len();
        let told = inspected(name, &profile, &text);
        if profile.language() == Language::Svg {
            assert_eq!(told["layers"].as_array().unwrap().len(), 3, "{name}");
            continue;
        }
        let waits = if profile.pens.change == PenChange::Pause { pens - 1 } else { 0 };
        assert_eq!((told["profile"].as_str(), told["pauses"].as_u64()), (Some(name), Some(waits as u64)), "{name}: {told}");
        assert_eq!(told["plot"]["total"]["paths"], 3 * pens, "{name}");
        assert_eq!(told["ends_with_pen_up"], true, "{name}");
        // From the second path of the last pen on.
        let last = (3 * pens - 1).to_string();
        let (status, rest, said) = drypoint(&["resume", "-", "--path", &last, "-o", "-"], &text);
        assert_eq!(status, 0, "{name}: {said}");
        let told = inspected(name, &profile, &rest);
        assert_eq!(told["pauses"], usize::from(waits > 0), "{name}: {rest}");
        assert_eq!(told["plot"]["total"]["paths"], 2, "{name}: {rest}");
        assert_eq!(told["plot"]["pens"][0]["pen"], pens, "{name}: {rest}");
    }
}

#[test]
fn an_svg_is_not_resumed_and_the_message_says_what_helps() {
    let text = written(&Profile::built_in("axidraw-v3-a3").unwrap());
    let (status, _, said) = drypoint(&["resume", "-", "--path", "2", "-o", "-"], &text);
    assert_eq!(status, 1);
    assert!(said.contains("driven by a program of its own") && said.contains("res_plot"), "{said}");
    assert!(said.contains("--layers 2,3 --profile axidraw-v3-a3"), "{said}");
    assert!(!said.contains("pen up is"), "{said}");
}
