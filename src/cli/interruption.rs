//! Ctrl-C, SIGTERM and SIGHUP: the work is asked to stop; if it does not stop soon, the process exits and leaves no temporary files.

use super::messages::say;
use crate::interrupt::Interrupt;
#[cfg(unix)]
use signal_hook::consts::SIGHUP;
use signal_hook::consts::{SIGINT, SIGTERM};
#[cfg(unix)]
use signal_hook::iterator::Signals;
use std::fs::{self, File, Permissions};
use std::io;
#[cfg(unix)]
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
#[cfg(not(unix))]
use std::sync::Arc;
#[cfg(any(not(unix), feature = "drive"))]
use std::sync::atomic::AtomicBool;
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::{LazyLock, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};
use tempfile::NamedTempFile;

/// The signal that stopped the work; 0 if none did.
static STOPPED_BY: AtomicI32 = AtomicI32::new(0);
/// Polled by the library's long loops.
static INTERRUPT: LazyLock<Interrupt> = LazyLock::new(Interrupt::new);
/// True while a machine draws: it must come to rest and lift its pen.
#[cfg(feature = "drive")]
static PATIENT: AtomicBool = AtomicBool::new(false);
/// Temporary files to remove when the process exits.
static TEMPORARY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Time for the work to stop by itself; with the clean-up, exit takes less than a second.
const GRACE: Duration = Duration::from_millis(600);
/// Time for a machine to come to rest and lift its pen.
#[cfg(feature = "drive")]
const MACHINE_GRACE: Duration = Duration::from_secs(30);
/// Polling interval for signals on systems where they cannot be waited for.
#[cfg(not(unix))]
const LOOKING: Duration = Duration::from_millis(50);
/// Time to wait for a rename in progress.
const RENAMING: Duration = Duration::from_millis(200);

/// Installs the handlers. The first signal asks the work to stop, and exits the process after a grace period; the second exits at once.
#[cfg(unix)]
pub(super) fn catch() {
    let hang_up = Some(SIGHUP).filter(|signal| !is_ignored(*signal));
    let caught = [SIGINT, SIGTERM].into_iter().chain(hang_up);
    // Without a handler the process just exits, which is fine too.
    let Ok(mut signals) = Signals::new(caught) else { return };
    std::thread::spawn(move || {
        signals.forever().for_each(stopped_by);
    });
}

/// Installs the handlers on systems where signals cannot be waited for: they are polled.
#[cfg(not(unix))]
pub(super) fn catch() {
    let flag = |signal: i32| {
        let flag = Arc::new(AtomicBool::new(false));
        let is_caught = signal_hook::flag::register(signal, Arc::clone(&flag)).is_ok();
        is_caught.then_some((signal, flag))
    };
    let flags: Vec<(i32, Arc<AtomicBool>)> = [SIGINT, SIGTERM].into_iter().filter_map(flag).collect();
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(LOOKING);
            flags.iter().filter(|(_, flag)| flag.swap(false, Ordering::SeqCst)).for_each(|(signal, _)| stopped_by(*signal));
        }
    });
}

fn stopped_by(signal: i32) {
    if STOPPED_BY.swap(signal, Ordering::SeqCst) != 0 {
        end();
    }
    INTERRUPT.raise();
    std::thread::spawn(|| {
        std::thread::sleep(grace());
        end();
    });
}

/// Time for the work to stop by itself.
fn grace() -> Duration {
    #[cfg(feature = "drive")]
    if PATIENT.load(Ordering::SeqCst) {
        return MACHINE_GRACE;
    }
    GRACE
}

/// From now on a signal waits for a machine to stop and lift its pen. A second one ends the process all the same.
#[cfg(feature = "drive")]
pub(super) fn wait_for_machine() {
    PATIENT.store(true, Ordering::SeqCst);
}

/// Work while the machine stands still with the pen up: a signal ends it as usual.
#[cfg(feature = "drive")]
pub(super) fn while_the_machine_rests<T>(work: impl FnOnce() -> T) -> T {
    let was_patient = PATIENT.swap(false, Ordering::SeqCst);
    let done = work();
    PATIENT.store(was_patient, Ordering::SeqCst);
    done
}

/// True if the parent process set a signal to be ignored, as `nohup` does with SIGHUP. (SIGINT is not checked: shells set it to be
/// ignored in all background jobs.)
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    mask & (1 << (signal - 1)) != 0
}

/// The flag polled by the library's long loops.
pub(super) fn interrupt() -> &'static Interrupt {
    &INTERRUPT
}

/// True if the work should stop.
pub(super) fn is_interrupted() -> bool {
    INTERRUPT.is_raised()
}

/// What is said of an interruption.
pub(super) const INTERRUPTED: &str = "interrupted; unfinished files are not written";

/// What is done before the process exits.
static LAST: OnceLock<fn()> = OnceLock::new();

/// Has something done before an interrupted process exits, such as setting a terminal back. Only the first is done.
#[cfg(feature = "drive")]
pub(super) fn at_last(act: fn()) {
    let _ = LAST.set(act);
}

/// 130 after Ctrl-C, 143 after SIGTERM or SIGHUP.
pub(super) fn exit_status() -> u8 {
    if matches!(STOPPED_BY.load(Ordering::SeqCst), 0 | SIGINT) { 130 } else { 143 }
}

/// Removes temporary files and exits the process, even if other threads are working.
fn end() -> ! {
    let given_up = Instant::now() + RENAMING;
    let held = loop {
        match TEMPORARY.try_lock() {
            Ok(held) => break Some(held),
            Err(_) if Instant::now() >= given_up => break None,
            Err(_) => std::thread::sleep(Duration::from_millis(5)),
        }
    };
    for path in held.iter().flat_map(|paths| paths.iter()) {
        let _ = fs::remove_file(path);
    }
    if let Some(act) = LAST.get() {
        act();
    }
    say!("drypoint: {INTERRUPTED}");
    std::process::exit(i32::from(exit_status()))
}

/// How names of temporary files begin, and the age up to which they are taken for a living process's.
const UNFINISHED: &str = ".drypoint-";
const YOUNG: std::time::Duration = std::time::Duration::from_secs(10);
/// Letters and digits that end them.
const ENDING: usize = 6;

/// A temporary file beside its target. It is removed on drop or exit unless it has replaced the target.
pub(super) struct Temporary(Option<NamedTempFile>);

impl Temporary {
    /// Creates the file with the permissions of the file to replace, else with those of a new file.
    pub(super) fn beside(path: &Path, replaced: Option<Permissions>) -> io::Result<Self> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut known = known();
        let mut builder = tempfile::Builder::new();
        builder.prefix(UNFINISHED);
        #[cfg(unix)]
        let replaced = replaced.or_else(|| Some(PermissionsExt::from_mode(0o666)));
        if let Some(permissions) = replaced {
            builder.permissions(permissions);
        }
        let file = builder.tempfile_in(folder)?;
        // Held as long as this process lives, so that what a killed one leaves can be told from it; some file systems have no locks.
        let _ = file.as_file().try_lock();
        known.push(file.path().to_owned());
        Ok(Self(Some(file)))
    }

    pub(super) fn file(&mut self) -> &mut File {
        self.0.as_mut().expect("it is taken only at the end").as_file_mut()
    }

    /// Syncs the file to disk, then renames it to the target.
    pub(super) fn replace(mut self, target: &Path) -> io::Result<()> {
        self.file().sync_all()?;
        let mut known = known();
        let Some(file) = self.0.take() else { return Ok(()) };
        let own = file.path().to_owned();
        file.persist(target).map_err(|error| error.error)?;
        known.retain(|path| *path != own);
        Ok(())
    }
}

/// Removes from a folder the temporary files of processes that were killed. A young one may be about to be locked and stays.
pub(super) fn remove_unfinished(folder: &Path) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    // A user's own file may begin so too.
    let is_ours = |name: &str| {
        let ending = name.strip_prefix(UNFINISHED);
        ending.is_some_and(|ending| ending.len() == ENDING && ending.bytes().all(|byte| byte.is_ascii_alphanumeric()))
    };
    for entry in entries.flatten().filter(|entry| is_ours(&entry.file_name().to_string_lossy())) {
        let age = entry.metadata().ok().filter(std::fs::Metadata::is_file).and_then(|data| data.modified().ok()?.elapsed().ok());
        let is_left = || File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok());
        if age.is_some_and(|age| age >= YOUNG) && is_left() {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(file) = self.0.take() {
            known().retain(|path| *path != file.path());
        }
    }
}

fn known() -> MutexGuard<'static, Vec<PathBuf>> {
    TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner)
}
