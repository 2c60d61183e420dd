//! Runs all test binaries, one per processor at a time, with their times.
//!
//! Cargo runs one after the other; some have few tests that take minutes, which leaves processors
//! idle.

use crate::Failure;
use crate::binaries::{Binary, binaries};
use std::io::{self, Write as _};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Instant;

/// Selection of test binaries.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Binaries {
    /// All binaries.
    All,
    /// Binaries whose tests can differ between the tiers; the default tier already ran the others.
    OfTier,
}

/// Builds all tests and runs the selected binaries in the tier of the environment.
///
/// The output of a binary is shown when it ends. Documentation examples are not run.
pub(crate) fn run(which: Binaries) -> Result<(), Failure> {
    let waiting = Mutex::new(chosen(which)?.into_iter());
    let failed = Mutex::new(Vec::new());
    let next = || {
        let mut waiting = waiting.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.next()
    };
    let work = || {
        while let Some(binary) = next() {
            let error = match shown(&binary) {
                Ok(true) => continue,
                Ok(false) => binary.name,
                Err(failure) => format!("{}: {failure}", binary.name),
            };
            let mut failed = failed.lock().unwrap_or_else(PoisonError::into_inner);
            failed.push(error);
        }
    };
    let count = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..count {
            scope.spawn(work);
        }
    });
    let failed = failed.into_inner().unwrap_or_else(PoisonError::into_inner);
    if failed.is_empty() {
        return Ok(());
    }
    Err(format!("failed: {}", failed.join(", ")).into())
}

/// Binaries to run; prints the names of the omitted ones.
fn chosen(which: Binaries) -> Result<Vec<Binary>, Failure> {
    let all = binaries()?;
    if which == Binaries::All {
        return Ok(all);
    }
    let mut chosen = Vec::new();
    let mut same = Vec::new();
    for binary in all {
        if binary.depends_on_tier()? {
            chosen.push(binary);
        } else {
            same.push(binary.name);
        }
    }
    println!("the same in all tiers, not run: {}", same.join(", "));
    Ok(chosen)
}

/// Runs a binary and shows its output; returns whether it succeeded.
fn shown(binary: &Binary) -> Result<bool, Failure> {
    let start = Instant::now();
    let output = binary.command().output()?;
    let seconds = start.elapsed().as_secs_f64();
    let mut out = io::stdout().lock();
    writeln!(out, "\n     Running {} ({seconds:.0} s)", binary.name)?;
    out.write_all(&output.stdout)?;
    out.write_all(&output.stderr)?;
    Ok(output.status.success())
}
