//! The record of a drawn picture, beside the outputs: what it was drawn from, and what came of it.

use super::super::failure::Failure;
use super::{hashed, write_whole};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The folder of records in the folder of outputs.
const FOLDER: &str = ".drypoint";

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Record {
    /// Hash of everything that decides the output.
    pub key: String,
    /// Of the output.
    pub sha256: String,
    pub bytes: u64,
}

impl Record {
    /// The record of an output, if there is a readable one.
    pub(super) fn of(output: &str) -> Option<Self> {
        serde_json::from_slice(&std::fs::read(place(output)).ok()?).ok()
    }

    /// The record of an output just made.
    pub(super) fn made(key: String, output: &str) -> Result<Self, Failure> {
        let (sha256, bytes) =
            hashed(Path::new(output)).map_err(|error| Failure::Work(format!("{output} cannot be read back: {error}")))?;
        Ok(Self { key, sha256, bytes })
    }

    /// True if the output is what this record says, drawn from the same.
    pub(super) fn holds(&self, key: &str, output: &str) -> bool {
        self.key == key && hashed(Path::new(output)).is_ok_and(|found| found == (self.sha256.clone(), self.bytes))
    }

    pub(super) fn write(&self, output: &str) -> Result<(), Failure> {
        let place = place(output);
        if let Some(folder) = place.parent() {
            std::fs::create_dir_all(folder).map_err(Failure::writing(output))?;
        }
        let text = serde_json::to_string(self).map_err(|error| Failure::Work(error.to_string()))?;
        write_whole(&place, &(text + "\n"))
    }
}

fn place(output: &str) -> PathBuf {
    let path = Path::new(output);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(FOLDER).join(format!("{name}.json"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_holds_until_anything_changes() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("a.svg").to_string_lossy().into_owned();
        std::fs::write(&output, "ink").unwrap();
        let record = Record::made("key".to_owned(), &output).unwrap();
        record.write(&output).unwrap();
        let read = Record::of(&output).unwrap();
        assert_eq!((&read, read.bytes), (&record, 3));
        assert!(read.holds("key", &output) && !read.holds("other", &output));
        std::fs::write(&output, "ink!").unwrap();
        assert!(!read.holds("key", &output));
        std::fs::write(place(&output), "{").unwrap();
        assert_eq!(Record::of(&output), None);
    }
}
