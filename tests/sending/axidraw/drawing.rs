//! Drawing on the board: steps, stops, pauses and lost power.

use super::*;

/// Heights, channels and rates are those that the maker's own program sends for 60 and 30 percent.
#[test]
fn each_pen_lift_is_moved_at_its_plug_and_in_its_range() {
    for (machine_name, lift, pin, settings) in [
        ("axidraw-v3", PenLift::Servo, 1, [(4, 20_641), (5, 15_248), (8, 8)]),
        ("axidraw-v3-brushless", PenLift::Brushless, 2, [(4, 9720), (5, 7560), (8, 1)]),
    ] {
        let machine = Machine::of_pace(Board::new(NEW), PACE);
        let plot = &drawings()[0];
        let program = program_for(machine_name, plot);
        let ending = drawn(&mut conversation_with(lift, &machine), &program, &mut Stopping(None)).0;
        assert_eq!(ending, Ending::Done);
        let board = machine.firmware();
        assert_eq!(board.pins, BTreeSet::from([pin]));
        settings.iter().for_each(|(number, value)| assert_eq!(board.servo[number], *value, "{machine_name} SC,{number}"));
        // It arrives before the profile goes on: the rate, once per period, covers the way in time.
        let period = 0.003 * board.servo[&8] as f64;
        let way = (board.servo[&4] - board.servo[&5]) as f64;
        let motion = Profile::built_in(machine_name).unwrap().motion;
        for (number, seconds) in [(11, motion.pen_up_seconds), (12, motion.pen_down_seconds)] {
            assert!(way / board.servo[&number] as f64 * period <= seconds, "{machine_name} SC,{number}");
        }
        assert!(board.unknown.is_empty(), "{:?}", board.unknown);
    }
}

#[test]
fn every_path_ends_on_the_planned_step_with_a_queue_of_one_and_of_32() {
    for version in [OLD, NEW] {
        for plot in drawings() {
            let machine = Machine::of_pace(Board::new(version), PACE);
            let program = program(&plot);
            let mut ebb = conversation(&machine);
            let begun = machine.firmware().now;
            let ending = drawn(&mut ebb, &program, &mut Stopping(None)).0;
            assert_eq!(ending, Ending::Done);
            let board = machine.firmware();
            assert!(board.unknown.is_empty(), "{:?}", board.unknown);
            // By the way of the bytes, ten times as long here as in life.
            assert!(
                50 * board.blocked <= program.lines.len(),
                "{} of {} commands found the queue full",
                board.blocked,
                program.lines.len()
            );
            let steps = |place: [f64; 3]| [place[0] + place[1], place[0] - place[1]].map(|mm| (mm * 80.0).round() as i64);
            let planned = program.paths.iter().map(|path| steps(program.lines[path.lift].at)).collect::<Vec<_>>();
            assert_eq!(board.lifts, planned, "{version}");
            let taken = board.now - begun;
            println!("{version}: {} paths in {taken:.2} s, told {:.2} s", planned.len(), program.seconds());
        }
    }
}

#[test]
fn a_stop_gets_through_at_once_and_leaves_the_pen_up() {
    let mut chance = Chance(5);
    let mut slowest: f64 = 0.0;
    for i in 0..many(60) {
        let machine = Machine::of_pace(Board::new([OLD, NEW][i % 2]), PACE);
        let program = program(&drawings()[i % 3]);
        let mut ebb = conversation(&machine);
        let wished = Instant::now() + Duration::from_millis(30 + chance.below(250));
        let ending = drawn(&mut ebb, &program, &mut Stopping(Some(wished))).0;
        // With the lifting of the pen, which the board has taken by then.
        slowest = slowest.max(wished.elapsed().as_secs_f64());
        assert_eq!(ending, Ending::Stopped);
        machine.rest();
        let board = machine.firmware();
        assert!(!board.is_down, "the pen is up");
        assert!(board.stopped.is_some());
    }
    println!("a stop takes at most {slowest:.3} s");
    assert!(slowest <= 0.2, "{slowest}");
}

/// Presses the board's button, and again when it has paused.
struct Pressing<'a> {
    machine: &'a Machine<Board>,
    at: Instant,
    paused: usize,
    resumed: usize,
}

impl Onlooker for Pressing<'_> {
    fn wish(&mut self) -> Option<Wish> {
        if self.paused == 0 && Instant::now() >= self.at {
            self.machine.firmware().is_pressed = true;
            self.at += Duration::from_hours(1);
        }
        None
    }

    fn happens(&mut self, happening: &Happening<'_>) {
        match happening {
            Happening::Paused => {
                let mut board = self.machine.firmware();
                assert!(!board.is_down && board.running.is_none());
                (self.paused, board.is_pressed) = (self.paused + 1, true);
            }
            Happening::Resumed => self.resumed += 1,
            _ => {}
        }
    }
}

#[test]
fn the_button_pauses_with_the_pen_up_and_goes_on() {
    let machine = Machine::of_pace(Board::new(NEW), PACE);
    let program = program(&drawings()[2]);
    let mut ebb = conversation(&machine);
    let at = Instant::now() + Duration::from_millis(150);
    let mut onlooker = Pressing { machine: &machine, at, paused: 0, resumed: 0 };
    let ending = drawn(&mut ebb, &program, &mut onlooker).0;
    assert_eq!((ending, onlooker.paused, onlooker.resumed), (Ending::Done, 1, 1));
}

/// An SVG of tool paths, made by the command.
fn tool_paths() -> Job {
    let job = Job::named("drawing.svg", "");
    let mut svg =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"150mm\" height=\"100mm\" viewBox=\"0 0 150 100\">".to_owned();
    for i in 0..24 {
        let (x, y) = (5 + 5 * i, 10 + (i * 7) % 30);
        svg += &["<path fill=\"none\" stroke=\"black\" stroke-width=\"0.3\" d=\"M", " h3 v3\"/>"].join(&format!("{x} {y}"));
    }
    std::fs::write(&job.file, svg + "</svg>").unwrap();
    let paths = job.folder.path().join("paths.svg");
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_drypoint"));
    command.args(["plot", job.file.to_str().unwrap(), "-o", paths.to_str().unwrap(), "--profile", "axidraw-v3", "-q"]);
    assert!(command.status().unwrap().success());
    Job { file: paths, ..job }
}

#[test]
fn the_command_draws_tool_paths_and_goes_on_after_a_kill() {
    at_once(many(20) as u64, |seed| {
        let (machine, job) = (Machine::of_pace(Board::new([OLD, NEW][seed as usize % 2]), 1.0), tool_paths());
        let mut child = job.start(&machine, &[]);
        std::thread::sleep(Duration::from_millis(900 + Chance(seed + 3).below(6000)));
        let _ = child.kill();
        let _ = child.wait();
        let options: &[&str] = if seed % 2 == 0 { &["--continue"] } else { &["--continue", "--overlap", "1mm"] };
        let output = job.run(&machine, options);
        assert!(output.status.success(), "seed {seed}: {}", said(&output));
        let board = machine.firmware();
        let mut places = board.touches.clone();
        places.sort_unstable();
        places.dedup();
        let again = board.touches.len() - 24;
        assert!(board.lifts.len() >= 24 && places.len() >= 24 && again <= 1, "seed {seed}: {again} paths twice");
        assert!(board.unknown.is_empty() && board.is_done());
    });
}

#[test]
fn power_lost_between_two_drawings_is_noticed() {
    let (machine, job) = (Machine::of_pace(Board::new(NEW), 1.0), tool_paths());
    assert!(job.run(&machine, &[]).status.success());
    {
        let mut board = machine.firmware();
        (board.was_dark, board.steps) = (true, [500, 700]);
        board.touches.clear();
    }
    // The motors are switched off and on, which is zero; without that the drawing would be shifted.
    assert!(job.run(&machine, &[]).status.success());
    let board = machine.firmware();
    assert_eq!((board.touches.len(), board.zeroed), (24, 3), "on, off and on");
}

#[test]
fn motors_that_lose_their_power_are_noticed() {
    at_once(2, |seed| {
        let version = [OLD, NEW][seed as usize];
        let (machine, job) = (Machine::of_pace(Board::new(version), 1.0), tool_paths());
        let child = job.start(&machine, &[]);
        std::thread::sleep(Duration::from_millis(2500));
        machine.firmware().is_powered = false;
        let output = child.wait_with_output().unwrap();
        assert!(!output.status.success() && said(&output).contains("no power"), "{version}: {}", said(&output));
        let dark = job.run(&machine, &["--continue"]);
        assert!(said(&dark).contains("no power"), "{}", said(&dark));
        {
            let mut board = machine.firmware();
            (board.is_powered, board.was_dark) = (true, version == NEW);
        }
        assert!(!machine.firmware().is_enabled, "the motors forget where they are");
        let output = job.run(&machine, &["--continue", "--at-origin"]);
        assert!(output.status.success(), "{version}: {}", said(&output));
        let board = machine.firmware();
        let mut places = board.touches.clone();
        places.sort_unstable();
        places.dedup();
        let again = board.touches.len() - 24;
        assert!(places.len() == 24 && again <= 2, "{version}: {} places, {again} again", places.len());
        assert_eq!(board.depth, 1, "the queue is as it was");
    });
}

/// The board moves by steps from where it stands: what comes before must not shift the drawing.
#[test]
fn a_frame_and_a_new_zero_leave_the_drawing_in_its_place() {
    let job = tool_paths();
    let drawn = |options: &[&str], begun: [i64; 2]| {
        let machine = Machine::of_pace(Board { steps: begun, is_enabled: true, ..Board::new(NEW) }, 1.0);
        let output = job.run(&machine, options);
        assert!(output.status.success(), "{}", said(&output));
        let touches = machine.firmware().touches.clone();
        assert_eq!(touches.len(), 24);
        touches
    };
    let cases: [(&[&str], [i64; 2]); 4] =
        [(&[], [0, 0]), (&["--frame"], [0, 0]), (&["--frame"], [800, -160]), (&["--at-origin"], [800, -160])];
    let found = Mutex::new(Vec::new());
    at_once(4, |i| {
        let touches = drawn(cases[i as usize].0, cases[i as usize].1);
        found.lock().unwrap().push(touches);
    });
    let found = found.into_inner().unwrap();
    assert!(found.len() == 4 && found.iter().all(|touches| *touches == found[0]), "{found:?}");
}

#[test]
fn a_drawing_that_is_no_plot_is_refused_with_advice() {
    let job = tool_paths();
    let drawing = Job { file: job.folder.path().join("drawing.svg"), folder: tempfile::tempdir().unwrap() };
    let output = drawing.run(&Machine::of_pace(Board::new(NEW), PACE), &[]);
    assert!(!output.status.success() && said(&output).contains("drypoint plot"), "{}", said(&output));
    let program = program(&drawings()[0]);
    assert!(program.lines.iter().any(|line| line.act == Act::Lower));
    let old = Machine::of_pace(Board::new("EBBv13_and_above EB Firmware Version 2.4.2"), PACE);
    let refused = job.run(&old, &[]);
    assert!(said(&refused).contains("2.8 or later"), "{}", said(&refused));
}
