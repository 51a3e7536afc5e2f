//! The processes that draw.

use super::super::failure::Failure;
use std::io::Read;
use std::path::PathBuf;
use std::process::{Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Bytes of a picture's messages that are kept.
const MOST_MESSAGES: u64 = 1 << 16;
/// How often the wish to stop is looked for.
const LOOKING: Duration = Duration::from_millis(20);
/// What our own messages begin with.
const OWN: &str = "drypoint: ";
const WARNING: &str = "warning: ";

/// The processes that draw now.
pub(super) struct Children {
    program: PathBuf,
    /// Their numbers. One leaves the list before the system may give its number to another process.
    running: Mutex<Vec<u32>>,
    has_ended: AtomicBool,
}

impl Children {
    pub(super) fn new() -> Result<Self, Failure> {
        let program = std::env::current_exe().map_err(|error| {
            Failure::Work(format!("drypoint does not find its own program, which draws each picture: {error}"))
        })?;
        Ok(Self { program, running: Mutex::new(Vec::new()), has_ended: AtomicBool::new(false) })
    }

    /// Runs the command; returns its warnings.
    pub(super) fn run(&self, words: &[String]) -> Result<Vec<String>, Failure> {
        let mut child = Command::new(&self.program)
            .args(words)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| Failure::Work(format!("{} cannot be started: {error}", self.program.display())))?;
        let number = child.id();
        self.running().push(number);
        let messages = child.stderr.take().map(messages).unwrap_or_default();
        let mut running = self.running();
        running.retain(|other| *other != number);
        // It has closed its messages, so it ends now.
        let status = child.wait();
        drop(running);
        let status = status.map_err(|error| Failure::Work(format!("the end of the process cannot be seen: {error}")))?;
        if status.success() { Ok(warnings(&messages)) } else { Err(failure(status, &messages)) }
    }

    /// Asks all processes to stop once that is wished; returns when the batch has ended.
    pub(super) fn stop_when(&self, is_wished: impl Fn() -> bool) {
        while !self.has_ended.load(Ordering::SeqCst) {
            if is_wished() {
                self.running().iter().for_each(|number| ask_to_stop(*number));
            }
            std::thread::sleep(LOOKING);
        }
    }

    pub(super) fn end(&self) {
        self.has_ended.store(true, Ordering::SeqCst);
    }

    fn running(&self) -> std::sync::MutexGuard<'_, Vec<u32>> {
        self.running.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(unix)]
fn ask_to_stop(number: u32) {
    let process = i32::try_from(number).ok().and_then(rustix::process::Pid::from_raw);
    if let Some(process) = process {
        // One that has just ended needs no signal.
        let _ = rustix::process::kill_process(process, rustix::process::Signal::TERM);
    }
}

/// Elsewhere a picture under way is finished.
#[cfg(not(unix))]
fn ask_to_stop(_: u32) {}

/// All that a process says, until it ends; only the beginning is kept.
fn messages(mut pipe: impl Read) -> String {
    let mut kept = Vec::new();
    let _ = pipe.by_ref().take(MOST_MESSAGES).read_to_end(&mut kept);
    let _ = std::io::copy(&mut pipe, &mut std::io::sink());
    String::from_utf8_lossy(&kept).into_owned()
}

fn warnings(messages: &str) -> Vec<String> {
    let own = messages.lines().filter_map(|line| line.strip_prefix(OWN));
    own.map(|line| line.strip_prefix(WARNING).unwrap_or(line).to_owned()).collect()
}

/// Why a process failed, from its last message.
fn failure(status: ExitStatus, messages: &str) -> Failure {
    let told = messages.lines().rev().find_map(|line| line.strip_prefix(OWN).filter(|line| !line.starts_with(WARNING)));
    match (status.code(), told) {
        // The parser's messages have several lines.
        (Some(2), None) => Failure::Usage(messages.trim().to_owned()),
        (Some(2), Some(told)) => Failure::Usage(told.to_owned()),
        (Some(_), Some(told)) => Failure::Work(told.to_owned()),
        (Some(code), None) => {
            let last = messages.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it said nothing");
            Failure::Work(format!("drawing ended with status {code}: {last}"))
        }
        (None, _) => {
            Failure::Work(format!("drawing was ended by the system ({status}); perhaps memory ran out: fewer --jobs need less"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_become_warnings_and_reasons() {
        let said = "drypoint: warning: little ink\ndrypoint: a.jpg is empty\n";
        assert_eq!(warnings(said), ["little ink", "a.jpg is empty"]);
        #[cfg(unix)]
        {
            use std::os::unix::process::ExitStatusExt;
            assert_eq!(failure(ExitStatus::from_raw(1 << 8), said).to_string(), "a.jpg is empty");
            assert!(matches!(failure(ExitStatus::from_raw(2 << 8), "error: x\n\nUsage: y\n"), Failure::Usage(_)));
            assert!(failure(ExitStatus::from_raw(101 << 8), "panicked\n").to_string().contains("status 101: panicked"));
            assert!(failure(ExitStatus::from_raw(9), "").to_string().contains("ended by the system"));
        }
    }
}
