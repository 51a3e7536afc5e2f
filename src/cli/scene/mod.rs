//! Command lines in files: scenes, presets and `--params` files, and the recipes inside drawings.
//!
//! ```text
//!   scene.toml, --preset, --params, recipe ---> entries: an option, its value, where it stands
//!   entries + the command line's own options -> one command line, read by the same parser as any other
//! ```
//!
//! A key of such a file is a long option of `draw`, so a scene and a command line that say the same are the same.

#[cfg(feature = "studio")]
mod check;
mod document;
mod expansion;
mod origin;
mod presets;
mod redo;
mod schema;
mod spelled;
mod writer;

#[cfg(feature = "studio")]
pub(super) use check::check;
pub(super) use document::{named_files, names_file, with_mask};
pub(super) use expansion::{Refusal, matches};
pub(super) use presets::presets;
pub(super) use schema::schema;
pub(super) use writer::{run, save};
