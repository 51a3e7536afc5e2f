//! After a kill, a pulled cable or a stop: nothing is missing, and at most one path, or two millimetres, is drawn twice.

use crate::grbl::firmware::{Build, Piece};
use crate::grbl::{Settings, Z};
use crate::machine::{Chance, Job, Machine, at_once, many, plot, plot_on_z, said};
use std::collections::BTreeMap;
use std::time::Duration;

/// Cells of 8 mm, one for each path of `plot`.
type Cell = (i64, i64);

fn cell(place: [f64; 2]) -> Cell {
    ((place[0] / 8.0).floor() as i64, (place[1] / 8.0).floor() as i64)
}

/// Length drawn in each cell, and how often the pen came down there.
fn by_cell(drawn: &[Piece], touches: &[[f64; 2]]) -> BTreeMap<Cell, (f64, usize)> {
    let mut cells: BTreeMap<Cell, (f64, usize)> = BTreeMap::new();
    for [from, to] in drawn {
        let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
        cells.entry(cell(middle)).or_default().0 += (to[0] - from[0]).hypot(to[1] - from[1]);
    }
    for place in touches {
        cells.entry(cell(*place)).or_default().1 += 1;
    }
    cells
}

/// Hundredths of a square millimetre that are inked: a pen of 0.3 mm, in squares of 0.1 mm.
fn inked(drawn: &[Piece]) -> std::collections::BTreeSet<(i64, i64)> {
    let mut squares = std::collections::BTreeSet::new();
    for [from, to] in drawn {
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let steps = (length / 0.05).ceil() as i64;
        for step in 0..=steps.max(1) {
            let t = step as f64 / steps.max(1) as f64;
            let place = [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])];
            squares.insert(((place[0] * 10.0).round() as i64, (place[1] * 10.0).round() as i64));
        }
    }
    squares
}

/// A kind of machine, and a drawing for it.
struct Bench {
    machine: fn() -> Machine,
    text: String,
}

/// What an undisturbed drawing leaves.
fn whole(bench: &Bench) -> Vec<Piece> {
    let machine = (bench.machine)();
    let output = Job::new(&bench.text).run(&machine, &[]);
    assert!(output.status.success(), "{}", said(&output));
    machine.firmware().drawn.clone()
}

/// No ink of the whole is missing.
fn check_ink(drawn: &[Piece], whole: &[Piece]) {
    let (ink, wanted) = (inked(drawn), inked(whole));
    // A point at a seam may fall on the next square.
    let near = |&(x, y): &(i64, i64)| (-1..=1).any(|i| (-1..=1).any(|j| ink.contains(&(x + i, y + j))));
    assert!(wanted.iter().all(near), "ink is missing");
}

/// What was disturbed equals the whole, up to one path or a length drawn twice.
fn compare(machine: &Machine, whole: &[Piece], paths: usize, overlap: Option<f64>) {
    let firmware = machine.firmware();
    let (drawn, expected) = (by_cell(&firmware.drawn, &firmware.touches), by_cell(whole, &[]));
    assert_eq!(drawn.len(), paths, "each path was begun");
    check_ink(&firmware.drawn, whole);
    let mut repeated = Vec::new();
    for (cell, (length, touches)) in &drawn {
        let once = expected.get(cell).map_or(0.0, |known| known.0);
        let more = length - once;
        assert!(more > -0.1, "{cell:?}: {more} mm are missing");
        if *touches > 1 || more > 0.1 {
            repeated.push((*cell, more, *touches));
        }
    }
    assert!(repeated.len() <= 1, "drawn twice: {repeated:?}");
    if let (Some(overlap), Some((_, more, _))) = (overlap, repeated.first()) {
        assert!(*more <= overlap + 0.1, "{more} mm drawn twice");
    }
}

/// Disturbs a drawing and continues it.
fn disturbed(seed: u64, whole: &[Piece], bench: &Bench, disturb: impl FnOnce(&Machine, &mut std::process::Child)) {
    let (machine, job) = ((bench.machine)(), Job::new(&bench.text));
    let mut child = job.start(&machine, &[]);
    disturb(&machine, &mut child);
    let _ = child.wait();
    machine.connect(true);
    let overlap = [None, Some("1mm"), Some("2mm")][seed as usize % 3];
    let mut options = vec!["--continue"];
    options.extend(overlap.iter().flat_map(|length| ["--overlap", length]));
    // Before the first record there is nothing to continue.
    if job.file.with_extension("gcode.journal").exists() {
        let output = job.run(&machine, &options);
        assert!(output.status.success(), "seed {seed}: {}", said(&output));
        compare(&machine, whole, PATHS, overlap.map(|text| text[..1].parse().unwrap()));
    }
}

const PATHS: usize = 40;
/// How much faster than in life the machine runs here: a minute in a second.
const PACE: f64 = 60.0;

fn in_parallel(bench: &Bench, runs: usize, disturb: impl Fn(u64, &Machine, &mut std::process::Child) + Sync) {
    let whole = whole(bench);
    at_once(runs as u64, |seed| disturbed(seed, &whole, bench, |machine, child| disturb(seed, machine, child)));
}

/// A machine with a servo.
fn servo() -> Bench {
    Bench { machine: || Machine::at_pace(PACE), text: plot(PATHS, 11) }
}

/// A machine with a z axis, on which neither lifting nor lowering proves anything.
fn z_axis() -> Bench {
    Bench { machine: || Machine::of_z_axis(PACE), text: plot_on_z(PATHS, 11) }
}

/// A machine whose planner holds so many moves, and either tells it or not.
fn deep(build: Build) -> Machine {
    let settings = Settings { blocks: 100, ..Z };
    Machine::with_settings(&settings, PACE, |firmware| {
        firmware.hang_pen();
        firmware.build = build;
    })
}

/// A moment between meeting the machine and the end.
fn moment(seed: u64) -> Duration {
    Duration::from_millis(450 + Chance(seed * 613 + 3).below(900))
}

fn kills(bench: &Bench, runs: usize) {
    in_parallel(bench, runs, |seed, _, child| {
        std::thread::sleep(moment(seed));
        let _ = child.kill();
    });
}

fn pulls(bench: &Bench, runs: usize) {
    in_parallel(bench, runs, |seed, machine, child| {
        std::thread::sleep(moment(seed + 1000));
        machine.connect(false);
        std::thread::sleep(Duration::from_millis(50));
        let _ = child.kill();
        machine.rest_with_half_lines();
    });
}

#[test]
fn killed_at_any_moment_it_goes_on() {
    kills(&servo(), many(200));
    kills(&z_axis(), many(200));
}

#[test]
fn however_deep_the_planner_is() {
    kills(&Bench { machine: || deep(Build::Told), text: plot_on_z(PATHS, 12) }, many(60));
    kills(&Bench { machine: || deep(Build::Untold), text: plot_on_z(PATHS, 13) }, many(60));
}

#[test]
fn a_pulled_cable_is_put_back_and_it_goes_on() {
    pulls(&servo(), many(100));
    pulls(&z_axis(), many(100));
}

#[test]
fn stopped_by_a_signal_it_lifts_and_goes_on() {
    for bench in [servo(), z_axis()] {
        in_parallel(&bench, many(50), |seed, machine, child| {
            std::thread::sleep(moment(seed + 2000));
            let killed = std::process::Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
            let status = child.wait().unwrap();
            assert!(killed.success());
            // It may have been done by then.
            let mut words = String::new();
            let _ = std::io::Read::read_to_string(child.stderr.as_mut().unwrap(), &mut words);
            assert!(matches!(status.code(), Some(0 | 143)), "seed {seed}, {status:?}: {words}");
            machine.rest();
            assert!(!machine.firmware().is_pen_down(), "seed {seed}: the pen is down after a stop");
        });
    }
}

/// The path of the last record.
fn recorded(job: &Job) -> u64 {
    let text = std::fs::read_to_string(job.file.with_extension("gcode.journal")).unwrap();
    let last = text.lines().rev().find_map(|line| serde_json::from_str::<serde_json::Value>(line).ok()).unwrap();
    last["path"].as_u64().unwrap_or(0)
}

#[test]
fn a_drawing_that_is_disturbed_again_and_again_never_goes_back() {
    let bench = servo();
    let (machine, job, whole) = ((bench.machine)(), Job::new(&bench.text), whole(&bench));
    let mut child = job.start(&machine, &[]);
    let mut last = 0;
    for seed in 0..8 {
        // Some are killed before they have sent a line.
        std::thread::sleep(Duration::from_millis(350 + 60 * seed));
        let _ = child.kill();
        let _ = child.wait();
        machine.rest_with_half_lines();
        if job.file.with_extension("gcode.journal").exists() {
            let path = recorded(&job);
            assert!(path >= last || path == 0, "from path {last} back to {path}");
            last = path;
        }
        child = job.start(&machine, &["--continue"]);
    }
    let _ = child.wait();
    let output = job.run(&machine, &["--continue"]);
    assert!(output.status.success(), "{}", said(&output));
    let firmware = machine.firmware();
    check_ink(&firmware.drawn, &whole);
    assert!(firmware.touches.len() <= PATHS + 9, "{} paths begun", firmware.touches.len());
}

#[test]
fn another_file_or_none_is_not_continued() {
    let (machine, job) = (Machine::start(), Job::new(&plot(3, 1)));
    let output = job.run(&machine, &["--continue"]);
    assert!(!output.status.success() && said(&output).contains("journal"), "{}", said(&output));
    assert!(job.run(&machine, &[]).status.success());
    let output = job.run(&machine, &["--continue"]);
    assert!(output.status.success() && said(&output).contains("everything is drawn already"), "{}", said(&output));
    std::fs::write(&job.file, plot(3, 2)).unwrap();
    let output = job.run(&machine, &["--continue"]);
    assert!(!output.status.success() && said(&output).contains("of another file"), "{}", said(&output));
}
