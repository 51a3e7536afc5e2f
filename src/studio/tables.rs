//! What the page builds its controls from: the command's own lists.

use super::error::StudioError;
use super::session::Studio;
use serde_json::{Value, json};

impl Studio {
    /// `GET /api/start`.
    pub(super) async fn start(&self) -> Result<Value, StudioError> {
        let list = self.list(&["styles", "--json"]).await?;
        let names = list["styles"].as_array().cloned().unwrap_or_default();
        let mut styles = Vec::new();
        for name in names.iter().filter_map(|style| style["name"].as_str()) {
            styles.push(self.list(&["styles", name, "--json"]).await?);
        }
        let mut presets = self.list(&["presets", "--json"]).await?["presets"].take();
        for preset in presets.as_array_mut().into_iter().flatten() {
            let name = preset["name"].as_str().unwrap_or_default().to_owned();
            let whole = self.list(&["presets", &name, "--json"]).await?;
            preset["values"] = toml::from_str(whole["toml"].as_str().unwrap_or_default()).unwrap_or_default();
        }
        Ok(json!({
            "version": env!("CARGO_PKG_VERSION"),
            "styles": styles,
            "presets": presets,
            "profiles": self.list(&["profiles", "--json"]).await?["profiles"],
            "schema": self.list(&["schema"]).await?,
        }))
    }

    pub(super) async fn list(&self, words: &[&str]) -> Result<Value, StudioError> {
        let done = self.program.run(self.scratch.path(), words, |_| {}).await?;
        serde_json::from_slice(&done.stdout).map_err(|error| StudioError::Failed(format!("{}: {error}", words.join(" "))))
    }
}
