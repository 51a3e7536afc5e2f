//! Options of `batch`.

use super::draw::DrawOptions;
use super::values::{Shard, memory_size, shard};
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct BatchOptions {
    #[command(flatten)]
    pub draw: DrawOptions,
    /// The photographs, folders and manifests.
    #[arg(skip)]
    pub inputs: Vec<String>,
    /// Draw every photograph as this scene or preset says; its own photograph is not used. Options on the command line win.
    #[arg(long, value_name = "FILE.toml", conflicts_with_all = ["preset", "params"])]
    pub recipe: Option<PathBuf>,
    /// Draw only part I of N, from 1: pictures are dealt out by a hash of their names, on each machine alike.
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub shard: Option<Shard>,
    /// Pictures drawn at once [default: one per core].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Memory for all pictures drawn at once, such as 4GB [default: three quarters of what is free]. A picture that is foretold to
    /// need more is drawn alone.
    #[arg(long, value_name = "SIZE", value_parser = memory_size)]
    pub max_memory: Option<u64>,
    /// Also append the JSON lines to this file.
    #[arg(long, value_name = "FILE")]
    pub results: Option<PathBuf>,
}
