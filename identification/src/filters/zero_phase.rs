//! Filtering forwards and backwards, as MATLAB's `filtfilt` does.
//!
//! The signal is extended at both ends by its odd reflection 2 x_0 - x_k over three times the
//! filter's order, and each pass starts in the steady state of its first value, so that neither
//! end rings.

use super::design::{LowPass, Section};
use crate::error::{Error, Problem};

/// Filters `signal` with zero phase and the squared magnitude of `filter`.
///
/// # Errors
/// A signal of no more than 3 x order samples.
pub fn filtfilt(filter: &LowPass, signal: &[f64]) -> Result<Vec<f64>, Error> {
    let padding = filter.padding();
    let (Some(&first), Some(&last)) = (signal.first(), signal.last()) else {
        return Err(too_short(filter, 0));
    };
    if signal.len() <= padding {
        return Err(too_short(filter, signal.len()));
    }
    let mut extended = Vec::with_capacity(signal.len() + 2 * padding);
    extended.extend(
        signal
            .iter()
            .skip(1)
            .take(padding)
            .rev()
            .map(|x| 2.0 * first - x),
    );
    extended.extend_from_slice(signal);
    extended.extend(
        signal
            .iter()
            .rev()
            .skip(1)
            .take(padding)
            .map(|x| 2.0 * last - x),
    );
    pass(filter, &mut extended);
    extended.reverse();
    pass(filter, &mut extended);
    extended.reverse();
    extended.truncate(signal.len() + padding);
    extended.drain(..padding);
    Ok(extended)
}

/// The error of a signal that the reflection does not fit into.
fn too_short(filter: &LowPass, found: usize) -> Error {
    Problem::new(format!(
        "a filter of order {} run forwards and backwards needs at least {} samples; there are {found}",
        filter.order(),
        filter.padding() + 1
    ))
    .help("record a longer run, or skip fewer samples")
    .into()
}

/// One pass through all sections, in place, started in the steady state of the first value.
fn pass(filter: &LowPass, signal: &mut [f64]) {
    let Some(&start) = signal.first() else { return };
    let mut level = start;
    for section in filter.sections() {
        let (mut state, gain) = steady_state(section);
        state = state.map(|s| s * level);
        level *= gain;
        let Section {
            b: [b0, b1, b2],
            a: [_, a1, a2],
        } = *section;
        let [mut s1, mut s2] = state;
        // Transposed direct form II.
        for x in signal.iter_mut() {
            let y = b0 * *x + s1;
            s1 = b1 * *x - a1 * y + s2;
            s2 = b2 * *x - a2 * y;
            *x = y;
        }
    }
}

/// The state of a section whose input has been 1 for ever, and its gain at rest.
fn steady_state(section: &Section) -> ([f64; 2], f64) {
    let Section { b, a } = section;
    let gain = (b[0] + b[1] + b[2]) / (a[0] + a[1] + a[2]);
    let s2 = b[2] - a[2] * gain;
    let s1 = b[1] - a[1] * gain + s2;
    ([s1, s2], gain)
}
