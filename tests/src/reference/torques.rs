//! Actuator torques of a redundant robot: one motion, many torques.
//!
//! - Not redundant, n = r: the unique torque of (15), (16), that is (19).
//! - Least norm: the smallest |τ| with (J_p^inv)ᵀ τ = Γ¹.
//! - Least multipliers: (26) with c = 0 minimises |λ|, not |τ|; it satisfies the model too, but
//!   depends on how the closure equations are scaled.
//! - Internal loads: the null space N of (J_p^inv)ᵀ; the projection (50) is τ - N Nᵀ τ, the
//!   columns of N orthonormal.

use super::Error;
use super::dynamics::{Dynamics, column, solve};
use super::linear::{null_space, pseudo_inverse};
use nalgebra::{DMatrix, DVector};

impl Dynamics<'_> {
    /// Torques of a robot with as many actuators as coordinates (19).
    ///
    /// # Errors
    ///
    /// If the robot is redundant or the state singular.
    pub fn torques(&self, parameters: &DVector<f64>) -> Result<DVector<f64>, Error> {
        let matrix = self.multiplier_matrix();
        if !matrix.is_square() {
            return Err(Error::Singular("the system of a redundant robot"));
        }
        let multipliers = solve(&matrix, &column(&self.tree_and_platform(parameters)))?;
        Ok(self.torques_of(&multipliers))
    }

    /// Torques of least norm.
    ///
    /// # Errors
    ///
    /// If the state is singular.
    pub fn least_norm_torques(&self, parameters: &DVector<f64>) -> Result<DVector<f64>, Error> {
        let inputs = self.platform_inputs(parameters)?;
        Ok(pseudo_inverse(&self.jacobians.inverse.transpose()) * inputs)
    }

    /// Torques of (26) with zero overconstraint c: least multipliers.
    #[must_use]
    pub fn least_multiplier_torques(&self, parameters: &DVector<f64>) -> DVector<f64> {
        let loads = column(&self.tree_and_platform(parameters));
        self.torques_of(&(pseudo_inverse(&self.multiplier_matrix()) * loads))
    }

    /// Torques with tensions of cables instead of the forces on their lengths, or the reverse.
    #[must_use]
    pub fn with_tensions(&self, torques: &DVector<f64>) -> DVector<f64> {
        let least = self.mechanism.least_tensions();
        DVector::from_fn(torques.len(), |i, _| {
            if least[i].is_some() {
                -torques[i]
            } else {
                torques[i]
            }
        })
    }

    /// Tensions t ≥ t_min with least |t - t_min| by trying every set of cables at their minimum.
    ///
    /// Actuators that are no cables have any torque, compared with zero.
    ///
    /// # Errors
    ///
    /// If no tensions produce the motion.
    pub fn tensions(&self, parameters: &DVector<f64>) -> Result<DVector<f64>, Error> {
        let least = self.mechanism.least_tensions();
        let n = least.len();
        let reference = DVector::from_fn(n, |i, _| least[i].unwrap_or(0.0));
        let mut columns = self.jacobians.inverse.transpose();
        for (i, _) in least.iter().enumerate().filter(|(_, own)| own.is_some()) {
            columns.column_mut(i).neg_mut();
        }
        let rest = self.platform_inputs(parameters)? - &columns * &reference;
        let scale = 1.0 + rest.amax();
        let mut best: Option<DVector<f64>> = None;
        for set in 0_u32..1 << n {
            let free: Vec<usize> = (0..n).filter(|i| set >> i & 1 == 0).collect();
            if (0..n).any(|i| set >> i & 1 == 1 && least[i].is_none()) || free.is_empty() {
                continue;
            }
            let part = columns.select_columns(&free);
            let own = pseudo_inverse(&part) * &rest;
            let mut deviation = DVector::zeros(n);
            for (&i, value) in free.iter().zip(own.iter()) {
                deviation[i] = *value;
            }
            let is_exact = (&columns * &deviation - &rest).amax() < 1e-8 * scale;
            let is_taut = (0..n).all(|i| least[i].is_none() || deviation[i] > -1e-9 * scale);
            let is_better = best
                .as_ref()
                .is_none_or(|best| deviation.norm() < best.norm());
            if is_exact && is_taut && is_better {
                best = Some(deviation);
            }
        }
        let best = best.ok_or(Error::Singular("the distribution of tensions"))?;
        Ok(reference + best)
    }

    /// Orthonormal basis of the torques that don't move the robot, n x (n - r).
    #[must_use]
    pub fn internal_loads(&self) -> DMatrix<f64> {
        null_space(&self.jacobians.inverse.transpose())
    }

    /// Torques without internal loads (50).
    #[must_use]
    pub fn project_torques(&self, torques: &DVector<f64>) -> DVector<f64> {
        let basis = self.internal_loads();
        torques - &basis * (basis.transpose() * torques)
    }

    /// Inputs projected on the platform, Γ¹ = (J_p^inv)ᵀ τ.
    #[must_use]
    pub fn project_on_platform(&self, torques: &DVector<f64>) -> DVector<f64> {
        self.jacobians.inverse.transpose() * torques
    }

    /// τ = [0, -B_pᵀ] λ (15).
    fn torques_of(&self, multipliers: &DMatrix<f64>) -> DVector<f64> {
        let all: Vec<usize> = (0..self.jacobians.transmission.nrows()).collect();
        (self.torque_rows(&all) * multipliers)
            .column(0)
            .into_owned()
    }
}
