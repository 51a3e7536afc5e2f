//! Properties of chains and of paths without repetitions.

use kurbo::Point;
use proptest::prelude::*;

use crate::interrupt::Interrupt;
use crate::order::Direction;
use crate::plot::Toolpath;

fn toolpaths(lines: Vec<Vec<Point>>) -> Vec<Toolpath> {
    lines.into_iter().filter_map(Toolpath::new).collect()
}

fn chain(lines: Vec<Vec<Point>>, tolerance: f64, direction: Direction) -> Vec<Vec<Point>> {
    super::chain(toolpaths(lines), tolerance, direction, &Interrupt::never())
        .into_iter()
        .map(|path| path.points().to_vec())
        .collect()
}

fn drop_duplicates(lines: Vec<Vec<Point>>, tolerance: f64) -> Vec<Vec<Point>> {
    super::drop_duplicates(toolpaths(lines), tolerance, &Interrupt::never())
        .into_iter()
        .map(|path| path.points().to_vec())
        .collect()
}

fn point() -> impl Strategy<Value = Point> {
    // Whole numbers now and then, so that points coincide and distances tie.
    prop_oneof![
        (0..6, 0..6).prop_map(|(x, y)| Point::new(f64::from(x), f64::from(y))),
        (0.0..100.0, 0.0..100.0).prop_map(|(x, y)| Point::new(x, y)),
    ]
}

fn polylines() -> impl Strategy<Value = Vec<Vec<Point>>> {
    prop::collection::vec(prop::collection::vec(point(), 1..5), 0..30)
}

fn are_close<'a>(a: impl ExactSizeIterator<Item = &'a Point>, b: &[Point]) -> bool {
    a.len() == b.len() && a.zip(b).all(|(p, q)| p.distance(*q) <= 0.01)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn chains_keep_all_ink_and_meet_no_more(lines in polylines()) {
        let chains = chain(lines.clone(), 0.0, Direction::Either);
        let ink = |paths: &[Vec<Point>]| -> f64 { paths.iter().flat_map(|path| path.windows(2)).map(|gap| gap[0].distance(gap[1])).sum() };
        prop_assert!((ink(&lines) - ink(&chains)).abs() < 1e-6);
        prop_assert!(chains.len() <= lines.len());
    }

    #[test]
    fn duplicates_go_and_nothing_else(lines in polylines(), again in any::<prop::sample::Index>()) {
        let once = drop_duplicates(lines.clone(), 0.01);
        prop_assert_eq!(&drop_duplicates(once.clone(), 0.01), &once);
        let is_closed = |line: &Vec<Point>| line.len() > 2 && line.first() == line.last();
        let is_kept = |line: &Vec<Point>| {
            is_closed(line) || once.iter().any(|kept| are_close(kept.iter(), line) || are_close(kept.iter().rev(), line))
        };
        prop_assert!(lines.iter().all(is_kept));
        if !lines.is_empty() {
            let mut more = lines.clone();
            let mut copy = again.get(&lines).clone();
            copy.reverse();
            for p in &mut copy {
                *p += (0.004, -0.004);
            }
            more.push(copy);
            prop_assert_eq!(drop_duplicates(more, 0.01), once);
        }
    }
}

#[test]
fn neighbouring_hatch_lines_stay_apart() {
    let line = |x0: f64, x1: f64, y: f64| vec![Point::new(x0, y), Point::new(x1, y)];
    let hatch = vec![line(0.0, 10.0, 0.0), line(10.0, 0.0, 0.04), line(0.0, 10.0, 0.08)];
    assert_eq!(chain(hatch.clone(), 0.05, Direction::Either), hatch);
    let broken = vec![line(0.0, 10.0, 0.0), line(20.0, 10.03, 0.0)];
    assert_eq!(chain(broken, 0.05, Direction::Either), [[0.0, 10.0, 10.03, 20.0].map(|x| Point::new(x, 0.0))]);
}

#[test]
fn four_sides_make_a_square_and_dots_stay_dots() {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(Point::from);
    let sides = vec![
        vec![corners[0], corners[1]],
        vec![corners[2], corners[1]],
        vec![corners[2], corners[3]],
        vec![corners[0], corners[3]],
    ];
    assert_eq!(chain(sides, 0.01, Direction::Either), [[corners[0], corners[1], corners[2], corners[3], corners[0]]]);
    let dots: Vec<Vec<Point>> = (0..5).map(|i| vec![Point::new(f64::from(i) * 0.001, 0.0); 2]).collect();
    assert_eq!(chain(dots.clone(), 0.01, Direction::Either), dots);
}

#[test]
fn a_crossroads_is_gone_straight_over() {
    let arm = |x: f64, y: f64| vec![Point::new(x, y), Point::ZERO];
    let chains = chain(vec![arm(1.0, 0.0), arm(0.0, 1.0), arm(-1.0, 0.0), arm(0.0, -1.0)], 0.0, Direction::Either);
    assert_eq!(
        chains,
        [[(1.0, 0.0), (0.0, 0.0), (-1.0, 0.0)].map(Point::from), [(0.0, 1.0), (0.0, 0.0), (0.0, -1.0)].map(Point::from)]
    );
}
