//! The identification model: one column per standard parameter, eqs. (30) and (36).
//!
//! A column of the platform projection is Σ_i (∂u_i/∂v)ᵀ s_i, where s_i is the generalised force of
//! the parameter on u_i. For a body parameter, s_i is its unit wrench projected on the partial
//! velocities. For a joint parameter the column is a scalar times the reduced Jacobian of that
//! joint. The actuator projection uses the rows ∂u_i/∂v J_a⁻¹, with J_a the kept rows of J_p^inv:
//! rows are transformed once, never columns.

mod forces;

use crate::cas::{Arena, Expr, Number, Vector3};
use crate::derivation::bodies::motion::RobotMotion;
use crate::derivation::bodies::payload::on_body;
use crate::derivation::bodies::platform_body::PlatformBody;
use crate::derivation::derivation_error::DerivationError;
use crate::derivation::linear_algebra::elimination::{Rows, inverse};
use crate::derivation::linear_algebra::linear::{add_to, dot, product, transposed};
use crate::derivation::parameter::BodyParameter;
use crate::derivation::robot::Robot;
use crate::derivation::selection::Combination;
use crate::mechanism::JointIndex;
use overact_description::StandardParameter;

/// Coordinates on which generalised forces are projected.
#[derive(Debug)]
pub struct Projection<'a> {
    /// ∂u/∂(projected coordinates) of every leg.
    legs: Vec<Rows<'a>>,
    /// Whether the projected coordinates are the platform's.
    on_platform: bool,
    /// ∂v/∂(projected coordinates).
    platform: Rows<'a>,
    /// The determinants of the divisors.
    pub determinants: Vec<Expr<'a>>,
}

impl<'a> Projection<'a> {
    /// ∂v/∂(projected coordinates): the identity in the platform projection, J_a⁻¹ in the actuator
    /// projection.
    #[must_use]
    pub const fn platform_rows(&self) -> &Rows<'a> {
        &self.platform
    }
}

impl<'a> Robot<'a> {
    /// Platform projection: on the platform's twist coordinates.
    #[must_use]
    pub fn project_on_platform(&self) -> Projection<'a> {
        let r = self.mechanism.dof();
        let entry = |i: usize, j: usize| self.arena.integer(i64::from(i == j));
        let identity = (0..r)
            .map(|i| (0..r).map(|j| entry(i, j)).collect())
            .collect();
        let legs = self.legs.iter().map(|l| l.rows.clone()).collect();
        Projection {
            legs,
            on_platform: true,
            platform: identity,
            determinants: Vec::new(),
        }
    }

    /// Actuator projection: on the kept actuators.
    ///
    /// # Errors
    /// Kept actuators that never determine the platform's motion.
    pub(crate) fn project_on_actuators(
        &self,
        kept: &[usize],
    ) -> Result<Projection<'a>, DerivationError> {
        let all = self.inverse_jacobian();
        let kept_rows: Rows<'a> = kept.iter().map(|&i| all[i].clone()).collect();
        let home = |e: Expr<'a>| self.at_home(e);
        let inverted = inverse(&kept_rows, &home).ok_or(DerivationError::SingularPartition)?;
        let legs: Vec<Rows<'a>> = self
            .legs
            .iter()
            .map(|l| product(&l.rows, &inverted.rows))
            .collect();
        self.name_partition(&inverted, &legs, kept);
        Ok(Projection {
            legs,
            on_platform: false,
            platform: inverted.rows,
            determinants: inverted.determinants,
        })
    }

    /// Column of a parameter, r numbers.
    #[must_use]
    pub fn column(
        &self,
        motion: &RobotMotion<'a>,
        projection: &Projection<'a>,
        parameter: BodyParameter,
    ) -> Vec<Expr<'a>> {
        match parameter {
            BodyParameter::Leg { leg, joint, symbol } if symbol.is_inertial() => {
                self.arena.enter(&self.mechanism.legs[leg].name);
                if let Some(body) = &motion.platform_bodies[leg][joint] {
                    return self.project_platform_body(projection, body, symbol);
                }
                let is_at_end = joint + 1 == self.mechanism.legs[leg].joints.len();
                if let Some(acceleration) = motion.ends[leg].filter(|_| is_at_end)
                    && symbol == StandardParameter::M
                {
                    return self.project_end(projection, leg, acceleration);
                }
                let body = &motion.bodies[leg][joint];
                let forces = body.project(body.unit_wrench(self.arena, symbol));
                self.project_leg(projection, leg, &forces)
            }
            BodyParameter::Leg { leg, joint, symbol } => {
                self.arena.enter(&self.mechanism.legs[leg].name);
                let form = &self.legs[leg].rates.joint[joint];
                let row = form.row(self.arena, &projection.legs[leg]);
                let force = self.joint_force(motion, JointIndex { leg, joint }, symbol);
                row.iter().map(|&g| g * force).collect()
            }
            BodyParameter::Spring(index) => {
                let forces = self.point_spring_column(motion, index);
                if projection.on_platform {
                    forces
                } else {
                    self.combine(&projection.platform, &forces)
                }
            }
            BodyParameter::Load { payload, symbol } => {
                let payload = &self.mechanism.payloads[payload];
                let mut sum = vec![self.arena.zero(); self.mechanism.dof()];
                for (of_body, factor) in on_body(self.arena, payload, symbol) {
                    let column = self.column(motion, projection, of_body).into_iter();
                    add_to(&mut sum, column.map(|entry| entry * factor).collect());
                }
                sum
            }
            BodyParameter::Motor { motor, symbol } => {
                let force = self.motor_force(motion, motor, symbol);
                let row = self.motor_row(motor, &projection.legs);
                row.iter().map(|&g| g * force).collect()
            }
            BodyParameter::Platform(symbol) | BodyParameter::Payload(symbol) => {
                self.arena.enter("platform");
                let body = motion.platform.as_ref();
                body.map_or_else(Vec::new, |b| {
                    self.project_platform_body(projection, b, symbol)
                })
            }
        }
    }

    /// Column of a mass at a leg's end, from its acceleration minus gravity.
    fn project_end(
        &self,
        projection: &Projection<'a>,
        leg: usize,
        acceleration: Vector3<'a>,
    ) -> Vec<Expr<'a>> {
        let Some(closure) = &self.legs[leg].closure else {
            return Vec::new();
        };
        let partials = self
            .parasitic_motion
            .as_ref()
            .map(|parasitic| parasitic.partials(self.arena));
        let velocities = closure.end_velocities(self.arena, partials.as_deref());
        let forces: Vec<Expr<'a>> = velocities.iter().map(|v| acceleration.dot(*v)).collect();
        if projection.on_platform {
            forces
        } else {
            self.combine(&projection.platform, &forces)
        }
    }

    /// Column of a body that moves with the platform.
    fn project_platform_body(
        &self,
        projection: &Projection<'a>,
        body: &PlatformBody<'a>,
        symbol: StandardParameter,
    ) -> Vec<Expr<'a>> {
        if let Some(parasitic) = self.parasitic_motion.as_ref().filter(|_| self.own_axes) {
            let forces = body.on_partials(self.arena, symbol, &parasitic.partials(self.arena));
            return if projection.on_platform {
                forces
            } else {
                self.combine(&projection.platform, &forces)
            };
        }
        let forces = body.project(&self.free, body.unit_wrench(self.arena, symbol));
        let forces = self.on_independent(forces);
        if projection.on_platform {
            return forces;
        }
        self.combine(&projection.platform, &forces)
    }

    /// A column as a combination of other columns; `None` if one of them is missing.
    ///
    /// The platform's and each leg's parts are summed separately, so that legs that meet in a
    /// platform point share them.
    #[must_use]
    pub(crate) fn combined(
        &self,
        combination: &Combination,
        column_of: &dyn Fn(BodyParameter) -> Option<Vec<Expr<'a>>>,
    ) -> Option<Vec<Expr<'a>>> {
        let in_leg = |p: BodyParameter| matches!(p, BodyParameter::Leg { .. });
        let mut parts = Vec::new();
        for wanted in [false, true] {
            let terms: Option<Vec<(Vec<Expr<'a>>, Number)>> = combination
                .of
                .iter()
                .filter(|(p, _)| in_leg(*p) == wanted)
                .map(|(p, c)| Some((column_of(*p)?, *c)))
                .collect();
            parts.push(terms?);
        }
        let entry = |row: usize| {
            let sum = |terms: &Vec<(Vec<Expr<'a>>, Number)>| {
                normalised_sum(
                    self.arena,
                    terms.iter().map(|(column, c)| (column[row], *c)),
                )
            };
            sum(&parts[0]) + sum(&parts[1])
        };
        Some((0..self.mechanism.dof()).map(entry).collect())
    }

    /// Force of a joint's own parameter on the joint, eq. (5).
    pub(crate) fn joint_force(
        &self,
        motion: &RobotMotion<'a>,
        at: JointIndex,
        symbol: StandardParameter,
    ) -> Expr<'a> {
        let JointIndex { leg, joint } = at;
        let form = &self.legs[leg].rates.joint[joint];
        let rate = || form.value(self.arena, &motion.u[leg]);
        if let Some(friction) = self.friction_force(at, symbol, rate) {
            return friction;
        }
        match symbol {
            StandardParameter::Ia => form.value(self.arena, &motion.u_dot[leg]),
            StandardParameter::K => self.spring_force(at),
            StandardParameter::Off => self.arena.one(),
            // The ten inertial parameters act through the body's wrench.
            symbol => {
                debug_assert!(symbol.is_inertial(), "a joint's parameter without a force");
                self.arena.zero()
            }
        }
    }

    /// Σ s_i ∂u_i/∂v for a leg's generalised forces s.
    ///
    /// On the platform the same forces are F = Σ s_i f_i at the leg's end, with the moment p × F
    /// about the platform's origin. For several nonzero s_i this takes fewer products.
    fn project_leg(
        &self,
        projection: &Projection<'a>,
        leg: usize,
        forces: &[Expr<'a>],
    ) -> Vec<Expr<'a>> {
        let rows = &projection.legs[leg];
        let at_end = self.legs[leg].closure.as_ref();
        let at_end = at_end.filter(|_| self.platform.is_some() && self.parasitic_motion.is_none());
        match at_end.filter(|c| projection.on_platform && c.is_shorter_at_end(rows, forces)) {
            Some(closure) => closure.project_at_end(forces),
            None => self.combine(rows, forces),
        }
    }

    pub(crate) fn combine(&self, rows: &Rows<'a>, forces: &[Expr<'a>]) -> Vec<Expr<'a>> {
        let width = rows.first().map_or(0, Vec::len);
        let entry = |c: usize| {
            let terms = rows.iter().zip(forces).map(|(row, s)| row[c] * *s);
            terms.fold(self.arena.zero(), |sum, term| sum + term)
        };
        (0..width).map(entry).collect()
    }

    /// Γ¹ = (J_p^inv)ᵀ τ, eq. (30), with -τ for the tension τ of a cable.
    #[must_use]
    pub fn projected_torques(&self, torques: &[Expr<'a>]) -> Vec<Expr<'a>> {
        let forces = self.with_tensions(torques.to_vec());
        transposed(&self.inverse_jacobian())
            .iter()
            .map(|row| dot(row, &forces))
            .collect()
    }
}

/// Σ c_i x_i as c_0 (x_0 + Σ (c_i / c_0) x_i).
///
/// The inner sum often has a meaning of its own, such as the acceleration of a platform point.
fn normalised_sum<'a>(
    arena: &'a Arena,
    terms: impl Iterator<Item = (Expr<'a>, Number)>,
) -> Expr<'a> {
    let mut terms = terms.filter(|(x, c)| !x.is_zero() && !c.is_zero());
    let Some((first, scale)) = terms.next() else {
        return arena.zero();
    };
    terms.fold(first, |sum, (x, c)| sum + x * (c / scale)) * scale
}
