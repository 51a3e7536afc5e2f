//! Processes of drypoint, which do the work.

use super::error::StudioError;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use tokio::io::{AsyncBufReadExt, AsyncReadExt, BufReader};
use tokio::process::{Child, ChildStderr, ChildStdout, Command};

/// What our own messages begin with.
const OWN: &str = "drypoint: ";
const WARNING: &str = "warning: ";
/// Bytes of messages that are kept.
const MOST_MESSAGES: usize = 1 << 16;

/// The program that draws.
#[derive(Clone, Debug)]
pub(super) struct Program {
    pub file: PathBuf,
    /// The folder of small copies, if it draws from these.
    pub proofs: Option<PathBuf>,
}

/// What a process left.
#[derive(Debug, Default)]
pub(super) struct Done {
    pub stdout: Vec<u8>,
    /// Its notices and warnings.
    pub said: Vec<String>,
}

impl Program {
    pub(super) const fn new(file: PathBuf) -> Self {
        Self { file, proofs: None }
    }

    /// The same, with a folder of small copies of photographs and masks.
    pub(super) fn with_proofs(&self, folder: &Path) -> Self {
        Self { proofs: Some(folder.to_owned()), ..self.clone() }
    }

    /// Runs to the end in the folder. `stage` hears the name of each step. Dropping the future ends the process.
    pub(super) async fn run(&self, folder: &Path, words: &[&str], mut stage: impl FnMut(&str)) -> Result<Done, StudioError> {
        let mut child = self.start(folder, words)?;
        let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
        let reading = async {
            let mut bytes = Vec::new();
            if let Some(mut pipe) = stdout {
                let _ = pipe.read_to_end(&mut bytes).await;
            }
            bytes
        };
        let hearing = async {
            let mut said = Vec::new();
            let mut length = 0;
            let mut lines = stderr.map(|pipe| BufReader::new(pipe).lines());
            while let Some(lines) = &mut lines
                && let Ok(Some(line)) = lines.next_line().await
            {
                if let Some(step) = line.strip_prefix("step: ") {
                    stage(step);
                } else if length < MOST_MESSAGES {
                    length += line.len();
                    said.push(line);
                }
            }
            said
        };
        let (stdout, said) = tokio::join!(reading, hearing);
        let status =
            child.wait().await.map_err(|error| StudioError::Failed(format!("drawing cannot be seen to end: {error}")))?;
        if status.success() {
            let told = said.iter().filter_map(|line| line.strip_prefix(OWN));
            return Ok(Done { stdout, said: told.map(str::to_owned).collect() });
        }
        Err(StudioError::Refused(reason(&said, &status.to_string())))
    }

    fn start(&self, folder: &Path, words: &[&str]) -> Result<Child, StudioError> {
        let mut command = Command::new(&self.file);
        command.args(words).current_dir(folder).env("DRYPOINT_PROGRESS", "lines");
        match &self.proofs {
            Some(folder) => command.env("DRYPOINT_PROOFS", folder),
            None => command.env_remove("DRYPOINT_PROOFS"),
        };
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).kill_on_drop(true);
        command.spawn().map_err(|error| StudioError::Failed(format!("{} cannot be started: {error}", self.file.display())))
    }
}

/// A process that sends a drawing to its machine. It outlives the page, and no signal of the terminal reaches it: the studio passes
/// one on, so that it hears it once and has the time to lift the pen.
pub(super) struct Sender(Child);

impl Program {
    /// Starts to send.
    pub(super) fn send(&self, folder: &Path, words: &[&str]) -> Result<Sender, StudioError> {
        if !cfg!(unix) {
            let why = "the page cannot pause or stop a machine on this system";
            return Err(StudioError::Refused(format!("{why}; export the file and use drypoint send in a terminal")));
        }
        let mut command = Command::new(&self.file);
        command.args(words).current_dir(folder);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).kill_on_drop(false);
        #[cfg(unix)]
        command.process_group(0);
        let cannot = |error| StudioError::Failed(format!("{} cannot be started: {error}", self.file.display()));
        command.spawn().map(Sender).map_err(cannot)
    }
}

impl Sender {
    pub(super) fn id(&self) -> Option<u32> {
        self.0.id()
    }

    /// Its status lines and its messages, once.
    pub(super) fn pipes(&mut self) -> Option<(ChildStdout, ChildStderr)> {
        self.0.stdout.take().zip(self.0.stderr.take())
    }

    /// Waits for its end; returns its status unless it succeeded.
    pub(super) async fn ended(&mut self) -> Option<String> {
        match self.0.wait().await {
            Ok(status) => (!status.success()).then(|| status.to_string()),
            Err(error) => Some(error.to_string()),
        }
    }

    /// Pauses at the end of the path, or goes on.
    pub(super) fn pause(id: u32) -> Result<(), StudioError> {
        signalled(id, Signal::Pause)
    }

    /// Stops at once and lifts the pen.
    pub(super) fn stop(id: u32) -> Result<(), StudioError> {
        signalled(id, Signal::Stop)
    }
}

#[derive(Clone, Copy)]
enum Signal {
    Pause,
    Stop,
}

#[cfg(unix)]
fn signalled(id: u32, signal: Signal) -> Result<(), StudioError> {
    use rustix::process::{Pid, kill_process};
    let signal = match signal {
        Signal::Pause => rustix::process::Signal::USR1,
        Signal::Stop => rustix::process::Signal::TERM,
    };
    let process = i32::try_from(id).ok().and_then(Pid::from_raw);
    let process = process.ok_or_else(|| StudioError::Failed("the sender's process has no number".to_owned()))?;
    kill_process(process, signal).map_err(|error| StudioError::Failed(format!("the sender cannot be told: {error}")))
}

#[cfg(not(unix))]
fn signalled(_: u32, _: Signal) -> Result<(), StudioError> {
    Err(StudioError::Refused("this system has no signals by which a sender could be told".to_owned()))
}

/// Why a process failed, from what it said.
pub(super) fn reason(said: &[String], status: &str) -> String {
    let own = said.iter().rev().find_map(|line| line.strip_prefix(OWN).filter(|line| !line.starts_with(WARNING)));
    // The parser's messages begin otherwise, and their first line says what is wrong.
    let parsers = said.iter().find_map(|line| line.strip_prefix("error: "));
    own.or(parsers).map_or_else(|| format!("drawing ended with {status}: {}", said.join(" ")), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_says_its_reason() {
        let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(reason(&lines("drypoint: warning: x\ndrypoint: a.jpg is empty"), "1"), "a.jpg is empty");
        assert_eq!(reason(&lines("error: no such style\n\nUsage: y"), "2"), "no such style");
        assert!(reason(&lines("panicked"), "exit status: 101").contains("101: panicked"));
    }
}
