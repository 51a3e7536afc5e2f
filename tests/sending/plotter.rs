//! An HP 7475A, modelled: a buffer of 1024 bytes that runs over as the real one does, escape sequences, slow drawing.

use crate::machine::{Chance, Device, FASTER, Job, Machine, at_once, many, said};
use crate::streaming::{Nobody, drawn};
use drypoint::drive::{Ending, Handshake, Hpgl, Port, Program};
use drypoint::interrupt::Interrupt;
use drypoint::plot::Profile;
use std::collections::{BTreeMap, VecDeque};
use std::fmt::Write as _;
use std::io;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

const BUFFER: usize = 1024;
/// XOFF is sent when fewer bytes are free.
const THRESHOLD: usize = 81;
/// Plotter units per second at the usual speed.
const SPEED: f64 = 0.3 * 40_193.0;
/// Seconds to lift or lower the pen.
const LIFT: f64 = 0.1;

#[derive(Default)]
struct Plotter {
    buffer: VecDeque<u8>,
    escape: Option<Vec<u8>>,
    output: Vec<u8>,
    now: f64,
    busy_until: f64,
    /// Moves of the instruction that is being drawn.
    moves: VecDeque<[f64; 2]>,
    at: [f64; 2],
    is_down: bool,
    error: u32,
    lost: usize,
    has_flow: bool,
    is_off: bool,
    drawn: Vec<[[f64; 2]; 2]>,
    touches: Vec<[f64; 2]>,
    fullest: usize,
    unknown: Vec<String>,
}

impl Device for Plotter {
    fn receive(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            if let Some(escape) = &mut self.escape {
                escape.push(byte);
                let letter = escape.get(1).copied().unwrap_or(0);
                let is_whole = match letter {
                    b'I' | b'N' | b'H' | b'M' => byte == b':',
                    0 => false,
                    _ => true,
                };
                if is_whole {
                    let escape = self.escape.take().unwrap();
                    self.control(&escape);
                }
            } else if byte == 0x1b {
                self.escape = Some(Vec::new());
            } else if self.buffer.len() < BUFFER {
                self.buffer.push_back(byte);
                self.fullest = self.fullest.max(self.buffer.len());
            } else {
                (self.error, self.lost) = (16, self.lost + 1);
            }
        }
        self.flow();
    }

    fn run_until(&mut self, seconds: f64) {
        self.now = seconds;
        while self.busy_until <= self.now {
            if let Some(to) = self.moves.pop_front() {
                let length = (to[0] - self.at[0]).hypot(to[1] - self.at[1]);
                if self.is_down && length > 0.0 {
                    self.drawn.push([self.at, to]);
                }
                self.at = to;
                self.busy_until = self.busy_until.max(self.now - 0.1) + length / SPEED;
            } else if !self.take() {
                self.busy_until = self.now + 1e-9;
                break;
            }
        }
        self.flow();
    }

    fn output(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.output)
    }

    fn is_done(&self) -> bool {
        self.moves.is_empty() && !self.buffer.contains(&b';') && self.busy_until <= self.now + 1e-6
    }
}

impl Plotter {
    fn answer(&mut self, text: &str) {
        self.output.extend_from_slice(text.as_bytes());
        self.output.push(b'\r');
    }

    fn control(&mut self, escape: &[u8]) {
        match escape[1] {
            b'B' => self.answer(&(BUFFER - self.buffer.len()).to_string()),
            b'O' => {
                let is_empty = self.moves.is_empty() && self.buffer.is_empty() && self.busy_until <= self.now + 1e-6;
                self.answer(if is_empty { "8" } else { "0" });
            }
            b'E' => {
                let error = std::mem::take(&mut self.error);
                self.answer(&error.to_string());
            }
            b'K' => self.buffer.clear(),
            b'N' => self.has_flow = true,
            b'I' | b'J' => {}
            other => self.unknown.push(format!("ESC.{}", char::from(other))),
        }
    }

    /// XOFF and XON.
    fn flow(&mut self) {
        let free = BUFFER - self.buffer.len();
        if self.has_flow && !self.is_off && free < THRESHOLD {
            self.is_off = true;
            self.output.push(19);
        } else if self.is_off && free > BUFFER / 2 {
            self.is_off = false;
            self.output.push(17);
        }
    }

    /// Takes the next whole instruction; false if there is none.
    fn take(&mut self) -> bool {
        let Some(end) = self.buffer.iter().position(|byte| *byte == b';') else { return false };
        let bytes: Vec<u8> = self.buffer.drain(..=end).collect();
        let text = String::from_utf8(bytes).unwrap();
        let text = text.trim_end_matches(';').trim();
        if text.is_empty() {
            return true;
        }
        let (name, rest) = text.split_at(2.min(text.len()));
        let numbers: Vec<f64> = rest.split(',').filter_map(|number| number.parse().ok()).collect();
        match name {
            "PU" | "PD" => {
                let is_down = name == "PD";
                if is_down != self.is_down {
                    self.busy_until = self.busy_until.max(self.now - 0.1) + LIFT;
                    if is_down {
                        self.touches.push(self.at);
                    }
                }
                self.is_down = is_down;
                self.moves.extend(numbers.chunks_exact(2).map(|pair| [pair[0], pair[1]]));
            }
            "OA" => self.answer(&format!("{:.0},{:.0},{}", self.at[0], self.at[1], u8::from(self.is_down))),
            "OI" => self.answer("7475A"),
            "IN" | "PS" | "SP" | "VS" => {}
            other => self.unknown.push(other.to_owned()),
        }
        true
    }
}

/// Paths of dots and strokes, each in a cell of its own, as for the 7475A.
fn plot(paths: usize) -> String {
    let mut chance = Chance(77);
    let mut text = "IN;PU;PS4;SP1;VS30;".to_owned();
    for i in 0..paths {
        let (x, y) = (200 * (i % 40) + 50, 200 * (i / 40) + 50);
        let _ = write!(text, "PU{x},{y};");
        if chance.below(2) == 0 {
            text += "PD;";
        } else {
            text += "PD";
            for step in 1..=chance.below(12) + 1 {
                let comma = if step == 1 { "" } else { "," };
                let _ = write!(text, "{comma}{},{}", x as u64 + 10 * step, y as u64 + chance.below(150));
            }
            text += ";";
        }
    }
    text + "PU;PU11040,7721;SP0;\n"
}

/// A plotter wired to this program, with RTS and CTS if it holds back what does not fit.
struct Wired {
    plotter: Arc<Mutex<Plotter>>,
    begun: Instant,
    holds_back: bool,
}

impl Wired {
    fn pass(&self) {
        self.plotter.lock().unwrap().run_until(FASTER * self.begun.elapsed().as_secs_f64());
    }
}

impl Port for Wired {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        for byte in bytes {
            while self.holds_back && self.plotter.lock().unwrap().buffer.len() > BUFFER - THRESHOLD {
                std::thread::sleep(Duration::from_millis(1));
                self.pass();
            }
            self.plotter.lock().unwrap().receive(&[*byte]);
        }
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let begun = Instant::now();
        loop {
            self.pass();
            let output = self.plotter.lock().unwrap().output();
            if !output.is_empty() {
                buffer[..output.len()].copy_from_slice(&output);
                return Ok(output.len());
            }
            if begun.elapsed() >= wait {
                return Ok(0);
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

const PATHS: usize = 300;

fn check(plotter: &Plotter, paths: usize) {
    assert_eq!((plotter.lost, plotter.touches.len()), (0, paths), "lost bytes, paths begun");
    assert!(plotter.unknown.is_empty(), "{:?}", plotter.unknown);
    assert!(plotter.fullest > BUFFER / 2, "the buffer was used: {}", plotter.fullest);
}

#[test]
fn no_handshake_overruns_the_buffer() {
    let program = Program::read(&Profile::built_in("hp7475a").unwrap(), &plot(PATHS), &Interrupt::never()).unwrap();
    for handshake in [Handshake::None, Handshake::Hardware] {
        let plotter = Arc::new(Mutex::new(Plotter::default()));
        let holds_back = handshake == Handshake::Hardware;
        let wired = Wired { plotter: Arc::clone(&plotter), begun: Instant::now(), holds_back };
        let mut hpgl = Hpgl::greet(Box::new(wired), handshake).unwrap();
        let ending = drawn(&mut hpgl, &program, &mut Nobody).0;
        assert_eq!(ending, Ending::Done);
        check(&plotter.lock().unwrap(), PATHS);
    }
}

#[test]
fn the_command_draws_by_asking_and_by_xon() {
    for handshake in ["query", "xon"] {
        let (machine, job) = (Machine::of(Plotter::default()), Job::named("plot.hpgl", &plot(PATHS)));
        let output = job.run(&machine, &["--handshake", handshake]);
        assert!(output.status.success() && said(&output).contains("7475A answers"), "{handshake}: {}", said(&output));
        check(&machine.firmware(), PATHS);
    }
}

/// Begun paths by their cell.
fn touched(plotter: &Plotter) -> BTreeMap<(i64, i64), usize> {
    let mut cells = BTreeMap::new();
    for [x, y] in &plotter.touches {
        *cells.entry(((x / 200.0).floor() as i64, (y / 200.0).floor() as i64)).or_default() += 1;
    }
    cells
}

fn length(drawn: &[[[f64; 2]; 2]]) -> f64 {
    drawn.iter().map(|[from, to]| (to[0] - from[0]).hypot(to[1] - from[1])).sum()
}

#[test]
fn a_pulled_cable_is_put_back_and_no_path_is_missing() {
    let whole = {
        let machine = Machine::of(Plotter::default());
        assert!(Job::named("plot.hpgl", &plot(120)).run(&machine, &[]).status.success());
        length(&machine.firmware().drawn)
    };
    at_once(many(50) as u64, |seed| {
        let (machine, job) = (Machine::of(Plotter::default()), Job::named("plot.hpgl", &plot(120)));
        let mut child = job.start(&machine, &[]);
        std::thread::sleep(Duration::from_millis(200 + Chance(seed * 97 + 5).below(900)));
        machine.connect(false);
        std::thread::sleep(Duration::from_millis(30));
        let _ = child.kill();
        let _ = child.wait();
        // Sometimes the machine has drawn what it held when the cable is put back.
        if seed % 2 == 0 {
            std::thread::sleep(Duration::from_millis(600));
        }
        machine.connect(true);
        if !job.file.with_extension("hpgl.journal").exists() {
            return;
        }
        let output = job.run(&machine, &["--continue"]);
        assert!(output.status.success(), "seed {seed}: {}", said(&output));
        let firmware = machine.firmware();
        let cells = touched(&firmware);
        let twice: Vec<_> = cells.iter().filter(|(_, count)| **count > 1).collect();
        assert!(cells.len() == 120 && twice.len() <= 1, "seed {seed}: {} paths, twice {twice:?}", cells.len());
        assert!(length(&firmware.drawn) > whole - 1.0, "seed {seed}: {} of {whole}", length(&firmware.drawn));
    });
}

#[test]
fn what_a_plotter_has_not_is_refused() {
    let (machine, job) = (Machine::of(Plotter::default()), Job::named("plot.hpgl", &plot(3)));
    let output = job.run(&machine, &["--at-origin"]);
    assert!(output.status.code() == Some(2) && said(&output).contains("front panel"), "{}", said(&output));
}
