//! Every machine's file does what was requested: it reads back to the same motion, inside sheet and machine, pen up first and
//! last, without words that the machine does not know or that could ruin a sheet.
#![cfg(feature = "cli")]

use crate::common;
use crate::machine_file;

use assert_cmd::Command;
use common::{Sheet, sample};
use drypoint::drawing::{Colour, Drawing, Handling, Mark, Page};
use drypoint::geometry::{BezPath, Point, Rect, Vec2, distance_to_segment, flatten};
use drypoint::interrupt::Interrupt;
use drypoint::order::{Direction, Effort};
use drypoint::plot::{
    Dialect, InkModel, Language, Lift, Mounting, MountingError, Nibs, PenChange, PenPaths, Plot, Profile, Strokes, Toolpath,
    built_in_names, clip_to, lower, mount,
};
use drypoint::read::read_svg;
use machine_file::{read_back, written};
use rayon::prelude::*;
use std::fs;

/// Words that no file may contain by default.
const FORBIDDEN: [&str; 9] = ["G28", "$H", "G92", "M84", "M2", "M30", "M5", "M18", "G20"];
/// Maximum distance of the motion read back from the requested one, in millimetres.
const NEAR: f64 = 0.03;

fn profiles() -> impl Iterator<Item = Profile> {
    built_in_names().into_iter().map(|name| Profile::built_in(name).unwrap())
}

fn pen(number: u32, name: &str, paths: Vec<Toolpath>) -> PenPaths {
    PenPaths { number, name: name.into(), colour: Colour::BLACK, nib: 0.3, handling: Handling::default(), paths }
}

fn hedcut() -> Drawing {
    Sheet { set: &[("pitch", "1.2")], ..Sheet::new(&sample("chelsea.png"), (60.0, 39.911)) }.draw()
}

fn plotted(drawing: &Drawing) -> Plot {
    let mut plot = lower(drawing, InkModel::Ink, &Nibs::all(0.3), 0.02, &Interrupt::never()).unwrap();
    plot.order_paths(Point::ORIGIN, Effort::Fast, Direction::Either, 0.05);
    plot
}

/// A square, a circle and touches, each with its own pen, and with names that a controller might misread.
fn three_layers() -> Plot {
    let square = [(5.0, 5.0), (55.0, 5.0), (55.0, 35.0), (5.0, 35.0), (5.0, 5.0)].map(|(x, y)| Point::new(x, y)).to_vec();
    let circle = (0..=90).map(|i| Point::new(30.0, 20.0) + Vec2::from_angle(f64::from(i) * std::f64::consts::PI / 45.0) * 12.0);
    let touches = (0..5).map(|i| Toolpath::touch(Point::new(10.0 + 8.0 * f64::from(i), 30.0))).collect();
    let pens = vec![
        pen(1, "black", vec![Toolpath::new(square).unwrap()]),
        pen(2, "r\u{e9}d?! ~(M5) %", vec![Toolpath::new(circle.collect()).unwrap()]),
        pen(3, "touches; G28", touches),
    ];
    Plot { page: Page::new(60.0, 40.0), pens }
}

fn distance(p: Point, path: &[Point]) -> f64 {
    let of_legs = path.windows(2).map(|w| distance_to_segment(p, w[0], w[1]));
    of_legs.fold(path.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min), f64::min)
}

/// Each path was drawn, by its pen, in order and within tolerance of the request, both ways.
fn assert_same_motion(name: &str, plot: &Plot, motion: &Strokes, profile: &Profile, mounting: &Mounting) {
    let asked: Vec<(u32, &Toolpath)> = plot.pens.iter().flat_map(|pen| pen.paths.iter().map(|path| (pen.number, path))).collect();
    assert_eq!(asked.len(), motion.paths.len(), "{name}");
    for ((number, path), (pen, drawn)) in asked.into_iter().zip(&motion.paths) {
        assert_eq!(number, *pen, "{name}");
        let sent: Vec<Point> = path.points().iter().map(|p| mounting.place(number, *p)).collect();
        let near = NEAR * profile.units_per_mm;
        assert!(sent.iter().all(|p| distance(*p, drawn) <= near), "{name}: {sent:?} is not {drawn:?}");
        assert!(drawn.iter().all(|p| distance(*p, &sent) <= near), "{name}: {drawn:?} was not {sent:?}");
        assert!(sent[0].distance(drawn[0]) <= near && sent[sent.len() - 1].distance(drawn[drawn.len() - 1]) <= near, "{name}");
    }
}

/// Checks that hold for every machine's file.
fn assert_safe(text: &str, motion: &Strokes, profile: &Profile, mounting: &Mounting, page: &Page) {
    let name = &profile.name;
    let limits = mounting.limits;
    let inside = |p: &Point| (limits.x0..=limits.x1).contains(&p.x) && (limits.y0..=limits.y1).contains(&p.y);
    assert!(motion.visited.iter().all(inside), "{name}");
    let sheet = page.rect().inflate(NEAR, NEAR);
    let on_page = |number: u32, p: Point| {
        mounting.to_machine.inverse() * (p - (mounting.place(number, Point::ORIGIN) - mounting.to_machine * Point::ORIGIN))
    };
    let on_sheet = |(number, path): &(u32, Vec<Point>)| path.iter().all(|p| sheet.contains(on_page(*number, *p)));
    assert!(motion.paths.iter().all(on_sheet), "{name}");
    assert!(motion.ends_up, "{name}");
    let last = motion.visited[motion.visited.len() - 1];
    assert!(last.distance(mounting.park) < 0.01 * profile.units_per_mm, "{name}: {last:?}");
    if let Dialect::Hpgl(hpgl) = &profile.dialect {
        assert!(text.starts_with("IN;PU;") && text.trim_end().ends_with("SP0;"), "{name}");
        assert!(text.split(';').all(|instruction| instruction.len() <= hpgl.chunk), "{name}");
    } else {
        assert_safe_gcode(text, profile);
    }
}

fn assert_safe_gcode(text: &str, profile: &Profile) {
    let name = &profile.name;
    let Dialect::Gcode(gcode) = &profile.dialect else { panic!("{name} is no G-code") };
    let code = |line: &str| line.split(['(', ';']).next().unwrap().trim().to_owned();
    let up = gcode.pen_up.clone().filter(|_| gcode.lift == Lift::Command).unwrap_or_else(|| "G0 Z".to_owned());
    let first = |wanted: &dyn Fn(&str) -> bool| text.lines().position(|line| wanted(&code(line))).unwrap_or(usize::MAX);
    assert!(first(&|line| line.starts_with(&up)) < first(&|line| line.contains('X')), "{name}: the pen goes up first");
    for line in text.lines() {
        assert!(line.len() <= 80 && line.len() <= gcode.line_length, "{name}: {line}");
        assert!(line.is_ascii() && !line.contains(['?', '!', '~']), "{name}: {line}");
        for (i, word) in code(line).split_whitespace().enumerate() {
            let is_command = word.starts_with(['G', 'M']) && word[1..].starts_with(|c: char| c.is_ascii_digit());
            assert!(!FORBIDDEN.contains(&word), "{name}: {line}");
            if is_command || i == 0 {
                assert!(word == "%" || gcode.words.iter().any(|known| known == word), "{name}: {line}");
            }
        }
        if let (Some(height), true) = (gcode.height, code(line).starts_with("G0")) {
            let z = code(line).split_whitespace().find_map(|word| word.strip_prefix('Z')?.parse::<f64>().ok());
            assert!(z.is_none_or(|z| (z - height.up).abs() < 1e-9), "{name}: the pen never goes down at G0's rate: {line}");
        }
    }
}

/// A plotter's SVG contains each path, in order and in place (its driver raises, parks and changes pens by itself), all on the
/// sheet and within the machine's reach.
fn assert_same_strokes(text: &str, plot: &Plot, profile: &Profile, mounting: &Mounting) {
    let name = &profile.name;
    let asked: Vec<&Toolpath> = plot.pens.iter().flat_map(|pen| &pen.paths).collect();
    let imported = read_svg(text.as_bytes()).unwrap();
    let drawn: Vec<&Mark> = imported.layers.iter().flat_map(|layer| &layer.layer.marks).collect();
    assert_eq!(asked.len(), drawn.len(), "{name}");
    let (sheet, limits) = (plot.page.rect().inflate(NEAR, NEAR), mounting.limits.inflate(NEAR, NEAR));
    for (path, mark) in asked.into_iter().zip(drawn) {
        let points = match mark {
            Mark::Stroke(stroke) => flattened(stroke.curve()),
            Mark::Dot(dot) => vec![dot.centre],
            Mark::Area(_) => panic!("{name}: an area"),
        };
        let sent = path.points();
        assert!(sent.iter().all(|p| distance(*p, &points) <= NEAR), "{name}: {sent:?} is not {points:?}");
        assert!(points.iter().all(|p| distance(*p, sent) <= NEAR), "{name}: {points:?} was not {sent:?}");
        assert!(sent[0].distance(points[0]) <= NEAR, "{name}");
        assert!(sent[sent.len() - 1].distance(points[points.len() - 1]) <= NEAR, "{name}");
        assert!(points.iter().all(|p| sheet.contains(*p) && limits.contains(mounting.to_machine * *p)), "{name}: {points:?}");
    }
}

fn flattened(curve: &BezPath) -> Vec<Point> {
    flatten(curve, 0.001).into_iter().flat_map(|(points, _)| points).collect()
}

fn assert_holds(plot: &Plot, profile: &Profile) {
    let name = &profile.name;
    let mounting = mount(profile, &plot.page).unwrap();
    mounting.check(profile, plot).unwrap_or_else(|error| panic!("{name}: {error}"));
    let changes = plot.pens.windows(2).filter(|pair| pair[0].number != pair[1].number).count();
    let cannot_wait = profile.language() == Language::Gcode && !profile.can_pause();
    let text = match written(plot, profile) {
        Ok(text) => text,
        Err(_) if cannot_wait && changes > 0 => return,
        Err(error) => panic!("{name}: {error}"),
    };
    assert!(!cannot_wait || changes == 0, "{name} cannot wait");
    if profile.language() == Language::Svg {
        assert_same_strokes(&text, plot, profile, &mounting);
        assert_eq!(text.matches("inkscape:label=\"!").count(), changes, "{name}");
        return;
    }
    let motion = read_back(&text, profile);
    assert_same_motion(name, plot, &motion, profile, &mounting);
    assert_safe(&text, &motion, profile, &mounting, &plot.page);
    let waits = if profile.pens.change == PenChange::Pause { changes } else { 0 };
    assert_eq!(motion.pauses, waits, "{name}");
}

#[test]
fn a_hedcut_and_three_layers_come_back_from_every_machine() {
    let hedcut = plotted(&hedcut());
    for profile in profiles() {
        assert_holds(&hedcut, &profile);
        let mut layers = three_layers();
        if profile.name == "toy" {
            // Its second pen is offset by half a millimetre, and its brush swells.
            let square = &mut layers.pens[0].paths[0];
            *square = square.clone().with_heights(vec![-0.1, -1.1, -0.5, -0.3, -0.1]).unwrap();
        }
        assert_holds(&layers, &profile);
    }
}

/// Deterministic pseudo-random numbers from 0 to 1 (splitmix64).
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    fn point(&mut self, within: Rect) -> Point {
        Point::new(within.x0 + self.next() * within.width(), within.y0 + self.next() * within.height())
    }

    /// A touch, a zigzag, or part of a spiral, inside a rectangle.
    fn path(&mut self, within: Rect) -> Toolpath {
        let start = self.point(within);
        let mut points = match self.below(4) {
            0 => vec![start],
            1 => (0..2 + self.below(5)).map(|_| self.point(within)).collect(),
            _ => {
                let (turn, grow, first) = (0.05 + self.next(), self.next() * 0.05, self.next() * 6.0);
                let radius = 0.1 + 3.0 * self.next();
                let at = |i: usize| start + Vec2::from_angle(first + turn * i as f64) * (radius + grow * i as f64);
                let kept = |p: Point| Point::new(p.x.clamp(within.x0, within.x1), p.y.clamp(within.y0, within.y1));
                (0..3 + self.below(20)).map(|i| kept(at(i))).collect()
            }
        };
        points.dedup();
        let mut path = Toolpath::new(points).unwrap();
        path.dwell_seconds = if self.below(8) == 0 { self.next() } else { 0.0 };
        path
    }
}

#[test]
fn ten_thousand_random_drawings_hold_on_every_machine() {
    profiles().collect::<Vec<_>>().into_par_iter().for_each(|profile| {
        let mut chance = Chance(profile.name.len() as u64);
        for _ in 0..10_000 {
            let page = Page::new(20.0 + 50.0 * chance.next(), 20.0 + 50.0 * chance.next());
            let within = mount(&profile, &page).unwrap().drawable(&page);
            let number = 1 + chance.below(profile.pens.count as usize) as u32;
            let paths = (0..=chance.below(3)).map(|_| chance.path(within)).collect();
            assert_holds(&Plot { page, pens: vec![pen(number, "a", paths)] }, &profile);
        }
    });
}

#[test]
fn what_lies_off_the_sheet_is_refused_though_the_machine_reaches_it() {
    let set = [("area.x".to_owned(), "[0, 594]".to_owned()), ("area.y".to_owned(), "[0, 432]".to_owned())];
    let text = drypoint::plot::built_in("grbl-servo").unwrap();
    let large = Profile::parse_with("grbl-servo", text, &set).unwrap();
    let page = Page::new(210.0, 297.0);
    let path = Toolpath::through(Point::new(20.0, 20.0), [Point::new(260.0, 150.0)]);
    let mut plot = Plot { page, pens: vec![pen(1, "a", vec![path])] };
    let mounting = mount(&large, &page).unwrap();
    let error = mounting.check(&large, &plot).unwrap_err();
    assert!(error.to_string().contains("50.00 mm beyond the sheet's right edge"), "{error}");
    let MountingError::OffSheet { room, .. } = error else { panic!("{error}") };
    assert!(!room.is_enough() && room.is_enough_across(), "{room:?}");
    let (lost, _) = clip_to(&mut plot, mounting.drawable(&page));
    assert!(lost > 50.0);
    assert_holds(&plot, &large);
}

const A3: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" \
    width=\"420mm\" height=\"297mm\" viewBox=\"0 0 420 297\" fill=\"none\">\
    <g id=\"a\" inkscape:groupmode=\"layer\" inkscape:label=\"1 black\"><path stroke=\"#000\" d=\"M30 30H390V265H30z\"/></g>\
    <g id=\"b\" inkscape:groupmode=\"layer\" inkscape:label=\"2 red\"><circle stroke=\"#c00\" cx=\"200\" cy=\"150\" r=\"80\"/></g>\
    <g id=\"c\" inkscape:groupmode=\"layer\" inkscape:label=\"3 blue\"><path stroke=\"#00c\" d=\"M40 50L300 250\"/></g></svg>";

fn drypoint(folder: &std::path::Path, arguments: &[&str]) -> (i32, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_drypoint")).current_dir(folder).args(arguments).output().unwrap();
    (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn three_pens_on_a3_have_their_slots_their_pauses_and_their_preview() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    fs::write(folder.path().join("a3.svg"), A3).unwrap();
    fs::write(folder.path().join("pens.toml"), "[black]\nslot = 2\n[red]\nslot = 5\nwidth = \"0.5mm\"\nspeed = 120\n").unwrap();
    let run = |more: &[&str]| drypoint(folder.path(), &[&["plot", "a3.svg", "-q", "--pens", "pens.toml"], more].concat());

    assert_eq!(run(&["--profile", "hp7475a", "-o", "a.hpgl", "--preview", "a.svg"]), (0, String::new()));
    let hpgl = at("a.hpgl");
    let slots: Vec<&str> = hpgl.split(';').filter(|word| word.starts_with("SP")).collect();
    assert_eq!(slots, ["SP2", "SP3", "SP5", "SP0"]);
    assert!(hpgl.contains("PS0;") && hpgl.contains("SP5;VS12;"), "{hpgl}");
    let preview = at("a.svg");
    for label in ["% sheet", "% machine", "2 black", "3 blue", "5 red", "% travel", "% start and park"] {
        assert!(preview.contains(&format!("inkscape:label=\"{label}\"")), "{label}");
    }
    assert!(preview.contains("stroke-width=\".5\"") && preview.contains("#cc0000"));

    let wide = ["--set-profile", "area.x=[0, 430]", "--profile", "grbl-servo", "-o", "a.gcode"];
    let (status, message) = run(&wide);
    assert_eq!(status, 2, "{message}");
    assert!(message.contains("'red' 120 mm/s, and grbl-servo draws at 100 mm/s at most"), "{message}");
    fs::write(folder.path().join("pens.toml"), "[red]\nwidth = 0.5\nspeed = 30\n").unwrap();
    let (status, message) = run(&wide);
    assert!(status == 0 && message.contains("pauses for each change"), "a warning in spite of -q: {message}");
    let gcode = at("a.gcode");
    let lines: Vec<&str> = gcode.lines().collect();
    let pauses: Vec<&[&str]> = lines.windows(3).filter(|w| w[2] == "M0").collect();
    assert_eq!(pauses, [["G0 X0 Y0", "(pen 2: red 0.5)", "M0"], ["G0 X0 Y0", "(pen 3: blue 0.3)", "M0"]]);
    assert!(gcode.contains("F1800") && gcode.contains("G2 X") || gcode.contains("G3 X"));
}

#[test]
fn what_cannot_be_is_refused_with_its_reason() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a3.svg"), A3).unwrap();
    let line = |i: i32| format!("<path stroke=\"#{:06x}\" d=\"M{} 50v9\"/>", i * 5000, 20 + i / 10);
    let colours = (0..3000).map(line).collect::<Vec<_>>().concat();
    let head = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"420mm\" height=\"297mm\" viewBox=\"0 0 420 297\">";
    fs::write(folder.path().join("many.svg"), format!("{head}{colours}</svg>")).unwrap();
    fs::write(folder.path().join("mine.toml"), "extends = \"hp7475a\"\n[motion]\ndraw_speed = 0\n").unwrap();
    fs::write(folder.path().join("two.toml"), "[red]\ncolour = \"red\"\nslot = 1\n[sky]\ncolour = \"#08f\"\nslot = 2\n").unwrap();
    for (arguments, words) in [
        (&["a3.svg", "--profile", "idraw-a3", "-o", "x.gcode"][..], "has no pause command"),
        (&["a3.svg", "--profile", "hp7475a", "--frame", "-o", "x.hpgl"], "--frame needs a pause"),
        (&["a3.svg", "--profile", "axidraw-v3", "-o", "x.svg"], "beyond the upper x limit of axidraw-v3"),
        (&["a3.svg", "--profile", "./mine.toml", "-o", "x.hpgl"], "mine.toml, line 3: motion.draw_speed must be above 0"),
        (&["a3.svg", "--profile", "hp7475a", "--set-profile", "motion.fast=1", "-o", "x.hpgl"], "--set-profile: motion.fast"),
    ] {
        let (status, message) = drypoint(folder.path(), &[&["plot"], arguments].concat());
        assert!(status != 0 && message.contains(words), "{arguments:?}: {message}");
        assert!(!folder.path().join("x.gcode").exists() && !folder.path().join("x.hpgl").exists());
    }
    let mapped = ["plot", "many.svg", "-q", "--pens", "two.toml", "--profile", "hp7475a", "-o", "x.hpgl"];
    assert_eq!(drypoint(folder.path(), &mapped).0, 0);
    let hpgl = fs::read_to_string(folder.path().join("x.hpgl")).unwrap();
    assert!(hpgl.contains("SP1;") && hpgl.contains("SP2;") && !hpgl.contains("SP3;"));
}
