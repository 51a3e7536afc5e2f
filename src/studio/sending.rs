//! A drawing sent to its machine. The page only asks: whether it stays open or not, the machine goes on, and when the studio ends, the
//! sender is told to stop, which lifts the pen.

use super::command::Sender;
use super::error::StudioError;
use super::exports::{checked, quoted};
use super::part::region;
use super::session::Studio;
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::io::{AsyncBufReadExt, BufReader};
use tokio::process::{ChildStderr, ChildStdout};

/// How often a running sender is asked whether the studio ends.
const LOOKING: Duration = Duration::from_millis(50);
/// Lines of messages that are kept.
const MOST_MESSAGES: usize = 50;
/// The states in which nothing moves any more.
const ENDED: [&str; 3] = ["done", "stopped", "failed"];

/// What the page asks for.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Wanted {
    port: String,
    profile: String,
    /// Only the paths that touch this box: x, y, width and height on the sheet in millimetres.
    part: Option<[f64; 4]>,
}

/// A file and how it is sent.
#[derive(Clone, Debug)]
struct Job {
    folder: PathBuf,
    file: String,
    wanted: Wanted,
    region: Option<String>,
}

/// The one drawing that may be on its way.
#[derive(Default)]
pub(super) struct Sending(Mutex<State>);

#[derive(Default)]
struct State {
    is_busy: bool,
    /// The process, while it runs.
    sender: Option<u32>,
    job: Option<Job>,
    last: Option<Value>,
}

/// Frees the machine again if preparing ends early, for whatever reason.
struct Claim<'a>(Option<&'a Sending>);

impl Drop for Claim<'_> {
    fn drop(&mut self) {
        if let Some(sending) = self.0 {
            sending.state().is_busy = false;
        }
    }
}

impl Sending {
    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What was last told of it.
    pub(super) fn last(&self) -> Option<Value> {
        self.state().last.clone()
    }

    fn claim(&self) -> Result<Claim<'_>, StudioError> {
        let mut state = self.state();
        if state.is_busy {
            return Err(StudioError::Refused("a drawing is on its way to a machine; stop it first".to_owned()));
        }
        state.is_busy = true;
        Ok(Claim(Some(self)))
    }
}

impl Studio {
    /// `GET /api/ports`.
    pub(super) async fn ports(&self) -> Result<Value, StudioError> {
        let mut answer = self.list(&["ports", "--json"]).await?;
        answer["sending"] = json!(self.sending.last());
        Ok(answer)
    }

    /// `GET /api/part`: the command that sends a part of the sheet.
    pub(super) async fn part_command(&self, profile: &str, part: [f64; 4]) -> Result<Value, StudioError> {
        let (machine, ending) = self.machine(profile).await?;
        let page = self.drawings.page().ok_or_else(|| StudioError::Refused("nothing is drawn yet; wait a moment".to_owned()))?;
        let region = region(part, page, &machine)?;
        let file = machine_file(&self.document()?.name(), profile, ending);
        Ok(json!({ "command": format!("drypoint send {} --port PORT {region}", quoted(&file)) }))
    }

    /// A machine's profile, and how its files end.
    async fn machine(&self, profile: &str) -> Result<(toml::Table, &'static str), StudioError> {
        let told = self.list(&["profiles", checked(profile)?, "--json"]).await?;
        let machine: toml::Table = told["toml"].as_str().unwrap_or_default().parse().unwrap_or_default();
        let ending = match machine.get("language").and_then(toml::Value::as_str) {
            Some("hpgl") => "hpgl",
            Some("gcode") => "gcode",
            _ => "svg",
        };
        Ok((machine, ending))
    }

    /// `POST /api/send`: makes the machine's file beside the scene and sends it.
    pub(super) async fn send(self: &Arc<Self>, wanted: Wanted) -> Result<Value, StudioError> {
        check_port(&wanted.port)?;
        let claim = self.sending.claim()?;
        let document = self.document()?;
        let (machine, ending) = self.machine(&wanted.profile).await?;
        let scene = document.name();
        let file = machine_file(&scene, &wanted.profile, ending);
        let words = ["draw", &scene, "-o", &file, "--profile", &wanted.profile, "--json"];
        let done = self.program.run(document.folder(), &words, |_| {}).await?;
        let report: Value = serde_json::from_slice(&done.stdout).unwrap_or_default();
        let page = [0, 1].map(|i| report["page_mm"][i].as_f64().unwrap_or_default());
        let region = wanted.part.map(|part| region(part, page, &machine)).transpose()?;
        let job = Job { folder: document.folder().to_owned(), file, wanted, region };
        self.begin(claim, job, None)
    }

    /// `POST /api/send/continue`: goes on where the last drawing stopped.
    pub(super) fn send_on(self: &Arc<Self>) -> Result<Value, StudioError> {
        let claim = self.sending.claim()?;
        let job = self.sending.state().job.clone();
        let job = job.ok_or_else(|| StudioError::Refused("nothing was sent yet that could go on".to_owned()))?;
        self.begin(claim, job, Some("--continue"))
    }

    /// `POST /api/send/pause`: pauses at the end of the path, or goes on.
    pub(super) fn send_pause(&self) -> Result<Value, StudioError> {
        self.signal(Sender::pause)
    }

    /// `POST /api/send/stop`: stops at once and lifts the pen.
    pub(super) fn send_stop(&self) -> Result<Value, StudioError> {
        self.signal(Sender::stop)
    }

    fn signal(&self, signal: fn(u32) -> Result<(), StudioError>) -> Result<Value, StudioError> {
        let state = self.sending.state();
        let sender = state.sender.ok_or_else(|| StudioError::Refused("nothing is being sent".to_owned()))?;
        signal(sender)?;
        Ok(json!(state.last))
    }

    fn begin(self: &Arc<Self>, mut claim: Claim<'_>, job: Job, more: Option<&str>) -> Result<Value, StudioError> {
        let Wanted { port, profile, .. } = &job.wanted;
        let mut words = vec!["send", &job.file, "--port", port, "--profile", profile, "--yes", "-q", "--status", "-"];
        // What is left of a part is in the journal.
        match more {
            Some(more) => words.push(more),
            None => words.extend(job.region.as_deref()),
        }
        let sender = self.program.send(&job.folder, &words)?;
        claim.0 = None;
        let mut state = self.sending.state();
        state.sender = sender.id();
        state.job = Some(job);
        drop(state);
        self.tell_sending(json!({ "state": "meeting" }));
        tokio::spawn(follow(Arc::clone(self), sender));
        Ok(json!(self.sending.last()))
    }

    fn tell_sending(&self, mut told: Value) {
        let mut state = self.sending.state();
        if let Some(job) = &state.job {
            told["file"] = json!(job.file);
            told["port"] = json!(job.wanted.port);
            told["machine"] = json!(job.wanted.profile);
        }
        // Within the lock, so that the pages hear it in the order in which it happened.
        state.last = Some(told.clone());
        self.events.tell("sending", told);
    }
}

/// The name of a machine's file beside the scene.
fn machine_file(scene: &str, profile: &str, ending: &str) -> String {
    let stem = |name: &str| name.strip_suffix(".toml").unwrap_or(name).to_owned();
    format!("{}-{}.{ending}", stem(scene), stem(profile))
}

/// Hears the sender until it ends, and stops it when the studio ends.
async fn follow(studio: Arc<Studio>, mut sender: Sender) {
    let Some((stdout, stderr)) = sender.pipes() else { return };
    let id = sender.id();
    let stopping = async {
        while !(studio.is_ending)() {
            tokio::time::sleep(LOOKING).await;
        }
        let _ = id.map(Sender::stop);
        std::future::pending::<()>().await;
    };
    let ended = async {
        let (end, said) = tokio::join!(hear(&studio, stdout), complaints(stderr));
        (end, said, sender.ended().await)
    };
    let (end, said, status) = tokio::select! {
        ended = ended => ended,
        () = stopping => return,
    };
    let mut state = studio.sending.state();
    state.is_busy = false;
    state.sender = None;
    drop(state);
    studio.tell_sending(end.unwrap_or_else(|| {
        let fault = status.map(|status| super::command::reason(&said, &status));
        json!({ "state": if fault.is_some() { "failed" } else { "done" }, "fault": fault })
    }));
}

/// Tells what the sender says. Its end is returned, to be told when the process has ended: whoever hears it can go on at once.
async fn hear(studio: &Studio, stdout: ChildStdout) -> Option<Value> {
    let mut lines = BufReader::new(stdout).lines();
    let mut end = None;
    while let Ok(Some(line)) = lines.next_line().await {
        let Ok(told) = serde_json::from_str::<Value>(&line) else { continue };
        if told["state"].as_str().is_some_and(|state| ENDED.contains(&state)) {
            end = Some(told);
        } else {
            studio.tell_sending(told);
        }
    }
    end
}

/// The last messages of the sender.
async fn complaints(stderr: ChildStderr) -> Vec<String> {
    let mut said = Vec::new();
    let mut lines = BufReader::new(stderr).lines();
    while let Ok(Some(line)) = lines.next_line().await {
        said.push(line);
        let surplus = said.len().saturating_sub(MOST_MESSAGES);
        said.drain(..surplus);
    }
    said
}

/// A serial line's name, or an address; never an option.
fn check_port(port: &str) -> Result<(), StudioError> {
    let is_name = !port.is_empty() && port.len() < 300 && !port.starts_with('-') && !port.contains(char::is_control);
    if is_name { Ok(()) } else { Err(StudioError::Refused(format!("'{port}' is no port; choose one, or write tcp://HOST:PORT"))) }
}
