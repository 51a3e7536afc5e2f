//! A machine on a pseudo-terminal, and files for it.

use crate::grbl::firmware::Firmware;
use crate::grbl::{SERVO, Settings, Z};
use serialport::{SerialPort, TTYPort};
use std::fmt::Write as _;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// How much faster than in life the machine runs.
pub const FASTER: f64 = 20.0;

/// True if the full numbers are asked for.
pub fn many(full: usize) -> usize {
    if std::env::var_os("DRYPOINT_MANY").is_some() { full } else { full.div_ceil(20) }
}

/// Runs at the same time: most of them wait.
pub fn at_once(runs: u64, run: impl Fn(u64) + Sync) {
    let next = AtomicU64::new(0);
    let work = || {
        loop {
            match next.fetch_add(1, Ordering::SeqCst) {
                seed if seed < runs => run(seed),
                _ => return,
            }
        }
    };
    std::thread::scope(|scope| (0..WORKERS).for_each(|_| drop(scope.spawn(work))));
}

/// Runs at a time.
const WORKERS: usize = 4;

/// A model of a machine, which sees bytes and time.
pub trait Device: Send + 'static {
    fn receive(&mut self, bytes: &[u8]);
    fn run_until(&mut self, seconds: f64);
    fn output(&mut self) -> Vec<u8>;
    fn is_done(&self) -> bool;
}

impl Device for Firmware {
    fn receive(&mut self, bytes: &[u8]) {
        self.receive(bytes);
    }

    fn run_until(&mut self, seconds: f64) {
        self.run_until(seconds);
    }

    fn output(&mut self) -> Vec<u8> {
        self.output()
    }

    fn is_done(&self) -> bool {
        self.is_done()
    }
}

/// A machine that runs on a thread of its own.
pub struct Machine<D = Firmware> {
    firmware: Arc<Mutex<D>>,
    is_connected: Arc<AtomicBool>,
    ends: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    /// The other end of its line, kept open so that the line lives between two senders.
    line: TTYPort,
}

impl Machine {
    pub fn start() -> Self {
        Self::at_pace(FASTER)
    }

    /// A machine that runs so many times faster than in life.
    pub fn at_pace(pace: f64) -> Self {
        Self::changed(pace, |_| {})
    }

    /// A machine with something about it changed.
    pub fn changed(pace: f64, change: impl FnOnce(&mut Firmware)) -> Self {
        Self::with_settings(&SERVO, pace, change)
    }

    /// A machine whose z axis lifts the pen, 2 mm above the paper.
    pub fn of_z_axis(pace: f64) -> Self {
        Self::with_settings(&Z, pace, Firmware::hang_pen)
    }

    pub fn with_settings(settings: &Settings, pace: f64, change: impl FnOnce(&mut Firmware)) -> Self {
        let mut firmware = Firmware::new(settings);
        // The greeting was said before anybody listened.
        firmware.output();
        change(&mut firmware);
        Self::of_pace(firmware, pace)
    }

    /// Waits until it has nothing left to do but half a line, which a pulled cable left.
    pub fn rest_with_half_lines(&self) {
        while !self.firmware().waits_for_line() {
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}

impl<D: Device> Machine<D> {
    pub fn of(device: D) -> Self {
        Self::of_pace(device, FASTER)
    }

    pub fn of_pace(device: D, pace: f64) -> Self {
        let (mut own, line) = TTYPort::pair().unwrap();
        own.set_timeout(Duration::from_millis(1)).unwrap();
        let firmware = Arc::new(Mutex::new(device));
        let (is_connected, ends) = (Arc::new(AtomicBool::new(true)), Arc::new(AtomicBool::new(false)));
        let (shared, connected, end) = (Arc::clone(&firmware), Arc::clone(&is_connected), Arc::clone(&ends));
        let thread = std::thread::spawn(move || {
            let (mut buffer, begun) = ([0; 4096], Instant::now());
            while !end.load(Ordering::SeqCst) {
                let count = own.read(&mut buffer).unwrap_or(0);
                let mut firmware = shared.lock().unwrap();
                let is_connected = connected.load(Ordering::SeqCst);
                if is_connected {
                    firmware.receive(&buffer[..count]);
                }
                firmware.run_until(pace * begun.elapsed().as_secs_f64());
                let output = firmware.output();
                drop(firmware);
                if is_connected && !output.is_empty() {
                    let _ = own.write_all(&output);
                }
            }
        });
        Self { firmware, is_connected, ends, thread: Some(thread), line }
    }

    /// The port's name.
    pub fn port(&self) -> String {
        self.line.name().unwrap()
    }

    pub fn firmware(&self) -> MutexGuard<'_, D> {
        self.firmware.lock().unwrap()
    }

    /// Pulls the cable, or puts it back.
    pub fn connect(&self, is_connected: bool) {
        self.is_connected.store(is_connected, Ordering::SeqCst);
    }

    /// Waits until it has nothing left to do.
    pub fn rest(&self) {
        while !self.firmware().is_done() {
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}

impl<D> Drop for Machine<D> {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::SeqCst);
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

/// A file in a folder of its own.
pub struct Job {
    pub folder: TempDir,
    pub file: PathBuf,
}

impl Job {
    pub fn new(text: &str) -> Self {
        Self::named("plot.gcode", text)
    }

    pub fn named(name: &str, text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(name);
        std::fs::write(&file, text).unwrap();
        Self { folder, file }
    }

    /// `drypoint send` of this file to a machine.
    pub fn send<D: Device>(&self, machine: &Machine<D>, more: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
        command.current_dir(self.folder.path()).args(["send", text(&self.file), "--port", &machine.port(), "--yes"]).args(more);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    pub fn start<D: Device>(&self, machine: &Machine<D>, more: &[&str]) -> Child {
        self.send(machine, more).spawn().unwrap()
    }

    pub fn run<D: Device>(&self, machine: &Machine<D>, more: &[&str]) -> Output {
        self.send(machine, more).output().unwrap()
    }
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

pub fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// A small generator, so that every run of the tests is the same.
pub struct Chance(pub u64);

impl Chance {
    pub fn below(&mut self, most: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % most
    }
}

/// A plot of dots, short strokes, arcs and long lines, with the lines of `grbl-servo`.
pub fn plot(paths: usize, seed: u64) -> String {
    let mut chance = Chance(seed * 7919 + 1);
    let mut text = "(drypoint 0.1.0 for grbl-servo)\n(pen up is M3 S300)\n(pen down is M3 S700)\nG21\nG90\nG94\nG17\nM3 S300\nG4 P.15\n(pen 1: lines 0.3)\n"
        .to_owned();
    for i in 0..paths {
        // Each path in a cell of its own, so that it is known by its place.
        let (x, y) = (8.0 * (i % 30) as f64 + 2.0, 8.0 * (i / 30) as f64 + 2.0);
        let _ = write!(text, "G0 X{x} Y{y}\nM3 S700\nG4 P.2\n");
        match chance.below(4) {
            0 => {}
            1 => {
                let _ = write!(text, "G1 X{} Y{y} F3000\nG3 X{} Y{} I0 J1.5\n", x + 3.0, x + 3.0, y + 3.0);
            }
            2 => {
                let _ = writeln!(text, "G1 X{} Y{} F3000", x + 5.0, y + 5.0);
            }
            _ => {
                for step in 1..=12 {
                    let feed = if step == 1 { " F3000" } else { "" };
                    let _ = writeln!(
                        text,
                        "G1 X{:.3} Y{:.3}{feed}",
                        x + 0.4 * f64::from(step),
                        y + chance.below(3000) as f64 / 1000.0
                    );
                }
            }
        }
        text += "M3 S300\nG4 P.15\n";
    }
    text + "G0 X0 Y0\n"
}

/// The same for `grbl-z`.
pub fn plot_on_z(paths: usize, seed: u64) -> String {
    plot(paths, seed)
        .replace("(pen up is M3 S300)\n(pen down is M3 S700)\n", "(pen up is G0 Z2)\n")
        .replace("M3 S300\nG4 P.15\n", "G0 Z2\n")
        .replace("M3 S700\nG4 P.2\n", "G1 Z0 F480\n")
        .replace("grbl-servo", "grbl-z")
}
