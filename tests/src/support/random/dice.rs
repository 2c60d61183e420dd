//! Random choices.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Stream of random choices, reproducible on any machine.
#[derive(Clone, Debug)]
pub struct Dice(Pcg64);

impl Dice {
    /// The stream of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    /// An integer below a bound.
    pub fn below(&mut self, bound: usize) -> usize {
        self.0.random_range(0..bound)
    }

    /// True with the given probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.0.random_range(0.0..1.0) < probability
    }

    /// One of several items.
    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// About half of several items, in order.
    pub fn some<T: Copy>(&mut self, of: &[T]) -> Vec<T> {
        of.iter().copied().filter(|_| self.chance(0.5)).collect()
    }

    /// A random order.
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for at in (1..items.len()).rev() {
            items.swap(at, self.below(at + 1));
        }
    }

    /// Length of whole millimetres up to a bound in either direction, m; sometimes zero.
    pub fn length(&mut self, bound: f64) -> f64 {
        if self.chance(0.15) {
            return 0.0;
        }
        (1e3 * self.0.random_range(-bound..bound)).round() / 1e3
    }

    /// Length of whole millimetres between bounds, m.
    pub fn distance(&mut self, low: f64, high: f64) -> f64 {
        (1e3 * self.0.random_range(low..high)).round() / 1e3
    }

    /// Angle up to a bound in either direction, rad: a decimal, or whole degrees.
    pub fn angle(&mut self, bound: f64) -> f64 {
        if self.chance(0.3) {
            return self
                .0
                .random_range(-bound..bound)
                .to_degrees()
                .round()
                .to_radians();
        }
        self.length(bound)
    }

    /// Angle between neighbouring axes: right, parallel, or any.
    pub fn twist(&mut self) -> f64 {
        let exact: f64 = self.pick(&[90.0, -90.0, 0.0, 180.0, 60.0, -45.0]);
        if self.chance(0.6) {
            exact.to_radians()
        } else {
            self.angle(2.0)
        }
    }
}
