//! The studio: a page in the browser, on this computer alone, where a portrait is tuned by eye.
//!
//! The scene file is the only truth. The server changes it, has it drawn by processes of `drypoint draw`, and tells the page; it
//! has no algorithm of its own. So what the page shows is what the command makes, and a drawing that nobody wants any more is ended
//! by ending its process.

mod answers;
mod artist;
mod command;
mod document;
mod drawings;
mod error;
mod events;
mod exports;
mod folder;
mod guard;
mod history;
mod masks;
mod page;
mod part;
mod photographs;
mod recent;
mod sending;
mod server;
mod session;
mod stages;
mod tables;
mod thumbnails;
mod watching;

pub use error::StudioError;
pub use photographs::{Shower, Shown};
pub use server::{Settings, serve};
pub use session::{SceneCheck, Ties};
