//! Nearest physically consistent parameters, with a bounded number of steps.
//!
//! Minimises ½‖R χ(J) - z‖² over positive definite pseudo-inertias J by an interior-point method
//! (Boyd and Vandenberghe, *Convex Optimization*, 2004, chapter 11). Each step is a Newton step of
//!
//! ½‖R χ(J) - z‖² - μ log det J,
//!
//! damped by 1/(1 + decrement), which keeps J positive definite. At the minimum for a μ, the first
//! term is at most 4 μ above the best possible. It is a sum of squares in standard deviations, so
//! a gap of 0.005 is far below the noise.

use super::pseudo_inertia::{Triangle, cholesky, inertia, inverse, is_diagonal, transformed};
use crate::float::Float;
use crate::online::triangle::{rotate_in, solve};

/// Largest number of steps.
const STEPS: usize = 100;

/// Largest distance from the best ½‖R χ - z‖² at the end.
pub(super) const GAP: f64 = 0.005;

/// Factor of μ after each minimum.
const DECREASE: f64 = 0.1;

/// Decrement below which a minimum is reached.
const REACHED: f64 = 0.5;

/// Fit of ten inertial parameters to the information of P of them.
pub(super) struct Fit<'a, const P: usize, T> {
    /// R.
    pub(super) factor: &'a [[T; P]; P],
    /// z.
    pub(super) side: &'a [T; P],
    /// Places of the P parameters among the ten.
    pub(super) places: &'a [usize; P],
    /// Length ℓ of the pseudo-inertia, m.
    pub(super) length: T,
    /// Weights of the ten parameters towards zero; zero for those with a column.
    pub(super) weights: [T; 10],
}

/// A pseudo-inertia with its cost.
pub(super) struct Fitted<T> {
    /// J, positive definite.
    pub(super) pseudo: Triangle<T>,
    /// ½‖R χ - z‖².
    pub(super) cost: T,
}

impl<const P: usize, T: Float> Fit<'_, P, T> {
    /// R χ(J) - `side`.
    fn residual(&self, pseudo: &Triangle<T>, side: &[T; P]) -> [T; P] {
        let parameters = inertia(pseudo, self.length);
        let mut residual = *side;
        for (rest, row) in residual.iter_mut().zip(self.factor) {
            *rest = -*rest;
            for (r, place) in row.iter().zip(self.places) {
                *rest += *r * parameters.get(*place).copied().unwrap_or(T::ZERO);
            }
        }
        residual
    }

    /// ½‖R χ(J) - z‖².
    fn cost(&self, pseudo: &Triangle<T>) -> T {
        let residual = self.residual(pseudo, self.side);
        T::of(0.5) * residual.iter().map(|r| *r * *r).sum::<T>()
    }

    /// The best J, starting from a positive definite one.
    pub(super) fn improve(&self, start: Triangle<T>) -> Fitted<T> {
        let one = T::of(1.0);
        let columns = self.columns();
        let mut pseudo = start;
        let last = T::of(0.25 * GAP);
        let mut barrier = (T::of(0.25) * self.cost(&start)).max(last);
        for _ in 0..STEPS {
            let Some((step, decrement)) = self.step(&columns, &pseudo, barrier) else {
                break;
            };
            let damping = if decrement > T::of(0.25) {
                one / (one + decrement)
            } else {
                one
            };
            let mut next = pseudo;
            for (entry, change) in next.iter_mut().zip(step) {
                *entry += damping * change;
            }
            // Only rounding can make J indefinite.
            if cholesky(&next).is_none() {
                break;
            }
            pseudo = next;
            if decrement < T::of(REACHED) {
                if barrier <= last {
                    break;
                }
                barrier = (T::of(DECREASE) * barrier).max(last);
            }
        }
        Fitted {
            pseudo,
            cost: self.cost(&pseudo),
        }
    }

    /// Changes of R χ for each entry of J: ten columns.
    fn columns(&self) -> [[T; P]; 10] {
        let mut columns = [[T::ZERO; P]; 10];
        for (entry, column) in columns.iter_mut().enumerate() {
            *column = self.residual(&unit(entry), &[T::ZERO; P]);
        }
        columns
    }

    /// Newton step for a barrier μ, and its decrement.
    ///
    /// With J = L Lᵀ and D = L⁻¹ dJ L⁻ᵀ, -log det(J + dJ) is ½‖D - 1‖² + constant up to second
    /// order. So the step solves the least squares ‖R χ(dJ) + R χ(J) - z‖² + μ ‖D - 1‖².
    fn step(
        &self,
        columns: &[[T; P]; 10],
        pseudo: &Triangle<T>,
        barrier: T,
    ) -> Option<([T; 10], T)> {
        let lower = inverse(&cholesky(pseudo)?);
        let (mut factor, mut side) = ([[T::ZERO; 10]; 10], [T::ZERO; 10]);
        let mut add = |row: &mut [T; 10], y: T| {
            rotate_in(factor.as_flattened_mut(), &mut side, row, y, 0);
        };
        for (line, rest) in self.residual(pseudo, self.side).into_iter().enumerate() {
            let mut row = [T::ZERO; 10];
            for (to, column) in row.iter_mut().zip(columns) {
                *to = column.get(line).copied().unwrap_or(T::ZERO);
            }
            add(&mut row, -rest);
        }
        let present = inertia(pseudo, self.length);
        for (parameter, weight) in self.weights.into_iter().enumerate() {
            if weight > T::ZERO {
                let mut row = [T::ZERO; 10];
                for (entry, to) in row.iter_mut().enumerate() {
                    let change = inertia(&unit(entry), self.length);
                    *to = weight * change.get(parameter).copied().unwrap_or(T::ZERO);
                }
                let value = present.get(parameter).copied().unwrap_or(T::ZERO);
                add(&mut row, -weight * value);
            }
        }
        let root = barrier.sqrt();
        let mut changes = [[T::ZERO; 10]; 10];
        for (entry, change) in changes.iter_mut().enumerate() {
            *change = transformed(&lower, entry);
        }
        for line in 0..10 {
            let mut row = [T::ZERO; 10];
            for (to, change) in row.iter_mut().zip(&changes) {
                *to = root * change.get(line).copied().unwrap_or(T::ZERO);
            }
            let y = if is_diagonal(line) { root } else { T::ZERO };
            add(&mut row, y);
        }
        let mut step = [T::ZERO; 10];
        if !solve(factor.as_flattened(), &side, &mut step) {
            return None;
        }
        // The squared decrement is dᵀ H d / μ = ‖z‖²/μ of the triangular system.
        let square = side.iter().map(|z| *z * *z).sum::<T>() / barrier;
        let decrement = square.sqrt();
        decrement.is_finite().then_some((step, decrement))
    }
}

/// J with a single entry 1.
fn unit<T: Float>(entry: usize) -> Triangle<T> {
    let mut unit = [T::ZERO; 10];
    let own = unit.iter_mut().skip(entry).take(1);
    own.for_each(|x| *x = T::of(1.0));
    unit
}
