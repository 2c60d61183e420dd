//! Mean equations of a periodic motion at each phase.
//!
//! Periodic signals remain in the mean over K periods, while the variance of noise decreases by K.
//! The number of phases is a power of two, for a fast Fourier transform.

use nalgebra::DMatrix;

use overact_logs::periods::PeriodicMotion;

/// Fewest equations of a period.
const FEWEST: usize = 16;

/// Largest number of phases of a period.
const MOST_PHASES: usize = 2048;

/// Phases of a run's equations in its motion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Phases {
    /// Number of the first run with this motion.
    pub(crate) motion: usize,
    /// Equations of a period.
    period: f64,
    count: usize,
}

impl Phases {
    /// Phases of a run with this decimation; `None` for a period of too few equations.
    pub(crate) fn new(motion: PeriodicMotion, decimation: usize) -> Option<Self> {
        let period = motion.samples as f64 / decimation as f64;
        let largest = (period as usize).min(MOST_PHASES);
        (largest >= FEWEST).then(|| Self {
            motion: motion.motion,
            period,
            count: 1 << largest.ilog2(),
        })
    }

    /// Phase of an equation.
    fn of(&self, equation: usize) -> usize {
        let part = (equation as f64 / self.period).fract();
        ((part * self.count as f64) as usize).min(self.count - 1)
    }
}

/// Sums of the rows of a line at each phase.
#[derive(Debug, Clone)]
pub(crate) struct PhaseSums {
    pub(crate) phases: Phases,
    /// Values of a row.
    width: usize,
    sums: Vec<f64>,
    counts: Vec<u32>,
}

impl PhaseSums {
    /// Sums of no rows.
    pub(crate) fn new(phases: Phases, width: usize) -> Self {
        Self {
            phases,
            width,
            sums: vec![0.0; phases.count * width],
            counts: vec![0; phases.count],
        }
    }

    /// Adds the row of an equation.
    pub(crate) fn add<'a>(&mut self, equation: usize, row: impl Iterator<Item = &'a f64>) {
        let phase = self.phases.of(equation);
        let place = phase * self.width;
        let sums = &mut self.sums[place..place + self.width];
        sums.iter_mut().zip(row).for_each(|(sum, own)| *sum += own);
        self.counts[phase] += 1;
    }

    /// Adds the sums of another run of the same motion.
    pub(crate) fn merge(&mut self, other: &Self) {
        if self.sums.len() != other.sums.len() {
            return;
        }
        let sums = self.sums.iter_mut().zip(&other.sums);
        sums.for_each(|(sum, own)| *sum += own);
        let counts = self.counts.iter_mut().zip(&other.counts);
        counts.for_each(|(count, own)| *count += own);
    }

    /// Mean rows, phases × values, times the square root of the equations per phase.
    ///
    /// Products of them approximate those of all rows. `None` if a phase has no equation.
    pub(crate) fn means(&self) -> Option<DMatrix<f64>> {
        if self.counts.contains(&0) {
            return None;
        }
        let equations: f64 = self.counts.iter().map(|count| f64::from(*count)).sum();
        let root = (equations / self.counts.len() as f64).sqrt();
        let value = |phase: usize, column: usize| {
            self.sums[phase * self.width + column] * root / f64::from(self.counts[phase])
        };
        Some(DMatrix::from_fn(self.counts.len(), self.width, value))
    }
}

/// Adds the sums of a run's lines to those of its motion, of which `all` has one entry each.
///
/// Returns the index of the run's motion.
pub(crate) fn add(all: &mut Vec<Vec<PhaseSums>>, own: Vec<PhaseSums>) -> usize {
    let motion = |lines: &[PhaseSums]| lines.first().map(|line| line.phases.motion);
    let same = all.iter().position(|one| motion(one) == motion(&own));
    let Some(place) = same else {
        all.push(own);
        return all.len() - 1;
    };
    let both = all[place].iter_mut().zip(&own);
    both.for_each(|(all, own)| all.merge(own));
    place
}

#[cfg(test)]
mod tests {
    use super::{PhaseSums, Phases, add};
    use overact_logs::periods::PeriodicMotion;

    fn phases(samples: usize, decimation: usize) -> Option<Phases> {
        let motion = PeriodicMotion { samples, motion: 0 };
        Phases::new(motion, decimation)
    }

    #[test]
    fn phase_means_preserve_products_of_a_periodic_motion() {
        // Five periods of 60 equations, with 32 phases.
        let phases = phases(600, 10).expect("long enough");
        let row = |equation: usize| {
            let angle = std::f64::consts::TAU * equation as f64 / 60.0;
            [1.0, angle.sin(), (3.0 * angle).cos()]
        };
        let mut sums = PhaseSums::new(phases, 3);
        let mut products = nalgebra::DMatrix::<f64>::zeros(3, 3);
        for equation in 0..300 {
            let own = row(equation);
            sums.add(equation, own.iter());
            let own = nalgebra::DMatrix::from_row_slice(1, 3, &own);
            products += own.tr_mul(&own);
        }
        let means = sums.means().expect("every phase has equations");
        assert_eq!(means.shape(), (32, 3));
        let miss = (means.tr_mul(&means) - &products).norm() / products.norm();
        assert!(miss < 0.03, "{miss}");
    }

    #[test]
    fn values_that_alternate_between_periods_cancel_in_the_means() {
        let mut sums = PhaseSums::new(phases(16, 1).expect("long enough"), 1);
        for equation in 0..64 {
            let sign = if equation / 16 % 2 == 0 { 1.0 } else { -1.0 };
            sums.add(equation, [sign].iter());
        }
        assert_eq!(sums.means().expect("every phase").norm(), 0.0);
    }

    #[test]
    fn runs_of_one_motion_are_summed_together() {
        let one = |value: f64| {
            let mut sums = PhaseSums::new(phases(16, 1).expect("long enough"), 1);
            (0..16).for_each(|equation| sums.add(equation, [value].iter()));
            sums
        };
        let mut all = Vec::new();
        assert_eq!(add(&mut all, vec![one(1.0)]), 0);
        assert_eq!(add(&mut all, vec![one(3.0)]), 0);
        let other = PeriodicMotion {
            samples: 16,
            motion: 2,
        };
        let phases = Phases::new(other, 1).expect("long enough");
        assert_eq!(add(&mut all, vec![PhaseSums::new(phases, 1)]), 1);
        assert_eq!(all.len(), 2);
        let means = all[0][0].means().expect("every phase");
        assert!(
            means
                .iter()
                .all(|mean| (mean - 2.0 * 2.0_f64.sqrt()).abs() < 1e-15)
        );
        assert!(all[1][0].means().is_none());
    }

    #[test]
    fn short_periods_are_not_summed() {
        assert!(phases(150, 10).is_none());
        assert!(phases(160, 10).is_some());
    }
}
