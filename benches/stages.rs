//! Every hot stage on its own: `cargo bench --bench stages`.

use divan::{Bencher, black_box};
use drypoint::drawing::{Drawing, Page};
use drypoint::field::{
    Curve, EdgeParameters, Sites, contours, detect_edges, detect_isophotes, distance_to_curves, nearest_seed, trace,
};
use drypoint::geometry::{Point, Rect, blue_noise_order};
use drypoint::order::{Direction, Effort, PathEnds, order};
use drypoint::raster::{Raster, Thresholds, bilateral, gaussian_blur, thin};
use drypoint::source::{Crop, Limits, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use drypoint::style::{Settings, Silent, find};
use drypoint::write::{SvgHead, write_svg};

fn main() {
    divan::main();
}

/// The astronaut at 900 x 900 working pixels, a hedcut of 90 x 90 mm at 0.6 mm.
fn portrait() -> Portrait {
    let bytes = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/samples/astronaut.jpg")).expect("the sample is there");
    let photograph = Photograph::decode(&bytes, Limits::default()).expect("the sample is sound");
    let placement = Placement::new(Rect::new(0.0, 0.0, 90.0, 90.0), 10.0);
    let page = Page::new(90.0, 90.0);
    Portrait::new(&photograph, Crop::all(&photograph), page, placement, ToneTarget::Lightness, ToneCurve::default())
        .expect("it fits")
}

fn drawing() -> Drawing {
    let style = find("hedcut").expect("the style is there");
    let settings = Settings::resolve("hedcut", style.parameters(), &[]).expect("defaults are sound");
    style.draw(&portrait(), &settings, 0, &Silent).expect("it draws")
}

/// Deterministic pseudo-random points.
fn points(count: usize, width: f64, height: f64) -> Vec<Point> {
    (1..=count)
        .map(|i| Point::new((i as f64 * 0.754_877_666).fract() * width, (i as f64 * 0.569_840_291).fract() * height))
        .collect()
}

#[divan::bench]
fn decode_and_resample(bencher: Bencher) {
    bencher.bench_local(|| black_box(portrait()));
}

#[divan::bench]
fn gaussian(bencher: Bencher) {
    let lightness = portrait().lightness;
    bencher.bench_local(|| gaussian_blur(black_box(&lightness), 6.0));
}

#[divan::bench]
fn bilateral_filter(bencher: Bencher) {
    let lightness = portrait().lightness;
    bencher.bench_local(|| bilateral(black_box(&lightness), 6.0, 0.08));
}

#[divan::bench]
fn edges(bencher: Bencher) {
    let lightness = portrait().lightness;
    let parameters =
        EdgeParameters { blur: 2.4, thresholds: Thresholds { low: 0.02, high: 0.05 }, least_length: 48.0, smoothing: 6.0 };
    bencher.bench_local(|| detect_edges(black_box(&lightness), parameters));
}

#[divan::bench]
fn isophotes(bencher: Bencher) {
    let lightness = portrait().lightness;
    bencher.bench_local(|| detect_isophotes(black_box(&lightness), 8, 3, 6.0, 48.0));
}

#[divan::bench]
fn tracing(bencher: Bencher) {
    let marked = portrait().lightness.map(|v| u8::from((v * 8.0).fract() < 0.1));
    let lines = thin(&marked);
    bencher.bench_local(|| trace(black_box(&lines)));
}

#[divan::bench]
fn distance(bencher: Bencher) {
    let curves: Vec<Curve> = contours(&gaussian_blur(&portrait().lightness, 4.0), 0.5);
    bencher.bench_local(|| distance_to_curves(black_box(&curves), 900, 900));
}

#[divan::bench]
fn voronoi_by_grid(bencher: Bencher) {
    let (sites, wanted) = (points(22_500, 900.0, 900.0), Raster::filled(900, 900, 1.0_f32));
    bencher.bench_local(|| Sites::new(black_box(&sites), 900.0, 900.0, 6.0).nearest(&wanted));
}

#[divan::bench]
fn voronoi_by_distance_transform(bencher: Bencher) {
    let mut marked = Raster::filled(900, 900, 0_u8);
    for p in points(22_500, 900.0, 900.0) {
        marked.set(p.x as usize, p.y as usize, 1);
    }
    bencher.bench_local(|| nearest_seed(black_box(&marked)));
}

#[divan::bench]
fn blue_noise(bencher: Bencher) {
    let points = points(20_000, 90.0, 90.0);
    bencher.bench_local(|| blue_noise_order(black_box(&points)));
}

#[divan::bench(sample_count = 10)]
fn hedcut(bencher: Bencher) {
    bencher.bench_local(|| black_box(drawing()));
}

#[divan::bench]
fn svg(bencher: Bencher) {
    let drawing = drawing();
    bencher.bench_local(|| write_svg(black_box(&drawing), &SvgHead::default(), &mut std::io::sink()));
}

#[divan::bench(args = [1_000, 10_000, 100_000], sample_count = 3)]
fn order_fast(bencher: Bencher, count: usize) {
    let ends: Vec<PathEnds> = points(count, 210.0, 297.0).into_iter().map(|p| PathEnds { start: p, end: p }).collect();
    bencher.bench_local(|| order(black_box(&ends), Point::ORIGIN, Effort::Fast, Direction::Either));
}
