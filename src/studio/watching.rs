//! Follows files that other programs change: the scene, the photograph, the masks.

use super::photographs::Seal;
use super::session::Studio;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// How often files are looked at.
const LOOKING: Duration = Duration::from_millis(300);

/// Watches until the studio ends.
pub(super) async fn watch_always(studio: Arc<Studio>) {
    let mut known: Option<(PathBuf, Seal)> = None;
    loop {
        tokio::time::sleep(LOOKING).await;
        studio.follow();
        let Ok(photograph) = studio.photograph() else { continue };
        let seal = Seal::of(&photograph);
        let is_changed = known.as_ref().is_some_and(|(file, before)| *file == photograph && *before != seal);
        known = Some((photograph, seal));
        if is_changed {
            studio.tell_change();
        }
    }
}
