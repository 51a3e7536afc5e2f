//! The form of people, as the directions of lines over it: around a face, along locks of hair, along folds of cloth.

mod canonical;
mod coils;
mod cropped;
mod directions;
mod growth;
mod surfaces;

#[cfg(test)]
pub(super) use canonical::tests::mean_portrait;
pub(super) use coils::with_curls;
pub(super) use directions::Directions;
pub(super) use growth::{Growth, growth_at};
pub(super) use surfaces::{Surface, Surfaces};
