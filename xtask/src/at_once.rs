//! All test binaries, one for each processor at a time: cargo runs one after the other, and some have few
//! tests that take minutes, which leaves processors idle. Each says how long it took.

use crate::Failure;
use crate::binaries::{Binary, binaries};
use std::io::{self, Write as _};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Instant;

/// Which test binaries run.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Binaries {
    /// All of them.
    All,
    /// Those whose tests can differ between the tiers. The others were run by the default tier.
    OfTier,
}

/// Builds all tests and runs those of some binaries in the tier that the environment asks for. What a binary says is
/// shown when it ends. Examples in the documentation are not run.
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

/// The binaries to run. Those that are left out are named.
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

/// Runs a binary and shows what it says; whether it succeeds.
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
