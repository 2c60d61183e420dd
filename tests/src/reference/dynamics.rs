//! Dynamics of the closed robot: constrained system, platform projection and actuator projection.
//!
//! *Lagrange multipliers.* Each leg end exerts a wrench w, in the rows of the ends, on the
//! platform. The torques of motors act on the joints by E = Tᵀ, which selects
//! actuated joints and has the factors of motors that drive several:
//!
//! - legs: E τ - J_endsᵀ w = τ_t, platform: J_attachmentsᵀ w = τ_pr.
//!
//! This is (15) and (16) with physical wrenches as multipliers, without an inverse of J_k, A_p and
//! B_p. For a redundant robot the system has more unknowns than equations. Any solution suffices,
//! because Γ¹ = (J_p^inv)ᵀ τ is the same for all of them.
//!
//! *Platform projection (case 1)*, in closed form for comparison: Γ¹ = J_tkᵀ J_k^-T τ_t + Dᵀ τ_p
//! (30).
//!
//! *Actuator projection (case 2).* The stacked system (31)-(36) in its corrected form, with kept
//! and projected actuators. Rows of -B_pᵀ of the projected ones on top of (16) give λ; then τ_kept
//! = -(B_pᵀ)_kept λ₂.

use super::Error;
use super::closure::State;
use super::elements::all_loads;
use super::jacobians::Jacobians;
use super::linear::{condition, pseudo_inverse};
use super::mechanism::Mechanism;
use super::motion::Motion;
use super::motors;
use super::newton_euler::{projected_platform_wrench, regressor, tree_torques};
use nalgebra::{DMatrix, DVector};
use std::cell::OnceCell;

/// Largest relative residual that counts as rounding.
const CONSISTENCY: f64 = 1e-8;
/// Condition number above which a square system counts as singular.
const SINGULAR: f64 = 1e12;

/// Dynamics of a mechanism in a state.
#[derive(Clone, Debug)]
pub struct Dynamics<'a> {
    /// The robot.
    pub mechanism: &'a Mechanism,
    /// Its motion.
    pub state: &'a State,
    /// Its Jacobians in this state.
    pub jacobians: Jacobians,
    /// End-wrench system with its pseudo-inverse, computed on demand.
    system: OnceCell<[DMatrix<f64>; 2]>,
}

/// Actuator projection: matrices of the parameters and of the projected torques (36).
#[derive(Clone, Debug, PartialEq)]
pub struct Partition {
    /// Regressor of the actuator projection, r x n_st.
    pub regressor: DMatrix<f64>,
    /// J_2ᵀ, r x (n - r): τ_kept = Γ² + J_2ᵀ τ_projected.
    pub projection: DMatrix<f64>,
    /// Condition number of the stacked matrix of (33).
    pub condition: f64,
    /// The actuators that are not kept, in order.
    pub projected: Vec<usize>,
}

impl<'a> Dynamics<'a> {
    /// Dynamics in a state.
    ///
    /// # Errors
    ///
    /// If the Jacobians can't be computed.
    pub fn new(mechanism: &'a Mechanism, state: &'a State) -> Result<Self, Error> {
        Ok(Self {
            mechanism,
            state,
            jacobians: state.jacobians(mechanism)?,
            system: OnceCell::new(),
        })
    }

    /// Right-hand side [τ_t; τ_pr] of (16) for given parameters.
    #[must_use]
    pub fn tree_and_platform(&self, parameters: &DVector<f64>) -> DVector<f64> {
        let tree = tree_torques(self.mechanism, self.state, parameters);
        let platform = projected_platform_wrench(self.mechanism, self.state, parameters);
        let own = DVector::from_iterator(
            tree.len() + platform.len(),
            tree.iter().chain(platform.iter()).copied(),
        );
        let elements = all_loads(self.mechanism, self.state, parameters, own.len());
        let motors = motors::all_loads(self.mechanism, self.state, parameters, elements.len());
        own + elements + motors
    }

    /// The same for every unit parameter: IDM of the tree above DᵀIDM of the platform.
    #[must_use]
    pub fn tree_and_platform_regressor(&self) -> DMatrix<f64> {
        regressor(self.mechanism, self.state)
    }

    /// Γ¹ through Lagrange multipliers, for given parameters (15), (16).
    ///
    /// # Errors
    ///
    /// If no multipliers satisfy the equations: a parallel singularity.
    pub fn platform_inputs(&self, parameters: &DVector<f64>) -> Result<DVector<f64>, Error> {
        let torques = self.any_torques(&column(&self.tree_and_platform(parameters)))?;
        Ok((self.jacobians.inverse.transpose() * torques)
            .column(0)
            .into_owned())
    }

    /// Regressor of the platform projection, r x n_st, through Lagrange multipliers.
    ///
    /// # Errors
    ///
    /// If no multipliers satisfy the equations: a parallel singularity.
    pub fn idm_red_platform(&self) -> Result<DMatrix<f64>, Error> {
        let torques = self.any_torques(&self.tree_and_platform_regressor())?;
        Ok(self.jacobians.inverse.transpose() * torques)
    }

    /// Regressor of the platform projection by the closed form (30), for comparison.
    ///
    /// # Errors
    ///
    /// If a leg is singular.
    pub fn idm_red_platform_closed_form(&self) -> Result<DMatrix<f64>, Error> {
        let columns = self.tree_and_platform_regressor();
        let joints = self.mechanism.joints();
        let multipliers = solve(
            &self.jacobians.legs.transpose(),
            &columns.rows(0, joints).into_owned(),
        )?;
        Ok(self.jacobians.platform.transpose() * multipliers
            + columns.rows(joints, self.mechanism.dof()))
    }

    /// Some actuator torques for right-hand sides of (16), by the pseudo-inverse of the equations
    /// with end wrenches and torques as unknowns.
    fn any_torques(&self, loads: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
        let [system, inverse] = self.system.get_or_init(|| {
            let system = self.wrenches_and_torques();
            let inverse = pseudo_inverse(&system);
            [system, inverse]
        });
        let solution = inverse * loads;
        let residual = (system * &solution - loads).amax() / (1.0 + loads.amax());
        if residual > CONSISTENCY {
            return Err(Error::Singular("the constrained system"));
        }
        let wrenches = self.jacobians.ends.nrows();
        Ok(solution.rows_range(wrenches..).into_owned())
    }

    /// Matrix of (15), (16) with end wrenches and torques as unknowns.
    fn wrenches_and_torques(&self) -> DMatrix<f64> {
        let jacobians = &self.jacobians;
        let (wrenches, joints) = jacobians.ends.shape();
        // With parasitic motion: all six components of the platform's wrench.
        let (dof, actuators) = (
            jacobians.attachments.ncols(),
            jacobians.transmission.nrows(),
        );
        let mut system = DMatrix::zeros(joints + dof, wrenches + actuators);
        system
            .view_mut((0, 0), (joints, wrenches))
            .copy_from(&-jacobians.ends.transpose());
        system
            .view_mut((joints, 0), (dof, wrenches))
            .copy_from(&jacobians.attachments.transpose());
        system
            .view_mut((0, wrenches), (joints, actuators))
            .copy_from(&jacobians.transmission.transpose());
        system
    }

    /// Aᵀ of (16): multipliers λ₁ of the legs, λ₂ of the reduced closure.
    #[must_use]
    pub fn multiplier_matrix(&self) -> DMatrix<f64> {
        let jacobians = &self.jacobians;
        let (joints, dof) = jacobians.platform.shape();
        let actuators = jacobians.transmission.nrows();
        let mut matrix = DMatrix::zeros(joints + dof, joints + actuators);
        matrix
            .view_mut((0, 0), (joints, joints))
            .copy_from(&jacobians.legs.transpose());
        matrix
            .view_mut((joints, 0), (dof, joints))
            .copy_from(&-jacobians.platform.transpose());
        matrix
            .view_mut((joints, joints), (dof, actuators))
            .copy_from(&jacobians.a_p.transpose());
        matrix
    }

    /// Rows of [0, -B_pᵀ] (15) for the given actuators.
    #[must_use]
    pub fn torque_rows(&self, actuators: &[usize]) -> DMatrix<f64> {
        let joints = self.mechanism.joints();
        let rows = -self.jacobians.b_p.transpose().select_rows(actuators);
        let mut wide = DMatrix::zeros(rows.nrows(), joints + rows.ncols());
        wide.columns_mut(joints, rows.ncols()).copy_from(&rows);
        wide
    }

    /// Actuator projection for the kept actuators, counted from 0 (33)-(36).
    ///
    /// # Errors
    ///
    /// If the partition is singular in this state.
    pub fn idm_red_actuators(&self, kept: &[usize]) -> Result<Partition, Error> {
        self.partition(kept, &self.tree_and_platform_regressor())
    }

    /// The same for given right-hand sides of (16) in place of all parameters' ones.
    ///
    /// # Errors
    ///
    /// If the partition is singular in this state.
    pub fn partition(&self, kept: &[usize], loads: &DMatrix<f64>) -> Result<Partition, Error> {
        let actuators = self.jacobians.transmission.nrows();
        let projected: Vec<usize> = (0..actuators).filter(|at| !kept.contains(at)).collect();
        let is_parasitic = matches!(self.mechanism.motion, Motion::Parasitic(_));
        if is_parasitic || self.mechanism.has_dependent_joints() {
            return self.partition_with_parasitic_motion(kept, projected, loads);
        }
        let matrix = self.partition_matrix(&projected);
        let condition = condition(&matrix);
        if condition > SINGULAR {
            return Err(Error::Singular("the partition"));
        }
        let (extra, size) = (projected.len(), matrix.nrows());
        let mut sides = DMatrix::zeros(size, extra + loads.ncols());
        sides.view_mut((0, 0), (extra, extra)).fill_with_identity();
        sides
            .view_mut((extra, extra), loads.shape())
            .copy_from(loads);
        let multipliers = matrix.lu().solve(&sides);
        let multipliers = multipliers.ok_or(Error::Singular("the partition"))?;
        let outputs = self.torque_rows(kept) * multipliers;
        Ok(Partition {
            projection: outputs.columns(0, extra).into_owned(),
            regressor: outputs.columns(extra, loads.ncols()).into_owned(),
            condition,
            projected,
        })
    }

    /// Actuator projection with parasitic motion, from any torques of the constrained system.
    ///
    /// These and the torques of the kept actuators alone do the same work.
    fn partition_with_parasitic_motion(
        &self,
        kept: &[usize],
        projected: Vec<usize>,
        loads: &DMatrix<f64>,
    ) -> Result<Partition, Error> {
        let inverse = &self.jacobians.inverse;
        let own = inverse.select_rows(kept).transpose();
        let condition = condition(&own);
        let work = inverse.transpose() * self.any_torques(loads)?;
        let others = inverse.select_rows(&projected).transpose();
        Ok(Partition {
            regressor: solve(&own, &work)?,
            projection: -solve(&own, &others)?,
            condition,
            projected,
        })
    }

    /// Matrix of (33): torque rows of the projected actuators above Aᵀ of (16).
    #[must_use]
    pub fn partition_matrix(&self, projected: &[usize]) -> DMatrix<f64> {
        let (above, below) = (self.torque_rows(projected), self.multiplier_matrix());
        let mut matrix = DMatrix::zeros(above.nrows() + below.nrows(), below.ncols());
        matrix.rows_mut(0, above.nrows()).copy_from(&above);
        matrix
            .rows_mut(above.nrows(), below.nrows())
            .copy_from(&below);
        matrix
    }

    /// Mass matrix and bias in twist coordinates: Γ¹ = M v̇ + h, friction within h.
    ///
    /// # Errors
    ///
    /// If the state is singular.
    pub fn mass_matrix_and_bias(
        &self,
        parameters: &DVector<f64>,
    ) -> Result<(DMatrix<f64>, DVector<f64>), Error> {
        let dof = self.mechanism.dof();
        // The configuration is that of this state, so the system and its inverse are the same.
        let inputs = |acceleration: &DVector<f64>| {
            let state = State::with_joints(
                self.mechanism,
                &self.state.pose,
                &self.state.q,
                &self.state.twist,
                acceleration,
            )?;
            let moved = Dynamics {
                state: &state,
                ..self.clone()
            };
            moved.platform_inputs(parameters)
        };
        let bias = inputs(&DVector::zeros(dof))?;
        let mut mass = DMatrix::zeros(dof, dof);
        for at in 0..dof {
            let mut unit = DVector::zeros(dof);
            unit[at] = 1.0;
            mass.set_column(at, &(inputs(&unit)? - &bias));
        }
        Ok((mass, bias))
    }
}

/// Solution of a regular square system.
pub(super) fn solve(matrix: &DMatrix<f64>, sides: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
    if condition(matrix) > SINGULAR {
        return Err(Error::Singular("a square system"));
    }
    matrix
        .clone()
        .lu()
        .solve(sides)
        .ok_or(Error::Singular("a square system"))
}

/// A vector as a matrix of one column.
pub(super) fn column(vector: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_column_slice(vector.len(), 1, vector.as_slice())
}
