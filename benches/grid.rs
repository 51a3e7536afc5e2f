//! The structure grid compared with its guarantees: `cargo bench --bench grid`.
//!
//! Two threads, in one run: field, grid and primitives of a portrait at 450 x 590 working pixels and 6 pixels per pitch, with the
//! defaults; a plain implementation of the paper's update on one thread; the growth with the page's area; coherent lines on a
//! megapixel.

#[path = "../tests/common/fields.rs"]
mod fields;
#[path = "../tests/common/paper_stripes.rs"]
mod paper_stripes;

use drypoint::drawing::Page;
use drypoint::field::{LineParameters, coherent_lines, edge_tangent_flow, flow_lines};
use drypoint::geometry::{Point, Rect};
use drypoint::raster::Raster;
use drypoint::source::{Crop, Limits, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use drypoint::style::{Observer, Picture, Settings, find};
use std::hint::black_box;
use std::sync::Mutex;
use std::time::Instant;

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("two threads can be had");
    let ours = pool.install(|| at_best(5, || style_seconds(75.0, 590.0 / 6.0)));
    for (step, seconds) in &ours {
        println!("  {step:14} {seconds:.3} s");
    }
    let total: f64 =
        ours.iter().filter(|(step, _)| !["lines", "isophotes", "feature lines"].contains(&step.as_str())).map(|s| s.1).sum();
    line("field, grid and primitives, s", total, "at most 1.0 s", total <= 1.0);
    let paper = paper_seconds();
    println!("the paper's update, 5 rounds, both families, one thread: {paper:.2} s");
    let grid: f64 = ours.iter().filter(|(step, _)| ["stripes", "grid"].contains(&step.as_str())).map(|s| s.1).sum();
    line("  our whole work against it, times", paper / total, "at least 10", paper / total >= 10.0);
    println!("  stripes, lines and crossings alone, times {:>8.2}", paper / grid);
    let sum = |steps: &[(String, f64)]| steps.iter().map(|s| s.1).sum::<f64>();
    let small = pool.install(|| sum(&at_best(3, || style_seconds(90.0, 90.0))));
    let large = pool.install(|| sum(&at_best(3, || style_seconds(180.0, 180.0))));
    line("4 x the area costs times", large / small, "at most 4.5", large / small <= 4.5);
    let lines = pool.install(coherent_seconds);
    line("coherent lines, 1024 x 1024 px, s", lines, "at most 0.5 s", lines <= 0.5);
}

/// The run with the least total time.
fn at_best(runs: usize, run: impl Fn() -> Vec<(String, f64)>) -> Vec<(String, f64)> {
    let sum = |steps: &Vec<(String, f64)>| steps.iter().map(|s| s.1).sum::<f64>();
    (0..runs).map(|_| run()).min_by(|a, b| sum(a).total_cmp(&sum(b))).expect("at least one run")
}

/// When each step began.
#[derive(Default)]
struct PenTime(Mutex<Vec<(String, Instant)>>);

impl Observer for PenTime {
    fn begin(&self, step: &str) {
        self.0.lock().expect("no other thread fails").push((step.to_owned(), Instant::now()));
    }
    fn progress(&self, _: f64) {}
    fn picture(&self, _: &str, _: &dyn Fn() -> Picture) {}
    fn warn(&self, _: &str) {}
    fn is_interrupted(&self) -> bool {
        false
    }
}

/// The astronaut at a pitch of one millimetre and 6 pixels per pitch.
fn style_seconds(width: f64, height: f64) -> Vec<(String, f64)> {
    let bytes = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/samples/astronaut.jpg")).expect("the sample is there");
    let photograph = Photograph::decode(&bytes, Limits::default()).expect("the sample is sound");
    let placement = Placement::new(Rect::new(0.0, 0.0, width, height), 6.0);
    let page = Page::new(width, height);
    let portrait =
        Portrait::new(&photograph, Crop::all(&photograph), page, placement, ToneTarget::Lightness, ToneCurve::default())
            .expect("it fits");
    let style = find("grid").expect("the style is there");
    let given = [("pitch".to_owned(), "1".to_owned())];
    let settings = Settings::resolve("grid", style.parameters(), &given).expect("they are sound");
    let clock = PenTime::default();
    black_box(style.draw(&portrait, &settings, 0, &clock).expect("it draws"));
    let end = Instant::now();
    let begun = clock.0.into_inner().expect("no other thread fails");
    let ends = begun.iter().skip(1).map(|(_, at)| *at).chain([end]);
    begun.iter().zip(ends).map(|((step, from), to)| (step.clone(), (to - *from).as_secs_f64())).collect()
}

fn paper_seconds() -> f64 {
    let (size, centre) = ((450, 590), Point::new(225.3, 295.8));
    let (_, _, field) = fields::known_fields(centre).swap_remove(5);
    let started = Instant::now();
    for is_turned in [true, false] {
        let random = fields::noise(u64::from(is_turned));
        let start = Raster::from_fn(size.0, size.1, |x, y| 3.0 * random((y * size.0 + x) as u64));
        black_box(paper_stripes::paper_stripes(&start, &fields::unit_raster(&field, size, is_turned), 6, 6, 5));
    }
    started.elapsed().as_secs_f64()
}

fn coherent_seconds() -> f64 {
    let bytes = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/samples/astronaut.jpg")).expect("the sample is there");
    let photograph = Photograph::decode(&bytes, Limits::default()).expect("the sample is sound");
    let placement = Placement::new(Rect::new(0.0, 0.0, 1024.0, 1024.0), 1.0);
    let page = Page::new(1024.0, 1024.0);
    let grey = Portrait::new(&photograph, Crop::all(&photograph), page, placement, ToneTarget::Lightness, ToneCurve::default())
        .expect("it fits")
        .lightness;
    let kang = LineParameters { width: 1.0, length: 3.0, contrast: 0.99, threshold: 0.5, rounds: 3 };
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let started = Instant::now();
        let flow = edge_tangent_flow(&grey, 5, 3);
        let flow_seconds = started.elapsed().as_secs_f64();
        let found = flow_lines(&grey, &flow, kang);
        let seconds = started.elapsed().as_secs_f64();
        let curves = coherent_lines(&found, &grey, 3.0, 12.0).lines.len();
        println!(
            "  flow {flow_seconds:.3} s, lines {:.3} s, {curves} curves {:.3} s",
            seconds - flow_seconds,
            started.elapsed().as_secs_f64() - seconds
        );
        best = best.min(seconds);
    }
    best
}

fn line(what: &str, figure: f64, promise: &str, is_kept: bool) {
    println!("{what:36} {figure:8.3}   {promise}: {}", if is_kept { "kept" } else { "MISSED" });
}
