//! Matrices of the closure equations: A_p, B_p, J_k, J_tk, and the closure error.

use crate::cas::Expr;
use crate::derivation::context::{DerivationContext, column};
use crate::derivation::kinematics::frames::independent_columns;
use crate::derivation::linear_algebra::elimination::{Rows, inverse};
use crate::derivation::robot::constraints::placement_error;
use crate::mechanism::Actuator;

impl<'a> DerivationContext<'a, '_> {
    /// A_p (n × r) and B_p (n × n), eq. (11): the rows of the legs' adjugates. A motor that drives
    /// several joints and a cable have their rows of J_p^inv and of minus the identity.
    pub(crate) fn closure_matrices(&mut self) -> (Rows<'a>, Rows<'a>) {
        let (arena, mechanism) = (self.robot.arena, self.robot.mechanism);
        let joints = mechanism.joints();
        let jacobian = self.robot.inverse_jacobian();
        let actuators = mechanism.actuators();
        let n = actuators.len();
        let scale = |k: usize| {
            let Actuator::Joint(joint) = actuators[k] else {
                return arena.one();
            };
            let leg = joints[joint].leg;
            let state = &self.robot.legs[leg];
            let closure = state.closure.as_ref().filter(|_| state.cable.is_none());
            if mechanism.has_dependent_coordinates() {
                self.determinant(leg).unwrap_or_else(|| arena.one())
            } else {
                closure.map_or_else(|| arena.one(), |c| c.determinant)
            }
        };
        let scales: Vec<Expr<'a>> = (0..n).map(scale).collect();
        let platform = (0..n)
            .map(|k| jacobian[k].iter().map(|&g| g * scales[k]).collect())
            .collect();
        let entry = |i: usize, j: usize| if i == j { -scales[i] } else { arena.zero() };
        let diagonal = (0..n)
            .map(|i| (0..n).map(|j| entry(i, j)).collect())
            .collect();
        (platform, diagonal)
    }

    /// Determinant of a leg's rows of J_k, if the leg is solved in other axes.
    fn determinant(&self, index: usize) -> Option<Expr<'a>> {
        let (arena, mechanism) = (self.robot.arena, self.robot.mechanism);
        let frames = self.robot.base_frames(index)?;
        let columns = independent_columns(arena, &mechanism.legs[index], &frames);
        let rows = mechanism.closure_rows(index).into_iter();
        let entry = |row: usize| columns.iter().map(|c| c.component(row)).collect();
        let matrix: Rows<'a> = rows.map(entry).collect();
        let home = |value: Expr<'a>| self.robot.at_home(value);
        Some(inverse(&matrix, &home)?.determinant)
    }

    /// Closure errors of the legs in the rows of J_k: positions (m), and half the axial vector of
    /// the remaining rotation (rad for small ones).
    pub(crate) fn closure_error(&mut self) -> Rows<'a> {
        let (arena, mechanism) = (self.robot.arena, self.robot.mechanism);
        let mut errors = Vec::new();
        for (index, (leg, state)) in mechanism.legs.iter().zip(&self.robot.legs).enumerate() {
            let (Some(closure), Some(platform)) = (&state.closure, self.robot.end_of(index)) else {
                // The joints of legs without an end are the pose.
                let places = mechanism
                    .coordinate_range(index)
                    .zip(mechanism.leg_range(index));
                errors.extend(places.map(|(in_pose, in_joints)| {
                    arena.input("pose", in_pose) - arena.input("joints", in_joints)
                }));
                continue;
            };
            if let Some(course) = &state.cable {
                errors.push(course.length - arena.input("joints", state.first_joint));
                continue;
            }
            let frames = self.robot.base_frames(index);
            let arm = platform.arm(closure.at);
            let error = frames.and_then(|frames| placement_error(&platform, arm, leg, &frames));
            let Some(error) = error else {
                continue;
            };
            let rows = mechanism.closure_rows(index).into_iter();
            errors.extend(rows.map(|row| error.component(row)));
        }
        column(errors)
    }

    /// D of a pose with dependent coordinates.
    pub(crate) fn platform_jacobian(&mut self) -> Rows<'a> {
        let parasitic = self.robot.dependent_coordinates();
        parasitic.map_or_else(Vec::new, |parasitic| {
            parasitic.platform_jacobian(self.robot.arena)
        })
    }

    /// Distance of a pose from those that the legs allow.
    pub(crate) fn blocked_error(&mut self) -> Rows<'a> {
        let errors = self.robot.blocked_errors().into_iter();
        column(errors.map(|(error, _)| error).collect())
    }

    /// A of A t = 0.
    pub(crate) fn blocked_jacobian(&mut self) -> Rows<'a> {
        let parasitic = self.robot.dependent_coordinates();
        parasitic.map_or_else(Vec::new, |parasitic| parasitic.matrix.clone())
    }

    /// J_k (n_t × n_t) and J_tk (n_t × r), eq. (9), in the base frame.
    pub(crate) fn leg_matrices(&mut self) -> (Rows<'a>, Rows<'a>) {
        let (arena, mechanism) = (self.robot.arena, self.robot.mechanism);
        let total = mechanism.joints().len();
        let (mut legs, mut platform) = (Vec::new(), Vec::new());
        for (index, (leg, state)) in mechanism.legs.iter().zip(&self.robot.legs).enumerate() {
            let is_solved = state.closure.is_some() && state.cable.is_none();
            let ends = state.closure.as_ref().zip(self.robot.end_of(index));
            let ends = ends.filter(|_| is_solved);
            let (Some((closure, end)), Some(frames)) = (ends, self.robot.base_frames(index)) else {
                // The joint rates of legs without an end are independent coordinates, and the
                // length of a cable follows from the pose.
                let own = mechanism.leg_range(index).len();
                for (i, row) in state.rows[..own].iter().enumerate() {
                    let mut entries = vec![arena.zero(); total];
                    entries[state.first_joint + i] = arena.one();
                    legs.push(entries);
                    platform.push(row.clone());
                }
                continue;
            };
            let columns = independent_columns(arena, leg, &frames);
            for row in mechanism.closure_rows(index) {
                let mut entries = vec![arena.zero(); total];
                for (k, column) in columns.iter().enumerate() {
                    entries[state.first_joint + k] = column.component(row);
                }
                legs.push(entries);
                let own = end.row(closure.at, row);
                platform.push(self.robot.on_independent(own));
            }
        }
        (legs, platform)
    }
}
