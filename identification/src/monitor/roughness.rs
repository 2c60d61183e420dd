//! Noise of signals, whatever smooth motion they follow, and signals that are equal throughout.

/// Mean square of third differences of white noise by its variance: 1 + 9 + 9 + 1.
const THIRD_DIFFERENCES: f64 = 20.0;

/// What is told of signals that stand side by side.
#[derive(Debug, Clone)]
pub(super) struct Roughness {
    /// The last three rows, the newest last.
    last: Vec<Vec<f64>>,
    /// Σ of the squares of third differences, and how many there are.
    squares: Vec<f64>,
    count: usize,
    /// Pairs of signals that have been equal so far.
    twins: Vec<(usize, usize)>,
}

impl Roughness {
    pub(super) fn new(signals: usize) -> Self {
        let pairs = (0..signals).flat_map(|i| (i + 1..signals).map(move |j| (i, j)));
        Self {
            last: Vec::new(),
            squares: vec![0.0; signals],
            count: 0,
            twins: pairs.collect(),
        }
    }

    pub(super) fn take(&mut self, row: &[f64]) {
        self.twins.retain(|&(i, j)| row[i] == row[j]);
        if let [first, second, third] = &self.last[..] {
            for (i, square) in self.squares.iter_mut().enumerate() {
                let difference = row[i] - 3.0 * third[i] + 3.0 * second[i] - first[i];
                *square += difference * difference;
            }
            self.count += 1;
            self.last.rotate_left(1);
            self.last[2].copy_from_slice(row);
        } else {
            self.last.push(row.to_vec());
        }
    }

    /// The variance of the noise of each signal, if it is white and the signal smooth.
    pub(super) fn variances(&self) -> Vec<f64> {
        let count = THIRD_DIFFERENCES * self.count.max(1) as f64;
        self.squares.iter().map(|square| square / count).collect()
    }

    /// Leaves pairs out whose first signal is of no interest.
    pub(super) fn forget(&mut self, is_idle: impl Fn(usize) -> bool) {
        self.twins.retain(|&(first, _)| !is_idle(first));
    }

    /// Pairs of signals that are equal throughout.
    pub(super) fn twins(&self) -> &[(usize, usize)] {
        &self.twins
    }
}

#[cfg(test)]
mod tests {
    use super::Roughness;

    #[test]
    fn noise_is_told_from_motion() {
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
        assert_eq!(roughness.twins(), [(0, 2)]);
    }
}
