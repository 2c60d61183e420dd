//! Clocks of files: usual steps, agreement, and overlap of times.

use crate::{error::Problem, formats::table_file::RowReader, problems::shown};
use overact::Code;

/// Number of steps of a clock from which the usual one is determined.
const FIRST_STEPS: usize = 256;

/// Longest gap for interpolation, in usual steps.
pub(super) const LONGEST_STEP: f64 = 3.5;

/// Usual step of a clock, s, from its first times: the mean of all steps except gaps.
pub(crate) fn usual_step(times: impl Iterator<Item = f64>) -> f64 {
    let times: Vec<f64> = times.take(FIRST_STEPS + 1).collect();
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    let median = steps.get(steps.len() / 2).copied().unwrap_or(f64::NAN);
    let steps: Vec<f64> = steps
        .into_iter()
        .filter(|step| *step <= LONGEST_STEP * median)
        .collect();
    steps.iter().sum::<f64>() / steps.len() as f64
}

/// Times of a file up to its end or an error, which is reported when the file is read.
pub(crate) fn times(mut clock: Box<dyn RowReader + '_>) -> impl Iterator<Item = f64> {
    std::iter::from_fn(move || {
        let mut time = [0.0];
        (clock.next(&mut time) == Ok(true)).then_some(time[0])
    })
}

/// Whether clocks differ by more than a fiftieth of a step, or one ends before the others.
pub(crate) fn differ(mut clocks: Vec<Box<dyn RowReader + '_>>) -> bool {
    let mut last = None;
    loop {
        let mut times = Vec::new();
        for clock in &mut clocks {
            let mut time = [0.0];
            match clock.next(&mut time) {
                Ok(true) => times.push(time[0]),
                Ok(false) => {}
                // An error in the clock is reported when the file is read.
                Err(_) => return false,
            }
        }
        let Some(&first) = times.first() else {
            return false;
        };
        let step = last.map(|last: f64| (first - last).abs());
        let is_off = |time: &f64| step.is_some_and(|step| (time - first).abs() > 0.02 * step);
        if times.len() < clocks.len() || times.iter().any(is_off) {
            return true;
        }
        last = Some(first);
    }
}

/// The problem of two files without a common time; the times of `first` are used.
pub(crate) fn apart(
    (first, (begin, end)): (&str, (f64, f64)),
    (file, (own_begin, own_end)): (&str, (f64, f64)),
) -> Problem {
    let message = if own_begin > end {
        format!(
            "the file begins at {own_begin} s, when {} has ended at {end} s",
            shown(first)
        )
    } else {
        format!(
            "the file ends at {own_end} s, before {} begins at {begin} s",
            shown(first)
        )
    };
    Problem::new(Code::LOG_FILES, message).file(file).help(
        "files are joined by time: check that they are of one run and that their clocks have the same origin",
    )
}
