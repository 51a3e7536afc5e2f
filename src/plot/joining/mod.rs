//! Fewer and longer paths before they are put in order: repeated ones go, and those that meet are joined.

mod duplicates;
mod loop_joins;
mod merge;
#[cfg(test)]
mod tests;

pub use duplicates::drop_duplicates;
pub(super) use loop_joins::join_to_loops;
pub use merge::chain;
