//! Files that leave the studio, made by the command that the page shows.

use super::error::StudioError;
use super::folder;
use super::session::Studio;
use serde_json::{Value, json};
use std::path::Path;

/// The command that makes a file of a scene, as one would type it.
pub(super) fn command_line(scene: &str, file: &str, profile: Option<&str>) -> String {
    let profile = profile.map(|profile| format!(" --profile {}", quoted(profile))).unwrap_or_default();
    format!("drypoint draw {} -o {}{profile}", quoted(scene), quoted(file))
}

/// A word for a shell.
pub(super) fn quoted(word: &str) -> String {
    let is_plain = word.chars().all(|c| c.is_ascii_alphanumeric() || "._-+/".contains(c)) && !word.is_empty();
    if is_plain { word.to_owned() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

impl Studio {
    /// Writes a file beside the scene.
    pub(super) async fn export(&self, file: &str, profile: Option<&str>) -> Result<Value, StudioError> {
        let document = self.document()?;
        let output = folder::inside(document.folder(), file)?;
        if output == document.file {
            return Err(StudioError::Refused(format!("{file} is the scene itself; choose another name")));
        }
        self.made(file, profile).await?;
        self.note_export(file, profile);
        let bytes = std::fs::metadata(&output).map_or(0, |found| found.len());
        Ok(json!({ "file": file, "bytes": bytes, "command": command_line(&document.name(), file, profile) }))
    }

    /// A file's bytes, for a download; nothing is left beside the scene.
    pub(super) async fn download(&self, file: &str, profile: Option<&str>) -> Result<Vec<u8>, StudioError> {
        let document = self.document()?;
        folder::inside(document.folder(), file)?;
        let passing = self.scratch.path().join(format!("download-{}", self.next_drawing()));
        std::fs::create_dir(&passing).map_err(StudioError::about(&passing))?;
        let output = passing.join(file);
        let made = self.made(&output.to_string_lossy(), profile).await;
        let bytes = made.and_then(|()| std::fs::read(&output).map_err(StudioError::about(&output)));
        let _ = std::fs::remove_dir_all(&passing);
        self.note_export(file, profile);
        bytes
    }

    /// What a machine would draw, in its order, with the report of it.
    pub(super) async fn plot(&self, profile: &str) -> Result<Vec<u8>, StudioError> {
        let document = self.document()?;
        let marks = self.scratch.path().join(format!("plot-{}.json", self.next_drawing()));
        let (scene, output) = (document.name(), marks.to_string_lossy().into_owned());
        let words = ["draw", &scene, "-o", &output, "--format", "json", "--profile", checked(profile)?, "--json"];
        let done = self.program.run(document.folder(), &words, |_| {}).await?;
        let report: Value = serde_json::from_slice(&done.stdout).unwrap_or_default();
        let paths = tokio::fs::read(&marks).await.map_err(StudioError::about(&marks))?;
        let _ = tokio::fs::remove_file(&marks).await;
        let head = json!({
            "machine": profile,
            "seconds": report["total"]["seconds"],
            "pens": report["pens"],
            "total": report["total"],
            "warnings": done.said,
        });
        let mut answer = head.to_string().into_bytes();
        answer.pop();
        answer.extend_from_slice(b",\"marks\":");
        answer.extend_from_slice(paths.trim_ascii_end());
        answer.push(b'}');
        Ok(answer)
    }

    async fn made(&self, output: &str, profile: Option<&str>) -> Result<(), StudioError> {
        let document = self.document()?;
        let scene = document.name();
        let mut words = vec!["draw", &scene, "-o", output];
        if let Some(profile) = profile.filter(|profile| !profile.is_empty()) {
            words.extend(["--profile", checked(profile)?]);
        }
        self.program.run(document.folder(), &words, |_| {}).await.map(drop)
    }
}

/// A profile's name; a file of a profile is named in the scene.
pub(super) fn checked(profile: &str) -> Result<&str, StudioError> {
    let is_name = !profile.starts_with('-')
        && profile.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c))
        && !profile.contains("..");
    let is_alone = Path::new(profile).components().count() == 1;
    if is_name && is_alone { Ok(profile) } else { Err(StudioError::Refused(format!("'{profile}' is no machine's name"))) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_can_be_pasted_into_a_shell() {
        assert_eq!(command_line("a.toml", "a.svg", None), "drypoint draw a.toml -o a.svg");
        assert_eq!(
            command_line("my face.toml", "it's.hpgl", Some("hp7475a")),
            r"drypoint draw 'my face.toml' -o 'it'\''s.hpgl' --profile hp7475a"
        );
    }

    #[test]
    fn machines_have_names() {
        assert!(checked("grbl-servo").is_ok());
        for wrong in ["", "-x", "../x", "a/b", "/etc/passwd"] {
            assert!(checked(wrong).is_err(), "{wrong}");
        }
    }
}
