//! A cascade of second-order sections for several interleaved signals, and its settling time.

use super::design::{LowPass, Section};

/// Largest settling time in samples, for poles on the unit circle up to rounding.
const LARGEST_SETTLING: usize = 1 << 24;

/// Sections of a filter with their states, for rows of several signals.
#[derive(Debug, Clone)]
pub(super) struct Cascade {
    sections: Vec<Section>,
    /// For each section, s1 of all signals, then s2 of all.
    states: Vec<f64>,
    width: usize,
}

impl Cascade {
    /// A filter in the steady state of the input `row`.
    pub(super) fn settled(filter: &LowPass, row: &[f64]) -> Self {
        let mut level = row.to_vec();
        let mut states = Vec::with_capacity(2 * row.len() * filter.sections().len());
        for section in filter.sections() {
            let ([s1, s2], gain) = steady_state(section);
            states.extend(level.iter().map(|level| s1 * level));
            states.extend(level.iter().map(|level| s2 * level));
            level.iter_mut().for_each(|level| *level *= gain);
        }
        Self {
            sections: filter.sections().to_vec(),
            states,
            width: row.len(),
        }
    }

    /// Current states: for each section, s1 of all signals, then s2 of all.
    pub(super) fn into_states(self) -> Vec<f64> {
        self.states
    }

    /// Filters rows in place, forwards.
    pub(super) fn pass(&mut self, rows: &mut [f64]) {
        for row in rows.chunks_exact_mut(self.width) {
            let states = self.states.chunks_exact_mut(2 * self.width);
            for (section, states) in self.sections.iter().zip(states) {
                let Section {
                    b: [b0, b1, b2],
                    a: [_, a1, a2],
                } = *section;
                let (first, second) = states.split_at_mut(self.width);
                // Transposed direct form II.
                for ((x, s1), s2) in row.iter_mut().zip(first).zip(second) {
                    let y = b0 * *x + *s1;
                    *s1 = b1 * *x - a1 * y + *s2;
                    *s2 = b2 * *x - a2 * y;
                    *x = y;
                }
            }
        }
    }

    /// Filters rows in place, backwards.
    pub(super) fn pass_backwards(&mut self, rows: &mut [f64]) {
        let width = self.width;
        for row in rows.rchunks_exact_mut(width) {
            self.pass(row);
        }
    }

    /// Largest magnitude of the states.
    fn largest_state(&self) -> f64 {
        self.states.iter().fold(0.0, |m, s| f64::max(m, s.abs()))
    }
}

/// Settling time of `filter` in samples.
///
/// After it, the transient stays below the fraction `tolerance` of its initial size. The input
/// steps from 1 to 0.
pub(crate) fn settling(filter: &LowPass, tolerance: f64) -> usize {
    let mut cascade = Cascade::settled(filter, &[1.0]);
    let start = cascade.largest_state();
    let mut last = 0;
    let mut sample = 0;
    // States oscillate through zero, so a transient counts as settled after staying small for as
    // long as it has lasted.
    while sample <= 2 * last + filter.order() && sample < LARGEST_SETTLING {
        cascade.pass(&mut [0.0]);
        sample += 1;
        if cascade.largest_state() > tolerance * start {
            last = sample;
        }
    }
    last
}

/// Odd reflection of rows about the first of them, nearest first: `count` rows.
pub(super) fn reflected<'a>(mut rows: impl Iterator<Item = &'a [f64]>, count: usize) -> Vec<f64> {
    let Some(first) = rows.next() else {
        return Vec::new();
    };
    rows.take(count)
        .flat_map(|row| first.iter().zip(row).map(|(first, x)| 2.0 * first - x))
        .collect()
}

/// A filter after its forward pass over the reflection before the first of `rows`.
///
/// There must be more rows than its padding.
pub(super) fn started(filter: &LowPass, width: usize, rows: &[f64]) -> Cascade {
    let reflection = reflected(rows.chunks_exact(width), filter.padding());
    // The farthest row comes first.
    let mut farthest_first = reflection.rchunks_exact(width).map(<[f64]>::to_vec);
    let mut row = farthest_first
        .next()
        .unwrap_or_else(|| rows[..width].to_vec());
    let mut cascade = Cascade::settled(filter, &row);
    if !reflection.is_empty() {
        cascade.pass(&mut row);
    }
    for mut row in farthest_first {
        cascade.pass(&mut row);
    }
    cascade
}

/// Steady state of a section for the constant input 1, and its static gain.
fn steady_state(section: &Section) -> ([f64; 2], f64) {
    let Section { b, a } = section;
    let gain = (b[0] + b[1] + b[2]) / (a[0] + a[1] + a[2]);
    let s2 = b[2] - a[2] * gain;
    let s1 = b[1] - a[1] * gain + s2;
    ([s1, s2], gain)
}

#[cfg(test)]
mod tests {
    use super::settling;
    use crate::filters::{butterworth, chebyshev1};

    #[test]
    fn settling_follows_the_slowest_pole() {
        let filter = butterworth(4, 0.04).expect("a design");
        let radius = filter
            .sections()
            .iter()
            .fold(0.0_f64, |r, section| r.max(section.a[2].sqrt()));
        for tolerance in [1e-3, 1e-6, 1e-15] {
            let expected = f64::ln(tolerance) / radius.ln();
            let found = settling(&filter, tolerance) as f64;
            assert!((found / expected - 1.0).abs() < 0.3, "{found} {expected}");
        }
        let narrow = chebyshev1(8, 0.05, 0.8 / 50.0).expect("a design");
        let samples = settling(&narrow, 1e-15);
        assert!((5_000..15_000).contains(&samples), "{samples}");
    }
}
