//! Leg Jacobians (9), inverse Jacobian (20) and reduced closure (11), numerically.
//!
//! A column of a leg's Jacobian is the velocity of its end when one variable moves at unit rate;
//! a column of the platform's is the velocity of the attachment for a unit twist coordinate.
//! Velocities are linear in the rates, so both are exact. Rows are the linear velocity of the end
//! frame's origin, then, for a rigid end, the angular velocity, in the base frame.
//!
//! For J_k and J_tk a leg keeps its rows that don't vanish identically; if these are more than its
//! variables, the first independent ones. The rates come from all rows, by least squares, and
//! their residual is checked: this is how a leg that can't follow the platform is found.
//!
//! The reduced closure of an actuated joint is its row of adj(J_k) times J_tk v = J_k q̇. The row is
//! reciprocal to all other columns of the leg and leaves a_p v + b_p q̇ = 0 with b_p = -det J_k.
//! For the DualV this gives the corrected (59) and (60).

use super::Error;
use super::cables;
use super::closure::chains;
use super::closure::parasitic_motion;
use super::kinematics::{
    end_components, end_equations, end_from_leg, end_from_platform, leg_motion, platform_motion,
};
use super::linear::{adjugate, condition, determinant, independent_rows, pseudo_inverse};
use super::mechanism::{End, Leg, Mechanism};
use super::motion::Motion;
use super::motors::transmission;
use nalgebra::{DMatrix, DVector};

/// Largest relative residual that counts as rounding.
const CONSISTENCY: f64 = 1e-9;

/// All first-order kinematics of a pose.
#[derive(Clone, Debug, PartialEq)]
pub struct Jacobians {
    /// Leg Jacobian with every row of every end, block diagonal.
    pub ends: DMatrix<f64>,
    /// The matching rows of the platform.
    pub attachments: DMatrix<f64>,
    /// J_k: independent rows of the legs, n_t x n_t, block diagonal (63).
    pub legs: DMatrix<f64>,
    /// J_tk: the matching rows of the platform, n_t x r (61), (62).
    pub platform: DMatrix<f64>,
    /// J_k^-1 J_tk, n_t x r: joint rates from the twist coordinates (9).
    pub joints: DMatrix<f64>,
    /// J_p^inv, n x r: actuator rates from the twist coordinates (20).
    pub inverse: DMatrix<f64>,
    /// A_p, n x r (11).
    pub a_p: DMatrix<f64>,
    /// B_p, n x n, diagonal (11).
    pub b_p: DMatrix<f64>,
    /// Positions of the actuated joints among the variables.
    pub actuated: Vec<usize>,
    /// T, n x n_t: actuator rates from joint rates.
    pub transmission: DMatrix<f64>,
}

impl Jacobians {
    /// Jacobians at a pose and at joint positions that close the loops.
    ///
    /// # Errors
    ///
    /// If a leg's Jacobian isn't square or the leg can't follow the platform.
    pub fn at(mechanism: &Mechanism, pose: &[f64], q: &DVector<f64>) -> Result<Self, Error> {
        let actuated = mechanism.actuated();
        let transmission = transmission(mechanism);
        let n = transmission.nrows();
        if mechanism.motion == Motion::None {
            return Ok(Self::of_tree(mechanism.joints(), actuated, transmission));
        }
        if !mechanism.motion.has_platform() {
            return chains::jacobians(mechanism, q);
        }
        if matches!(mechanism.motion, Motion::Parasitic(_)) {
            return parasitic_motion::jacobians(mechanism, pose, q);
        }
        let (total, dof) = (mechanism.joints(), mechanism.dof());
        let equations: usize = mechanism.legs.iter().map(end_equations).sum();
        let mut all = Self {
            ends: DMatrix::zeros(equations, total),
            attachments: DMatrix::zeros(equations, dof),
            legs: DMatrix::zeros(total, total),
            platform: DMatrix::zeros(total, dof),
            joints: DMatrix::zeros(total, dof),
            inverse: DMatrix::zeros(n, dof),
            a_p: DMatrix::zeros(n, dof),
            b_p: DMatrix::zeros(n, n),
            actuated,
            transmission,
        };
        let mut first = 0;
        for (k, (leg, range)) in mechanism
            .legs
            .iter()
            .zip(mechanism.leg_ranges())
            .enumerate()
        {
            let is_cable = matches!(leg.end, End::Cable { .. });
            let (end, attachment) = if is_cable {
                (DMatrix::identity(1, 1), cables::row(mechanism, leg, pose))
            } else {
                let end = end_jacobian(leg, &q.as_slice()[range.clone()]);
                (end, attachment_jacobian(mechanism, leg, pose))
            };
            let joints = follow(k, &end, &attachment)?;
            let rows = if is_cable { vec![0] } else { end_rows(k, leg)? };
            let square = end.select_rows(&rows);
            all.ends
                .view_mut((first, range.start), end.shape())
                .copy_from(&end);
            all.attachments
                .rows_mut(first, end.nrows())
                .copy_from(&attachment);
            all.legs
                .view_mut((range.start, range.start), square.shape())
                .copy_from(&square);
            let kept = attachment.select_rows(&rows);
            all.platform
                .rows_mut(range.start, rows.len())
                .copy_from(&kept);
            all.joints
                .rows_mut(range.start, rows.len())
                .copy_from(&joints);
            all.reduce(range.start, &square, &kept);
            first += end.nrows();
        }
        all.inverse = &all.transmission * &all.joints;
        all.reduce_motors();
        Ok(all)
    }

    /// Without a platform the twist coordinates are the joint rates themselves.
    fn of_tree(joints: usize, actuated: Vec<usize>, transmission: DMatrix<f64>) -> Self {
        let identity = DMatrix::identity(joints, joints);
        Self {
            ends: identity.clone(),
            attachments: identity.clone(),
            legs: identity.clone(),
            platform: identity.clone(),
            joints: identity.clone(),
            inverse: identity.clone(),
            a_p: identity.clone(),
            b_p: -identity,
            actuated,
            transmission,
        }
    }

    /// Writes the reduced closure of the actuated joints of the leg whose variables begin at
    /// `start`.
    pub(super) fn reduce(&mut self, start: usize, leg: &DMatrix<f64>, platform: &DMatrix<f64>) {
        let (cofactors, determinant) = (adjugate(leg), determinant(leg));
        for (row, &at) in self.actuated.iter().enumerate() {
            if (start..start + leg.ncols()).contains(&at) {
                self.a_p
                    .set_row(row, &(cofactors.row(at - start) * platform));
                self.b_p[(row, row)] = -determinant;
            }
        }
    }

    /// Writes the closure of the motors, θ̇ = T q̇: their rows of J_p^inv, and -1.
    pub(super) fn reduce_motors(&mut self) {
        for row in self.actuated.len()..self.transmission.nrows() {
            let own = self.inverse.row(row).into_owned();
            self.a_p.set_row(row, &own);
            self.b_p[(row, row)] = -1.0;
        }
    }

    /// Largest condition number of the legs' Jacobians.
    #[must_use]
    pub fn worst_leg_condition(&self, mechanism: &Mechanism) -> f64 {
        let block = |range: std::ops::Range<usize>| {
            self.legs
                .view((range.start, range.start), (range.len(), range.len()))
                .into_owned()
        };
        mechanism
            .leg_ranges()
            .into_iter()
            .map(|range| condition(&block(range)))
            .fold(1.0, f64::max)
    }
}

/// Velocity of a leg's end for unit rates of its variables, all rows.
#[must_use]
pub fn end_jacobian(leg: &Leg, q: &[f64]) -> DMatrix<f64> {
    let zero = vec![0.0; q.len()];
    let mut jacobian = DMatrix::zeros(end_equations(leg), q.len());
    for at in 0..q.len() {
        let mut rates = zero.clone();
        rates[at] = 1.0;
        let twist = end_from_leg(leg, &leg_motion(leg, q, &rates, &zero)).twist();
        for (row, &component) in end_components(leg).iter().enumerate() {
            jacobian[(row, at)] = twist[component];
        }
    }
    jacobian
}

/// Velocity of a leg's attachment for unit twist coordinates, all rows.
#[must_use]
pub fn attachment_jacobian(mechanism: &Mechanism, leg: &Leg, pose: &[f64]) -> DMatrix<f64> {
    let dof = mechanism.dof();
    let mut jacobian = DMatrix::zeros(end_equations(leg), dof);
    for at in 0..dof {
        let mut unit = DVector::zeros(dof);
        unit[at] = 1.0;
        let platform = platform_motion(&mechanism.motion, pose, &unit, &DVector::zeros(dof));
        let twist = end_from_platform(leg, &platform).twist();
        for (row, &component) in end_components(leg).iter().enumerate() {
            jacobian[(row, at)] = twist[component];
        }
    }
    jacobian
}

/// Rates of a leg's variables for each column of end velocities, by least squares.
///
/// # Errors
///
/// If no rates give these velocities.
pub fn follow(
    leg: usize,
    end: &DMatrix<f64>,
    velocities: &DMatrix<f64>,
) -> Result<DMatrix<f64>, Error> {
    if end.is_empty() {
        return Ok(DMatrix::zeros(end.ncols(), velocities.ncols()));
    }
    let rates = pseudo_inverse(end) * velocities;
    let residual = (end * &rates - velocities).amax() / (1.0 + velocities.amax() + rates.amax());
    if residual < CONSISTENCY {
        Ok(rates)
    } else {
        Err(Error::Inconsistent { leg, residual })
    }
}

/// Independent rows of a leg's end, the same for all poses.
///
/// They are determined at positions away from the start, where rows do not vanish by coincidence.
///
/// # Errors
///
/// If there are not as many independent rows as variables of the leg.
pub fn end_rows(k: usize, leg: &Leg) -> Result<Vec<usize>, Error> {
    let variables = leg.start.len();
    let away = |step: usize| -> Vec<f64> {
        // Multiples of the golden ratio fill the interval evenly and never repeat.
        let shift = |at: usize| 0.4 * (((step * variables + at + 1) as f64 * 0.618_034) % 1.0);
        leg.start
            .iter()
            .enumerate()
            .map(|(at, q)| q + shift(at))
            .collect()
    };
    let samples: Vec<DMatrix<f64>> = (0..3).map(|step| end_jacobian(leg, &away(step))).collect();
    let scale = samples
        .iter()
        .map(|sample| sample.amax())
        .fold(0.0, f64::max);
    let alive = |row: &usize| samples.iter().any(|s| s.row(*row).amax() > 1e-9 * scale);
    let mut rows: Vec<usize> = (0..end_equations(leg)).filter(alive).collect();
    if rows.len() > variables {
        let independent = independent_rows(&samples[0].select_rows(&rows), 1e-6 * scale);
        rows = independent.into_iter().map(|at| rows[at]).collect();
    }
    if rows.len() == variables {
        Ok(rows)
    } else {
        Err(Error::NotSquare {
            leg: k,
            equations: rows.len(),
            variables,
        })
    }
}

/// Chooses as many equations of a leg as it has joints, in order.
///
/// Each step takes the row that is longest after removing its components along the chosen rows; the
/// first on ties. The choice is a convention.
#[must_use]
pub fn longest_rows(matrix: &DMatrix<f64>) -> Vec<usize> {
    let mut left = matrix.clone();
    let mut chosen: Vec<usize> = Vec::new();
    for _ in 0..matrix.ncols() {
        let lengths: Vec<f64> = left.row_iter().map(|row| row.norm()).collect();
        let longest = lengths.iter().copied().fold(0.0, f64::max);
        let found = lengths.iter().position(|l| *l > longest * (1.0 - 1e-8));
        let Some(row) = found.filter(|row| !chosen.contains(row)) else {
            break;
        };
        let direction = left.row(row).normalize();
        left = &left - (&left * direction.transpose()) * direction;
        chosen.push(row);
    }
    chosen.sort_unstable();
    chosen
}
