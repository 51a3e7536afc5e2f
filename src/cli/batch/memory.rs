//! Memory of the pictures drawn at once.

use std::path::Path;
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

/// Memory of a process that has looked for faces and not yet drawn, in bytes: 63 MB with the networks on a photograph of 0.3
/// megapixels, rounded up.
pub(super) const STANDING: f64 = 80e6;
/// Bytes per pixel of a photograph, decoded and reduced: 6.6 measured on JPEGs of 0.3 to 19 megapixels.
const PER_PIXEL: f64 = 8.0;
/// Megapixels assumed of a photograph whose size cannot be read from its head.
const UNKNOWN: f64 = 12e6;
/// Share of the free memory that is used.
const SHARE: f64 = 0.75;
/// Bytes used where the system does not say how much is free.
const USUAL: u64 = 4_000_000_000;
/// How often an interruption is looked for while waiting.
const LOOKING: Duration = Duration::from_millis(100);

/// Memory that pictures hold while they are drawn.
pub(super) struct Memory {
    most: u64,
    held: Mutex<u64>,
    released: Condvar,
}

/// Held until dropped.
pub(super) struct Held<'a> {
    memory: &'a Memory,
    bytes: u64,
}

impl Memory {
    pub(super) const fn new(most: u64) -> Self {
        Self { most, held: Mutex::new(0), released: Condvar::new() }
    }

    /// Waits until so much is free; what exceeds all of it waits until nothing else is held.
    pub(super) fn hold(&self, bytes: u64, is_interrupted: impl Fn() -> bool) -> Held<'_> {
        let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        while *held > 0 && held.saturating_add(bytes) > self.most && !is_interrupted() {
            held = self.released.wait_timeout(held, LOOKING).unwrap_or_else(PoisonError::into_inner).0;
        }
        *held += bytes;
        Held { memory: self, bytes }
    }
}

impl Drop for Held<'_> {
    fn drop(&mut self) {
        *self.memory.held.lock().unwrap_or_else(PoisonError::into_inner) -= self.bytes;
        self.memory.released.notify_all();
    }
}

/// Memory of a photograph in bytes, from the size in its head.
pub(super) fn photograph_bytes(path: &Path) -> f64 {
    let size = imagesize::size(path).ok();
    // What drypoint refuses takes no memory.
    let most = crate::source::Limits::default().pixels as f64;
    PER_PIXEL * size.map_or(UNKNOWN, |size| (size.width as f64 * size.height as f64).min(most))
}

/// What a batch may use of the memory that is free now.
pub(super) fn free() -> u64 {
    let limits = [available(), in_group()];
    limits.into_iter().flatten().min().map_or(USUAL, |bytes| (SHARE * bytes as f64) as u64)
}

/// Free memory of a Linux machine.
fn available() -> Option<u64> {
    let told = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = told.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.split_whitespace().next()?.parse::<u64>().ok().map(|kilobytes| kilobytes * 1024)
}

/// Free memory of the process's control group (version 2), as containers and schedulers set it.
fn in_group() -> Option<u64> {
    let groups = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    let group = groups.lines().find_map(|line| line.strip_prefix("0::/"))?;
    let folder = Path::new("/sys/fs/cgroup").join(group);
    let number = |file: &str| std::fs::read_to_string(folder.join(file)).ok()?.trim().parse::<u64>().ok();
    Some(number("memory.max")?.saturating_sub(number("memory.current")?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, Ordering};

    #[test]
    fn never_more_is_held_than_there_is_but_one_alone_may_exceed_it() {
        let memory = Memory::new(100);
        let (held, most) = (AtomicU64::new(0), AtomicU64::new(0));
        std::thread::scope(|scope| {
            for i in 0..8 {
                let (memory, held, most) = (&memory, &held, &most);
                scope.spawn(move || {
                    let bytes = if i == 0 { 1000 } else { 45 };
                    let hold = memory.hold(bytes, || false);
                    let now = held.fetch_add(bytes, Ordering::SeqCst) + bytes;
                    most.fetch_max(if now == 1000 { 0 } else { now }, Ordering::SeqCst);
                    std::thread::sleep(Duration::from_millis(5));
                    held.fetch_sub(bytes, Ordering::SeqCst);
                    drop(hold);
                });
            }
        });
        assert!((45..=90).contains(&most.into_inner()));
        assert_eq!(*memory.held.lock().unwrap(), 0);
    }
}
