//! Pauses, pens and the rules of the machine.

use super::*;

/// The simulated rules matter: the comparison would show if one were left out.
#[test]
fn a_machine_with_other_rules_takes_another_time() {
    let same = |changes: &[(&str, &str)], plot: &Plot| compare(changes[0].0, plot, &profile(changes), &SERVO)[0];
    heading();
    let fine = one_pen(vec![(0..1000).map(|i| [0.1 * f64::from(i), 0.0]).collect()]);
    assert!(same(&[("block_buffer = 16", "")], &fine) > 10.0);
    assert!(same(&[("block_buffer = 16", "block_buffer = 17")], &fine) > 1.0);
    let curve = one_pen(vec![circle(15.0, 0.05)]);
    assert!(same(&[("steps_per_mm = [80, 80, 400]", ""), ("arcs = true", "arcs = false")], &curve) > 5.0);
    let long = one_pen((0..40).map(|i| vec![spread(i), spread(i + 40)]).collect());
    assert!(same(&[("limits = \"axis\"", "limits = \"path\"")], &long) > 5.0);
    let corners = one_pen(vec![zigzag(0.5, 0.25, 600)]);
    assert!(same(&[("junction_deviation = 0.01", "junction_deviation = 0.02")], &corners) > 2.0);
}

/// The one effect that is not estimated. From 0.2 mm along an axis, at 250 mm/s^2, it takes four segments of 10 ms to stop, so
/// that rings which end with such a chord end on a segment's end; a file of only ten of them takes 1 to 3 % longer than
/// estimated.
#[test]
fn a_stop_on_the_end_of_a_segment_is_late() {
    let servo = profile(&[]);
    let plot = one_pen(vec![circle_from(0.0, 2.0, 0.2); 10]);
    let mounting = mount(&servo, &plot.page).unwrap();
    let machine = run(&written(&plot, &servo).unwrap(), &SERVO);
    let told = clock(&plot, &servo, &mounting, &Interrupt::never()).unwrap()[0];
    let told = told.drawing + told.travelling;
    println!("motion {:.3} s, late {:.3} s, told {told:.3} s", machine.motion, machine.late);
    assert!((0.97..1.0).contains(&(told / machine.motion)));
    assert!((told / (machine.motion - machine.late) - 1.0).abs() < 5e-3);
}

#[test]
fn pens_are_changed_and_layers_wait_as_told() {
    let servo = profile(&[]);
    let mut plot = one_pen(mixture());
    for (number, delay_seconds, speed_percent) in [(1, 0.33, None), (2, 0.0, Some(37.0)), (3, 1.0, None)] {
        let handling = Handling { pauses: number == 3, speed_percent, delay_seconds };
        plot.pens.push(PenPaths {
            number,
            handling,
            paths: vec![Toolpath::through(Point::new(5.0, 7.0), [Point::new(60.0, 99.0)])],
            ..plot.pens[0].clone()
        });
    }
    heading();
    let errors = compare("four layers, three pens", &plot, &servo, &SERVO);
    assert!(errors.iter().all(|error| *error <= 0.1), "{errors:?} %");
}

/// The simulation itself, in cases with a known answer.
#[test]
fn the_simulated_machine_keeps_its_rules() {
    let seconds = |text: &str| run(text, &SERVO);
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 2e-3, "{a} is not {b}");
    // A trapezoid: 50 mm/s after 0.2 s, and the same at the end.
    near(seconds("G1 X100 F3000").motion, 100.0 / 50.0 + 50.0 / 250.0);
    assert_eq!(seconds("G1 X100 Y50 F3000").steps, 8000);
    // A diagonal is faster, a slow rate is kept, and a wait is rounded to whole steps and lies between two motions from rest to
    // rest.
    near(seconds("G0 X100 Y100").motion, seconds("G0 X100").motion);
    near(seconds("G1 X1 F60").motion, 1.0 + 1.0 / 250.0);
    let waited = seconds("G1 X50 F3000\nG4 P0.12\nG1 X100");
    near(waited.motion, 2.0 * (1.0 + 0.2));
    near(waited.dwell, 0.15);
    // A spindle command stops the motion too, unless it changes nothing; in laser mode a new speed does not stop it.
    near(seconds("M3 S5\nG1 X50 F3000\nS6\nG1 X100").motion, 2.4);
    near(seconds("M3 S5\nG1 X50 F3000\nM3 S5\nG1 X100").motion, 2.2);
    near(run("M3 S5\nG1 X50 F3000\nS6\nG1 X100", &Settings { laser: Laser::On, ..SERVO }).motion, 2.2);
    // A square corner: a d s / (1 - s) with s of half a right angle, along the diagonal of the axes' accelerations.
    let half = 0.5_f64.sqrt();
    let corner = (250.0 * 2.0_f64.sqrt() * 0.01 * half / (1.0 - half)).sqrt();
    let leg = |from: f64| 40.0 / 50.0 + (50.0 - from).powi(2) / (2.0 * 250.0 * 50.0) + 50.0 / (2.0 * 250.0);
    near(seconds("G1 X40 F3000\nY40").motion, 2.0 * leg(corner));
    // With 0.1 mm blocks only 14 of them are available for stopping; a single block reaches 50 mm/s.
    let fine = (1..1000).map(|i| format!("G1 X{}.{} F3000", i / 10, i % 10)).collect::<Vec<_>>().join("\n");
    near(seconds(&fine).top_speed, (2.0 * 250.0 * 1.4_f64).sqrt());
    near(seconds("G1 X100 F3000").top_speed, 50.0);
    // An arc becomes chords within 0.002 mm of it.
    let count = (0.5 * TAU * 10.0 / (0.002 * (20.0 - 0.002_f64)).sqrt()).floor() as u32;
    let chord = |i: u32| (TAU * f64::from(i) / f64::from(count)).sin_cos();
    let chords: Vec<String> =
        (1..=count).map(chord).map(|(sin, cos)| format!("G1 X{:.3} Y{:.3}", 10.0 + 10.0 * cos, 10.0 + 10.0 * sin)).collect();
    let arc = seconds("G1 X20 Y10 F1200\nG4 P1\nG3 X20 Y10 I-10 J0").motion;
    near(arc, seconds(&format!("G1 X20 Y10 F1200\nG4 P1\n{}", chords.join("\n"))).motion);
    near(arc, seconds("G1 X20 Y10 F1200\nG4 P1\nG2 X20 Y10 I-10 J0").motion);
}

/// Runs the program; its report as JSON.
fn drypoint(arguments: &[&str]) -> serde_json::Value {
    let output = Command::new(env!("CARGO_BIN_EXE_drypoint")).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn inspect_and_plot_tell_the_same_time() {
    let folder = std::env::temp_dir().join(format!("drypoint-planner-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let photo = format!("{}/samples/chelsea.png", env!("CARGO_MANIFEST_DIR"));
    drypoint(&["draw", &photo, "--style", "hedcut", "--size", "60x40mm", "-o", &path("a.svg"), "--json"]);
    for (machine, file) in [("grbl-servo", "a.gcode"), ("hp7475a", "a.hpgl")] {
        let plotted = drypoint(&["plot", &path("a.svg"), "--profile", machine, "--order", "fast", "-o", &path(file), "--json"]);
        let inspected = drypoint(&["inspect", &path(file), "--profile", machine, "--json"]);
        let told = plotted["total"]["seconds"].as_f64().unwrap();
        let read = inspected["plot"]["total"]["seconds"].as_f64().unwrap();
        println!("{machine}: plot {told:.3} s, inspect {read:.3} s");
        assert!((read / told - 1.0).abs() < 1e-3, "{machine}: {told} and {read}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
