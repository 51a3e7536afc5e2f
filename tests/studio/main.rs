//! The studio's server, asked as its page asks it. The page itself is tried in a browser (`src/studio/page/trial`).
#![cfg(feature = "studio")]

mod asking;
mod keeping;
mod proofs;
mod showing;
mod trust;
