//! What a hand does before drawing, and what the machine was told by other programs: zero, offsets, the pen.

use crate::machine::{FASTER, Job, Machine, plot, plot_on_z, said};
use std::process::{Command, Output};
use std::time::Duration;

/// `drypoint send` without a file.
fn by_hand(machine: &Machine, options: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    command.args(["send", "--port", &machine.port()]).args(options).output().unwrap()
}

#[test]
fn hands_set_up_and_a_frame_is_traced_with_the_pen_up() {
    let (machine, job) = (Machine::start(), Job::new(&plot(4, 5)));
    let output = by_hand(&machine, &["--jog", "10,-2.5", "--profile", "grbl-servo", "--pen", "up"]);
    assert!(output.status.success(), "{}", said(&output));
    machine.rest();
    let output = job.run(&machine, &["--at-origin", "--frame"]);
    assert!(output.status.success(), "{}", said(&output));
    let firmware = machine.firmware();
    let [x, y] = firmware.touches[0];
    assert!((x - 12.0).abs() < 0.02 && (y + 0.5).abs() < 0.02, "zero was set where the pen stood: {x} {y}");
    assert_eq!(firmware.touches.len(), 4);
}

/// Where the first path came down on the machine, and how many did.
fn first_touch(machine: &Machine) -> ([f64; 2], usize) {
    let firmware = machine.firmware();
    (firmware.touches[0], firmware.touches.len())
}

fn is_near(place: [f64; 2], expected: [f64; 2]) -> bool {
    (0..2).all(|axis| (place[axis] - expected[axis]).abs() < 0.02)
}

/// The offset of the work comes in every tenth report only.
#[test]
fn offsets_that_other_programs_set_are_kept() {
    for reports in [0, 1, 5, 9] {
        let job = Job::new(&plot(4, 5));
        let by_reset = Machine::changed(FASTER, |firmware| firmware.offset = [30.0, 40.0, 1.5]);
        let lasting = Machine::changed(FASTER, |firmware| firmware.work = [30.0, 40.0, 0.0]);
        for machine in [&by_reset, &lasting] {
            // Another program has asked so often.
            machine.firmware().receive(&vec![b'?'; reports]);
            let output = job.run(machine, &[]);
            assert!(output.status.success(), "{}", said(&output));
            let (place, count) = first_touch(machine);
            assert!(is_near(place, [32.0, 42.0]) && count == 4, "{reports} reports: {place:?}, {count}");
        }
        assert_eq!(by_reset.firmware().offset, [30.0, 40.0, 1.5]);
        assert_eq!(lasting.firmware().offset, [0.0; 3], "zero by G54 is not moved");
    }
}

#[test]
fn the_pen_is_lifted_before_a_hand_moves_it() {
    for options in [&["--jog", "20,5", "--profile", "grbl-servo"][..], &["--home", "--profile", "grbl-servo"]] {
        let machine = Machine::changed(FASTER, |firmware| firmware.set_servo(700.0));
        let output = by_hand(&machine, options);
        assert!(output.status.success(), "{}", said(&output));
        machine.rest();
        let firmware = machine.firmware();
        assert!(firmware.drawn.is_empty() && firmware.servo() == 300.0, "{options:?}: {:?}", firmware.drawn);
    }
    let locked = Machine::changed(FASTER, |firmware| firmware.set_servo(700.0));
    locked.firmware().alarm(1);
    std::thread::sleep(Duration::from_millis(20));
    let output = by_hand(&locked, &["--home", "--profile", "grbl-servo"]);
    assert!(output.status.success() && locked.firmware().servo() == 300.0, "{}", said(&output));
    let output = by_hand(&Machine::start(), &["--jog", "1,1"]);
    assert!(said(&output).contains("without --profile the pen is not lifted"), "{}", said(&output));
}

/// Sends a signal after a time, and waits for the end.
fn signalled(child: std::process::Child, after: Duration) -> Output {
    std::thread::sleep(after);
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    child.wait_with_output().unwrap()
}

#[test]
fn an_interrupt_stops_a_frame_and_homing_at_once() {
    let machine = Machine::at_pace(1.0);
    let job = Job::new(&plot(120, 5));
    let child = job.start(&machine, &["--frame"]);
    let output = signalled(child, Duration::from_millis(1500));
    assert_eq!(output.status.code(), Some(130), "{}", said(&output));
    let rested = machine.firmware().rested;
    std::thread::sleep(Duration::from_millis(300));
    let firmware = machine.firmware();
    assert!(firmware.is_done() && rested > 0.0 && firmware.rested == rested, "it stood still at {rested} s");
    assert!(firmware.drawn.is_empty() && firmware.touches.is_empty());
    drop(firmware);

    let machine = Machine::at_pace(1.0);
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let child = command
        .args(["send", "--port", &machine.port(), "--home", "--profile", "grbl-servo"])
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let output = signalled(child, Duration::from_secs(2));
    assert_eq!(output.status.code(), Some(130), "{}", said(&output));
    std::thread::sleep(Duration::from_millis(100));
    assert!(machine.firmware().is_done(), "homing was left");
}

/// Dips on a machine whose ink stands out of its reach are refused before anything moves.
#[test]
fn the_ink_stands_within_reach() {
    let machine = Machine::of_z_axis(FASTER);
    let job = Job::new(&plot_on_z(3, 1));
    let output = job.run(&machine, &["--dip", "3m", "--at", "900,10"]);
    assert!(!output.status.success() && said(&output).contains("--at 900,10"), "{}", said(&output));
    assert_eq!(machine.firmware().rested, 0.0);
    let output = job.run(&machine, &["--dip", "3m", "--at", "200,10"]);
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(machine.firmware().touches.len(), 4, "three paths and a dip");
}
