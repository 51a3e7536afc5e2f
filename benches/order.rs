//! Path order on planted inputs: `cargo bench --bench order`, or with the folder of the peers' own inputs
//! `cargo bench --bench order -- FOLDER` (files such as `dots_1000.txt`: one polyline per line, `x,y x,y ...` in millimetres).
//!
//! Pen-up travel, without the way from and to home, compared with a plain nearest-neighbour order in the same run.

use drypoint::geometry::Point;
use drypoint::order::{Direction, Effort, PathEnds, Stop, Visit, order, order_stops, pen_up_length};
use std::path::Path;
use std::time::Instant;

fn main() {
    let folder = std::env::args().skip(1).find(|a| !a.starts_with("--"));
    println!("{:14} {:>12} {:>22} {:>22}", "input", "neighbour mm", "fast mm, s", "full mm, s");
    let inputs = folder.map_or_else(generated, |folder| read(Path::new(&folder)));
    for (name, paths) in inputs {
        // The naive order is quadratic: only for inputs where it finishes.
        let neighbour = if paths.len() <= 20_000 { without_home(&paths, &nearest_neighbour(&paths)) } else { f64::NAN };
        let [fast, full] = [Effort::Fast, Effort::Full].map(|effort| {
            let started = Instant::now();
            let visits = order(&paths, Point::ORIGIN, effort, Direction::Either);
            (without_home(&paths, &visits), started.elapsed().as_secs_f64())
        });
        println!("{name:14} {neighbour:>12.1} {:>14.1} {:>7.2} {:>14.1} {:>7.2}", fast.0, fast.1, full.0, full.1);
    }
    loops();
}

/// Saving from entering loops anywhere instead of at their start, on a sheet of 2000 circles and polygons.
fn loops() {
    let rings: Vec<Vec<Point>> = (1..=2000).map(ring).collect();
    let given: Vec<Stop> =
        rings.iter().map(|ring| Stop::new(PathEnds { start: ring[0], end: ring[0] }, Direction::Either)).collect();
    let free: Vec<Stop> = given.iter().zip(&rings).map(|(stop, ring)| Stop { ring: Some(ring), ..*stop }).collect();
    for (name, effort) in [("fast", Effort::Fast), ("full", Effort::Full)] {
        let [fixed, free] = [&given, &free].map(|stops| {
            let mut stops = stops.clone();
            let started = Instant::now();
            let visits = order_stops(&mut stops, Point::ORIGIN, effort);
            let ends: Vec<PathEnds> = stops.iter().map(|stop| stop.ends).collect();
            (without_home(&ends, &visits), started.elapsed().as_secs_f64())
        });
        println!(
            "2000 loops, {name}: fixed seams {:.1} mm in {:.2} s, free seams {:.1} mm in {:.2} s, {:.1} % less",
            fixed.0,
            fixed.1,
            free.0,
            free.1,
            100.0 * (1.0 - free.0 / fixed.0)
        );
    }
}

/// A circle or polygon of 1 to 6 mm radius somewhere on A4.
fn ring(i: usize) -> Vec<Point> {
    let uniform = |step: f64| (i as f64 * step).fract();
    let centre = Point::new(210.0 * uniform(0.754_877_666), 297.0 * uniform(0.569_840_291));
    let radius = 1.0 + 5.0 * uniform(0.618_033_989);
    let corners = if i.is_multiple_of(2) { 48 } else { 3 + i % 5 };
    let turn = |k: usize| std::f64::consts::TAU * ((k % corners) as f64 / corners as f64 + uniform(0.414_213_562));
    (0..=corners).map(|k| centre + drypoint::geometry::Vec2::from_angle(turn(k)) * radius).collect()
}

fn without_home(paths: &[PathEnds], visits: &[Visit]) -> f64 {
    let Some(first) = visits.first() else { return 0.0 };
    let start = if first.reversed { paths[first.path].end } else { paths[first.path].start };
    pen_up_length(paths, visits, start)
}

/// The naive order: always the nearest free end; quadratic time.
fn nearest_neighbour(paths: &[PathEnds]) -> Vec<Visit> {
    let mut left: Vec<usize> = (0..paths.len()).collect();
    let mut at = Point::ORIGIN;
    let mut visits = Vec::new();
    while !left.is_empty() {
        let gap = |path: usize| at.distance_squared(paths[path].start).min(at.distance_squared(paths[path].end));
        let slot = (0..left.len()).min_by(|&a, &b| gap(left[a]).total_cmp(&gap(left[b]))).unwrap_or(0);
        let path = left.swap_remove(slot);
        let reversed = at.distance_squared(paths[path].end) < at.distance_squared(paths[path].start);
        at = if reversed { paths[path].start } else { paths[path].end };
        visits.push(Visit { path, reversed });
    }
    visits
}

/// Uniform dots and short segments on A4.
fn generated() -> Vec<(String, Vec<PathEnds>)> {
    let uniform = |i: usize, step: f64| (i as f64 * step).fract();
    let place = |i: usize| Point::new(210.0 * uniform(i, 0.754_877_666), 297.0 * uniform(i, 0.569_840_291));
    let mut inputs = Vec::new();
    for count in [1_000, 10_000] {
        inputs.push((format!("dots_{count}"), (1..=count).map(|i| PathEnds { start: place(i), end: place(i) }).collect()));
        let segment = |i: usize| {
            let along = drypoint::geometry::Vec2::from_angle(std::f64::consts::TAU * uniform(i, 0.618_033_989));
            PathEnds { start: place(i), end: place(i) + along * (2.0 + 8.0 * uniform(i, 0.414_213_562)) }
        };
        inputs.push((format!("segs_{count}"), (1..=count).map(segment).collect()));
    }
    inputs
}

/// Every `.txt` of a folder.
fn read(folder: &Path) -> Vec<(String, Vec<PathEnds>)> {
    let mut files: Vec<_> =
        std::fs::read_dir(folder).expect("the folder is there").filter_map(|e| Some(e.ok()?.path())).collect();
    files.sort();
    let point = |text: &str| {
        let (x, y) = text.split_once(',').expect("x,y");
        Point::new(x.parse().expect("a number"), y.parse().expect("a number"))
    };
    let ends = |line: &str| {
        let points: Vec<Point> = line.split_whitespace().map(point).collect();
        PathEnds { start: points[0], end: points[points.len() - 1] }
    };
    files
        .into_iter()
        .filter(|path| path.extension().is_some_and(|e| e == "txt"))
        .map(|path| {
            let text = std::fs::read_to_string(&path).expect("the file can be read");
            let name = path.file_stem().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
            (name, text.lines().filter(|line| !line.trim().is_empty()).map(ends).collect())
        })
        .collect()
}
