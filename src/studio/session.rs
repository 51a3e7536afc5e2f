//! The state that all pages share: the scene, what can be undone, what was drawn.

use super::command::Program;
use super::document::{Change, Document};
use super::drawings::Drawings;
use super::error::StudioError;
use super::events::{Events, Told};
use super::history::{History, Masks, State};
use super::masks;
use super::photographs::Photographs;
use super::recent::Recent;
use super::sending::Sending;
use super::server::Settings;
use super::stages::Stages;
use super::thumbnails::Thumbnails;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::sync::watch;

/// One scene with all that belongs to it.
pub(super) struct Studio {
    pub port: u16,
    pub token: String,
    pub program: Program,
    pub events: Events,
    pub drawings: Drawings,
    pub photographs: Photographs,
    pub stages: Stages,
    pub thumbnails: Thumbnails,
    pub sending: Sending,
    pub recent: Recent,
    /// Refuses a scene whose keys the command would not take, in words.
    check: SceneCheck,
    /// True once the process was told to end.
    pub is_ending: fn() -> bool,
    /// For drawings on their way and for what was found in photographs; gone when the studio ends.
    pub scratch: tempfile::TempDir,
    /// The folder for a photograph that is dropped before a scene is open.
    pub home: PathBuf,
    session: Mutex<Session>,
    /// The number of the scene's present state; the artist waits for it to change.
    pub revision: watch::Sender<u64>,
    next_drawing: AtomicU64,
}

/// Says what is wrong with a scene's text.
pub type SceneCheck = fn(&str) -> Result<(), String>;

/// What the command line lends the studio. Without it, no scene is remembered, any key is taken, and the process ends unheard.
#[derive(Clone, Debug)]
pub struct Ties {
    /// The file of recent scenes; it need not be there yet.
    pub recent: Option<PathBuf>,
    /// Refuses a scene whose keys or values the command does not know.
    pub check: SceneCheck,
    /// True once the process was told to end: a machine that draws is then stopped.
    pub is_ending: fn() -> bool,
}

impl Default for Ties {
    fn default() -> Self {
        Self { recent: None, check: |_| Ok(()), is_ending: || false }
    }
}

#[derive(Default)]
struct Session {
    document: Option<Document>,
    /// Why the file that an editor left cannot be read.
    error: Option<String>,
    history: History,
    /// What was last told of sight.
    sight: Option<Value>,
    /// Why the last drawing failed.
    failure: Option<Value>,
    /// The file that was last exported, and its machine: the command to copy makes the like.
    exported: Option<(String, Option<String>)>,
}

impl Studio {
    pub(super) fn new(port: u16, settings: &Settings, ties: Ties) -> Result<Self, StudioError> {
        let Settings { program, home, token, show, .. } = settings.clone();
        let Ties { recent, check, is_ending } = ties;
        let scratch = tempfile::Builder::new().prefix("drypoint-studio-").tempdir();
        Ok(Self {
            port,
            token,
            program: Program::new(program),
            events: Events::new(),
            drawings: Drawings::default(),
            photographs: Photographs::new(show),
            stages: Stages::default(),
            thumbnails: Thumbnails::default(),
            sending: Sending::default(),
            recent: Recent(recent),
            check,
            is_ending,
            scratch: scratch.map_err(|error| StudioError::Failed(format!("no folder for drawings on their way: {error}")))?,
            home,
            session: Mutex::default(),
            revision: watch::Sender::new(0),
            next_drawing: AtomicU64::new(1),
        })
    }

    fn session(&self) -> MutexGuard<'_, Session> {
        self.session.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn next_drawing(&self) -> u64 {
        self.next_drawing.fetch_add(1, Ordering::Relaxed)
    }

    /// The scene that is open.
    pub(super) fn document(&self) -> Result<Document, StudioError> {
        self.session().document.clone().ok_or_else(no_scene)
    }

    /// The photograph's file.
    pub(super) fn photograph(&self) -> Result<PathBuf, StudioError> {
        let document = self.document()?;
        let name =
            document.string("photograph").ok_or_else(|| StudioError::Refused("the scene names no photograph".to_owned()))?;
        Ok(document.folder().join(name))
    }

    /// Opens a scene's file, or begins one of a photograph.
    pub(super) async fn open(&self, file: &Path) -> Result<(), StudioError> {
        if !is_scene(file) && file.is_file() {
            // What is no photograph gets no scene.
            self.photographs.shown(file, None).await?;
        }
        let document = self.checked(opened(file)?)?;
        self.recent.note(&document.file);
        let mut session = self.session();
        *session = Session { document: Some(document), ..Session::default() };
        drop(session);
        self.tell_change();
        Ok(())
    }

    /// Refuses a scene with keys or values that the command does not know.
    fn checked(&self, document: Document) -> Result<Document, StudioError> {
        match (self.check)(document.text()) {
            Ok(()) => Ok(document),
            Err(why) => Err(StudioError::Refused(format!("{}: {why}", document.name()))),
        }
    }

    /// Remembers what was exported, for the command to copy.
    pub(super) fn note_export(&self, file: &str, profile: Option<&str>) {
        let profile = profile.filter(|profile| !profile.is_empty()).map(str::to_owned);
        self.session().exported = Some((file.to_owned(), profile));
    }

    /// Changes the scene's keys as one step of undo.
    pub(super) fn change(&self, label: &str, changes: &[Change]) -> Result<(), StudioError> {
        self.step(label, Masks::new(), |document| document.changed(changes))
    }

    /// Replaces the scene's text as one step of undo.
    pub(super) fn replace(&self, label: &str, text: &str) -> Result<(), StudioError> {
        self.step(label, Masks::new(), |document| Document::of(&document.file, text))
    }

    /// Makes one step: masks are written, then the scene.
    pub(super) fn step(
        &self,
        label: &str,
        painted: Masks,
        change: impl FnOnce(&Document) -> Result<Document, StudioError>,
    ) -> Result<(), StudioError> {
        let mut session = self.session();
        let before = session.document.as_ref().ok_or_else(no_scene)?;
        let after = self.checked(change(before)?)?;
        let masks_before = masks::painted(after.folder(), &after, painted.keys())?;
        masks::put(after.folder(), &after, &painted)?;
        after.write()?;
        let states = (
            State { text: before.text().to_owned(), masks: masks_before },
            State { text: after.text().to_owned(), masks: painted },
        );
        session.history.note(label, states.0, states.1);
        session.document = Some(after);
        session.error = None;
        drop(session);
        self.tell_change();
        Ok(())
    }

    /// Takes the last step back; without one, nothing happens.
    pub(super) fn undo(&self) -> Result<(), StudioError> {
        self.go(History::undo, History::redo)
    }

    /// Makes the last undone step again.
    pub(super) fn redo(&self) -> Result<(), StudioError> {
        self.go(History::redo, History::undo)
    }

    fn go(
        &self,
        there: impl Fn(&mut History) -> Option<State>,
        back: impl Fn(&mut History) -> Option<State>,
    ) -> Result<(), StudioError> {
        let mut session = self.session();
        let Some(state) = there(&mut session.history) else { return Ok(()) };
        let document = session.document.as_ref().ok_or_else(no_scene)?;
        let restore = || {
            // Masks lie in the sight folder that either text names.
            let restored = Document::of(&document.file, &state.text)?;
            let keeper = if restored.string("sight").is_some() { &restored } else { document };
            masks::put(document.folder(), keeper, &state.masks)?;
            restored.write()?;
            Ok(restored)
        };
        match restore() {
            Ok(restored) => session.document = Some(restored),
            Err(error) => {
                back(&mut session.history);
                return Err(error);
            }
        }
        drop(session);
        self.tell_change();
        Ok(())
    }

    /// Takes over what an editor wrote into the scene's file, or says why it cannot.
    pub(super) fn follow(&self) {
        let mut session = self.session();
        let Some(document) = &session.document else { return };
        let Ok(bytes) = std::fs::read(&document.file) else { return };
        let text = String::from_utf8_lossy(&bytes);
        if text == document.text() && session.error.is_none() {
            return;
        }
        match Document::of(&document.file, &text).and_then(|read| self.checked(read)) {
            Ok(read) => {
                let states = [document.text(), read.text()].map(|text| State { text: text.to_owned(), masks: Masks::new() });
                let [before, after] = states;
                session.history.note("the file was edited", before, after);
                session.document = Some(read);
                session.error = None;
            }
            Err(error) => {
                let error = Some(error.to_string());
                if session.error == error {
                    return;
                }
                session.error = error;
            }
        }
        drop(session);
        self.tell_change();
    }

    /// A file that the scene names has changed.
    pub(super) fn tell_change(&self) {
        self.revision.send_modify(|revision| *revision += 1);
        self.events.tell("scene", json!({ "revision": *self.revision.borrow() }));
    }

    /// Says what is known of the photograph's people.
    pub(super) fn tell_sight(&self, state: &str, message: &str) {
        let told = json!({ "state": state, "message": message });
        self.session().sight = Some(told.clone());
        self.events.tell("sight", told);
    }

    /// Says why a drawing failed.
    pub(super) fn tell_failure(&self, told: Value) {
        self.session().failure = Some(told.clone());
        self.events.tell("failed", told);
    }

    /// What a page that begins to listen must know.
    pub(super) fn greeting(&self) -> Vec<Told> {
        let revision = *self.revision.borrow();
        let mut told = vec![Told::new("scene", json!({ "revision": revision }))];
        told.extend(self.session().sight.clone().map(|sight| Told::new("sight", sight)));
        let failure = self.session().failure.clone().filter(|failure| failure["revision"] == revision);
        told.extend(failure.map(|failure| Told::new("failed", failure)));
        told.extend(self.sending.last().map(|sending| Told::new("sending", sending)));
        if let Some(drawn) = self.drawings.of_revision(revision) {
            told.push(Told::new("finished", json!({ "id": drawn.id, "quality": drawn.quality.name(), "revision": revision })));
        }
        told
    }

    /// The scene's state for the page.
    pub(super) async fn state(self: &Arc<Self>) -> Value {
        let photograph = match self.photograph() {
            Ok(file) => self.photographs.shown(&file, None).await.ok().map(|shown| {
                json!({ "name": file.file_name().map(|name| name.to_string_lossy()), "width": shown.size.0, "height": shown.size.1 })
            }),
            Err(_) => None,
        };
        let session = self.session();
        let (undo, redo) = session.history.counts();
        let (undo_label, redo_label) = session.history.labels();
        let document = session.document.as_ref();
        let name = document.map(Document::name);
        let exported = session.exported.clone().or_else(|| {
            let output = Path::new(name.as_ref()?).with_extension("svg");
            Some((output.to_string_lossy().into_owned(), None))
        });
        json!({
            "revision": *self.revision.borrow(),
            "file": name,
            "folder": document.map(|document| document.folder().to_string_lossy().into_owned()),
            "toml": document.map_or("", Document::text),
            "values": document.map_or_else(|| json!({}), Document::values),
            "undo": undo,
            "redo": redo,
            "undo_label": undo_label,
            "redo_label": redo_label,
            "command": name.zip(exported).map(|(name, (file, profile))| super::exports::command_line(&name, &file, profile.as_deref())),
            "error": session.error,
            "photograph": photograph,
        })
    }
}

fn no_scene() -> StudioError {
    StudioError::Missing("no scene is open; drop a photograph on the page".to_owned())
}

fn is_scene(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
}

/// The scene in a file; for a photograph, the scene beside it, which is begun if it is not there.
fn opened(file: &Path) -> Result<Document, StudioError> {
    let file = &std::path::absolute(file).map_err(StudioError::about(file))?;
    if is_scene(file) {
        return Document::read(file);
    }
    if !file.is_file() {
        return Err(StudioError::Missing(format!("{} is no file; give a photograph or a scene", file.display())));
    }
    let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let scene = file.with_extension("toml");
    if let Ok(document) = Document::read(&scene)
        && document.string("photograph") == Some(&name)
    {
        return Ok(document);
    }
    let folder = file.parent().unwrap_or(Path::new("."));
    let scene = super::folder::unused(folder, &scene.file_name().unwrap_or_default().to_string_lossy())?;
    let document = Document::of_photograph(&scene, &name)?;
    document.write()?;
    Ok(document)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(home: &Path) -> Settings {
        let show = |_: &Path, _| Err("no photograph".to_owned());
        Settings { program: PathBuf::new(), file: None, home: home.to_owned(), port: 0, token: String::new(), show }
    }

    #[tokio::test]
    async fn a_scene_that_the_command_would_refuse_is_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let check = |text: &str| if text.contains("stile") { Err("there is no key 'stile'".to_owned()) } else { Ok(()) };
        let studio = Studio::new(1, &settings(folder.path()), Ties { check, ..Ties::default() }).unwrap();
        let scene = folder.path().join("a.toml");
        std::fs::write(&scene, "stile = 3\n").unwrap();
        assert_eq!(studio.open(&scene).await.unwrap_err().to_string(), "a.toml: there is no key 'stile'");
        std::fs::write(&scene, "photograph = 'a.jpg'\n").unwrap();
        studio.open(&scene).await.unwrap();
        assert!(studio.replace("text", "stile = 3\n").is_err());
        let change: Change = serde_json::from_value(json!({ "path": ["stile"], "value": 3 })).unwrap();
        assert!(studio.change("stile", &[change]).is_err());
        assert_eq!(std::fs::read_to_string(&scene).unwrap(), "photograph = 'a.jpg'\n");
    }

    #[tokio::test]
    async fn what_is_no_photograph_gets_no_scene() {
        let folder = tempfile::tempdir().unwrap();
        let studio = Studio::new(1, &settings(folder.path()), Ties::default()).unwrap();
        std::fs::write(folder.path().join("notes.txt"), "words").unwrap();
        assert!(studio.open(&folder.path().join("notes.txt")).await.is_err());
        assert!(!folder.path().join("notes.toml").exists());
    }
}
