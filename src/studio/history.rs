//! Steps that can be undone: the scene's text and the masks that were painted.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Steps that are kept.
const MOST_STEPS: usize = 500;
/// Bytes of masks that are kept; the oldest steps go first.
const MOST_BYTES: usize = 256 << 20;
/// Changes of one slider within this time are one step.
const TOGETHER: Duration = Duration::from_secs(1);

/// Masks by role; `None` is one that was not painted.
pub(super) type Masks = BTreeMap<String, Option<Arc<[u8]>>>;

/// What one step changed, as it was before or after.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct State {
    pub text: String,
    /// The masks that the step touched.
    pub masks: Masks,
}

#[derive(Debug)]
struct Step {
    label: String,
    before: State,
    after: State,
}

/// What was done and what was undone.
#[derive(Debug, Default)]
pub(super) struct History {
    done: Vec<Step>,
    undone: Vec<Step>,
    last: Option<Instant>,
}

impl History {
    /// Notes a step that has been made.
    pub(super) fn note(&mut self, label: &str, before: State, after: State) {
        if before == after {
            return;
        }
        self.undone.clear();
        let is_soon = self.last.replace(Instant::now()).is_some_and(|last| last.elapsed() < TOGETHER);
        let is_more = |step: &Step| {
            is_soon
                && step.label == label
                && step.after.text == before.text
                && step.after.masks.is_empty()
                && after.masks.is_empty()
        };
        match self.done.last_mut() {
            Some(step) if is_more(step) => step.after = after,
            _ => self.done.push(Step { label: label.to_owned(), before, after }),
        }
        while self.done.len() > MOST_STEPS || (self.done.len() > 1 && self.bytes() > MOST_BYTES) {
            self.done.remove(0);
        }
    }

    fn bytes(&self) -> usize {
        let masks = self.done.iter().flat_map(|step| step.before.masks.values().chain(step.after.masks.values()));
        masks.flatten().map(|mask| mask.len()).sum()
    }

    /// Takes the last step back; returns the state before it.
    pub(super) fn undo(&mut self) -> Option<State> {
        let step = self.done.pop()?;
        let state = step.before.clone();
        self.undone.push(step);
        self.last = None;
        Some(state)
    }

    /// Makes the last undone step again; returns the state after it.
    pub(super) fn redo(&mut self) -> Option<State> {
        let step = self.undone.pop()?;
        let state = step.after.clone();
        self.done.push(step);
        self.last = None;
        Some(state)
    }

    /// How many steps can be undone and made again.
    pub(super) fn counts(&self) -> (usize, usize) {
        (self.done.len(), self.undone.len())
    }

    /// The names of the steps that would be undone and made again.
    pub(super) fn labels(&self) -> (Option<&str>, Option<&str>) {
        (self.done.last().map(|step| step.label.as_str()), self.undone.last().map(|step| step.label.as_str()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(text: &str) -> State {
        State { text: text.to_owned(), masks: Masks::new() }
    }

    #[test]
    fn a_hundred_steps_are_undone_and_made_again() {
        let mut history = History::default();
        for i in 0..150 {
            history.note(&format!("step {i}"), state(&i.to_string()), state(&(i + 1).to_string()));
        }
        for i in (0..150).rev() {
            assert_eq!(history.undo(), Some(state(&i.to_string())));
        }
        assert_eq!(history.undo(), None);
        for i in 0..150 {
            assert_eq!(history.redo(), Some(state(&(i + 1).to_string())));
        }
    }

    #[test]
    fn a_slider_s_way_is_one_step() {
        let mut history = History::default();
        history.note("pitch", state("a"), state("b"));
        history.note("pitch", state("b"), state("c"));
        history.note("gamma", state("c"), state("d"));
        assert_eq!(history.counts(), (2, 0));
        history.undo();
        assert_eq!(history.undo(), Some(state("a")));
    }
}
