use super::*;
use crate::drawing::{Colour, Handling, Page};
use crate::plot::PenPaths;

fn line(points: &[(f64, f64)]) -> Toolpath {
    Toolpath::new(points.iter().map(|&p| p.into()).collect()).unwrap()
}

fn square(x: f64, y: f64) -> Toolpath {
    line(&[(x, y), (x + 1.0, y), (x + 1.0, y + 1.0), (x, y + 1.0), (x, y)])
}

fn length(paths: &[Toolpath]) -> f64 {
    paths.iter().map(Toolpath::length).sum()
}

const PLAIN: Sequence = Sequence {
    effort: Effort::Full,
    direction: Direction::Either,
    merge: 0.0,
    duplicates: Duplicates::Drop,
    seam: Seam::Nearest,
    course: Course::Forwards,
    start: None,
};

fn travel(paths: &[Toolpath], home: Point) -> f64 {
    paths.iter().fold((home, 0.0), |(at, sum), path| (path.ends().end, sum + at.distance(path.ends().start))).1
}

#[test]
fn loops_are_entered_where_the_pen_passes() {
    let squares: Vec<Toolpath> = (0..20).map(|i| square(3.0 * f64::from(i % 5), 3.0 * f64::from(i / 5))).collect();
    let free = in_order(squares.clone(), Point::ORIGIN, &PLAIN, &Interrupt::never());
    let fixed = in_order(squares.clone(), Point::ORIGIN, &Sequence { seam: Seam::Drawn, ..PLAIN }, &Interrupt::never());
    assert!((length(&free) - length(&squares)).abs() < 1e-9 && free.iter().all(Toolpath::is_closed));
    // The pen leaves each loop where it entered it, so only the travel across the outermost loops and the turns are saved.
    assert!(travel(&free, Point::ORIGIN) < 0.95 * travel(&fixed, Point::ORIGIN));
}

#[test]
fn groups_stay_together_as_they_stand() {
    let mut paths: Vec<Toolpath> = (0..40).map(|i| line(&[(f64::from(i * 7 % 40), 0.0), (f64::from(i * 7 % 40), 1.0)])).collect();
    for i in [3, 17, 30] {
        paths[i].group = Some(4);
    }
    let asked: Vec<Toolpath> = [3, 17, 30].map(|i| paths[i].clone()).to_vec();
    let drawn = in_order(paths, Point::ORIGIN, &Sequence { merge: 0.05, ..PLAIN }, &Interrupt::never());
    let first = drawn.iter().position(|path| path.group.is_some()).unwrap();
    assert_eq!(drawn[first..first + 3], asked[..]);
    assert_eq!(drawn.len(), 40);
}

#[test]
fn repeated_paths_go_and_neighbours_stay() {
    let turned = line(&[(1.0, 1.0), (1.0, 0.0), (0.0, 0.0), (0.0, 1.0), (1.0, 1.0)]);
    let hatch = [line(&[(0.0, 5.0), (9.0, 5.0)]), line(&[(9.0, 5.02), (0.0, 5.02)]), line(&[(9.0, 5.001), (0.0, 5.0)])];
    let paths: Vec<Toolpath> = [square(0.0, 0.0), turned].into_iter().chain(hatch).collect();
    let page = Page { width: 10.0, height: 10.0, paper: Colour { r: 255, g: 255, b: 255 } };
    let pen = PenPaths { number: 1, name: String::new(), colour: Colour::BLACK, nib: 0.3, handling: Handling::default(), paths };
    let mut plot = Plot { page, pens: vec![pen] };
    assert_eq!(plot.put_in_order(Point::ORIGIN, &PLAIN, &Interrupt::never()), Ok(2));
    assert_eq!(plot.pens[0].paths.len(), 3);
}

#[test]
fn heights_go_with_their_vertices() {
    let mut swelling = square(2.0, 2.0);
    swelling = swelling.with_heights(vec![0.0, 1.0, 2.0, 1.0, 0.0]).unwrap();
    let drawn = in_order(vec![swelling], Point::new(9.0, 9.0), &PLAIN, &Interrupt::never());
    assert_eq!(drawn[0].first(), Point::new(3.0, 3.0));
    assert_eq!(drawn[0].heights().unwrap(), [2.0, 1.0, 0.0, 1.0, 2.0]);
}

#[test]
fn a_stem_on_a_loop_is_drawn_with_it() {
    let paths = vec![square(0.0, 0.0), line(&[(-5.0, 0.4), (0.0, 0.4)])];
    let drawn = in_order(paths.clone(), Point::ORIGIN, &Sequence { merge: 0.05, ..PLAIN }, &Interrupt::never());
    assert_eq!(drawn.len(), 1);
    assert!((length(&drawn) - length(&paths)).abs() < 1e-9);
}

#[test]
fn seams_lie_where_they_are_asked_for() {
    let seam = |seam: Seam| seam.place(line(&[(1.0, 1.0), (5.0, 0.0), (6.0, 3.0), (0.0, 2.9), (1.0, 1.0)])).first();
    assert_eq!(seam(Seam::Top), Point::new(5.0, 0.0));
    assert_eq!(seam(Seam::Bottom), Point::new(6.0, 3.0));
    assert_eq!(seam(Seam::Left), Point::new(0.0, 2.9));
    assert_eq!(seam(Seam::Right), Point::new(6.0, 3.0));
    assert_eq!(seam(Seam::Corner), Point::new(0.0, 2.9));
    assert_eq!(seam(Seam::Drawn), Point::new(1.0, 1.0));
}

#[test]
fn courses_draw_the_same_paths() {
    let paths: Vec<Toolpath> = (0..30).map(|i| line(&[(f64::from(i * 7 % 30), 0.0), (f64::from(i * 7 % 30), 1.0)])).collect();
    let forwards = in_order(paths.clone(), Point::ORIGIN, &PLAIN, &Interrupt::never());
    let mut backwards =
        in_order(paths.clone(), Point::ORIGIN, &Sequence { course: Course::Backwards, ..PLAIN }, &Interrupt::never());
    backwards.reverse();
    assert_eq!(backwards.into_iter().map(Toolpath::reversed).collect::<Vec<_>>(), forwards);
    let shuffled =
        in_order(paths.clone(), Point::ORIGIN, &Sequence { course: Course::Shuffled(1), ..PLAIN }, &Interrupt::never());
    assert_ne!(shuffled, paths);
    assert!((length(&shuffled) - length(&paths)).abs() < 1e-9 && shuffled.len() == 30);
}
