//! Processes of drypoint, which do the work.

use super::error::StudioError;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use tokio::io::{AsyncBufReadExt, AsyncReadExt, BufReader};
use tokio::process::{Child, Command};

/// What our own messages begin with.
const OWN: &str = "drypoint: ";
const WARNING: &str = "warning: ";
/// Bytes of messages that are kept.
const MOST_MESSAGES: usize = 1 << 16;

/// The program that draws.
#[derive(Clone, Debug)]
pub(super) struct Program(pub PathBuf);

/// What a process left.
#[derive(Debug, Default)]
pub(super) struct Done {
    pub stdout: Vec<u8>,
    /// Its notices and warnings.
    pub said: Vec<String>,
}

impl Program {
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
        let mut command = Command::new(&self.0);
        command.args(words).current_dir(folder).env("DRYPOINT_PROGRESS", "lines");
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).kill_on_drop(true);
        command.spawn().map_err(|error| StudioError::Failed(format!("{} cannot be started: {error}", self.0.display())))
    }
}

/// Why a process failed, from what it said.
fn reason(said: &[String], status: &str) -> String {
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
