//! The `drypoint` command: parses, runs and reports.

use std::process::ExitCode;

fn main() -> ExitCode {
    drypoint::cli::main()
}
