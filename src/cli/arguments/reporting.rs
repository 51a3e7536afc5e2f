//! Reporting options.

use clap::Args;

/// Reporting options.
#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct Reporting {
    /// No progress and no summary; warnings and errors are still shown.
    #[arg(long, short)]
    pub quiet: bool,
    /// Print one JSON object on stdout.
    #[arg(long)]
    pub json: bool,
}
