//! What the server tells its pages as it happens.

use super::session::Studio;
use axum::extract::State;
use axum::response::sse::{Event, KeepAlive, Sse};
use serde_json::Value;
use std::convert::Infallible;
use std::sync::Arc;
use tokio::sync::broadcast::error::RecvError;
use tokio::sync::broadcast::{Receiver, Sender, channel};
use tokio_stream::Stream;

/// Events kept for a page that is slow; one that misses some is told the state anew.
const KEPT: usize = 256;

/// One event: its name and its data.
#[derive(Clone, Debug)]
pub(super) struct Told {
    name: &'static str,
    data: Value,
}

/// The pages that listen.
pub(super) struct Events(Sender<Told>);

impl Events {
    pub(super) fn new() -> Self {
        Self(channel(KEPT).0)
    }

    /// Tells all pages; it is no error if none listens.
    pub(super) fn tell(&self, name: &'static str, data: Value) {
        let _ = self.0.send(Told { name, data });
    }
}

/// `GET /api/events`.
pub(super) async fn listen(State(studio): State<Arc<Studio>>) -> Sse<impl Stream<Item = Result<Event, Infallible>>> {
    let receiver = studio.events.0.subscribe();
    let greeting = studio.greeting();
    Sse::new(stream(receiver, greeting, studio)).keep_alive(KeepAlive::default())
}

/// What is so now, then what happens.
fn stream(receiver: Receiver<Told>, greeting: Vec<Told>, studio: Arc<Studio>) -> impl Stream<Item = Result<Event, Infallible>> {
    let state = (greeting.into_iter(), receiver, studio);
    futures_util::stream::unfold(state, |(mut waiting, mut receiver, studio)| async move {
        loop {
            if let Some(told) = waiting.next() {
                let event = Event::default().event(told.name).data(told.data.to_string());
                return Some((Ok(event), (waiting, receiver, studio)));
            }
            match receiver.recv().await {
                Ok(told) => waiting = vec![told].into_iter(),
                Err(RecvError::Lagged(_)) => waiting = studio.greeting().into_iter(),
                Err(RecvError::Closed) => return None,
            }
        }
    })
}

impl Told {
    pub(super) const fn new(name: &'static str, data: Value) -> Self {
        Self { name, data }
    }
}
