//! A request to stop takes effect within a second, whatever the work.

use drypoint::drawing::{Area, Colour, Dot, Drawing, Handling, Ink, Layer, Mark, Mixing, Page, Stroke};
use drypoint::geometry::{BezPath, Point};
use drypoint::interrupt::{Interrupt, Interrupted};
use drypoint::order::Effort;
use drypoint::plot::{
    Hides, InkModel, Nibs, PenPaths, Plot, Profile, Sequence, Toolpath, coverage, delay_for_drying, lower, mount, occluded,
    report,
};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// One second, doubled for a machine that is busy with other tests.
const AT_ONCE: Duration = Duration::from_secs(2);

/// One test at a time: they share the threads of one pool, so one's work would wait for another's.
static ALONE: Mutex<()> = Mutex::new(());

/// Starts some work repeatedly, asks it to stop after each of these numbers of seconds and checks the limit. A run that finishes
/// before the request proves nothing; the first must not.
fn stops_at_once<T>(name: &str, moments: &[f64], mut work: impl FnMut(&Interrupt) -> Result<T, Interrupted>) {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    for (i, &moment) in moments.iter().enumerate() {
        let interrupt = Interrupt::new();
        let handle = interrupt.clone();
        let asked = std::thread::spawn(move || {
            std::thread::sleep(Duration::from_secs_f64(moment));
            handle.raise();
            Instant::now()
        });
        let is_stopped = work(&interrupt).is_err();
        let over = Instant::now();
        let late = over.saturating_duration_since(asked.join().unwrap());
        println!("{name}, asked after {moment} s: {:.3} s later", late.as_secs_f64());
        assert!(is_stopped || i > 0, "{name} was done before it was asked to stop");
        assert!(late < AT_ONCE, "{name}, asked after {moment} s: {late:?}");
    }
}

/// Points spread evenly over a page of 500 mm, without a pattern.
fn place(i: usize) -> Point {
    let share = |step: f64| (i as f64 * step).fract();
    Point::new(500.0 * share(0.754_877_666_246_69), 500.0 * share(0.569_840_290_998_05))
}

fn page_of(marks: Vec<Mark>) -> Drawing {
    Drawing { page: Page::new(500.0, 500.0), layers: vec![Layer { marks, ..Layer::new("marks", 1) }] }
}

fn touches(count: usize) -> Plot {
    plot_of((0..count).map(|i| Toolpath::touch(place(i))).collect())
}

fn plot_of(paths: Vec<Toolpath>) -> Plot {
    let (colour, handling) = (Colour::BLACK, Handling::default());
    let pen = PenPaths { number: 1, name: "dots".to_owned(), colour, nib: 0.3, handling, paths };
    Plot { page: Page::new(500.0, 500.0), pens: vec![pen] }
}

/// A comb of thin teeth, slow to fill.
fn comb(teeth: usize) -> BezPath {
    let mut path = BezPath::new();
    path.move_to((0.0, 0.0));
    for i in 0..teeth {
        let x = 500.0 * i as f64 / teeth as f64;
        path.line_to((x, 480.0 + 10.0 * place(i).x / 500.0));
        path.line_to((x + 250.0 / teeth as f64, 10.0));
    }
    path.line_to((500.0, 0.0));
    path.close_path();
    path
}

#[test]
fn an_order_of_a_million_dots_stops() {
    let sequence = Sequence { effort: Effort::Full, merge: 0.05, ..Sequence::default() };
    let dots = touches(1_000_000);
    // From the search for neighbours to the first kicks; about 6 s in, tiles are joined.
    stops_at_once("order", &[0.2, 1.0, 2.5, 5.0, 6.2, 9.0], |interrupt| {
        dots.clone().put_in_order(Point::ORIGIN, &sequence, interrupt)
    });
}

#[test]
fn lowering_of_a_large_area_stops() {
    let area = page_of(vec![Mark::Area(Area { outline: comb(1500), colour: None })]);
    stops_at_once("area", &[0.05, 0.3, 1.0, 2.5, 5.0, 9.0], |interrupt| {
        lower(&area, InkModel::Ink, &Nibs::all(0.1), 0.005, interrupt)
    });
}

#[test]
fn thinning_of_many_dots_stops() {
    let dots = page_of((0..1_000_000).map(|i| Mark::Dot(Dot::circle(place(i), 0.1))).collect());
    stops_at_once("dots", &[0.2, 2.0, 6.0], |interrupt| lower(&dots, InkModel::Ink, &Nibs::all(0.5), 0.02, interrupt));
}

#[test]
fn occlusion_of_many_marks_stops() {
    let line = |i: usize| {
        let mut curve = BezPath::new();
        curve.move_to(place(i));
        curve.line_to(place(7 * i + 3));
        Mark::Stroke(Stroke::even(curve, 0.3).with_colour(Some(Colour { r: (i % 251) as u8, g: 0, b: 0 })))
    };
    let mut drawing = page_of((0..40_000).map(line).collect());
    drawing.layers[0].mixing = Mixing::Paint;
    drawing.layers[0].ink = Ink::Colour(Colour::BLACK);
    stops_at_once("occlusion", &[0.5, 2.0], |interrupt| {
        occluded(&drawing, &drawing.painting_order(), Hides::OtherColours, interrupt)
    });
}

#[test]
fn measuring_a_million_dots_stops() {
    let dots = page_of((0..1_000_000).map(|i| Mark::Dot(Dot::circle(place(i), 0.3))).collect());
    let plot = touches(1_000_000);
    stops_at_once("coverage", &[0.1, 0.8], |interrupt| coverage(&dots, &plot, &Nibs::all(0.05), interrupt));
}

#[test]
fn the_clock_of_a_long_file_and_the_wait_for_ink_stop() {
    let lines = (0..400_000).map(|i| Toolpath::through(place(i), [place(i + 1), place(2 * i)])).collect();
    let plot = plot_of(lines);
    let profile = Profile::built_in("grbl-servo").unwrap();
    let mounting = mount(&profile, &Page::new(200.0, 200.0)).unwrap();
    stops_at_once("clock", &[0.02, 0.2], |interrupt| report(&plot, Point::ORIGIN, Some((&profile, &mounting)), None, interrupt));
    stops_at_once("drying", &[0.3, 2.0], |interrupt| {
        delay_for_drying(&mut plot.clone(), 600.0, Point::ORIGIN, &profile.motion, interrupt)
    });
}
