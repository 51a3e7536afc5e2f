//! Hand-worked times of short ways.

use super::*;
use crate::elementary::Elementary as _;
use crate::plot::profile::Planner;

const MOTION: Motion = Motion {
    draw_speed: 50.0,
    draw_speed_limit: None,
    travel_speed: 100.0,
    travel_speed_limit: None,
    acceleration: 250.0,
    travel_acceleration: None,
    junction_deviation: Some(0.01),
    corner_factor: None,
    pen_up_seconds: 0.15,
    pen_down_seconds: 0.2,
    touch_seconds: 0.0,
    planner: Planner {
        block_buffer: None,
        limits: Limits::Path,
        axis_speed: None,
        axis_acceleration: None,
        z_speed: None,
        z_acceleration: None,
        steps_per_mm: None,
        arc_tolerance: None,
        segment_seconds: None,
        dwell_step_seconds: 0.0,
    },
};

fn time(motion: &Motion, places: &[[f64; 2]]) -> f64 {
    let mut planner = LookAhead::new(motion, 1);
    for [x, y] in places {
        planner.line([*x, *y, 0.0], 50.0, 0);
    }
    planner.rest();
    planner.seconds()[0]
}

fn with_planner(planner: Planner) -> Motion {
    Motion { planner, ..MOTION }
}

#[test]
fn a_long_line_is_a_trapezoid_and_a_short_one_a_triangle() {
    assert!((time(&MOTION, &[[100.0, 0.0]]) - (100.0 / 50.0 + 50.0 / 250.0)).abs() < 1e-9);
    assert!((time(&MOTION, &[[1.0, 0.0]]) - 2.0 * (1.0_f64 / 250.0).sqrt()).abs() < 1e-9);
}

#[test]
fn points_on_a_straight_line_cost_nothing_and_a_reversal_stops() {
    let whole = time(&MOTION, &[[100.0, 0.0]]);
    let straight: Vec<[f64; 2]> = (1..=100).map(|i| [f64::from(i), 0.0]).collect();
    assert!((time(&MOTION, &straight) - whole).abs() < 1e-6);
    assert!((time(&MOTION, &[[100.0, 0.0], [0.0, 0.0]]) - 2.0 * whole).abs() < 1e-9);
}

#[test]
fn a_short_buffer_never_runs_faster_than_it_can_stop() {
    // 14 blocks of 0.1 mm are known: the speed settles where 1.4 mm suffice to stop.
    let fine: Vec<[f64; 2]> = (1..=3000).map(|i| [0.1 * f64::from(i), 0.0]).collect();
    let limited = with_planner(Planner { block_buffer: Some(16), ..Planner::default() });
    let settled = (2.0 * 250.0 * 1.4_f64).sqrt();
    assert!((time(&limited, &fine) / (300.0 / settled) - 1.0).abs() < 0.02, "{}", time(&limited, &fine));
    assert!(time(&MOTION, &fine) < 0.6 * time(&limited, &fine));
}

#[test]
fn settled_blocks_are_timed_early_without_a_difference() {
    let wave: Vec<[f64; 2]> = (1..=40_000).map(|i| [0.05 * f64::from(i), (0.02 * f64::from(i)).sine()]).collect();
    let limited = with_planner(Planner { block_buffer: Some(16), ..Planner::default() });
    let mut whole = LookAhead::new(&limited, 1);
    let mut from = [0.0; 3];
    // The same in pieces that never fill the kept blocks, each run with all known blocks behind it.
    for [x, y] in &wave {
        from = [*x, *y, 0.0];
        whole.line(from, 50.0, 0);
        if whole.blocks.len() > 100 {
            whole.run(whole.blocks.len() - 15);
        }
    }
    whole.rest();
    assert!(from[0] > 0.0 && (whole.seconds()[0] - time(&limited, &wave)).abs() < 1e-6);
}

#[test]
fn a_diagonal_is_faster_where_limits_are_the_axes_own() {
    let axes = with_planner(Planner { limits: Limits::Axis, ..Planner::default() });
    let travel = |motion: &Motion, to: [f64; 3]| {
        let mut planner = LookAhead::new(motion, 1);
        planner.travel(to, f64::INFINITY.min(if motion == &axes { f64::INFINITY } else { 100.0 }), 0);
        planner.rest();
        planner.seconds()[0]
    };
    let along = travel(&axes, [100.0, 0.0, 0.0]);
    assert!((travel(&axes, [100.0, 100.0, 0.0]) - along).abs() < 1e-9);
    assert!(travel(&MOTION, [100.0, 100.0, 0.0]) > along);
    let slow_z = with_planner(Planner { axis_speed: Some([100.0, 100.0, 5.0]), ..axes.planner });
    assert!((travel(&slow_z, [0.0, 0.0, 5.0]) - (1.0 + 5.0 / 250.0)).abs() < 1e-9);
    // GRBL's 500 mm/min is the default, and settings of z alone take precedence.
    let usual = 500.0 / 60.0;
    assert!((travel(&axes, [0.0, 0.0, 5.0]) - (5.0 / usual + usual / 250.0)).abs() < 1e-9);
    let own = with_planner(Planner { z_speed: Some(4.0), z_acceleration: Some(10.0), ..slow_z.planner });
    assert!((travel(&own, [0.0, 0.0, 8.0]) - (2.0 + 4.0 / 10.0)).abs() < 1e-9);
    // A combined move is no faster than the slower axis allows.
    let leg = (8.0_f64 * 8.0 + 6.0 * 6.0).sqrt() / 8.0;
    assert!((travel(&own, [6.0, 0.0, 8.0]) - (8.0 * leg / (4.0 * leg) + 4.0 / 10.0)).abs() < 1e-9);
}

#[test]
fn a_start_from_rest_counts_its_first_way_twice_where_it_ends_in_the_second_hundredth() {
    let grbl = with_planner(Planner {
        limits: Limits::Axis,
        steps_per_mm: Some([80.0, 80.0, 400.0]),
        segment_seconds: Some(0.01),
        ..Planner::default()
    });
    let lost = |mm: f64| time(&grbl, &[[mm, 0.0]]) - 2.0 * (mm / 250.0).sqrt();
    // 0.05 mm is half up, half down: the ramp lasts 14.1 ms and ends at 3.54 mm/s, 0.0125 mm and 2.5 mm/s were there at 10 ms.
    assert!((lost(0.05) - 2.0 * 0.0125 / (2.5 + (250.0_f64 * 0.05).sqrt())).abs() < 1e-9, "{}", lost(0.05));
    // Shorter than a segment, or longer than two.
    assert!(lost(0.0125).abs() < 1e-9 && lost(0.5).abs() < 1e-9);
}

#[test]
fn a_corner_factor_is_a_deviation_in_5000ths_of_an_inch() {
    let driver = Motion { junction_deviation: None, corner_factor: Some(10.0), ..MOTION };
    assert!((driver.corner_deviation() - 0.0508).abs() < 1e-12);
    let corner = [[20.0, 0.0], [20.0, 20.0]];
    assert!(time(&driver, &corner) < time(&MOTION, &corner));
}
