//! The answers to the page's requests.

use super::document::Change;
use super::drawings::Quality;
use super::error::StudioError;
use super::folder;
use super::sending::Wanted;
use super::session::Studio;
use axum::body::Bytes;
use axum::extract::{Path as UrlPath, Query, State};
use axum::http::{HeaderValue, header};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::Path;
use std::sync::Arc;

type Shared = State<Arc<Studio>>;
type Answer = Result<Response, StudioError>;

fn json(value: &Value) -> Response {
    bytes("application/json", value.to_string().into_bytes())
}

fn bytes(kind: &'static str, bytes: Vec<u8>) -> Response {
    ([(header::CONTENT_TYPE, kind)], bytes).into_response()
}

fn parsed<T: DeserializeOwned>(body: &Bytes) -> Result<T, StudioError> {
    serde_json::from_slice(body).map_err(|error| StudioError::Refused(format!("the request cannot be read: {error}")))
}

async fn state(studio: &Arc<Studio>) -> Answer {
    Ok(json(&studio.state().await))
}

pub(super) async fn start(State(studio): Shared) -> Answer {
    Ok(json(&studio.start().await?))
}

pub(super) async fn scene(State(studio): Shared) -> Answer {
    state(&studio).await
}

#[derive(Deserialize)]
struct Changes {
    label: String,
    changes: Vec<Change>,
}

pub(super) async fn change(State(studio): Shared, body: Bytes) -> Answer {
    let Changes { label, changes } = parsed(&body)?;
    studio.change(&label, &changes)?;
    state(&studio).await
}

#[derive(Deserialize)]
struct Text {
    toml: String,
}

pub(super) async fn replace(State(studio): Shared, body: Bytes) -> Answer {
    let Text { toml } = parsed(&body)?;
    studio.replace("text", &toml)?;
    state(&studio).await
}

pub(super) async fn undo(State(studio): Shared) -> Answer {
    studio.undo()?;
    state(&studio).await
}

pub(super) async fn redo(State(studio): Shared) -> Answer {
    studio.redo()?;
    state(&studio).await
}

#[derive(Deserialize)]
pub(super) struct Named {
    name: String,
}

/// A photograph that was dropped on the page: it is kept beside the scene, and a scene of it begins.
pub(super) async fn drop_photograph(State(studio): Shared, Query(Named { name }): Query<Named>, body: Bytes) -> Answer {
    let home = studio.document().map_or_else(|_| studio.home.clone(), |document| document.folder().to_owned());
    folder::inside(&home, &name)?;
    let trial = studio.scratch.path().join(format!("dropped-{}-{name}", studio.next_drawing()));
    folder::write(&trial, &body)?;
    let seen = studio.photographs.shown(&trial, None).await;
    let _ = std::fs::remove_file(&trial);
    seen.map_err(|error| StudioError::Refused(error.to_string().replace(&*trial.to_string_lossy(), &name)))?;
    let same = folder::inside(&home, &name).ok().filter(|file| std::fs::read(file).is_ok_and(|there| there == *body));
    let file = match same {
        Some(file) => file,
        None => folder::unused(&home, &name)?,
    };
    folder::write(&file, &body)?;
    studio.open(&file).await?;
    state(&studio).await
}

#[derive(Deserialize)]
struct Opened {
    file: String,
}

pub(super) async fn open(State(studio): Shared, body: Bytes) -> Answer {
    let Opened { file } = parsed(&body)?;
    let home = studio.document().map_or_else(|_| studio.home.clone(), |document| document.folder().to_owned());
    // Scenes elsewhere only if they were open before: the list is the user's own.
    let known = studio.recent.list().into_iter().find(|scene| *scene == Path::new(&file));
    let file = known.map_or_else(|| folder::inside(&home, &file), Ok)?;
    studio.open(&file).await?;
    state(&studio).await
}

#[derive(Deserialize)]
pub(super) struct Side {
    long: Option<u32>,
}

pub(super) async fn photograph(State(studio): Shared, Query(Side { long }): Query<Side>) -> Answer {
    let shown = studio.photographs.shown(&studio.photograph()?, Some(long.unwrap_or(1600))).await?;
    Ok(bytes("image/jpeg", shown.jpeg.clone()))
}

pub(super) async fn drawing(State(studio): Shared, UrlPath(id): UrlPath<u64>) -> Answer {
    Ok(bytes("application/json", studio.drawings.find(id)?.answer()))
}

pub(super) async fn masks(State(studio): Shared) -> Answer {
    Ok(json(&studio.masks()?))
}

pub(super) async fn mask(State(studio): Shared, UrlPath(role): UrlPath<String>) -> Answer {
    Ok(bytes("image/png", studio.mask(&role)?))
}

pub(super) async fn paint(State(studio): Shared, UrlPath(role): UrlPath<String>, body: Bytes) -> Answer {
    studio.paint(&role, Some(body.to_vec()))?;
    state(&studio).await
}

pub(super) async fn unpaint(State(studio): Shared, UrlPath(role): UrlPath<String>) -> Answer {
    studio.paint(&role, None)?;
    state(&studio).await
}

#[derive(Deserialize)]
pub(super) struct Machine {
    profile: String,
}

pub(super) async fn plot(State(studio): Shared, Query(Machine { profile }): Query<Machine>) -> Answer {
    Ok(bytes("application/json", studio.plot(&profile).await?))
}

#[derive(Deserialize)]
pub(super) struct How {
    #[serde(default)]
    quality: Quality,
}

pub(super) async fn stages(State(studio): Shared, Query(How { quality }): Query<How>) -> Answer {
    Ok(json(&studio.stages(quality).await?))
}

pub(super) async fn stage(State(studio): Shared, UrlPath(file): UrlPath<String>, Query(How { quality }): Query<How>) -> Answer {
    let (kind, picture) = studio.stage(&file, quality)?;
    Ok(bytes(kind, picture))
}

pub(super) async fn thumbnail(State(studio): Shared, UrlPath(preset): UrlPath<String>) -> Answer {
    Ok(bytes("image/svg+xml", studio.thumbnail(&preset).await?))
}

pub(super) async fn recent(State(studio): Shared) -> Answer {
    let own = studio.document().map(|document| document.file).ok();
    let scenes = studio.recent.list().into_iter().filter(|scene| own.as_ref() != Some(scene));
    let files: Vec<String> = scenes.map(|scene| scene.to_string_lossy().into_owned()).collect();
    Ok(json(&serde_json::json!({ "files": files })))
}

pub(super) async fn ports(State(studio): Shared) -> Answer {
    Ok(json(&studio.ports().await?))
}

#[derive(Deserialize)]
pub(super) struct Part {
    profile: String,
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

pub(super) async fn part(State(studio): Shared, Query(part): Query<Part>) -> Answer {
    let Part { profile, x, y, width, height } = part;
    Ok(json(&studio.part_command(&profile, [x, y, width, height]).await?))
}

pub(super) async fn send(State(studio): Shared, body: Bytes) -> Answer {
    Ok(json(&studio.send(parsed::<Wanted>(&body)?).await?))
}

pub(super) async fn send_on(State(studio): Shared) -> Answer {
    Ok(json(&studio.send_on()?))
}

pub(super) async fn send_pause(State(studio): Shared) -> Answer {
    Ok(json(&studio.send_pause()?))
}

pub(super) async fn send_stop(State(studio): Shared) -> Answer {
    Ok(json(&studio.send_stop()?))
}

#[derive(Deserialize)]
pub(super) struct Export {
    file: String,
    profile: Option<String>,
}

pub(super) async fn export(State(studio): Shared, body: Bytes) -> Answer {
    let Export { file, profile } = parsed(&body)?;
    Ok(json(&studio.export(&file, profile.as_deref()).await?))
}

pub(super) async fn download(State(studio): Shared, Query(Export { file, profile }): Query<Export>) -> Answer {
    let mut answer = bytes("application/octet-stream", studio.download(&file, profile.as_deref()).await?);
    let attached = HeaderValue::from_str(&format!("attachment; filename=\"{}\"", file.replace('"', "")));
    if let Ok(attached) = attached {
        answer.headers_mut().insert(header::CONTENT_DISPOSITION, attached);
    }
    Ok(answer)
}
