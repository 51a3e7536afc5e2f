//! The cost of painting with Glass patterns, compared with the guarantees: `cargo bench --bench glass`.
//!
//! The minimum of several runs on two threads; other work on the machine affects the figures.

use drypoint::drawing::Page;
use drypoint::field::{Flow, GlassLevels, RibbonFit, glass_pattern, glass_ribbons};
use drypoint::geometry::{Rect, Vec2};
use drypoint::raster::{Raster, edge_preserving, fast_gaussian, gaussian_blur};
use drypoint::source::{Crop, Limits, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use drypoint::style::{Settings, Silent, find};
use drypoint::write::{SvgHead, write_svg};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::time::Instant;

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(2).build_global().expect("the pool is made once");
    let size = 1024;
    let noise = fast_gaussian(&white(size), 0.7);
    let flow = Flow::from_fn(size, size, |p| Vec2::new((p.y / 40.0).sin() + 0.3, (p.x / 55.0).cos()));
    let pattern = least(3, || glass_pattern(&noise, &flow, 18.0));
    line("pattern, 1024 x 1024 px, a = 18, s", pattern, "at most 0.3 s", pattern <= 0.3);

    let raster = glass_pattern(&noise, &flow, 18.0);
    let levels = GlassLevels::new(&raster, 3);
    let ribbons = least(3, || glass_ribbons(&noise, &raster, &flow, 18.0, RibbonFit::Brush, |height| levels.of(height)));
    println!("{:44} {ribbons:8.3}", "  its ribbons at three levels, s");

    let photo = photograph();
    let painting = least(3, || painted(&photo));
    line("painting of 200 x 200 mm, written, s", painting, "at most 3 s", painting <= 3.0);

    let planes = [white(size).map(|v| 0.5 + 0.1 * v)];
    let costs: Vec<f64> = [3.0, 6.0, 12.0, 24.0].map(|sigma| least(3, || edge_preserving(&planes, sigma, 4.0))).to_vec();
    println!("{:44} {costs:8.3?}", "smoothing, 1024 x 1024 px, sigma 3, 6, 12, 24");
    let ratio = costs[3] / costs[0];
    line("  sigma 24 over sigma 3", ratio, "no growth (at most 1.25)", ratio <= 1.25);
    let plain = least(2, || gaussian_blur(&planes[0], 12.0)) / least(3, || fast_gaussian(&planes[0], 12.0));
    println!("{:44} {plain:8.2}", "plain Gaussian over the fast one, sigma 12");
}

fn white(size: usize) -> Raster<f32> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    Raster::from_vec(size, size, (0..size * size).map(|_| (0..4).map(|_| random.random::<f32>()).sum::<f32>() - 2.0).collect())
}

fn photograph() -> Vec<u8> {
    std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/samples/astronaut.jpg")).expect("the sample is there")
}

/// From the photograph's bytes to the painting's.
fn painted(photo: &[u8]) -> usize {
    let style = find("glass").expect("the style is there");
    let settings = Settings::resolve("glass", style.parameters(), &[]).expect("defaults are sound");
    let photograph = Photograph::decode(photo, Limits::default()).expect("the sample is sound");
    let placement = Placement::new(Rect::new(0.0, 0.0, 200.0, 200.0), style.pixels_per_mm(&settings, &[]));
    let page = Page::new(200.0, 200.0);
    let crop = Crop::all(&photograph);
    let portrait =
        Portrait::new(&photograph, crop, page, placement, ToneTarget::Lightness, ToneCurve::default()).expect("it has pixels");
    let drawing = style.draw(&portrait, &settings, 0, &Silent).expect("there is something to draw");
    let mut bytes = Vec::new();
    write_svg(&drawing, &SvgHead::default(), &mut bytes).expect("memory takes all");
    bytes.len()
}

fn least<T>(runs: usize, mut work: impl FnMut() -> T) -> f64 {
    (0..runs)
        .map(|_| {
            let started = Instant::now();
            std::hint::black_box(work());
            started.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}

fn line(what: &str, figure: f64, promise: &str, is_kept: bool) {
    println!("{what:44} {figure:8.3}   {promise}: {}", if is_kept { "kept" } else { "MISSED" });
}
