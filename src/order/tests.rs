//! Properties of any order, for any paths.

use kurbo::Point;
use proptest::prelude::*;

use super::greedy::greedy_tour;
use super::kicks::kick;
use super::lin_kernighan::LinKernighan;
use super::neighbours::Neighbours;
use super::one_way::OneWay;
use super::random::SplitMix;
use super::rearrangement::Rearrangement;
use super::rings::Rings;
use super::sites::{Sites, numbering};
use super::tour::Tour;
use super::workpiece::Workpiece;
use super::{Direction, Effort, NEIGHBOURS, PathEnds, Stop, Visit, order, pen_up_length};
use crate::interrupt::Interrupt;

const HOME: Point = Point::ZERO;

fn point() -> impl Strategy<Value = Point> {
    // Whole numbers now and then, so that points coincide and distances tie.
    prop_oneof![
        (0..6, 0..6).prop_map(|(x, y)| Point::new(f64::from(x), f64::from(y))),
        (0.0..100.0, 0.0..100.0).prop_map(|(x, y)| Point::new(x, y)),
    ]
}

fn paths(most: usize) -> impl Strategy<Value = Vec<PathEnds>> {
    prop::collection::vec((point(), point()).prop_map(|(start, end)| PathEnds { start, end }), 0..most)
}

fn direction() -> impl Strategy<Value = Direction> {
    prop_oneof![Just(Direction::Either), Just(Direction::AsDrawn)]
}

/// `count` dots or lines at reproducible random places on a square of 100 mm.
fn scattered(count: usize, length: f64) -> Vec<PathEnds> {
    let mut random = SplitMix::new(count as u64);
    let mut millimetres = |most: f64| random.below(1 << 30) as f64 / f64::from(1 << 30) * most;
    let mut path = || {
        let start = Point::new(millimetres(100.0), millimetres(100.0));
        PathEnds { start, end: start + (millimetres(length), millimetres(length)) }
    };
    (0..count).map(|_| path()).collect()
}

fn is_permutation(visits: &[Visit], count: usize) -> bool {
    let mut paths: Vec<usize> = visits.iter().map(|visit| visit.path).collect();
    paths.sort_unstable();
    paths.into_iter().eq(0..count)
}

fn length(paths: &[PathEnds], effort: Effort, direction: Direction) -> f64 {
    pen_up_length(paths, &order(paths, HOME, effort, direction), HOME)
}

/// The shortest length of all orders and directions.
fn optimum(paths: &[PathEnds], pen: Point, left: &[usize], direction: Direction) -> f64 {
    if left.is_empty() {
        return 0.0;
    }
    let rest = |path: usize| -> Vec<usize> { left.iter().copied().filter(|&other| other != path).collect() };
    let via = |path: usize, from: Point, to: Point| pen.distance(from) + optimum(paths, to, &rest(path), direction);
    let ways = left.iter().flat_map(|&path| {
        let PathEnds { start, end } = paths[path];
        let backwards = if direction == Direction::Either { via(path, end, start) } else { f64::INFINITY };
        [via(path, start, end), backwards]
    });
    ways.fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_path_is_visited_once(paths in paths(300), direction in direction()) {
        let visits = order(&paths, HOME, Effort::Fast, direction);
        prop_assert!(is_permutation(&visits, paths.len()));
    }

    #[test]
    fn as_drawn_reverses_nothing(paths in paths(200)) {
        let visits = order(&paths, HOME, Effort::Fast, Direction::AsDrawn);
        prop_assert!(visits.iter().all(|visit| !visit.reversed));
    }

    #[test]
    fn pen_up_length_is_the_sum_of_the_gaps(paths in paths(50)) {
        let visits = order(&paths, HOME, Effort::Fast, Direction::Either);
        let ends = visits.iter().flat_map(|visit| {
            let PathEnds { start, end } = paths[visit.path];
            if visit.reversed { [end, start] } else { [start, end] }
        });
        let stops: Vec<Point> = std::iter::once(HOME).chain(ends).collect();
        let sum: f64 = stops.chunks_exact(2).map(|gap| gap[0].distance(gap[1])).sum();
        prop_assert!((pen_up_length(&paths, &visits, HOME) - sum).abs() <= 1e-9 * (1.0 + sum));
    }

}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn more_effort_is_never_worse(paths in paths(60), direction in direction()) {
        let by_effort = [Effort::None, Effort::Fast, Effort::Full].map(|effort| length(&paths, effort, direction));
        prop_assert!(by_effort.is_sorted_by(|a, b| a >= b), "{by_effort:?}");
    }

    #[test]
    fn a_few_paths_are_ordered_optimally(paths in paths(6), direction in direction()) {
        let all: Vec<usize> = (0..paths.len()).collect();
        let optimum = optimum(&paths, HOME, &all, direction);
        let found = length(&paths, Effort::Full, direction);
        prop_assert!(found <= optimum + 1e-9 * (1.0 + optimum), "{found} instead of {optimum}");
    }
}

#[test]
fn degenerate_input_is_ordered() {
    let dot = |x: f64, y: f64| PathEnds { start: Point::new(x, y), end: Point::new(x, y) };
    let inputs = [
        vec![],
        vec![dot(1.0, 2.0)],
        vec![dot(1.0, 2.0), dot(-1.0, 2.0)],
        vec![dot(3.0, 3.0); 2000],
        vec![PathEnds { start: Point::new(0.0, 0.0), end: Point::new(5.0, 0.0) }; 2000],
        (0..500).map(|i| dot(f64::from(i % 7), 0.0)).collect(),
        vec![dot(f64::MAX, f64::MIN), dot(f64::MIN, f64::MAX), dot(1e300, 0.0), dot(0.0, 0.0)],
        (0..100).map(|i| dot(1e15 + f64::from(i), 1e-15)).collect(),
    ];
    for paths in inputs {
        for direction in [Direction::Either, Direction::AsDrawn] {
            for effort in [Effort::None, Effort::Fast] {
                assert!(is_permutation(&order(&paths, HOME, effort, direction), paths.len()));
            }
        }
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let paths = scattered(12_000, 3.0);
    let on_threads = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a small pool");
        pool.install(|| order(&paths, HOME, Effort::Fast, Direction::Either))
    };
    assert_eq!(on_threads(1), on_threads(3));
}

#[test]
fn dots_come_close_to_the_expected_optimum() {
    let paths = scattered(2000, 0.0);
    // The limit for many uniform dots, 0.7124 sqrt(n area), with an allowance for the rim.
    let expected = 0.7124 * (2000.0_f64 * 100.0 * 100.0).sqrt() * 1.04;
    assert!(length(&paths, Effort::Fast, Direction::Either) < 1.06 * expected);
    assert!(length(&paths, Effort::None, Direction::Either) > 10.0 * expected);
}

#[test]
fn gains_add_up_to_the_difference_in_length() {
    for direction in [Direction::Either, Direction::AsDrawn] {
        let stops: Vec<Stop> = scattered(400, 5.0).into_iter().map(|ends| Stop::new(ends, direction)).collect();
        let numbering = numbering(&stops);
        let sites = Sites::new(&stops, &numbering, HOME, &Interrupt::never());
        let neighbours = Neighbours::new(&sites, NEIGHBOURS);
        let first = Tour::new(greedy_tour(&sites, &neighbours));
        let all: Vec<u32> = (0..sites.end_count() as u32).collect();
        let mut search = LinKernighan::new(&sites, &neighbours, first);
        let before = search.length_at(&all);
        for &end in &all {
            search.look_at(end);
        }
        let mut gained = search.improve(LinKernighan::keep);
        gained += kick(&mut search, 2000, &mut SplitMix::new(1));
        let after = search.length_at(&all);
        assert!(gained > 0.0 && (before - after - gained).abs() < 1e-9 * before, "{before} - {after} is not {gained}");
    }
}

#[test]
fn changes_are_taken_back() {
    let entries: Vec<u32> = (0..50).map(|path| 2 * path + path % 2).collect();
    let mut tour = Tour::new(entries.clone());
    for cuts in [[0, 3, 4, 9], [7, 10, 11, 16], [3, 30, 44, 49], [0, 1, 2, 48]] {
        tour.rearrange(&Rearrangement::reverse_order(50, cuts));
    }
    assert_ne!(tour.entries_from(entries[0]), entries);
    tour.take_back();
    assert_eq!(tour.entries_from(entries[0]), entries);
}

#[test]
fn exchanges_that_leave_several_rings_are_refused() {
    let tour = Tour::new((0..10).map(|path| 2 * path).collect());
    // Cut 1|2 and 5|6. Joining the entry of 2 with the exit of 5 makes a ring of them; with the entry of 6, it turns them round.
    let free = OneWay::new(Vec::new());
    assert!(Rearrangement::new(&tour, &[3, 4, 11, 12], &free).is_none());
    let reversal = Rearrangement::new(&tour, &[3, 4, 12, 11], &free);
    assert!(reversal.is_some_and(|new| { new.moved().all(|segment| segment.reversed && segment.len == 4) }));
}

#[test]
fn rings_are_joined_to_one_tour() {
    let stops: Vec<Stop> = scattered(300, 2.0).into_iter().map(|ends| Stop::new(ends, Direction::Either)).collect();
    let numbering = numbering(&stops);
    let sites = Sites::new(&stops, &numbering, HOME, &Interrupt::never());
    let neighbours = Neighbours::new(&sites, NEIGHBOURS);
    let tour = Tour::new(greedy_tour(&sites, &neighbours));
    // Close the seats 10 to 19, 40 to 89 and 100 alone to rings, and the rest over the gaps.
    let close = |first, last| [[tour.entry(first), tour.entry(last) ^ 1], [tour.entry(first - 1) ^ 1, tour.entry(last + 1)]];
    let links = [close(10, 19), close(40, 89), close(100, 100)].concat();
    let (joined, joints) = Rings::with(&tour, links.into_iter()).joined(&sites, &neighbours);
    let paths: std::collections::BTreeSet<u32> = joined.entries_from(0).into_iter().map(|entry| entry >> 1).collect();
    assert_eq!((joined.len(), paths.len(), joints.len()), (301, 301, 3 * 4));
}

#[test]
fn one_way_paths_among_others_keep_their_direction_in_every_tile() {
    // Dots may be entered from either side. On one half of the paper there are lines alone, so that a tile may hold nothing else.
    let shifted = |paths: Vec<PathEnds>, by: f64| -> Vec<PathEnds> {
        paths.into_iter().map(|PathEnds { start, end }| PathEnds { start: start + (by, 0.0), end: end + (by, 0.0) }).collect()
    };
    let paths = [shifted(scattered(6000, 3.0), 0.0), shifted(scattered(6100, 0.0), 100.0)].concat();
    let stops: Vec<Stop> = paths.iter().map(|ends| Stop::new(*ends, Direction::AsDrawn)).collect();
    let numbering = numbering(&stops);
    let sites = Sites::new(&stops, &numbering, HOME, &Interrupt::never());
    let neighbours = Neighbours::new(&sites, NEIGHBOURS);
    let tour = Tour::new(greedy_tour(&sites, &neighbours));
    let mut work = Workpiece { sites, neighbours, tour };
    work.settle();
    work.kick(1.0, 0);
    let entries = work.tour.entries_from(work.sites.free_end());
    assert_eq!(entries.len(), 12_101);
    assert!(entries.into_iter().all(|entry| entry & 1 == 0 || !work.sites.one_way().contains(entry as usize >> 1)));
}

#[test]
fn a_good_order_is_kept() {
    let line: Vec<PathEnds> =
        (0..200).map(|i| PathEnds { start: Point::new(f64::from(i), 0.0), end: Point::new(f64::from(i), 0.5) }).collect();
    let once = order(&line, HOME, Effort::Full, Direction::Either);
    let turned = |visit: &Visit| {
        let PathEnds { start, end } = line[visit.path];
        if visit.reversed { PathEnds { start: end, end: start } } else { PathEnds { start, end } }
    };
    let given: Vec<PathEnds> = once.iter().map(turned).collect();
    assert!(length(&given, Effort::Fast, Direction::Either) <= length(&given, Effort::None, Direction::Either));
}
