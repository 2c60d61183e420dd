//! Ctrl-C and SIGTERM: files that wait for their name are removed before the process ends by the signal.

use std::{
    collections::BTreeSet,
    io,
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};
use tempfile::NamedTempFile;

/// Temporary files of results that are not complete yet. Whoever holds the lock makes, renames or removes one, so
/// that a signal comes before or after that and never between.
static WAITING: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn waiting() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    WAITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes a temporary file that does not outlive a signal.
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

/// Gives a temporary file its name.
///
/// # Errors
/// A folder that can't be written any more.
pub(crate) fn persist(file: NamedTempFile, target: &Path) -> io::Result<()> {
    let mut waiting = waiting();
    waiting.remove(file.path());
    file.persist(target).map(drop).map_err(|error| error.error)
}

/// Removes what waits for its name; the lock is never given back, so that nothing new is made.
#[cfg(unix)]
fn remove_all() {
    let waiting = waiting();
    for path in waiting.iter() {
        // It may have been removed by who made it.
        let _ = std::fs::remove_file(path);
    }
    std::mem::forget(waiting);
}

/// From now on Ctrl-C and SIGTERM remove temporary files first. A process that cannot be told of signals goes on
/// without: it is ended by them as any other.
#[cfg(unix)]
pub(crate) fn watch() {
    use signal_hook::{
        consts::{SIGINT, SIGTERM},
        iterator::Signals,
        low_level::emulate_default_handler,
    };
    let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else {
        return;
    };
    std::thread::spawn(move || {
        for signal in &mut signals {
            remove_all();
            // The shell sees a process that the signal ended.
            let _ = emulate_default_handler(signal);
        }
    });
}

/// Elsewhere the system removes nothing and asks nobody.
#[cfg(not(unix))]
pub(crate) const fn watch() {}
