//! On Ctrl-C, SIGTERM and SIGHUP, removes temporary files before the process ends.

use std::{
    collections::BTreeSet,
    io,
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};
use tempfile::NamedTempFile;

/// Temporary files of incomplete results.
///
/// Files are created, renamed and removed under this lock, so that a signal never interrupts these
/// steps.
static WAITING: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn waiting() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    WAITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Creates a temporary file that is removed on a signal.
///
/// # Errors
/// As `make`.
pub(crate) fn guarded(
    make: impl FnOnce() -> io::Result<NamedTempFile>,
) -> io::Result<NamedTempFile> {
    let mut waiting = waiting();
    let file = make()?;
    waiting.insert(file.path().to_owned());
    Ok(file)
}

/// Renames a temporary file to its final path.
///
/// # Errors
/// A folder that can no longer be written.
pub(crate) fn persist(file: NamedTempFile, target: &Path) -> io::Result<()> {
    let mut waiting = waiting();
    waiting.remove(file.path());
    file.persist(target).map(drop).map_err(|error| error.error)
}

/// Removes all temporary files; the lock is kept forever so that no new ones are created.
#[cfg(unix)]
fn remove_all() {
    let waiting = waiting();
    for path in waiting.iter() {
        // Its owner may have removed it.
        let _ = std::fs::remove_file(path);
    }
    std::mem::forget(waiting);
}

/// Starts to remove temporary files on Ctrl-C, SIGTERM and SIGHUP.
///
/// If no handler can be installed, signals end the process as usual.
#[cfg(unix)]
pub(crate) fn watch() {
    use signal_hook::{
        consts::{SIGHUP, SIGINT, SIGTERM},
        iterator::Signals,
        low_level::emulate_default_handler,
    };
    let Ok(mut signals) = Signals::new([SIGINT, SIGTERM, SIGHUP]) else {
        return;
    };
    std::thread::spawn(move || {
        for signal in &mut signals {
            remove_all();
            // The shell then sees that a signal ended the process.
            let _ = emulate_default_handler(signal);
        }
    });
}

/// Other systems have no such signals.
#[cfg(not(unix))]
pub(crate) const fn watch() {}
