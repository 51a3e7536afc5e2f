//! Independent programs read what drypoint writes, and draw the same.

use crate::common;
use crate::machine_file;

use common::{Sheet, sample, skip};
use drypoint::geometry::{BezPath, Point, flatten, flatten_arc};
use drypoint::interrupt::Interrupt;
use drypoint::order::{Direction, Effort};
use drypoint::plot::{Dialect, InkModel, Language, Lift, Nibs, Plot, Profile, built_in_names, lower, mount};
use machine_file::written;
use std::collections::HashMap;
use std::process::Command;

/// Maximum distance of a program's ink from ours, in millimetres, and the least fraction of it within that distance.
const NEAR: f64 = 0.15;
const SHARE: f64 = 0.995;
/// Spacing of the ink points that are compared, in millimetres.
const GRAIN: f64 = 0.05;

/// Runs a program; if it is not installed, reports the check as skipped.
fn run(program: &str, arguments: &[&str]) -> Option<(i32, String)> {
    let Ok(output) = Command::new(program).args(arguments).output() else {
        skip(&format!("{program} is not installed"));
        return None;
    };
    let words = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    Some((output.status.code().unwrap_or(-1), words))
}

fn plotted() -> Plot {
    let drawing = Sheet { set: &[("pitch", "1.2")], ..Sheet::new(&sample("chelsea.png"), (60.0, 39.911)) }.draw();
    let mut plot = lower(&drawing, InkModel::Ink, &Nibs::all(0.3), 0.02, &Interrupt::never()).unwrap();
    plot.order_paths(Point::ORIGIN, Effort::Fast, Direction::Either, 0.05);
    plot
}

/// What a plot's pens draw, in millimetres along the machine's axes.
fn asked(plot: &Plot, profile: &Profile) -> Vec<Vec<Point>> {
    let mounting = mount(profile, &plot.page).unwrap();
    let mm = |p: &Point| (mounting.place(1, *p).to_vec2() / profile.units_per_mm).to_point();
    plot.pens.iter().flat_map(|pen| &pen.paths).map(|path| path.points().iter().map(mm).collect()).collect()
}

/// Points of ink along paths.
fn ink(paths: &[Vec<Point>]) -> Vec<Point> {
    let mut points = Vec::new();
    for path in paths {
        points.extend(path.first());
        for leg in path.windows(2) {
            let steps = (leg[0].distance(leg[1]) / GRAIN).ceil().max(1.0) as usize;
            points.extend((1..=steps).map(|i| leg[0].lerp(leg[1], i as f64 / steps as f64)));
        }
    }
    points
}

/// The fraction of the points that lie near one of the others.
fn share_near(points: &[Point], others: &[Point]) -> f64 {
    let cell = |p: &Point| ((p.x / NEAR).floor() as i64, (p.y / NEAR).floor() as i64);
    let mut cells: HashMap<(i64, i64), Vec<Point>> = HashMap::new();
    for p in others {
        cells.entry(cell(p)).or_default().push(*p);
    }
    let is_near = |p: &&Point| {
        let (x, y) = cell(p);
        let around = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| (x, y)));
        around.filter_map(|at| cells.get(&at)).flatten().any(|q| q.distance(**p) <= NEAR)
    };
    points.iter().filter(is_near).count() as f64 / points.len() as f64
}

fn assert_same_ink(name: &str, ours: &[Vec<Point>], theirs: &[Vec<Point>]) {
    let (ours, theirs) = (ink(ours), ink(theirs));
    let shares = [share_near(&ours, &theirs), share_near(&theirs, &ours)];
    println!("{name}: {:.4} of our ink is theirs, {:.4} of theirs is ours", shares[0], shares[1]);
    assert!(shares.iter().all(|share| *share >= SHARE), "{name}: {shares:?}");
}

fn least(paths: &[Vec<Point>]) -> (f64, f64) {
    let points = || paths.iter().flatten();
    (points().map(|p| p.x).fold(f64::INFINITY, f64::min), points().map(|p| p.y).fold(f64::INFINITY, f64::min))
}

/// hp2xx's lines, in points of 1/72 inch with y down; it takes a unit to be 1/40 mm.
fn of_hp2xx(svg: &str, units_per_mm: f64) -> Vec<Vec<Point>> {
    let mm = 25.4 / 72.0 * 40.0 / units_per_mm;
    let groups = svg.split("</g>").filter(|group| !group.contains("stroke-width:1.000mm"));
    let data = groups.flat_map(|group| group.split(" d=\"").skip(1)).filter_map(|rest| rest.split('"').next());
    let paths = data.map(|d| BezPath::from_svg(d).unwrap()).flat_map(|path| flatten(&path, 0.1));
    paths.map(|(points, _)| points.into_iter().map(|p| Point::new(p.x * mm, -p.y * mm)).collect()).collect()
}

#[test]
fn hp2xx_takes_every_hpgl_file_and_draws_the_same() {
    let plot = plotted();
    let folder = tempfile::tempdir().unwrap();
    let (hpgl, svg) = (folder.path().join("a.hpgl"), folder.path().join("a.svg"));
    for name in built_in_names() {
        let profile = Profile::built_in(name).unwrap();
        if profile.language() != Language::Hpgl {
            continue;
        }
        std::fs::write(&hpgl, written(&plot, &profile).unwrap()).unwrap();
        let arguments = ["-t", "-c", "1", "-m", "svg", "-f", svg.to_str().unwrap(), hpgl.to_str().unwrap()];
        let Some((_, words)) = run("hp2xx", &arguments) else { return };
        assert!(words.contains("HPGL command(s) ignored: 0"), "{name}: {words}");
        assert!(words.contains("Unexpected event(s):  0"), "{name}: {words}");
        let ours = asked(&plot, &profile);
        let mut theirs = of_hp2xx(&std::fs::read_to_string(&svg).unwrap(), profile.units_per_mm);
        // Its picture begins at the ink.
        let ((x, y), (to_x, to_y)) = (least(&theirs), least(&ours));
        theirs.iter_mut().flatten().for_each(|p| *p = Point::new(p.x + to_x - x, p.y + to_y - y));
        assert_same_ink(name, &ours, &theirs);
    }
}

/// The file as `LinuxCNC`'s interpreter accepts it: between percent signs, with other controllers' named commands replaced by
/// words that it knows.
fn for_rs274(text: &str, profile: &Profile) -> String {
    let Dialect::Gcode(gcode) = &profile.dialect else { panic!("{} is no G-code", profile.name) };
    let line = |line: &str| match line {
        _ if gcode.lift == Lift::Command && Some(line) == gcode.pen_up.as_deref() => "G0 Z1".to_owned(),
        _ if gcode.lift == Lift::Command && Some(line) == gcode.pen_down.as_deref() => "G0 Z-1".to_owned(),
        "PAUSE" => "M0".to_owned(),
        "M400" => String::new(),
        other => other.to_owned(),
    };
    let body: String = text.lines().map(|l| line(l) + "\n").collect();
    if gcode.frame.is_some() { body } else { format!("%\n{body}%\n") }
}

/// What the interpreter's canonical commands draw with the pen down, in millimetres.
fn of_rs274(words: &str, is_down: impl Fn(f64) -> bool) -> Vec<Vec<Point>> {
    let (mut paths, mut at, mut z): (Vec<Vec<Point>>, Point, f64) = (Vec::new(), Point::ORIGIN, f64::NAN);
    for line in words.lines() {
        let Some((call, rest)) = line.split_once("N..... ").and_then(|(_, call)| call.split_once('(')) else { continue };
        let numbers: Vec<f64> = rest.trim_end_matches(')').split(',').filter_map(|n| n.trim().parse().ok()).collect();
        let was_down = is_down(z);
        let (to, steps) = match (call, &numbers[..]) {
            ("STRAIGHT_TRAVERSE" | "STRAIGHT_FEED", &[x, y, new, ..]) => {
                z = new;
                (Point::new(x, y), vec![Point::new(x, y)])
            }
            ("ARC_FEED", &[x, y, i, j, turn, ..]) => {
                let (to, centre) = (Point::new(x, y), Point::new(i, j));
                let (a, b) = (at - centre, to - centre);
                let angle = a.cross(b).atan2(a.dot(b));
                let sweep = if angle * turn <= 0.0 { angle + turn * std::f64::consts::TAU } else { angle };
                (to, flatten_arc(at, to, centre, sweep, 0.005))
            }
            _ => continue,
        };
        match (was_down, is_down(z)) {
            (false, true) => paths.push(vec![to]),
            (true, true) => paths.last_mut().unwrap().extend(steps),
            _ => {}
        }
        at = to;
    }
    paths
}

#[test]
fn linuxcnc_takes_every_gcode_file_and_draws_the_same() {
    let plot = plotted();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.ngc");
    for name in built_in_names() {
        let profile = Profile::built_in(name).unwrap();
        let Dialect::Gcode(_) = &profile.dialect else { continue };
        std::fs::write(&file, for_rs274(&written(&plot, &profile).unwrap(), &profile)).unwrap();
        let Some((status, words)) = run("rs274", &["-g", file.to_str().unwrap()]) else { return };
        assert_eq!(status, 0, "{name}: {}", words.lines().last().unwrap_or(""));
        let (up, down) = profile.height().map_or((1.0, -1.0), |height| (height.up, height.down));
        let theirs = of_rs274(&words, |z| (z - down).abs() < (z - up).abs());
        assert_same_ink(name, &asked(&plot, &profile), &theirs);
    }
}
