//! Nothing is lost and nothing waits while lines stream.

use crate::machine::{Chance, FASTER, Job, Machine, many, plot, said};
use drypoint::drive::{
    Beginning, Controller, Ending, Grbl, Handshake, Happening, Journal, Ledger, LineSettings, Onlooker, Port, Program, Session,
    Wish, open_port,
};
use drypoint::interrupt::Interrupt;
use drypoint::plot::Profile;
use std::fmt::Write as _;
use std::io;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// A port of ours that stalls now and then, as a busy computer does.
struct Stalling {
    port: Box<dyn Port>,
    chance: Chance,
}

impl Stalling {
    /// Once in forty times it waits for 50 to 800 ms of the machine's time.
    fn stall(&mut self) {
        if self.chance.below(40) == 0 {
            let milliseconds = 50 + self.chance.below(750);
            std::thread::sleep(Duration::from_secs_f64(milliseconds as f64 / 1000.0 / FASTER));
        }
    }
}

impl Port for Stalling {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.stall();
        self.port.send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        self.stall();
        self.port.receive(buffer, wait)
    }
}

struct Memory(Vec<String>);

impl Ledger for Memory {
    fn append(&mut self, line: &str) -> io::Result<()> {
        self.0.push(line.to_owned());
        Ok(())
    }

    fn sync(&mut self) -> io::Result<()> {
        Ok(())
    }
}

pub struct Nobody;

impl Onlooker for Nobody {
    fn wish(&mut self) -> Option<Wish> {
        None
    }

    fn happens(&mut self, _: &Happening<'_>) {}
}

pub fn beginning() -> Beginning {
    Beginning {
        file: "plot.gcode".into(),
        sha256: String::new(),
        profile: "grbl-servo".into(),
        machine: String::new(),
        paths: None,
    }
}

pub fn connected(machine: &Machine) -> Box<dyn Port> {
    connected_at(&machine.port())
}

pub fn connected_at(port: &str) -> Box<dyn Port> {
    open_port(port, LineSettings { baud: 115_200, handshake: Handshake::None }).unwrap()
}

/// A drawing in this process: how it ended, and its journal.
pub fn drawn(controller: &mut dyn Controller, program: &Program, onlooker: &mut dyn Onlooker) -> (Ending, Vec<String>) {
    let mut memory = Memory(Vec::new());
    let mut journal = Journal::begin(&mut memory, &beginning()).unwrap();
    let ending = Session::new(controller, program).run(&mut journal, onlooker, &Interrupt::never()).unwrap();
    (ending, memory.0)
}

/// A file for `grbl-servo`.
pub fn program(text: &str) -> Program {
    Program::read(&Profile::built_in("grbl-servo").unwrap(), text, &Interrupt::never()).unwrap()
}

/// Lines of a drawing of flattened curves: a thousand lines, 2 mm each.
fn lines(seed: u64) -> String {
    let mut chance = Chance(seed + 99);
    let mut text = "(pen up is M3 S300)\n(pen down is M3 S700)\nG21\nG90\nM3 S300\nG4 P.15\n(pen 1: lines 0.3)\nG0 X150 Y150\nM3 S700\nG4 P.2\n"
        .to_owned();
    for i in 0..1000 {
        let angle = f64::from(i) * 0.05 + chance.below(100) as f64 / 1000.0;
        let radius = 20.0 + 0.1 * f64::from(i);
        let feed = if i == 0 { " F3000" } else { "" };
        let _ = writeln!(text, "G1 X{:.3} Y{:.3}{feed}", 150.0 + radius * angle.cos(), 150.0 + radius * angle.sin());
    }
    text + "M3 S300\nG4 P.15\nG0 X0 Y0\n"
}

/// One drawing in memory: bytes lost, greatest use of the line buffer, time starved and time in all, and lines received and sent.
fn stream(seed: u64) -> (usize, usize, f64, f64, [usize; 2]) {
    let machine = Machine::start();
    let program = program(&lines(seed));
    let port = Stalling { port: connected(&machine), chance: Chance(seed * 31 + 7) };
    let (mut grbl, _) = Grbl::greet(Box::new(port)).unwrap();
    let begun = machine.firmware().now;
    assert_eq!(drawn(&mut grbl, &program, &mut Nobody).0, Ending::Done);
    let firmware = machine.firmware();
    let sent = program.lines.iter().filter(|line| !line.text.is_empty()).count();
    (firmware.lost, firmware.fullest, firmware.starved, firmware.now - begun, [firmware.lines, sent])
}

#[test]
fn a_hundred_thousand_lines_with_stalls_lose_no_byte_and_starve_nobody() {
    let runs: Vec<u64> = (0..many(100) as u64).collect();
    let results: Vec<_> = std::thread::scope(|scope| {
        let workers: Vec<_> = runs
            .chunks(runs.len().div_ceil(6))
            .map(|part| scope.spawn(move || part.iter().map(|seed| stream(*seed)).collect::<Vec<_>>()))
            .collect();
        workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
    });
    let (mut starved, mut all, mut fullest, mut count) = (0.0, 0.0, 0, 0);
    for (lost, full, hungry, seconds, [received, sent]) in &results {
        assert_eq!((*lost, received), (0, sent));
        starved += hungry;
        all += seconds;
        fullest = fullest.max(*full);
        count += received;
    }
    println!(
        "{count} lines, {all:.0} s of drawing, starved {:.4} %, {fullest} bytes in the buffer at most",
        100.0 * starved / all
    );
    assert!(fullest <= 127 && starved <= 0.001 * all, "starved {starved} s of {all} s");
}

/// A port through which a hand presses the machine's own buttons: hold after twenty lines, start once the hold was told.
struct Buttons {
    port: Box<dyn Port>,
    sent: usize,
    told: Arc<Mutex<Vec<String>>>,
    has_started: bool,
}

impl Port for Buttons {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.sent += usize::from(bytes.len() > 1);
        if self.sent == 20 {
            self.sent += 1;
            self.port.send(b"!")?;
        }
        if !self.has_started && !self.told.lock().unwrap().is_empty() {
            self.has_started = true;
            self.port.send(b"~")?;
        }
        self.port.send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        self.port.receive(buffer, wait)
    }
}

/// Remembers what the machine says.
struct Listener(Arc<Mutex<Vec<String>>>);

impl Onlooker for Listener {
    fn wish(&mut self) -> Option<Wish> {
        None
    }

    fn happens(&mut self, happening: &Happening<'_>) {
        if let Happening::Said(text) = happening {
            self.0.lock().unwrap().push((*text).to_owned());
        }
    }
}

#[test]
fn a_hold_by_the_machine_s_own_button_is_told_once() {
    let (machine, told) = (Machine::start(), Arc::new(Mutex::new(Vec::new())));
    let program = program(&lines(3));
    let port = Buttons { port: connected(&machine), sent: 0, told: Arc::clone(&told), has_started: false };
    let (mut grbl, _) = Grbl::greet(Box::new(port)).unwrap();
    assert_eq!(drawn(&mut grbl, &program, &mut Listener(Arc::clone(&told))).0, Ending::Done);
    let told = told.lock().unwrap();
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].contains("its start button goes on"), "{told:?}");
}

#[test]
fn the_command_draws_a_whole_file_in_the_time_that_it_told() {
    let (machine, job) = (Machine::start(), Job::new(&plot(40, 3)));
    let begun = machine.firmware().now;
    let output = job.run(&machine, &["--status", "-"]);
    assert!(output.status.success(), "{}", said(&output));
    let text = String::from_utf8(output.stdout).unwrap();
    let states: Vec<serde_json::Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(states.last().unwrap()["state"], "done");
    let told = states[0]["seconds_left"].as_f64().unwrap();
    let taken = machine.firmware().rested - begun;
    println!("told {told:.1} s, taken {taken:.1} s with the meeting before");
    assert!(taken >= told && machine.firmware().touches.len() == 40);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(message.contains("40 paths") && message.contains("grbl-servo"), "{message}");
}

#[test]
fn what_differs_is_told_before_anything_moves() {
    let job = Job::new(&plot(3, 1));
    let machine = Machine::start();
    machine.firmware().set("110", "3000.000");
    let output = job.run(&machine, &["--adopt", "own.toml"]);
    assert!(said(&output).contains("$110 (greatest rate of x, mm/min) is 3000"), "{}", said(&output));
    let again = job.run(&machine, &["--profile", "own.toml"]);
    assert!(again.status.success() && !said(&again).contains("$110"), "{}", said(&again));
}

#[test]
fn nothing_moves_without_consent_or_beyond_the_reach() {
    let machine = Machine::start();
    let far = plot(3, 1).replace("G0 X2 Y2", "G0 X302 Y2");
    let output = Job::new(&far).run(&machine, &[]);
    assert!(!output.status.success() && said(&output).contains("beyond the reach"), "{}", said(&output));
    let job = Job::new(&plot(3, 1));
    let mut command = job.send(&machine, &[]);
    let arguments: Vec<_> = command.get_args().filter(|argument| *argument != "--yes").map(std::ffi::OsStr::to_owned).collect();
    command = std::process::Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let asked = command.args(arguments).stdin(std::process::Stdio::null()).output().unwrap();
    assert_eq!(asked.status.code(), Some(2), "{}", said(&asked));
    let broken = Job::new(&plot(3, 1).replace("G1 ", "G1 Xnan ")).run(&machine, &[]);
    assert!(!broken.status.success(), "{}", said(&broken));
    let long = plot(3, 1).replace("G1 X", &format!("G1 X{}", "0".repeat(130)));
    let output = Job::new(&long).run(&machine, &[]);
    assert!(!output.status.success() && said(&output).contains("takes 126"), "{}", said(&output));
    let firmware = machine.firmware();
    assert!(firmware.rested == 0.0 && firmware.touches.is_empty(), "nothing moved");
    assert_eq!(firmware.servo(), 300.0, "the reset took the servo's signal away; the pen is up again");
}

#[test]
fn the_machine_checks_a_file_without_moving() {
    let (machine, job) = (Machine::start(), Job::new(&plot(5, 2)));
    let output = job.run(&machine, &["--check"]);
    assert!(output.status.success() && said(&output).contains("takes every line"), "{}", said(&output));
    assert!(machine.firmware().drawn.is_empty());
}

#[test]
fn nothing_answers_at_a_dead_port() {
    let machine = Machine::start();
    machine.connect(false);
    let output = Job::new(&plot(2, 1)).run(&machine, &[]);
    assert!(said(&output).contains("nothing answers within"), "{}", said(&output));
    let missing = drypoint::drive::open_port("/dev/no-such-port", LineSettings { baud: 9600, handshake: Handshake::default() });
    assert!(missing.is_err());
}

/// `FluidNC` listens on a socket.
#[test]
fn a_machine_on_the_network_draws() {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let draws = std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        stream.set_read_timeout(Some(Duration::from_millis(1))).unwrap();
        let mut firmware = crate::grbl::firmware::Firmware::new(&crate::grbl::SERVO);
        let (begun, mut buffer) = (std::time::Instant::now(), [0; 1024]);
        loop {
            match std::io::Read::read(&mut stream, &mut buffer) {
                Ok(0) => return firmware.touches.len(),
                Ok(count) => firmware.receive(&buffer[..count]),
                Err(_) => {}
            }
            firmware.run_until(40.0 * begun.elapsed().as_secs_f64());
            let _ = std::io::Write::write_all(&mut stream, &firmware.output());
        }
    });
    let job = Job::new(&plot(12, 6));
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let output = command.arg("send").arg(&job.file).args(["--port", &format!("tcp://{address}"), "--yes"]).output().unwrap();
    assert!(output.status.success() && said(&output).contains("Grbl 1.1h answers"), "{}", said(&output));
    assert_eq!(draws.join().unwrap(), 12);
}
