//! Options of the studio.

use clap::Args;

#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct StudioOptions {
    /// A photograph or a scene (.toml); a photograph's scene lies beside it. Without one, drop a photograph on the page.
    pub file: Option<String>,
    /// The port on this computer's own address; 0 takes a free one.
    #[arg(long, default_value_t = 0)]
    pub port: u16,
    /// Only print the page's address.
    #[arg(long)]
    pub no_browser: bool,
}
