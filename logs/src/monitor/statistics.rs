//! Single-pass statistics of signals: means, extremes, sizes.

/// Means of torques at a rate with little noise that still resolves peaks.
#[derive(Debug, Clone)]
pub(super) struct Means {
    /// Rows of one mean per actuator.
    pub(super) rows: Vec<f64>,
    sums: Vec<f64>,
    count: usize,
    size: usize,
}

impl Means {
    /// Rate of the means, Hz, and largest number of their rows (ten minutes).
    const RATE: f64 = 500.0;
    const LARGEST: usize = 300_000;

    pub(super) fn new(actuators: usize, frequency: f64) -> Self {
        Self {
            rows: Vec::new(),
            sums: vec![0.0; actuators],
            count: 0,
            size: ((frequency / Self::RATE).round() as usize).max(1),
        }
    }

    pub(super) fn take(&mut self, torques: &[f64]) {
        if self.rows.len() >= Self::LARGEST * self.sums.len() {
            return;
        }
        self.sums
            .iter_mut()
            .zip(torques)
            .for_each(|(sum, torque)| *sum += torque);
        self.count += 1;
        if self.count == self.size {
            let count = self.count as f64;
            self.rows.extend(self.sums.iter().map(|sum| sum / count));
            self.sums.fill(0.0);
            self.count = 0;
        }
    }
}

/// Number of occurrences of a signal's largest value, and of the one next to it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extreme {
    pub(super) value: f64,
    pub(super) count: usize,
    next: f64,
    pub(super) next_count: usize,
}

impl Default for Extreme {
    fn default() -> Self {
        Self {
            value: f64::NEG_INFINITY,
            count: 0,
            next: f64::NEG_INFINITY,
            next_count: 0,
        }
    }
}

impl Extreme {
    pub(super) fn take(&mut self, value: f64) {
        if value > self.value {
            (self.next, self.next_count) = (self.value, self.count);
            (self.value, self.count) = (value, 1);
        } else if value == self.value {
            self.count += 1;
        } else if value > self.next {
            (self.next, self.next_count) = (value, 1);
        } else if value == self.next {
            self.next_count += 1;
        }
    }
}

/// Histogram of magnitudes by their power of two.
#[derive(Debug, Clone)]
pub(super) struct Histogram {
    counts: [usize; Self::BINS],
    total: usize,
}

impl Default for Histogram {
    fn default() -> Self {
        Self {
            counts: [0; Self::BINS],
            total: 0,
        }
    }
}

impl Histogram {
    const BINS: usize = 128;
    const LEAST_EXPONENT: i32 = -80;

    pub(super) fn take(&mut self, magnitude: f64) {
        self.total += 1;
        if magnitude > 0.0 {
            // The exponent of a normal number is in its bits.
            let exponent = (magnitude.to_bits() >> 52) as i32 - 1022;
            let bin = usize::try_from(exponent - Self::LEAST_EXPONENT).unwrap_or(0);
            self.counts[bin.min(Self::BINS - 1)] += 1;
        }
    }

    /// A quantile of the magnitudes for the fraction `part`, up to a factor of two.
    pub(super) fn quantile(&self, part: f64) -> f64 {
        let mut above = self.total as f64 * (1.0 - part);
        for (bin, count) in self.counts.iter().enumerate().rev() {
            above -= *count as f64;
            if above < 0.0 {
                return 2_f64.powi(bin as i32 + Self::LEAST_EXPONENT);
            }
        }
        0.0
    }
}
