//! Pause, stop, change of pen, parts of a file, and what a hand does before drawing.

use crate::machine::{Chance, FASTER, Job, Machine, many, plot, said};
use crate::streaming::{Memory, beginning, connected};
use drypoint::drive::{Ending, Grbl, Happening, Journal, Onlooker, Program, Session, SpeedChange, Wish};
use drypoint::interrupt::Interrupt;
use drypoint::plot::Profile;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Pauses at times of its own, looks at the pen, and goes on.
struct Pausing<'a> {
    machine: &'a Machine,
    chance: Chance,
    next: Instant,
    wishes: VecDeque<Wish>,
    paused: usize,
    most: usize,
    is_waiting: bool,
}

impl Onlooker for Pausing<'_> {
    fn wish(&mut self) -> Option<Wish> {
        if let Some(wish) = self.wishes.pop_front() {
            return Some(wish);
        }
        if self.is_waiting || self.paused >= self.most || Instant::now() < self.next {
            return None;
        }
        self.is_waiting = true;
        Some(Wish::Pause)
    }

    fn happens(&mut self, happening: &Happening<'_>) {
        if *happening == Happening::Paused {
            let firmware = self.machine.firmware();
            assert!(firmware.is_done() && !firmware.is_pen_down(), "paused with the pen down or moving");
            self.paused += 1;
            self.is_waiting = false;
            self.next = Instant::now() + Duration::from_millis(self.chance.below(40));
            self.wishes.push_back(Wish::Resume);
        }
    }
}

fn pauses(seed: u64, most: usize) -> usize {
    let machine = Machine::start();
    let profile = Profile::built_in("grbl-servo").unwrap();
    let program = Program::read(&profile, &plot(120, seed), &Interrupt::never()).unwrap();
    let (mut grbl, _) = Grbl::greet(connected(&machine)).unwrap();
    let mut memory = Memory(Vec::new());
    let mut journal = Journal::begin(&mut memory, &beginning()).unwrap();
    let mut onlooker = Pausing {
        machine: &machine,
        chance: Chance(seed + 5),
        next: Instant::now(),
        wishes: VecDeque::new(),
        paused: 0,
        most,
        is_waiting: false,
    };
    let ending = Session::new(&mut grbl, &program).run(&mut journal, &mut onlooker, &Interrupt::never()).unwrap();
    assert_eq!(ending, Ending::Done);
    assert_eq!(machine.firmware().touches.len(), 120, "each path once");
    onlooker.paused
}

#[test]
fn a_pause_ends_with_the_pen_up() {
    let counts: Vec<usize> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..many(20) as u64).map(|seed| scope.spawn(move || pauses(seed, 25))).collect();
        workers.into_iter().map(|worker| worker.join().unwrap()).collect()
    });
    let all: usize = counts.iter().sum();
    println!("{all} pauses, each with the pen up");
    assert!(all >= many(500), "{counts:?}");
}

/// Stops after a time.
struct Stopping(Instant);

impl Onlooker for Stopping {
    fn wish(&mut self) -> Option<Wish> {
        (Instant::now() >= self.0).then_some(Wish::Stop)
    }

    fn happens(&mut self, _: &Happening<'_>) {}
}

#[test]
fn a_stop_lifts_soon_after_standing_still() {
    let mut chance = Chance(17);
    let mut slowest: f64 = 0.0;
    for seed in 0..many(100) as u64 {
        let machine = Machine::start();
        let profile = Profile::built_in("grbl-servo").unwrap();
        let program = Program::read(&profile, &plot(60, seed), &Interrupt::never()).unwrap();
        let (mut grbl, _) = Grbl::greet(connected(&machine)).unwrap();
        let mut memory = Memory(Vec::new());
        let mut journal = Journal::begin(&mut memory, &beginning()).unwrap();
        let mut onlooker = Stopping(Instant::now() + Duration::from_millis(20 + chance.below(600)));
        let ending = Session::new(&mut grbl, &program).run(&mut journal, &mut onlooker, &Interrupt::never()).unwrap();
        assert_eq!(ending, Ending::Stopped);
        let firmware = machine.firmware();
        assert!(!firmware.is_pen_down() && firmware.is_done());
        // In real seconds: the line is not faster than in life, only the machine is.
        slowest = slowest.max((firmware.lifted - firmware.rested) / FASTER);
        assert!(memory.0.last().unwrap().contains("\"is_stopped\":true"), "{:?}", memory.0.last());
    }
    println!("the pen was lifted at most {slowest:.3} s after standing still");
    assert!(slowest <= 0.5, "{slowest} s");
}

/// Goes on whenever a pen is wanted, and remembers which.
#[derive(Default)]
struct Changing {
    wanted: Vec<String>,
    wishes: VecDeque<Wish>,
}

impl Onlooker for Changing {
    fn wish(&mut self) -> Option<Wish> {
        self.wishes.pop_front()
    }

    fn happens(&mut self, happening: &Happening<'_>) {
        if let Happening::PenWanted { number, name, parked } = happening {
            assert_eq!(*parked, [0.0, 0.0]);
            self.wanted.push(format!("{number} {name}"));
            self.wishes.extend([Wish::Speed(SpeedChange::Faster), Wish::Press(1), Wish::Resume]);
        }
    }
}

#[test]
fn a_change_of_pen_waits_parked_with_the_pen_up() {
    let text = plot(6, 4);
    let middle = text.match_indices("G0 X").nth(3).unwrap().0;
    let text = format!("{}G0 X0 Y0\n(pen 2: red 0.5)\nM0\n{}", &text[..middle], &text[middle..]);
    let machine = Machine::start();
    let program = Program::read(&Profile::built_in("grbl-servo").unwrap(), &text, &Interrupt::never()).unwrap();
    let (mut grbl, _) = Grbl::greet(connected(&machine)).unwrap();
    let mut memory = Memory(Vec::new());
    let mut journal = Journal::begin(&mut memory, &beginning()).unwrap();
    let mut onlooker = Changing::default();
    Session::new(&mut grbl, &program).run(&mut journal, &mut onlooker, &Interrupt::never()).unwrap();
    assert_eq!(onlooker.wanted, ["2 pen 2: red 0.5"]);
    assert_eq!(machine.firmware().touches.len(), 6);
}

/// The places where the pen came down.
fn touched(machine: &Machine) -> Vec<[i64; 2]> {
    machine.firmware().touches.iter().map(|place| place.map(|v| v.round() as i64)).collect()
}

#[test]
fn parts_of_a_file_are_drawn() {
    let job = Job::new(&plot(12, 9));
    for (options, first, count) in [
        (&["--path", "10"][..], [74, 2], 3),
        (&["--from", "100%"], [0, 0], 0),
        (&["--region", "0,0,20,20"], [2, 2], 3),
        (&["--layer", "lines"], [2, 2], 12),
        (&["--layer", "1", "--path", "12"], [90, 2], 1),
        (&["--line", "1"], [2, 2], 12),
    ] {
        let machine = Machine::start();
        let output = job.run(&machine, options);
        if count == 0 {
            assert!(said(&output).contains("no path lies"), "{}", said(&output));
            continue;
        }
        assert!(output.status.success(), "{options:?}: {}", said(&output));
        let touched = touched(&machine);
        assert_eq!((touched[0], touched.len()), (first, count), "{options:?}");
    }
    let output = job.run(&Machine::start(), &["--path", "99"]);
    assert!(output.status.code() == Some(2) && said(&output).contains("the paths 1 to 12"), "{}", said(&output));
}

#[test]
fn hands_set_up_and_a_frame_is_traced_with_the_pen_up() {
    let (machine, job) = (Machine::start(), Job::new(&plot(4, 5)));
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let by_hand = command.args(["send", "--port", &machine.port(), "--jog", "10,-2.5", "--profile", "grbl-servo", "--pen", "up"]);
    let output = by_hand.output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    machine.rest();
    let output = job.run(&machine, &["--at-origin", "--frame"]);
    assert!(output.status.success(), "{}", said(&output));
    let firmware = machine.firmware();
    let [x, y] = firmware.touches[0];
    assert!((x - 12.0).abs() < 0.02 && (y + 0.5).abs() < 0.02, "zero was set where the pen stood: {x} {y}");
    assert_eq!(firmware.touches.len(), 4);
}

#[test]
fn a_locked_machine_is_told_in_words() {
    let (machine, job) = (Machine::start(), Job::new(&plot(2, 5)));
    machine.firmware().alarm(1);
    std::thread::sleep(Duration::from_millis(20));
    let output = job.run(&machine, &[]);
    assert!(said(&output).contains("locked") && said(&output).contains("--home"), "{}", said(&output));
    let output = job.run(&machine, &["--unlock"]);
    assert!(output.status.success(), "{}", said(&output));
}
