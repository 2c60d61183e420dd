//! Noise of smooth signals, and pairs of equal signals.

/// Mean square of third differences of white noise by its variance: 1 + 9 + 9 + 1.
const THIRD_DIFFERENCES: f64 = 20.0;

/// Statistics of interleaved signals.
#[derive(Debug, Clone)]
pub(super) struct Roughness {
    /// Last three rows, the newest last.
    last: Vec<f64>,
    /// Sum of squared third differences, and their number.
    squares: Vec<f64>,
    count: usize,
    /// First row.
    first: Vec<f64>,
    /// Pairs of signals that have been proportional so far.
    twins: Vec<Twins>,
}

/// Relative rounding error of scaled and shifted signals.
const ROUNDING: f64 = 1e-13;

/// Two signals that have been equal up to a factor and an offset so far.
///
/// They may be one measured signal in two units, or on both sides of a gear.
#[derive(Debug, Clone)]
struct Twins {
    pair: (usize, usize),
    /// Whether they have been equal.
    equal: bool,
    /// Their differences to the first row, where the first signal was farthest from it.
    farthest: [f64; 2],
}

impl Twins {
    const fn new(pair: (usize, usize)) -> Self {
        Self {
            pair,
            equal: true,
            farthest: [0.0; 2],
        }
    }

    /// Whether they are still proportional, or equal, at a row.
    fn take(&mut self, row: &[f64], first: &[f64]) -> bool {
        let (i, j) = self.pair;
        self.equal &= row[i] == row[j];
        let [a, b] = [i, j].map(|at| row[at] - first[at]);
        let rounding = [i, j].map(|at| ROUNDING * (row[at].abs() + first[at].abs()));
        let [far_a, far_b] = self.farthest;
        // Tests a : b = far_a : far_b without division.
        let allowed = (rounding[0] * far_b.abs() + rounding[1] * far_a.abs())
            + ROUNDING * (a * far_b).abs().max((b * far_a).abs());
        let proportional = (a * far_b - b * far_a).abs() <= 4.0 * allowed;
        if a.abs() > far_a.abs() {
            self.farthest = [a, b];
        }
        proportional || self.equal
    }

    /// Whether they are one signal that varies, up to a factor and an offset.
    fn is_one(&self) -> bool {
        self.farthest.iter().all(|far| *far != 0.0)
    }
}

impl Roughness {
    pub(super) fn new(signals: usize) -> Self {
        let pairs = (0..signals).flat_map(|i| (i + 1..signals).map(move |j| (i, j)));
        Self {
            last: Vec::new(),
            squares: vec![0.0; signals],
            count: 0,
            first: Vec::new(),
            twins: pairs.map(Twins::new).collect(),
        }
    }

    /// Adds the next rows.
    pub(super) fn take(&mut self, rows: &[f64]) {
        let n = self.squares.len().max(1);
        if self.first.is_empty() {
            self.first = rows.get(..n).unwrap_or_default().to_vec();
        }
        for row in rows.chunks_exact(n) {
            if self.twins.is_empty() {
                break;
            }
            self.twins.retain_mut(|twins| twins.take(row, &self.first));
        }
        self.last.extend_from_slice(rows);
        for rows in self.last.windows(4 * n).step_by(n) {
            let (before, fourth) = rows.split_at(3 * n);
            for (i, square) in self.squares.iter_mut().enumerate() {
                let [first, second, third] = [i, n + i, 2 * n + i].map(|place| before[place]);
                let difference = fourth[i] - 3.0 * third + 3.0 * second - first;
                *square += difference * difference;
            }
        }
        let done = (self.last.len() / n).saturating_sub(3);
        self.count += done;
        self.last.drain(..done * n);
    }

    /// Noise variance of each signal, for white noise on a smooth signal.
    pub(super) fn variances(&self) -> Vec<f64> {
        let count = THIRD_DIFFERENCES * self.count.max(1) as f64;
        self.squares.iter().map(|square| square / count).collect()
    }

    /// Removes pairs whose first signal is idle.
    pub(super) fn forget(&mut self, is_idle: impl Fn(usize) -> bool) {
        self.twins.retain(|twins| !is_idle(twins.pair.0));
    }

    /// Pairs of equal signals; with `in_any_unit` also proportional ones.
    ///
    /// Signals that do not vary are no pair: two dead sensors read the same number.
    pub(super) fn twins(&self, in_any_unit: bool) -> Vec<(usize, usize)> {
        let is_one = |twins: &&Twins| (twins.equal || in_any_unit) && twins.is_one();
        let one = self.twins.iter().filter(is_one);
        one.map(|twins| twins.pair).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Roughness;

    #[test]
    fn noise_is_distinguished_from_motion() {
        let mut roughness = Roughness::new(3);
        let mut state = 1_u64;
        let mut noise = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for k in 0..20_000 {
            let smooth = (1e-3 * f64::from(k)).sin();
            roughness.take(&[smooth, smooth + 0.1 * noise(), smooth]);
        }
        let [still, noisy, _] = roughness.variances()[..] else {
            panic!("three signals");
        };
        assert!(still < 1e-17, "{still}");
        // Uniform noise of width 0.1 has the variance 0.01/12.
        assert!((noisy * 12.0 / 0.01 - 1.0).abs() < 0.05, "{noisy}");
        assert_eq!(roughness.twins(true), [(0, 2)]);
    }

    #[test]
    fn scaled_copies_of_a_signal_are_recognised() {
        let mut roughness = Roughness::new(6);
        for k in 0..5_000 {
            let phase = 1e-3 * f64::from(k);
            let own = (3.0 * phase).sin() + 0.2 * phase;
            // With another gear and offset; with a thousandth of another motion; at rest.
            let other = 0.3 - own / 45.0;
            roughness.take(&[own / 32.0, other, own + 1e-3 * phase.cos(), 0.7, 0.0, 0.0]);
        }
        assert_eq!(roughness.twins(true), [(0, 1)]);
    }
}
