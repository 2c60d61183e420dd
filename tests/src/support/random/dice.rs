//! Random choices.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// A stream of choices, the same for the same seed on any machine.
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

    /// True in so many cases of one.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.0.random_range(0.0..1.0) < probability
    }

    /// One of several.
    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// About half of several, in order.
    pub fn some<T: Copy>(&mut self, of: &[T]) -> Vec<T> {
        of.iter().copied().filter(|_| self.chance(0.5)).collect()
    }

    /// A random order.
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for at in (1..items.len()).rev() {
            items.swap(at, self.below(at + 1));
        }
    }

    /// A length of full millimetres within a bound on either side, m; sometimes zero.
    pub fn length(&mut self, bound: f64) -> f64 {
        if self.chance(0.15) {
            return 0.0;
        }
        (1e3 * self.0.random_range(-bound..bound)).round() / 1e3
    }

    /// A length of full millimetres between bounds, m.
    pub fn distance(&mut self, low: f64, high: f64) -> f64 {
        (1e3 * self.0.random_range(low..high)).round() / 1e3
    }

    /// An angle within a bound on either side, rad: a decimal, or full degrees.
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

    /// The angle between neighbouring axes: a right angle, parallel, or any.
    pub fn twist(&mut self) -> f64 {
        let exact: f64 = self.pick(&[90.0, -90.0, 0.0, 180.0, 60.0, -45.0]);
        if self.chance(0.6) {
            exact.to_radians()
        } else {
            self.angle(2.0)
        }
    }
}
