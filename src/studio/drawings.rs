//! Drawings that the page may fetch.

use super::error::StudioError;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

/// Drawings that are kept: the last coarse and full ones, and one before.
const KEPT: usize = 4;

/// How finely something is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Quality {
    /// With marks farther apart, at once.
    #[default]
    Coarse,
    /// As the command draws it.
    Full,
}

impl Quality {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Coarse => "coarse",
            Self::Full => "full",
        }
    }
}

/// A drawing with what was said of it.
#[derive(Debug)]
pub(super) struct Drawn {
    pub id: u64,
    pub quality: Quality,
    pub revision: u64,
    pub seconds: f64,
    /// The command's report.
    pub report: Value,
    pub said: Vec<String>,
    /// The marks, as the command writes them.
    pub marks: Vec<u8>,
}

impl Drawn {
    /// The answer to the page: what is known of it, then the marks as they are.
    pub(super) fn answer(&self) -> Vec<u8> {
        let head = json!({
            "id": self.id,
            "quality": self.quality.name(),
            "revision": self.revision,
            "seconds": self.seconds,
            "summary": self.summary(),
            "warnings": self.said,
            "report": self.report,
            "placement": self.report.get("picture"),
        });
        let mut answer = head.to_string().into_bytes();
        answer.pop();
        answer.extend_from_slice(b",\"marks\":");
        answer.extend_from_slice(self.marks.trim_ascii_end());
        answer.push(b'}');
        answer
    }

    fn summary(&self) -> String {
        let page = |i: usize| self.report["page_mm"][i].as_f64().unwrap_or_default();
        let layers = self.report["layers"].as_array().map_or(&[][..], Vec::as_slice);
        let count = |kind: &str| layers.iter().filter_map(|layer| layer[kind].as_u64()).sum::<u64>();
        let kinds = ["dots", "strokes", "areas"].map(|kind| (count(kind), kind));
        let counts = kinds.iter().filter(|(count, _)| *count > 0).map(|(count, kind)| format!(", {count} {kind}"));
        format!("{:.1} x {:.1} mm{}", page(0), page(1), counts.collect::<String>())
    }
}

/// The drawings that were made last.
#[derive(Default)]
pub(super) struct Drawings(Mutex<VecDeque<Arc<Drawn>>>);

impl Drawings {
    pub(super) fn keep(&self, drawn: Drawn) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.push_back(Arc::new(drawn));
        while kept.len() > KEPT {
            kept.pop_front();
        }
    }

    pub(super) fn find(&self, id: u64) -> Result<Arc<Drawn>, StudioError> {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let found = kept.iter().find(|drawn| drawn.id == id).cloned();
        found.ok_or_else(|| StudioError::Missing("that drawing has been replaced by a newer one".to_owned()))
    }

    /// Width and height of the sheet that was drawn last, in millimetres.
    pub(super) fn page(&self) -> Option<[f64; 2]> {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let page = &kept.back()?.report["page_mm"];
        Some([page[0].as_f64()?, page[1].as_f64()?])
    }

    /// The best drawing of a revision.
    pub(super) fn of_revision(&self, revision: u64) -> Option<Arc<Drawn>> {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.iter().rev().find(|drawn| drawn.revision == revision).cloned()
    }
}
