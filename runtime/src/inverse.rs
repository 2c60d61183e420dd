//! Inverse kinematics by Newton's method, for legs without closed form.
//!
//! Each leg's closure error e(x, q) is reduced to zero with the generated leg Jacobian J_k, eq.
//! (9): J_k Δq = e. The iteration starts from the home configuration. If a leg does not converge,
//! or changes its working mode (the sign of its determinant), the path from the home pose is
//! divided into more and smaller steps.
//!
//! No function can panic, whatever the lengths of the slices are. Entries are accessed with `get`;
//! a missing one is NaN, which ends the iteration with an error.

use crate::{Error, float::Float};
use core::ops::Range;

/// A robot's legs and home configuration.
#[derive(Debug, Clone, Copy)]
pub struct Legs<'a, T = f64> {
    /// Names.
    pub names: &'a [&'static str],
    /// Number of joints of each leg.
    pub joints: &'a [usize],
    /// Home pose.
    pub home_pose: &'a [T],
    /// Home joint positions.
    pub home_joints: &'a [T],
    /// Whether the pose ends with a quaternion.
    pub has_quaternion: bool,
}

impl<'a, T> Legs<'a, T> {
    /// Each leg's name and the range of its joints.
    fn ranges(&self) -> impl Iterator<Item = (&'static str, Range<usize>)> + use<'a, T> {
        let named = self.names.iter().copied().zip(self.joints);
        named.scan(0, |start, (leg, &count)| {
            let range = *start..*start + count;
            *start = range.end;
            Some((leg, range))
        })
    }
}

/// Memory for [`solve`]: slices of lengths n_t, n_t², and of a pose.
#[derive(Debug)]
pub struct Workspace<'a, T = f64> {
    /// n_t numbers.
    pub error: &'a mut [T],
    /// n_t² numbers.
    pub jacobian: &'a mut [T],
    /// One pose.
    pub pose: &'a mut [T],
}

const ITERATIONS: usize = 30;
/// Largest step of a joint (m, rad).
const LONGEST_STEP: f64 = 0.5;

/// Finds the joint positions of a pose in the working mode of the home configuration.
///
/// `evaluate` writes the closure error (n_t) and J_k (n_t × n_t, row-major) of a pose and joint
/// positions. The pose has to be finite.
///
/// # Errors
/// [`Error::OutOfReach`] or [`Error::SingularLeg`] for the leg that does not converge.
pub fn solve<T: Float>(
    legs: Legs<'_, T>,
    pose: &[T],
    joints: &mut [T],
    workspace: Workspace<'_, T>,
    mut evaluate: impl FnMut(&[T], &[T], &mut [T], &mut [T]) -> Result<(), Error>,
) -> Result<(), Error> {
    let Workspace {
        error,
        jacobian,
        pose: way,
    } = workspace;
    let mut result = Ok(());
    for steps in [1_u32, 8, 64] {
        joints
            .iter_mut()
            .zip(legs.home_joints)
            .for_each(|(q, home)| *q = *home);
        result = Ok(());
        for step in 1..=steps {
            let part = T::of(f64::from(step) / f64::from(steps));
            between(&legs, pose, part, way);
            result = newton(&legs, way, joints, error, jacobian, &mut evaluate);
            if result.is_err() {
                break;
            }
        }
        if result.is_ok() {
            result = same_mode(&legs, pose, joints, error, jacobian, &mut evaluate);
        }
        if result.is_ok() {
            return result;
        }
    }
    result
}

/// An intermediate pose between home and the target.
fn between<T: Float>(legs: &Legs<'_, T>, pose: &[T], part: T, way: &mut [T]) {
    for ((w, h), p) in way.iter_mut().zip(legs.home_pose).zip(pose) {
        *w = if part >= T::of(1.0) {
            *p
        } else {
            *h + part * (*p - *h)
        };
    }
    if legs.has_quaternion {
        let before = way.len().saturating_sub(4);
        let squares = way.iter().skip(before).map(|q| *q * *q);
        let norm = squares.sum::<T>().sqrt();
        way.iter_mut().skip(before).for_each(|q| *q /= norm);
    }
}

fn newton<T: Float>(
    legs: &Legs<'_, T>,
    pose: &[T],
    joints: &mut [T],
    error: &mut [T],
    jacobian: &mut [T],
    evaluate: &mut impl FnMut(&[T], &[T], &mut [T], &mut [T]) -> Result<(), Error>,
) -> Result<(), Error> {
    for _ in 0..ITERATIONS {
        evaluate(pose, joints, error, jacobian)?;
        let mut largest = T::ZERO;
        for (leg, range) in legs.ranges() {
            let mut system = System::new(joints.len(), jacobian, error);
            let (_, condition) = system.eliminate(range.clone());
            let is_regular = condition * T::of(T::LIMITS.singular) <= T::of(1.0);
            if !is_regular {
                return Err(singular(leg, condition));
            }
            let (step, longest) = (largest_of(part(error, range.clone())), T::of(LONGEST_STEP));
            let scale = if step > longest {
                longest / step
            } else {
                T::of(1.0)
            };
            let moved = joints.iter_mut().zip(error.iter());
            for (q, s) in moved.skip(range.start).take(range.len()) {
                *q += scale * *s;
            }
            largest = largest.max(step);
        }
        if largest < T::of(T::LIMITS.joint_step) {
            return Ok(());
        }
    }
    evaluate(pose, joints, error, jacobian)?;
    closed(legs, error)
}

/// Checks that all legs are closed; the error names the leg with the largest closure error.
fn closed<T: Float>(legs: &Legs<'_, T>, error: &[T]) -> Result<(), Error> {
    let sizes = legs
        .ranges()
        .map(|(leg, range)| (leg, largest_of(part(error, range))));
    let open = sizes.filter(|(_, size)| *size >= T::of(T::LIMITS.closed));
    match open.reduce(|worst, next| if next.1 > worst.1 { next } else { worst }) {
        Some((leg, _)) => Err(Error::OutOfReach { leg }),
        None => Ok(()),
    }
}

/// Whether every leg's determinant has its sign at home.
fn same_mode<T: Float>(
    legs: &Legs<'_, T>,
    pose: &[T],
    joints: &[T],
    error: &mut [T],
    jacobian: &mut [T],
    evaluate: &mut impl FnMut(&[T], &[T], &mut [T], &mut [T]) -> Result<(), Error>,
) -> Result<(), Error> {
    let total = joints.len();
    for (leg, range) in legs.ranges() {
        evaluate(legs.home_pose, legs.home_joints, error, jacobian)?;
        let (home, _) = System::new(total, jacobian, error).eliminate(range.clone());
        evaluate(pose, joints, error, jacobian)?;
        let (here, condition) = System::new(total, jacobian, error).eliminate(range);
        if home * here <= T::ZERO {
            return Err(singular(leg, condition));
        }
    }
    Ok(())
}

fn singular<T: Float>(leg: &'static str, condition: T) -> Error {
    Error::SingularLeg {
        leg,
        condition: condition.into(),
    }
}

fn part<T>(numbers: &[T], range: Range<usize>) -> &[T] {
    numbers.get(range).unwrap_or_default()
}

fn largest_of<T: Float>(numbers: &[T]) -> T {
    numbers
        .iter()
        .fold(T::ZERO, |largest, x| largest.max(x.abs()))
}

/// A square matrix, row-major, and a right-hand side; entries outside of them are NaN.
pub(crate) struct System<'a, T> {
    size: usize,
    matrix: &'a mut [T],
    vector: &'a mut [T],
}

impl<'a, T: Float> System<'a, T> {
    pub(crate) fn new(size: usize, matrix: &'a mut [T], vector: &'a mut [T]) -> Self {
        Self {
            size,
            matrix,
            vector,
        }
    }

    fn entry(&self, row: usize, column: usize) -> T {
        let entry = self.matrix.get(row * self.size + column);
        entry.copied().unwrap_or(T::NAN)
    }

    fn side(&self, row: usize) -> T {
        self.vector.get(row).copied().unwrap_or(T::NAN)
    }

    fn set_entry(&mut self, row: usize, column: usize, value: T) {
        if let Some(entry) = self.matrix.get_mut(row * self.size + column) {
            *entry = value;
        }
    }

    fn set_side(&mut self, row: usize, value: T) {
        if let Some(side) = self.vector.get_mut(row) {
            *side = value;
        }
    }

    /// Solves the diagonal block `range` in place by Gaussian elimination with row pivoting.
    ///
    /// Returns the sign of the block's determinant and the ratio of its largest to its smallest
    /// pivot.
    pub(crate) fn eliminate(&mut self, range: Range<usize>) -> (T, T) {
        let mut sign = T::of(1.0);
        let (mut largest, mut smallest) = (T::ZERO, T::INFINITY);
        for k in range.clone() {
            if self.bring_pivot_up(k, &range) {
                sign = -sign;
            }
            let pivot = self.entry(k, k);
            largest = largest.max(pivot.abs());
            smallest = smallest.min(pivot.abs());
            if pivot == T::ZERO || !pivot.is_finite() {
                return (T::ZERO, T::INFINITY);
            }
            if pivot < T::ZERO {
                sign = -sign;
            }
            for row in k + 1..range.end {
                let factor = self.entry(row, k) / pivot;
                for column in k..range.end {
                    let rest = self.entry(row, column) - factor * self.entry(k, column);
                    self.set_entry(row, column, rest);
                }
                self.set_side(row, self.side(row) - factor * self.side(k));
            }
        }
        for k in range.clone().rev() {
            let known = (k + 1..range.end).map(|column| self.entry(k, column) * self.side(column));
            let rest = known.fold(self.side(k), |rest, product| rest - product);
            self.set_side(k, rest / self.entry(k, k));
        }
        (sign, largest / smallest)
    }

    /// Swaps row k of a block with the later one that has the largest entry in column k; returns
    /// whether one exists.
    fn bring_pivot_up(&mut self, k: usize, range: &Range<usize>) -> bool {
        let mut pivot_row = k;
        for row in k + 1..range.end {
            if self.entry(row, k).abs() > self.entry(pivot_row, k).abs() {
                pivot_row = row;
            }
        }
        if pivot_row == k {
            return false;
        }
        for column in range.clone() {
            let (here, there) = (self.entry(k, column), self.entry(pivot_row, column));
            self.set_entry(k, column, there);
            self.set_entry(pivot_row, column, here);
        }
        let (here, there) = (self.side(k), self.side(pivot_row));
        self.set_side(k, there);
        self.set_side(pivot_row, here);
        true
    }
}
