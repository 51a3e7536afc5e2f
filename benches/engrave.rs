//! The cost of engraving, compared with the guarantees: `cargo bench --bench engrave`.
//!
//! Whole drawings on two threads, from decoded pictures to the drawing and to SVG; superpixels on one thread, compared with the
//! time of `OpenCV`'s SLIC for the same work on the machine where it was measured.

use drypoint::drawing::Page;
use drypoint::field::superpixels;
use drypoint::geometry::Rect;
use drypoint::raster::Raster;
use drypoint::source::{Crop, DepthSense, Limits, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use drypoint::style::{Settings, Silent, find};
use drypoint::write::{SvgHead, write_svg};
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma};
use std::io::Cursor;
use std::time::Instant;

/// `OpenCV`'s SLIC: 2048 x 2048, 32 px, 10 iterations, one thread, in seconds.
const OPENCV_SLIC: f64 = 1.43;

fn main() {
    let threads = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("threads start");
    let seconds = threads.install(|| least_of(3, engraving));
    line("1500 x 1500 depth to 200 x 200 mm, crossed", seconds, "at most 1.5 s", seconds <= 1.5);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread starts");
    let colours = Raster::from_fn(2048, 2048, |x, y| {
        let wave = |a: usize, b: usize| 50.0 + 40.0 * (a as f32 / 60.0).sin() * (b as f32 / 45.0).cos();
        [wave(x, y), 0.2 * wave(y, x), 0.3 * wave(x + y, x)]
    });
    let seconds = one.install(|| {
        least_of(3, || {
            assert!(superpixels(&colours, 32, 10.0, 10).pixels().iter().any(|l| *l > 1000));
        })
    });
    let ratio = seconds / OPENCV_SLIC;
    line("SLIC 2048 x 2048, 32 px, 10 rounds, 1 thread", seconds, "OpenCV took 1.43 s", seconds <= OPENCV_SLIC);
    line("  times OpenCV's", ratio, "at most 1", ratio <= 1.0);
}

/// The photograph and its depth, made once.
static FILES: std::sync::OnceLock<[Photograph; 2]> = std::sync::OnceLock::new();

fn engraving() {
    let bump = |x: u32, y: u32| {
        let (u, v) = (f64::from(x) / 750.0 - 1.0, f64::from(y) / 750.0 - 1.0);
        (1.0 - 0.4 * (u * u + v * v) + 0.05 * (9.0 * u).sin() * (7.0 * v).cos()).clamp(0.01, 1.0)
    };
    let [photograph, depth] = FILES.get_or_init(|| [picture(|x, y| 0.9 * bump(x, y).powi(3)), picture(bump)]);
    let style = find("engrave").expect("the style is there");
    let given = [("look".to_owned(), "crosshatch".to_owned())];
    let settings = Settings::resolve("engrave", style.parameters(), &given).expect("the settings are sound");
    let placement = Placement::new(Rect::new(0.0, 0.0, 200.0, 200.0), style.pixels_per_mm(&settings, &[]));
    let (page, crop) = (Page::new(200.0, 200.0), Crop::all(photograph));
    let started = Instant::now();
    let mut portrait =
        Portrait::new(photograph, crop, page, placement, ToneTarget::Lightness, ToneCurve::default()).expect("it fits");
    portrait.add_depth(depth, DepthSense::NearWhite, photograph, crop).expect("it fits");
    let read = started.elapsed().as_secs_f64();
    let drawing = style.draw(&portrait, &settings, 0, &Silent).expect("there is something to draw");
    let drawn = started.elapsed().as_secs_f64();
    let mut svg = Vec::new();
    write_svg(&drawing, &SvgHead::default(), &mut svg).expect("memory takes it");
    let written = started.elapsed().as_secs_f64();
    let counts =
        drawing.layers.iter().map(drypoint::drawing::Layer::counts).fold([0; 3], |s, c| [s[0] + c[0], s[1] + c[1], s[2] + c[2]]);
    println!(
        "  reading {read:.2} s, drawing {:.2} s, writing {:.2} s: {} strokes, {} dots, {} MB",
        drawn - read,
        written - drawn,
        counts[1],
        counts[0],
        svg.len() / 1_000_000
    );
}

fn picture(value: impl Fn(u32, u32) -> f64) -> Photograph {
    let pixels = ImageBuffer::from_fn(1500, 1500, |x, y| Luma([(value(x, y) * 65535.0) as u16]));
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::ImageLuma16(pixels).write_to(&mut bytes, ImageFormat::Png).expect("memory takes it");
    Photograph::decode(&bytes.into_inner(), Limits::default()).expect("it was just written")
}

/// The least wall time of several runs; also prints the processor time of each if the system reports it, which other work on the
/// machine affects less.
fn least_of(runs: usize, mut work: impl FnMut()) -> f64 {
    (0..runs)
        .map(|_| {
            let (started, used) = (Instant::now(), processor_seconds());
            work();
            if let (Some(before), Some(after)) = (used, processor_seconds()) {
                println!("  {:.2} s on the clock, {:.2} s of processor", started.elapsed().as_secs_f64(), after - before);
            }
            started.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}

/// User and system time of this process so far, from Linux's accounts (in hundredths of a second).
fn processor_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks: f64 = fields.get(11)?.parse::<f64>().ok()? + fields.get(12)?.parse::<f64>().ok()?;
    Some(0.01 * ticks)
}

fn line(what: &str, figure: f64, promise: &str, is_kept: bool) {
    println!("{what:46} {figure:8.2}   {promise}: {}", if is_kept { "kept" } else { "MISSED" });
}
