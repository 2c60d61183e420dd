//! Tensions of cables: the admissible torques nearest to the minimum tensions.
//!
//! All torques that produce a motion are τ = p + N z, with torques p of some actuators alone and an
//! orthonormal basis N of the internal torques. [`solve`] finds the one with least ‖τ - τ_min‖ and
//! τ_i ≥ τ_min,i for every cable i. Without these conditions it is d + τ_min, with
//! d = p - τ_min + N Nᵀ (τ_min - p). The internal torques z that are added to it obey
//! N z ≥ -d, and ‖z‖ is least:
//!
//! - with one internal torque each cable gives a half line of z; the solution is the point of their
//!   intersection that is nearest to zero;
//! - with more, conditions are added one by one by the dual method of D. Goldfarb and A. Idnani
//!   (*A numerically stable dual method for solving strictly convex quadratic programs*, 1983).
//!
//! No function can panic, whatever the lengths of the slices are: a missing number is NaN, which
//! ends in an error. The interpreter and the runtime call this module, and generated C has the same
//! operations.

use crate::Error;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A floating-point type of torques.
pub trait Torque:
    Copy
    + PartialOrd
    + From<f32>
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
}

impl Torque for f32 {}
impl Torque for f64 {}

/// Memory for [`solve`].
#[derive(Debug)]
pub struct Workspace<'a, T> {
    /// Internal torques z, one for each redundant actuator.
    pub internal: &'a mut [T],
    /// Direction of a step of z, of the same length.
    pub direction: &'a mut [T],
    /// Multipliers of the active conditions, of the same length.
    pub multipliers: &'a mut [T],
    /// Changes of the multipliers, of the same length.
    pub changes: &'a mut [T],
    /// Active conditions, of the same length.
    pub active: &'a mut [usize],
    /// Products of active conditions, the square of this length.
    pub products: &'a mut [T],
}

/// Torques τ = p + N z with least ‖τ - τ_min‖ and τ ≥ τ_min, for n actuators, m of them redundant.
///
/// `system` contains p, n numbers, and N, n × m numbers, row by row. `least` contains τ_min; an
/// actuator that is no cable has -∞ there, and its torque is compared with zero. m is the length of
/// `workspace.internal`. `small` is the fraction of the largest torque that counts as zero.
///
/// # Errors
/// [`Error::Tensions`] if there are no such torques, [`Error::Overflow`] if they exceed the range
/// of numbers.
pub fn solve<T: Torque>(
    system: &[T],
    least: &[T],
    small: T,
    torques: &mut [T],
    mut workspace: Workspace<'_, T>,
) -> Result<(), Error> {
    let m = workspace.internal.len();
    let problem = Problem {
        particular: system.get(..least.len()).unwrap_or_default(),
        basis: system.get(least.len()..).unwrap_or_default(),
        least,
        m,
        small,
    };
    let tolerance = problem.start(torques, workspace.internal);
    match m {
        0 => {}
        1 => {
            let z = problem.nearest(torques);
            workspace.internal.iter_mut().for_each(|own| *own = z);
        }
        _ => problem.dual(torques, tolerance, &mut workspace)?,
    }
    problem.finish(torques, workspace.internal, tolerance)
}

/// The number at an index; NaN if there is none.
fn get<T: Torque>(numbers: &[T], at: usize) -> T {
    numbers.get(at).copied().unwrap_or(T::from(f32::NAN))
}

fn zero<T: Torque>() -> T {
    T::from(0.0)
}

fn infinity<T: Torque>() -> T {
    T::from(f32::INFINITY)
}

fn is_finite<T: Torque>(number: T) -> bool {
    magnitude(number) < infinity()
}

fn magnitude<T: Torque>(number: T) -> T {
    if number < zero() { -number } else { number }
}

/// The larger number; the first if one is NaN.
fn larger<T: Torque>(one: T, other: T) -> T {
    if other > one { other } else { one }
}

/// The smaller number; the first if one is NaN.
fn smaller<T: Torque>(one: T, other: T) -> T {
    if other < one { other } else { one }
}

fn set<T>(numbers: &mut [T], at: usize, value: T) {
    if let Some(number) = numbers.get_mut(at) {
        *number = value;
    }
}

/// p, N and τ_min.
struct Problem<'a, T> {
    particular: &'a [T],
    basis: &'a [T],
    least: &'a [T],
    m: usize,
    /// Fraction that counts as zero.
    small: T,
}

impl<T: Torque> Problem<'_, T> {
    /// Entry of N.
    fn basis(&self, row: usize, column: usize) -> T {
        get(self.basis, row * self.m + column)
    }

    /// Whether an actuator is a cable.
    fn is_cable(&self, at: usize) -> bool {
        get(self.least, at) > -infinity::<T>()
    }

    /// τ_min of a cable, zero for other actuators.
    fn reference(&self, at: usize) -> T {
        if self.is_cable(at) {
            get(self.least, at)
        } else {
            zero::<T>()
        }
    }

    /// Sets `torques` to d and z to zero; returns the tolerance of the conditions.
    fn start(&self, torques: &mut [T], internal: &mut [T]) -> T {
        let n = self.least.len();
        for k in 0..self.m {
            let mut sum = zero::<T>();
            for i in 0..n {
                sum += self.basis(i, k) * (self.reference(i) - get(self.particular, i));
            }
            set(internal, k, sum);
        }
        let mut largest = zero::<T>();
        for i in 0..n {
            let mut torque = get(self.particular, i);
            for k in 0..self.m {
                torque += self.basis(i, k) * get(internal, k);
            }
            torque = torque - self.reference(i);
            largest = larger(largest, magnitude(torque));
            largest = larger(largest, magnitude(self.reference(i)));
            largest = larger(largest, magnitude(get(self.particular, i)));
            set(torques, i, torque);
        }
        internal.iter_mut().for_each(|z| *z = zero::<T>());
        self.small * largest
    }

    /// The z nearest to zero in the intersection of the half lines of one internal torque.
    fn nearest(&self, deviations: &[T]) -> T {
        let small = self.small;
        let mut lower = -infinity::<T>();
        let mut upper = infinity::<T>();
        for i in 0..self.least.len() {
            let factor = self.basis(i, 0);
            if self.is_cable(i) && factor > small {
                lower = larger(lower, -get(deviations, i) / factor);
            }
            if self.is_cable(i) && factor < -small {
                upper = smaller(upper, -get(deviations, i) / factor);
            }
        }
        if lower > zero::<T>() {
            lower
        } else if upper < zero::<T>() {
            upper
        } else {
            zero::<T>()
        }
    }

    /// d + N z of an actuator.
    fn deviation(&self, deviations: &[T], internal: &[T], at: usize) -> T {
        let mut sum = get(deviations, at);
        for k in 0..self.m {
            sum += self.basis(at, k) * get(internal, k);
        }
        sum
    }

    /// z by the dual method: the most violated condition is added until none is.
    fn dual(
        &self,
        deviations: &[T],
        tolerance: T,
        workspace: &mut Workspace<'_, T>,
    ) -> Result<(), Error> {
        let n = self.least.len();
        let mut count = 0;
        for _ in 0..10 * (n + self.m) {
            let mut worst = -tolerance;
            let mut at = n;
            for i in 0..n {
                let is_active = workspace.active.iter().take(count).any(|own| *own == i);
                if self.is_cable(i) && !is_active {
                    let value = self.deviation(deviations, workspace.internal, i);
                    if value < worst {
                        worst = value;
                        at = i;
                    }
                }
            }
            if at == n {
                return Ok(());
            }
            count = self.add(deviations, at, count, workspace)?;
        }
        Err(Error::Tensions)
    }

    /// Moves z onto condition `at`, and drops active conditions that then no longer hold it back;
    /// returns the number of active conditions.
    fn add(
        &self,
        deviations: &[T],
        at: usize,
        active: usize,
        workspace: &mut Workspace<'_, T>,
    ) -> Result<usize, Error> {
        let small = self.small;
        let mut count = active;
        let mut multiplier = zero::<T>();
        for _ in 0..self.m + 1 {
            self.step(at, count, workspace);
            let mut square = zero::<T>();
            let mut length = zero::<T>();
            for k in 0..self.m {
                let own = get(workspace.direction, k);
                square += own * own;
                length += self.basis(at, k) * self.basis(at, k);
            }
            let mut longest = infinity::<T>();
            let mut dropped = count;
            for j in 0..count {
                let change = get(workspace.changes, j);
                if change > zero::<T>() {
                    let ratio = get(workspace.multipliers, j) / change;
                    if ratio < longest {
                        longest = ratio;
                        dropped = j;
                    }
                }
            }
            let is_free = square > small * length;
            let full = if is_free {
                -self.deviation(deviations, workspace.internal, at) / square
            } else {
                infinity::<T>()
            };
            let is_full = full <= longest;
            let size = if is_full { full } else { longest };
            if !is_finite(size) {
                return Err(Error::Tensions);
            }
            if is_free {
                for k in 0..self.m {
                    let moved = get(workspace.internal, k) + size * get(workspace.direction, k);
                    set(workspace.internal, k, moved);
                }
            }
            for j in 0..count {
                let moved = get(workspace.multipliers, j) - size * get(workspace.changes, j);
                set(workspace.multipliers, j, moved);
            }
            multiplier += size;
            if is_full {
                set(workspace.active, count, at);
                set(workspace.multipliers, count, multiplier);
                return Ok(count + 1);
            }
            for j in dropped + 1..count {
                let (own, value) = (
                    workspace.active.get(j).copied().unwrap_or(0),
                    get(workspace.multipliers, j),
                );
                set(workspace.active, j - 1, own);
                set(workspace.multipliers, j - 1, value);
            }
            count = count.saturating_sub(1);
        }
        Err(Error::Tensions)
    }

    /// Sets `changes` to r with G Gᵀ r = G g, with the active rows G of N and the row g of `at`,
    /// and `direction` to g - Gᵀ r.
    fn step(&self, at: usize, count: usize, workspace: &mut Workspace<'_, T>) {
        let m = self.m;
        let row = |active: &[usize], j: usize| active.get(j).copied().unwrap_or(0);
        for i in 0..count {
            let own = row(workspace.active, i);
            for j in 0..count {
                let other = row(workspace.active, j);
                let mut sum = zero::<T>();
                for k in 0..m {
                    sum += self.basis(own, k) * self.basis(other, k);
                }
                set(workspace.products, i * m + j, sum);
            }
            let mut sum = zero::<T>();
            for k in 0..m {
                sum += self.basis(own, k) * self.basis(at, k);
            }
            set(workspace.changes, i, sum);
        }
        // Elimination without exchange of rows: the matrix is positive definite.
        for i in 0..count {
            for j in i + 1..count {
                let factor =
                    get(workspace.products, j * m + i) / get(workspace.products, i * m + i);
                for k in i..count {
                    let left = get(workspace.products, j * m + k)
                        - factor * get(workspace.products, i * m + k);
                    set(workspace.products, j * m + k, left);
                }
                let left = get(workspace.changes, j) - factor * get(workspace.changes, i);
                set(workspace.changes, j, left);
            }
        }
        for i in (0..count).rev() {
            let mut sum = get(workspace.changes, i);
            for k in i + 1..count {
                sum = sum - get(workspace.products, i * m + k) * get(workspace.changes, k);
            }
            set(
                workspace.changes,
                i,
                sum / get(workspace.products, i * m + i),
            );
        }
        for k in 0..m {
            let mut sum = self.basis(at, k);
            for j in 0..count {
                let own = row(workspace.active, j);
                sum = sum - self.basis(own, k) * get(workspace.changes, j);
            }
            set(workspace.direction, k, sum);
        }
    }

    /// Sets `torques` from d to τ_min + d + N z; an error if one is too small.
    fn finish(&self, torques: &mut [T], internal: &[T], tolerance: T) -> Result<(), Error> {
        for i in 0..self.least.len() {
            let mut deviation = self.deviation(torques, internal, i);
            if !is_finite(deviation) {
                return Err(Error::Overflow);
            }
            if self.is_cable(i) {
                if deviation < -tolerance {
                    return Err(Error::Tensions);
                }
                if deviation < zero::<T>() {
                    deviation = zero::<T>();
                }
            }
            set(torques, i, self.reference(i) + deviation);
        }
        Ok(())
    }
}
