//! The number of worker threads.

use super::failure::Failure;

/// Sets the number of worker threads; all cores without one.
pub(super) fn limit_threads(threads: Option<u16>) -> Result<(), Failure> {
    let Some(threads) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(usize::from(threads))
        .build_global()
        .map_err(|error| Failure::Work(format!("cannot start {threads} threads: {error}")))
}
