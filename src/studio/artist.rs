//! Draws whatever the scene says: coarse at once, then in full. A newer change ends the older drawing's process.

use super::drawings::{Drawn, Quality};
use super::error::StudioError;
use super::photographs::Seal;
use super::session::Studio;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;
use tokio::sync::Notify;
use tokio::sync::watch::Receiver;

/// Draws until the studio ends.
pub(super) async fn draw_always(studio: Arc<Studio>) {
    let mut revisions = studio.revision.subscribe();
    let mut looked_at = None;
    loop {
        let revision = *revisions.borrow_and_update();
        tokio::select! {
            // Dropping the work ends its process.
            () = draw(&studio, revision, &mut looked_at) => {}
            () = newer(&mut revisions) => continue,
        }
        newer(&mut revisions).await;
    }
}

async fn newer(revisions: &mut Receiver<u64>) {
    // It fails only once the studio is gone, and this task with it.
    if revisions.changed().await.is_err() {
        std::future::pending::<()>().await;
    }
}

/// Draws one state of the scene in both qualities.
async fn draw(studio: &Studio, revision: u64, looked_at: &mut Option<Seal>) {
    let Ok(photograph) = studio.photograph() else { return };
    let seal = Seal::of(&photograph);
    let proof = Notify::new();
    let looking = async {
        if looked_at.as_ref() != Some(&seal) {
            // What was found before is gone from here on, also if a newer change ends this look.
            *looked_at = None;
            look(studio, &photograph, &proof).await;
            *looked_at = Some(seal);
        }
        proof.notify_one();
    };
    // The coarse drawing waits for the small copies of what was found, not for the large ones.
    let coarse = async {
        proof.notified().await;
        tell_one(studio, revision, Quality::Coarse).await;
    };
    tokio::join!(looking, coarse);
    tell_one(studio, revision, Quality::Full).await;
}

/// Makes one drawing and tells the pages of it. Of a failure only the full drawing tells: it is what the command would say.
async fn tell_one(studio: &Studio, revision: u64, quality: Quality) {
    let id = studio.next_drawing();
    studio.events.tell("started", json!({ "id": id, "quality": quality.name(), "revision": revision }));
    match one(studio, id, revision, quality).await {
        Ok(drawn) => {
            studio.drawings.keep(drawn);
            studio.events.tell("finished", json!({ "id": id, "quality": quality.name(), "revision": revision }));
        }
        Err(error) if quality == Quality::Full => {
            studio.tell_failure(json!({ "quality": quality.name(), "revision": revision, "message": error.to_string() }));
        }
        Err(_) => {}
    }
}

/// Finds what is in the photograph, once for all drawings of it. `proof` is told when the small copies of it are written.
async fn look(studio: &Studio, photograph: &Path, proof: &Notify) {
    studio.tell_sight("looking", "");
    let (found, proofs) = (studio.found(), studio.proofs());
    for before in [&found, &proofs] {
        let _ = std::fs::remove_dir_all(before);
    }
    let _ = std::fs::create_dir_all(&proofs);
    let folder = photograph.parent().unwrap_or(Path::new("."));
    let words = ["see", &photograph.to_string_lossy(), "-o", &found.to_string_lossy()];
    let hear = |step: &str| {
        if step == "proof" {
            proof.notify_one();
        }
    };
    match studio.program.with_proofs(&proofs).run(folder, &words, hear).await {
        Ok(done) => {
            let state = if found.join("subject.png").exists() { "found" } else { "none" };
            studio.tell_sight(state, done.said.first().map_or("", String::as_str));
        }
        Err(error) => studio.tell_sight("failed", &error.to_string()),
    }
}

async fn one(studio: &Studio, id: u64, revision: u64, quality: Quality) -> Result<Drawn, StudioError> {
    let document = studio.document()?;
    let started = Instant::now();
    let marks = studio.scratch.path().join("drawing.json");
    let (scene, output) = (document.name(), marks.to_string_lossy().into_owned());
    let (program, found) = studio.drawing_with(&document, quality);
    let mut words = vec!["draw", &scene, "-o", &output, "--format", "json", "--json"];
    words.extend(found.iter().flat_map(|found| ["--sight", found]));
    if quality == Quality::Coarse {
        words.push("--draft");
    }
    let done = program.run(document.folder(), &words, |stage| {
        studio.events.tell("stage", json!({ "id": id, "stage": stage }));
    });
    let done = done.await?;
    let report: Value = serde_json::from_slice(&done.stdout)
        .map_err(|error| StudioError::Failed(format!("the drawing's report cannot be read: {error}")))?;
    let marks = tokio::fs::read(&marks).await.map_err(StudioError::about(&marks))?;
    Ok(Drawn { id, quality, revision, seconds: started.elapsed().as_secs_f64(), report, said: done.said, marks })
}
