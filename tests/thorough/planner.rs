//! The estimated time comes true: compared with a step-by-step simulation of a machine with GRBL 1.1.
//!
//! The difference on drawings, 0.1 to 0.2 %, is mostly the firmware's own rounding: a stop that falls on the end of a segment may
//! make the last step up to 33 ms late (the column `late`). See `a_stop_on_the_end_of_a_segment_is_late`.
#![cfg(feature = "cli")]

mod rules;

use crate::common;
use crate::grbl;
use crate::machine_file;

use common::{Sheet, sample};
use drypoint::drawing::{Colour, Handling, Page};
use drypoint::geometry::Point;
use drypoint::interrupt::Interrupt;
use drypoint::order::{Direction, Effort};
use drypoint::plot::{InkModel, Nibs, PenPaths, PenTime, Plot, Profile, Toolpath, built_in, clock, lower, mount};
use grbl::{Elapsed, Laser, SERVO, Settings, Z, run};
use machine_file::written;
use std::f64::consts::TAU;
use std::process::Command;

/// The profile, with some of its text replaced.
fn profile(changes: &[(&str, &str)]) -> Profile {
    let text = changes.iter().fold(built_in("grbl-servo").unwrap().to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "the profile has no {from}");
        text.replace(from, to)
    });
    Profile::parse("grbl-servo", &text).unwrap()
}

/// Told and simulated seconds of a plot: motion without waits, and the total.
fn compare(name: &str, plot: &Plot, profile: &Profile, settings: &Settings) -> [f64; 2] {
    let mounting = mount(profile, &plot.page).unwrap();
    let clocks = clock(plot, profile, &mounting, &Interrupt::never()).unwrap();
    let motion: f64 = clocks.iter().map(PenTime::motion).sum();
    let total: f64 = clocks.iter().map(PenTime::total).sum();
    let machine: Elapsed = run(&written(plot, profile).unwrap(), settings);
    let waiting: f64 = clocks.iter().map(|c| c.waiting).sum();
    assert!((waiting - machine.dwell).abs() < 1e-3 * (1.0 + machine.dwell), "{name}: waits {waiting} s for {} s", machine.dwell);
    let error = |told: f64, true_one: f64| 100.0 * (told / true_one - 1.0);
    let (motion_error, total_error) = (error(motion, machine.motion), error(total, machine.total()));
    println!(
        "{name:34} {:10.2} {motion:10.2} {motion_error:+8.3} % {:10.2} {total:10.2} {total_error:+8.3} % {:8.3}",
        machine.motion,
        machine.total(),
        machine.late
    );
    [motion_error.abs(), total_error.abs()]
}

fn heading() {
    println!(
        "{:34} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10} {:>8}",
        "seconds", "motion", "told", "", "total", "told", "", "late"
    );
}

fn one_pen(paths: Vec<Vec<[f64; 2]>>) -> Plot {
    let paths = paths
        .into_iter()
        .filter_map(|points| Toolpath::new(points.into_iter().map(|[x, y]| Point::new(x, y)).collect()))
        .collect();
    let pen =
        PenPaths { number: 1, name: "lines".to_owned(), colour: Colour::BLACK, nib: 0.3, handling: Handling::default(), paths };
    Plot { page: Page::new(200.0, 200.0), pens: vec![pen] }
}

/// A circle about the middle of the page in chords of this length, starting at a direction in radians.
fn circle_from(from: f64, radius: f64, chord: f64) -> Vec<[f64; 2]> {
    let count = (TAU * radius / chord).ceil() as u32;
    let place = |i: u32| (from + TAU * f64::from(i) / f64::from(count)).sin_cos();
    (0..=count).map(place).map(|(sin, cos)| [100.0 + radius * cos, 100.0 + radius * sin]).collect()
}

fn circle(radius: f64, chord: f64) -> Vec<[f64; 2]> {
    circle_from(0.3, radius, chord)
}

fn spiral(pitch: f64, chord: f64, radius: f64) -> Vec<[f64; 2]> {
    let mut angle = 0.0_f64;
    let mut points = vec![[100.0, 100.0]];
    while pitch * angle / TAU < radius {
        let r = pitch * angle / TAU;
        angle += chord / r.max(0.2);
        let r = pitch * angle / TAU;
        points.push([100.0 + r * angle.cos(), 100.0 + r * angle.sin()]);
    }
    points
}

fn zigzag(width: f64, pitch: f64, turns: u32) -> Vec<[f64; 2]> {
    (0..turns).map(|i| [20.0 + width * f64::from(i % 2), 20.0 + pitch * f64::from(i)]).collect()
}

/// Evenly spread points, the same each time.
fn spread(i: usize) -> [f64; 2] {
    [10.0 + 180.0 * (i as f64 * 0.754_877_666).fract(), 10.0 + 180.0 * (i as f64 * 0.569_840_291).fract()]
}

/// Lines of many lengths and curves of all chord lengths, with touches between them.
fn mixture() -> Vec<Vec<[f64; 2]>> {
    let mut paths = vec![zigzag(3.0, 0.3, 60), spiral(0.3, 0.05, 3.0), circle(20.0, 0.1)];
    for i in 0..60 {
        let [x, y] = spread(i);
        let length = 0.01 * 1.2_f64.powi(i as i32 % 40);
        paths.push(vec![[x, y]]);
        paths.push(vec![[x, y], [x + 0.6 * length, y + 0.8 * length]]);
        let wave = |k: i32| [x * 0.8 + 0.01 * f64::from(k) * f64::from(i as i32 % 7 + 1), y * 0.8 + (0.1 * f64::from(k)).sin()];
        paths.push((0..100).map(wave).collect());
    }
    paths
}

fn synthetic() -> Vec<(String, Plot)> {
    let mut plots = vec![
        ("long lines".to_owned(), one_pen((0..40).map(|i| vec![spread(i), spread(i + 40)]).collect())),
        ("wide zigzag".to_owned(), one_pen(vec![zigzag(60.0, 0.3, 200)])),
        ("narrow zigzag".to_owned(), one_pen(vec![zigzag(0.5, 0.25, 600)])),
        ("tiny zigzag".to_owned(), one_pen(vec![zigzag(0.06, 0.03, 3000)])),
        ("spiral, chords of 0.05".to_owned(), one_pen(vec![spiral(0.4, 0.05, 12.0)])),
        ("spiral, chords of 0.4".to_owned(), one_pen(vec![spiral(0.6, 0.4, 30.0)])),
        ("touches".to_owned(), one_pen((0..300).map(|i| vec![spread(i)]).collect())),
        (
            "tiny spirals".to_owned(),
            one_pen(
                (0..100)
                    .map(|i| {
                        let [x, y] = spread(i);
                        spiral(0.25, 0.06, 0.5).into_iter().map(|[a, b]| [a - 100.0 + x, b - 100.0 + y]).collect()
                    })
                    .collect(),
            ),
        ),
        ("a mixture with waits".to_owned(), one_pen(mixture())),
    ];
    for chord in [0.02, 0.05, 0.1, 0.15, 0.2, 0.3] {
        plots.push((format!("circle of 15, chords of {chord}"), one_pen(vec![circle(15.0, chord)])));
        plots.push((
            format!("circles of 2, chords of {chord}"),
            one_pen((0..10).map(|i| circle(1.9 + 0.021 * f64::from(i), chord)).collect()),
        ));
    }
    plots
}

#[test]
fn synthetic_files_take_what_is_told() {
    hold_synthetic(|name| !name.starts_with("circles of 2"));
}

#[test]
fn small_rings_take_what_is_told() {
    hold_synthetic(|name| name.starts_with("circles of 2"));
}

/// Requires the estimates for the synthetic files of these names to be within 1 %.
fn hold_synthetic(is_held: fn(&str) -> bool) {
    let servo = profile(&[]);
    let finer = profile(&[("steps_per_mm = [80, 80, 400]", "steps_per_mm = [100, 100, 400]")]);
    let finer_settings = Settings { steps_per_mm: [100.0, 100.0, 400.0], ..SERVO };
    let uneven = profile(&[
        (
            "steps_per_mm = [80, 80, 400]",
            "steps_per_mm = [80, 160, 400]\naxis_speed = [100, 40, 5]\naxis_acceleration = [500, 200, 50]",
        ),
        ("junction_deviation = 0.01", "junction_deviation = 0.03"),
        ("pen_up_seconds = 0.15", "pen_up_seconds = 0.16"),
    ]);
    let uneven_settings = Settings {
        steps_per_mm: [80.0, 160.0, 400.0],
        greatest_rate: [6000.0, 2400.0, 300.0],
        acceleration: [500.0, 200.0, 50.0],
        junction_deviation: 0.03,
        ..SERVO
    };
    let machines =
        [("80 steps/mm", servo, SERVO), ("100 steps/mm", finer, finer_settings), ("uneven axes", uneven, uneven_settings)];
    let mut wrong = Vec::new();
    for (machine, profile, settings) in machines {
        println!("{machine}");
        heading();
        for (name, plot) in synthetic() {
            let errors = compare(&name, &plot, &profile, &settings);
            if is_held(&name) && errors.iter().any(|error| error.is_nan() || *error > 1.0) {
                wrong.push((machine, name, errors));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// A sample as a hedcut, lowered with a nib of 0.3 mm and ordered.
fn sample_plot(name: &str, width: f64, profile: &Profile) -> Plot {
    let photo = sample(name);
    let size = image::load_from_memory(&photo).unwrap();
    let drawing = Sheet::new(&photo, (width, width * f64::from(size.height()) / f64::from(size.width()))).drawn_once();
    let mut plot = lower(&drawing, InkModel::Ink, &Nibs::all(0.3), 0.02, &Interrupt::never()).unwrap();
    let mounting = mount(profile, &plot.page).unwrap();
    plot.order_paths(mounting.to_machine.inverse() * Point::ORIGIN, Effort::Fast, Direction::Either, 0.1);
    plot
}

fn samples_take_what_is_told(names: &[&str], width: f64) {
    let (servo, z) = (profile(&[]), Profile::built_in("grbl-z").unwrap());
    heading();
    for name in names {
        let plot = sample_plot(name, width, &servo);
        let errors = compare(name, &plot, &servo, &SERVO);
        assert!(errors[0] <= 0.5 && errors[1] <= 0.2, "{name}: {errors:?} %");
        let errors = compare(&format!("{name}, z"), &plot, &z, &Z);
        assert!(errors.iter().all(|error| *error <= 0.2), "{name}, z: {errors:?} %");
    }
}

/// A z axis slower or faster than the profile's takes the estimated time once the profile states it; by default GRBL's `$112`
/// holds.
#[test]
fn a_z_axis_has_its_own_rate_and_acceleration() {
    let plot = one_pen(mixture());
    let z = |set: &[(&str, &str)]| {
        let set: Vec<(String, String)> = set.iter().map(|(k, v)| (format!("motion.planner.{k}"), (*v).to_owned())).collect();
        Profile::parse_with("grbl-z", built_in("grbl-z").unwrap(), &set).unwrap()
    };
    heading();
    let [rates, mill] = [[6000.0, 6000.0, 2400.0], Z.greatest_rate];
    for (name, profile, settings) in [
        ("as the profile says", z(&[]), Z),
        (
            "faster",
            z(&[("z_speed", "40"), ("z_acceleration", "800")]),
            Settings { greatest_rate: rates, acceleration: [250.0, 250.0, 800.0], ..Z },
        ),
        ("a mill's", z(&[("z_acceleration", "10")]), Settings { greatest_rate: mill, acceleration: [250.0, 250.0, 10.0], ..Z }),
    ] {
        let errors = compare(name, &plot, &profile, &settings);
        assert!(errors.iter().all(|error| *error <= 0.3), "{name}: {errors:?} %");
    }
    let mut unsaid = z(&[]);
    (unsaid.motion.planner.z_speed, unsaid.motion.planner.z_acceleration) = (None, None);
    let errors = compare("GRBL's default", &plot, &unsaid, &Z);
    assert!(errors.iter().all(|error| *error <= 0.3), "{errors:?} %");
}

/// Seconds of motion that the firmware's own code takes (gnea/grbl 1.1: `planner.c`, `stepper.c` and `motion_control.c` compiled
/// for a computer, the timer's interrupt called directly and its periods summed), at 80 and 400 steps/mm, `$112` = 500 and 250
/// mm/s^2.
#[test]
fn the_simulated_machine_takes_what_the_firmware_takes() {
    let measured = [
        ("G1 X.05 Y.02 F3000", 0.032_426),
        ("G1 X.03 Y.04 F3000\nG4 P.1\nG1 X.08 Y.06\nG4 P.1\nG1 X.1 Y.12", 0.096_911),
        ("G1 X1.5 F3000\nG1 X1.45 Y.04", 0.175_792),
        ("G3 X0 Y0 I-.129 J0 F3000", 0.119_840),
        ("G3 X0 Y0 I-2 J0 F3000", 0.510_190),
        ("G3 X-.3 Y.3 I-.3 J0 F3000\nG4 P.1\nG2 X0 Y0 I.3 J.05", 0.246_365),
        ("G0 Z2\nG0 X10 Y5\nG1 Z0 F480\nG1 X20 Y5 F3000\nG0 Z2\nG0 X0 Y0", 2.091_922),
        ("G1 X3 Y4 Z1 F3000\nG1 X6 Y4 Z.5\nG1 X8 Y1 Z0\nG0 Z2", 0.885_763),
        ("G1 Z1 F480\nG4 P.1\nG0 X.4 Z1.2", 0.236_975),
    ];
    for (text, seconds) in measured {
        let simulated = run(text, &Z).motion;
        println!("{seconds:.6} {simulated:.6}");
        assert!((simulated / seconds - 1.0).abs() < 1e-4, "{text}: {simulated} s, not {seconds} s");
    }
}

#[test]
fn portraits_take_what_is_told() {
    samples_take_what_is_told(&["astronaut.jpg", "grace-hopper.jpg", "bust-light.png", "bust-brown.png", "bust-dark.png"], 60.0);
}

#[test]
fn animals_and_things_take_what_is_told() {
    samples_take_what_is_told(&["chelsea.png", "coffee.png", "raccoon.jpg", "astronaut-cutout.png"], 60.0);
}

#[test]
fn a_pen_on_a_z_axis_takes_what_is_told() {
    let z = profile(&[
        ("pen_up = \"M3 S300\"", "pen_up = \"G0 Z2\""),
        ("pen_down = \"M3 S700\"", "pen_down = \"G1 Z0 F900\""),
        ("pen_up_seconds = 0.15", "pen_up_seconds = 0"),
        ("pen_down_seconds = 0.2", "pen_down_seconds = 0"),
        ("dwell_step_seconds", "axis_speed = [100, 100, 30]\naxis_acceleration = [250, 250, 100]\ndwell_step_seconds"),
    ]);
    let settings = Settings { greatest_rate: [6000.0, 6000.0, 1800.0], acceleration: [250.0, 250.0, 100.0], ..SERVO };
    heading();
    for (name, plot) in synthetic() {
        let errors = compare(&name, &plot, &z, &settings);
        assert!(errors.iter().all(|error| *error <= 1.0), "{name}: {errors:?} %");
    }
}
