//! Tensions of cables: the admissible torques nearest to the minimum tensions.
//!
//! [`distribute`] is what generated code of cable robots calls; [`overact_core::tension`] has the
//! method.
//!
//! ```
//! use overact::tension::distribute;
//!
//! // Two cables pull a slider in opposite directions; the first one has to pull with 3 N more.
//! let half = 0.5_f64.sqrt();
//! let system = [3.0, 0.0, half, half]; // p, then N row by row
//! let tensions = distribute::<f64, 2, 1>(&system, &[5.0, 5.0])?;
//! assert!((tensions[0] - 8.0).abs() < 1e-12 && (tensions[1] - 5.0).abs() < 1e-12);
//! # Ok::<(), overact::Error>(())
//! ```

use crate::{Error, float::Float};
use overact_core::tension::{Torque, Workspace, solve};

/// Torques τ = p + N z with least ‖τ - τ_min‖ and τ ≥ τ_min, for n actuators, m of them redundant.
///
/// `system` contains p, n numbers, and N, n × m numbers, row by row. `least` contains τ_min; an
/// actuator that is no cable has -∞ there, and its torque is compared with zero.
///
/// # Errors
/// [`Error::Tensions`] if there are no such torques, [`Error::Overflow`] if they exceed the range
/// of numbers.
pub fn distribute<T: Float + Torque, const N: usize, const M: usize>(
    system: &[T],
    least: &[T; N],
) -> Result<[T; N], Error> {
    let mut torques = [T::ZERO; N];
    let mut products = [[T::ZERO; M]; M];
    let workspace = Workspace {
        internal: &mut [T::ZERO; M],
        direction: &mut [T::ZERO; M],
        multipliers: &mut [T::ZERO; M],
        changes: &mut [T::ZERO; M],
        active: &mut [0; M],
        products: products.as_flattened_mut(),
    };
    solve(
        system,
        least,
        T::of(T::LIMITS.tension),
        &mut torques,
        workspace,
    )?;
    Ok(torques)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::distribute;
    use crate::Error;
    use std::vec::Vec;

    /// A number between -1 and 1 from a linear congruential generator.
    fn draw(state: &mut u64) -> f64 {
        *state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// An orthonormal basis of M random columns, row by row.
    fn basis<const N: usize, const M: usize>(state: &mut u64) -> Vec<f64> {
        let mut columns: Vec<[f64; N]> = Vec::new();
        while columns.len() < M {
            let mut column: [f64; N] = core::array::from_fn(|_| draw(state));
            for _ in 0..2 {
                for other in &columns {
                    let along: f64 = column.iter().zip(other).map(|(a, b)| a * b).sum();
                    column
                        .iter_mut()
                        .zip(other)
                        .for_each(|(a, b)| *a -= along * b);
                }
            }
            let norm = column.iter().map(|a| a * a).sum::<f64>().sqrt();
            columns.push(column.map(|a| a / norm));
        }
        (0..N)
            .flat_map(|i| columns.iter().map(move |column| column[i]))
            .collect()
    }

    /// Least ‖d + N z‖ with d + N z ≥ 0 by many projections onto the conditions in turn (Dykstra),
    /// or `None` if they do not converge.
    fn by_projections<const N: usize, const M: usize>(
        particular: &[f64; N],
        basis: &[f64],
        least: &[f64; N],
    ) -> Option<[f64; N]> {
        let project = |x: &[f64; N]| -> [f64; N] {
            let z: Vec<f64> = (0..M)
                .map(|k| {
                    (0..N)
                        .map(|i| basis[i * M + k] * (x[i] - particular[i]))
                        .sum()
                })
                .collect();
            core::array::from_fn(|i| {
                particular[i] + (0..M).map(|k| basis[i * M + k] * z[k]).sum::<f64>()
            })
        };
        let mut x = *least;
        let mut correction = [0.0; N];
        for _ in 0..2_000_000 {
            let on = project(&x);
            let next: [f64; N] = core::array::from_fn(|i| (on[i] + correction[i]).max(least[i]));
            for i in 0..N {
                correction[i] += on[i] - next[i];
            }
            let gap = (0..N).map(|i| (next[i] - on[i]).abs()).fold(0.0, f64::max);
            let change = (0..N).map(|i| (next[i] - x[i]).abs()).fold(0.0, f64::max);
            x = next;
            if gap < 1e-11 && change < 1e-13 {
                return Some(x);
            }
        }
        None
    }

    fn compare<const N: usize, const M: usize>(seed: u64) -> (usize, usize) {
        let mut state = seed;
        let (mut solved, mut refused) = (0, 0);
        for _ in 0..60 {
            let basis = basis::<N, M>(&mut state);
            let particular: [f64; N] = core::array::from_fn(|_| 10.0 * draw(&mut state));
            let least: [f64; N] = core::array::from_fn(|_| 2.0 + draw(&mut state));
            let system: Vec<f64> = particular.iter().copied().chain(basis.clone()).collect();
            match distribute::<f64, N, M>(&system, &least) {
                Ok(tensions) => {
                    solved += 1;
                    // The torques are those of the system, and no cable is below its minimum.
                    assert!(tensions.iter().zip(&least).all(|(t, least)| t >= least));
                    // Their difference from p is internal: N Nᵀ does not change it.
                    let part = |k: usize| -> f64 {
                        let own = tensions.iter().zip(&particular).enumerate();
                        own.map(|(i, (t, p))| basis[i * M + k] * (t - p)).sum()
                    };
                    for (i, (t, p)) in tensions.iter().zip(&particular).enumerate() {
                        let internal: f64 = (0..M).map(|k| basis[i * M + k] * part(k)).sum();
                        assert!((t - p - internal).abs() < 1e-9, "{tensions:?}");
                    }
                    if let Some(expected) = by_projections::<N, M>(&particular, &basis, &least) {
                        let far = |(a, b): (&f64, &f64)| (a - b).abs();
                        let far = tensions.iter().zip(&expected).map(far).fold(0.0, f64::max);
                        assert!(far < 1e-6, "{tensions:?} {expected:?}");
                    }
                }
                Err(error) => {
                    refused += 1;
                    assert_eq!(error, Error::Tensions);
                }
            }
        }
        (solved, refused)
    }

    #[test]
    fn tensions_are_closest_to_their_minima() {
        for (solved, refused) in [
            compare::<4, 1>(1),
            compare::<8, 2>(2),
            compare::<8, 5>(3),
            compare::<6, 3>(4),
        ] {
            assert!(solved > 3, "{solved} solved, {refused} refused");
        }
    }

    #[test]
    fn infeasible_torques_are_an_error() {
        // Both cables pull in the same direction, and the motion needs a push.
        let half = 0.5_f64.sqrt();
        let system = [-3.0, 0.0, half, -half];
        assert_eq!(
            distribute::<f64, 2, 1>(&system, &[1.0, 1.0]),
            Err(Error::Tensions)
        );
        assert_eq!(
            distribute::<f64, 1, 0>(&[0.5], &[1.0]),
            Err(Error::Tensions)
        );
        assert_eq!(distribute::<f64, 1, 0>(&[1.5], &[1.0]), Ok([1.5]));
    }

    #[test]
    fn actuators_other_than_cables_may_push() {
        let half = 0.5_f64.sqrt();
        let system = [0.0, -4.0, half, half];
        let least = [1.0, f64::NEG_INFINITY];
        let torques = distribute::<f64, 2, 1>(&system, &least).expect("torques");
        // The cable keeps its distance from 1 N, the other actuator that from 0: the middle.
        assert!((torques[0] - 2.5).abs() < 1e-12 && (torques[1] + 1.5).abs() < 1e-12);
    }

    #[test]
    fn invalid_numbers_are_an_error() {
        for system in [[f64::NAN, 0.0, 1.0, 0.0], [f64::MAX, -f64::MAX, 0.8, 0.6]] {
            assert!(distribute::<f64, 2, 1>(&system, &[1.0, 1.0]).is_err());
        }
        assert!(distribute::<f64, 2, 1>(&[], &[1.0, 1.0]).is_err());
    }
}
