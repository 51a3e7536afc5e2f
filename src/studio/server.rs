//! The server on this computer's own address.

use super::error::StudioError;
use super::photographs::Shower;
use super::session::{Studio, Ties};
use super::{answers, artist, events, guard, page, watching};
use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::middleware::from_fn_with_state;
use axum::routing::{get, post};
use std::net::Ipv4Addr;
use std::path::PathBuf;
use std::sync::Arc;
use tokio::net::TcpListener;

/// Bytes of a request: a large photograph.
const MOST_BYTES: usize = 300 << 20;

/// What the studio is started with.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The program that draws: this one.
    pub program: PathBuf,
    /// A photograph or a scene; without one the page waits for a photograph to be dropped.
    pub file: Option<PathBuf>,
    /// Where a photograph is kept that is dropped before a scene is open.
    pub home: PathBuf,
    /// The port; 0 takes a free one.
    pub port: u16,
    /// What the page's address must hold: nobody else on this computer can guess it.
    pub token: String,
    /// Makes the page's pictures of photographs.
    pub show: Shower,
}

/// Serves the page until the process ends, with what the command line lends it. `announce` is given its address.
pub fn serve(settings: Settings, ties: Ties, announce: impl FnOnce(&str)) -> Result<(), StudioError> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let runtime = runtime.map_err(|error| StudioError::Failed(format!("the server cannot start: {error}")))?;
    runtime.block_on(run(settings, ties, announce))
}

async fn run(settings: Settings, ties: Ties, announce: impl FnOnce(&str)) -> Result<(), StudioError> {
    let taken = |error| {
        let other = if settings.port == 0 { "" } else { "; choose another, or 0 for any that is free" };
        StudioError::Failed(format!("port {}: {error}{other}", settings.port))
    };
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, settings.port)).await.map_err(taken)?;
    let port = listener.local_addr().map_err(taken)?.port();
    let address = format!("http://127.0.0.1:{port}/?token={}", settings.token);
    let studio = Arc::new(Studio::new(port, &settings, ties)?);
    if let Some(file) = &settings.file {
        studio.open(file).await?;
    }
    tokio::spawn(artist::draw_always(Arc::clone(&studio)));
    tokio::spawn(watching::watch_always(Arc::clone(&studio)));
    announce(&address);
    axum::serve(listener, router(studio)).await.map_err(|error| StudioError::Failed(format!("the server ended: {error}")))
}

fn router(studio: Arc<Studio>) -> Router {
    Router::new()
        .route("/", get(page::index))
        .route("/studio.js", get(page::script))
        .route("/worker.js", get(page::worker))
        .route("/studio.css", get(page::style))
        .route("/api/start", get(answers::start))
        .route("/api/scene", get(answers::scene).post(answers::change).put(answers::replace))
        .route("/api/undo", post(answers::undo))
        .route("/api/redo", post(answers::redo))
        .route("/api/open", post(answers::open))
        .route("/api/photograph", get(answers::photograph).post(answers::drop_photograph))
        .route("/api/drawing/{id}", get(answers::drawing))
        .route("/api/masks", get(answers::masks))
        .route("/api/mask/{role}", get(answers::mask).put(answers::paint).delete(answers::unpaint))
        .route("/api/stages", get(answers::stages))
        .route("/api/stage/{file}", get(answers::stage))
        .route("/api/thumbnail/{preset}", get(answers::thumbnail))
        .route("/api/recent", get(answers::recent))
        .route("/api/ports", get(answers::ports))
        .route("/api/part", get(answers::part))
        .route("/api/send", post(answers::send))
        .route("/api/send/pause", post(answers::send_pause))
        .route("/api/send/stop", post(answers::send_stop))
        .route("/api/send/continue", post(answers::send_on))
        .route("/api/plot", get(answers::plot))
        .route("/api/export", get(answers::download).post(answers::export))
        .route("/api/events", get(events::listen))
        .layer(DefaultBodyLimit::max(MOST_BYTES))
        .layer(from_fn_with_state(Arc::clone(&studio), guard::guard))
        .with_state(studio)
}
