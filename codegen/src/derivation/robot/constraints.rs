//! Constraints of the legs on a platform with parasitic motion or on a skeleton, and the resulting
//! motion.
//!
//! The platform is derived as a free body, and every leg is closed on it as on any other platform.
//! A leg with more shared components than joints has remaining rows. Each is a wrench (a, n) at its
//! end that does no work on the joints, a · Ṗ + n · ω = 0: a row of A t = 0. Its derivative does
//! not require that of A. With the bias accelerations b, β of the leg's end at u̇ = 0 it is
//! a · (P̈ - b) + n · (ω̇ - β) = 0, which gives the dependent components of ṫ.
//!
//! A skeleton with dependent joints is derived in the same way, with the rates of its joints as t.

use super::Robot;
use crate::cas::{Expr, Number, Ratio, Vector3};
use crate::derivation::closure::bias::end_bias;
use crate::derivation::closure::parasitic_motion::{
    BlockedRow, ParasiticMotion, SIX, dependent_components,
};
use crate::derivation::derivation_error::DerivationError;
use crate::derivation::guard::{Guard, GuardKind};
use crate::derivation::kinematics::frames::LegFrames;
use crate::derivation::kinematics::platform::PlatformPose;
use crate::derivation::kinematics::spatial::SpatialMotion;
use crate::derivation::linear_algebra::linear::apply;
use crate::derivation::names::{Accelerations, coordinate_label};
use crate::mechanism::numeric::best_conditioned;
use crate::mechanism::{End, Leg, Motion, TwistCoordinate};
use nalgebra::DMatrix;

impl<'a> Robot<'a> {
    /// Derives the velocity of a pose with dependent coordinates from the independent ones.
    ///
    /// Uses the rows that best determine the dependent components at home.
    ///
    /// # Errors
    /// Rows that do not determine them.
    pub(crate) fn derive_parasitic_motion(
        &mut self,
    ) -> Result<Option<ParasiticMotion<'a>>, DerivationError> {
        let Some(independent) = self.mechanism.independent_coordinates() else {
            return Ok(None);
        };
        let count = self.mechanism.velocity_len();
        let dependent = dependent_components(count, &independent);
        let all = self.blocked_rows();
        let at_home = DMatrix::from_fn(all.len(), dependent.len(), |row, column| {
            self.at_home(all[row].entries[dependent[column]])
        });
        let chosen = best_conditioned(&at_home).into_iter();
        let rows = chosen.map(|row| all[row].clone()).collect();
        let home = |value: Expr<'a>| self.at_home(value);
        let parasitic = ParasiticMotion::new(count, independent, rows, &home)
            .ok_or_else(|| DerivationError::SingularHome { leg: String::new() })?;
        self.guard_coordinates(&parasitic.solved.determinants);
        Ok(Some(parasitic))
    }

    /// All rows of A.
    fn blocked_rows(&self) -> Vec<BlockedRow<'a>> {
        let mut all = Vec::new();
        for (leg, state) in self.legs.iter().enumerate() {
            let Some(closure) = &state.closure else {
                continue;
            };
            for (index, entries) in closure.blocked_rows().into_iter().enumerate() {
                all.push(BlockedRow {
                    leg,
                    index,
                    entries,
                });
            }
        }
        all
    }

    /// Guards the determinants that are zero if the independent coordinates do not determine the
    /// others.
    fn guard_coordinates(&mut self, determinants: &[Expr<'a>]) {
        for determinant in determinants {
            let (_, base) = determinant.factor_and_base();
            if base.as_number().is_none() && !self.guards.iter().any(|g| g.value == base) {
                let kind = GuardKind::Coordinates(self.at_home(base).abs());
                self.guards.push(Guard {
                    value: base,
                    kind,
                    leg: String::new(),
                });
            }
        }
    }

    /// Projects quantities per component of the platform's velocity on the independent coordinates.
    pub(crate) fn on_independent(&self, free: Vec<Expr<'a>>) -> Vec<Expr<'a>> {
        match &self.parasitic_motion {
            Some(parasitic) => parasitic.on_independent(&free),
            None => free,
        }
    }

    /// Velocity and acceleration of the platform along its pose coordinates. `None` without a
    /// platform.
    pub(crate) fn free_motion(
        &self,
        twist: &[Expr<'a>],
        acceleration: &[Expr<'a>],
    ) -> (Vec<Expr<'a>>, Vec<Expr<'a>>) {
        let (Some(parasitic), Some(platform)) = (&self.parasitic_motion, &self.platform) else {
            return (twist.to_vec(), acceleration.to_vec());
        };
        let velocity = parasitic.velocity(twist);
        for &at in &parasitic.dependent {
            let _ = velocity[at].named(&coordinate_label(&self.free[at]));
        }
        let still = vec![self.arena.zero(); SIX];
        let moved = platform.motion(&velocity, &still);
        let missing: Vec<Expr<'a>> = parasitic
            .rows
            .iter()
            .map(|row| {
                let leg = row.leg;
                let state = &self.legs[leg];
                let Some(closure) = &state.closure else {
                    return self.arena.zero();
                };
                let own = &self.mechanism.legs[leg];
                self.arena.enter(&own.name);
                let u = self.rates_of_leg(state, closure, twist, &moved);
                let bias = end_bias(self.arena, own, &state.frames, &state.rates, &u);
                let along = -closure.blocked_acceleration(self.arena, row.index, &moved, &bias);
                self.arena.enter("");
                along
            })
            .collect();
        let own = apply(&parasitic.follow, acceleration);
        let bias = parasitic.solved.solve(&missing);
        let others: Vec<Expr<'a>> = own.iter().zip(&bias).map(|(a, b)| *a + *b).collect();
        (velocity, parasitic.together(acceleration, &others))
    }

    /// Rates and accelerations of the joints in the pose of a skeleton.
    ///
    /// With dependent joints, the chains up to the last blocked direction move once at zero
    /// accelerations of these joints: this gives the bias of each blocked direction.
    pub(crate) fn skeleton_motion(
        &self,
        twist: &[Expr<'a>],
        acceleration: &[Expr<'a>],
    ) -> (Vec<Expr<'a>>, Vec<Expr<'a>>) {
        let Some(dependent) = &self.dependent_joints else {
            return (twist.to_vec(), acceleration.to_vec());
        };
        let arena = self.arena;
        let velocity = dependent.velocity(twist);
        let mut missing = vec![arena.zero(); dependent.rows.len()];
        let last = dependent.rows.iter().map(|row| row.leg).max();
        let (mut u, mut u_dot) = (Vec::new(), Vec::new());
        let legs = self.mechanism.legs.iter().zip(&self.legs).enumerate();
        for (index, (leg, state)) in legs.take(last.map_or(0, |last| last + 1)) {
            let (Some(closure), Some(end)) = (&state.closure, &state.platform) else {
                let own = velocity[self.mechanism.coordinate_range(index)].to_vec();
                u_dot.extend(vec![arena.zero(); own.len()]);
                u.extend(own);
                continue;
            };
            arena.enter(&leg.name);
            let end = end.motion(&u, &u_dot);
            let own = self.rates_of_leg(state, closure, twist, &end);
            let bias = end_bias(arena, leg, &state.frames, &state.rates, &own);
            for (missing, row) in missing.iter_mut().zip(&dependent.rows) {
                if row.leg == index {
                    *missing = -closure.blocked_acceleration(arena, row.index, &end, &bias);
                }
            }
            let names = Accelerations::new(&[]).labels(leg, "still_a_on_f");
            u_dot.extend(closure.accelerations(arena, &end, &bias, &names));
            u.extend(own);
        }
        arena.enter("");
        let own = apply(&dependent.follow, acceleration);
        let bias = dependent.solved.solve(&missing);
        let others: Vec<Expr<'a>> = own.iter().zip(&bias).map(|(a, b)| *a + *b).collect();
        (velocity, dependent.together(acceleration, &others))
    }

    /// The relation of dependent coordinates of the pose to the independent ones, if there are any.
    pub(crate) fn dependent_coordinates(&self) -> Option<&ParasiticMotion<'a>> {
        let of_platform = self.parasitic_motion.as_ref();
        of_platform.or(self.dependent_joints.as_ref())
    }

    /// Violation of the legs' constraints by the pose: for each row of A, with the leg.
    pub(crate) fn blocked_errors(&self) -> Vec<(Expr<'a>, usize)> {
        let rows = self
            .dependent_coordinates()
            .into_iter()
            .flat_map(|parasitic| &parasitic.rows);
        let errors = rows.filter_map(|row| {
            let leg = row.leg;
            let state = &self.legs[leg];
            let closure = state.closure.as_ref()?;
            let error = placement_error(
                state.platform.as_ref()?,
                closure.arm,
                &self.mechanism.legs[leg],
                &state.frames,
            )?;
            Some((closure.blocked[row.index].along(&error), leg))
        });
        errors.collect()
    }

    /// Guards that the legs allow the pose.
    pub(crate) fn closed_guards(&self) -> Vec<Guard<'a>> {
        let scale = self.mechanism.length_scale();
        let errors = self.blocked_errors().into_iter();
        let guard = |(value, leg): (Expr<'a>, usize)| Guard {
            value,
            kind: GuardKind::Closed(overact_core::CLOSED * scale.max(1e-3)),
            leg: self.mechanism.legs[leg].name.clone(),
        };
        let errors = errors.filter(|(value, _)| value.as_number().is_none());
        errors.map(guard).collect()
    }

    /// Guards that the coordinates assumed zero are zero.
    pub(crate) fn still_guards(&self, still: &[usize]) -> Vec<Guard<'a>> {
        let rows = self
            .parasitic_motion
            .iter()
            .flat_map(|parasitic| &parasitic.rows);
        let leg = rows.map(|row| self.mechanism.legs[row.leg].name.clone());
        let leg = leg.min().unwrap_or_default();
        let scale = self.mechanism.length_scale().max(1e-3);
        let guard = |&at: &usize| Guard {
            value: self.arena.input("pose", at),
            kind: GuardKind::Closed(overact_core::CLOSED * if at < 3 { scale } else { 1.0 }),
            leg: leg.clone(),
        };
        still.iter().map(guard).collect()
    }

    /// The components of the platform's velocity along its pose coordinates.
    pub(crate) fn free_coordinates(motion: Option<Motion>) -> Vec<TwistCoordinate> {
        motion.map(|own| own.of_pose().twist()).unwrap_or_default()
    }
}

/// Placement error of a leg's end in the leg's axes: a position (m), and half the axial vector of
/// the remaining rotation (rad for small ones).
pub(crate) fn placement_error<'a>(
    platform: &PlatformPose<'a>,
    arm: Vector3<'a>,
    leg: &Leg,
    frames: &LegFrames<'a>,
) -> Option<SpatialMotion<'a>> {
    let arena = arm.x().arena();
    let last = frames.frames.last()?;
    let into = frames.axes.transposed();
    let base = Vector3::constant(arena, leg.base.at);
    let position = into * (platform.origin + arm - base) - last.origin;
    let turn = match &leg.end {
        Some(End::Rigid(placement)) => {
            let left = (into * platform.orientation(placement)) * last.rotation.transposed();
            let half = Number::ratio(Ratio::new(1, 2).unwrap_or(Ratio::ONE));
            let m = left.0;
            let axial = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]];
            Vector3(axial.map(|a| a * half))
        }
        _ => Vector3::zero(arena),
    };
    Some(SpatialMotion {
        linear: position,
        angular: turn,
    })
}
