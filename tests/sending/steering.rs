//! Pause, stop, change of pen, parts of a file, and what a hand does before drawing.

use crate::machine::{Chance, FASTER, Job, Machine, many, plot, said};
use crate::streaming::{Nobody, beginning, connected, drawn, program};
use drypoint::drive::{DriveError, Ending, Grbl, Happening, Journal, Ledger, Onlooker, Session, SpeedChange, Wish};
use drypoint::interrupt::Interrupt;
use std::collections::VecDeque;
use std::io;
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
    let (mut grbl, _) = Grbl::greet(connected(&machine)).unwrap();
    let mut onlooker = Pausing {
        machine: &machine,
        chance: Chance(seed + 5),
        next: Instant::now(),
        wishes: VecDeque::new(),
        paused: 0,
        most,
        is_waiting: false,
    };
    assert_eq!(drawn(&mut grbl, &program(&plot(120, seed)), &mut onlooker).0, Ending::Done);
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
        let (mut grbl, _) = Grbl::greet(connected(&machine)).unwrap();
        let mut onlooker = Stopping(Instant::now() + Duration::from_millis(20 + chance.below(600)));
        let (ending, journal) = drawn(&mut grbl, &program(&plot(60, seed)), &mut onlooker);
        assert_eq!(ending, Ending::Stopped);
        let firmware = machine.firmware();
        assert!(!firmware.is_pen_down() && firmware.is_done());
        // In real seconds: the line is not faster than in life, only the machine is.
        slowest = slowest.max((firmware.lifted - firmware.rested) / FASTER);
        assert!(journal.last().unwrap().contains("\"is_stopped\":true"), "{:?}", journal.last());
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
    let (mut grbl, _) = Grbl::greet(connected(&machine)).unwrap();
    let mut onlooker = Changing::default();
    drawn(&mut grbl, &program(&text), &mut onlooker);
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
fn a_locked_machine_is_told_in_words() {
    let (machine, job) = (Machine::start(), Job::new(&plot(2, 5)));
    machine.firmware().alarm(1);
    std::thread::sleep(Duration::from_millis(20));
    let output = job.run(&machine, &[]);
    assert!(said(&output).contains("locked") && said(&output).contains("--home"), "{}", said(&output));
    let output = job.run(&machine, &["--unlock"]);
    assert!(output.status.success(), "{}", said(&output));
}

/// A journal on a full disk.
struct Full(usize);

impl Ledger for Full {
    fn append(&mut self, _: &str) -> io::Result<()> {
        self.0 = self.0.checked_sub(1).ok_or(io::ErrorKind::StorageFull)?;
        Ok(())
    }

    fn sync(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_journal_that_cannot_be_written_stops_with_the_pen_up() {
    for lines in [1, 4, 9, 14] {
        let machine = Machine::start();
        let (mut grbl, _) = Grbl::greet(connected(&machine)).unwrap();
        let mut full = Full(lines);
        let mut journal = Journal::begin(&mut full, &beginning()).unwrap();
        let program = program(&plot(60, 3));
        let ending = Session::new(&mut grbl, &program).run(&mut journal, &mut Nobody, &Interrupt::never());
        assert!(matches!(ending, Err(DriveError::Journal(_))), "{ending:?}");
        machine.rest();
        let firmware = machine.firmware();
        assert!(firmware.servo() == 300.0 && firmware.touches.len() < 60, "the pen is up");
    }
}
