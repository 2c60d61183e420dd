//! The matrices of the paper's closure equations: A_p, B_p, J_k, J_tk, and the closure error itself.

use super::elimination::Rows;
use super::frames::independent_columns;
use super::sheet::{Sheet, column};
use crate::cas::{Expr, Number, Ratio, Vector3};
use crate::mechanism::End;

impl<'a> Sheet<'a, '_> {
    /// A_p (n x r) and B_p (n x n), eq. (11): the rows of the legs' adjugates.
    pub(super) fn closure_matrices(&mut self) -> (Rows<'a>, Rows<'a>) {
        let (arena, mechanism) = (self.robot.arena, self.robot.mechanism);
        let joints = mechanism.joints();
        let jacobian = self.robot.inverse_jacobian();
        let actuated = mechanism.actuated();
        let n = actuated.len();
        let scale = |k: usize| {
            let state = &self.robot.legs[joints[actuated[k]].leg];
            state
                .closure
                .as_ref()
                .map_or_else(|| arena.one(), |c| c.determinant)
        };
        let scales: Vec<Expr<'a>> = (0..n).map(scale).collect();
        let platform = (0..n)
            .map(|k| jacobian[k].iter().map(|&g| g * scales[k]).collect())
            .collect();
        let diagonal = |i: usize, j: usize| if i == j { -scales[i] } else { arena.zero() };
        let actuators = (0..n)
            .map(|i| (0..n).map(|j| diagonal(i, j)).collect())
            .collect();
        (platform, actuators)
    }

    /// By how much the legs' ends miss the platform, in the rows of J_k: positions (m), and half the
    /// axial vector of the rotation that is left (rad for small ones).
    pub(super) fn closure_error(&mut self) -> Rows<'a> {
        let (arena, mechanism) = (self.robot.arena, self.robot.mechanism);
        let mut errors = Vec::new();
        for (index, (leg, state)) in mechanism.legs.iter().zip(&self.robot.legs).enumerate() {
            let (Some(closure), Some(platform)) = (&state.closure, &state.platform) else {
                // The skeleton's joints are the pose.
                let own = |i: usize| arena.input("pose", i) - arena.input("joints", i);
                errors.extend((0..state.rows.len()).map(own));
                continue;
            };
            let frames = self.robot.base_frames(index);
            let Some(last) = frames.as_ref().and_then(|f| f.frames.last()) else {
                continue;
            };
            let base = Vector3::constant(arena, leg.base.at);
            let position = platform.origin + closure.arm - base - last.origin;
            let turn = match &leg.end {
                Some(End::Rigid(placement)) => {
                    let left = platform.orientation(placement) * last.rotation.transposed();
                    let half = Number::ratio(Ratio::new(1, 2).unwrap_or(Ratio::ONE));
                    let m = left.0;
                    let axial = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]];
                    Vector3(axial.map(|a| a * half))
                }
                _ => Vector3::zero(arena),
            };
            let rows = mechanism.closure_rows(index).into_iter();
            errors.extend(rows.map(|row| [position, turn][row / 3].0[row % 3]));
        }
        column(errors)
    }

    /// J_k (n_t x n_t) and J_tk (n_t x r), eq. (9), in the base frame.
    pub(super) fn leg_matrices(&mut self) -> (Rows<'a>, Rows<'a>) {
        let (arena, mechanism) = (self.robot.arena, self.robot.mechanism);
        let total = mechanism.joints().len();
        let (mut legs, mut platform) = (Vec::new(), Vec::new());
        for (index, (leg, state)) in mechanism.legs.iter().zip(&self.robot.legs).enumerate() {
            let (Some(closure), Some(frames)) = (&state.closure, self.robot.base_frames(index))
            else {
                // The rates of the skeleton's joints are the independent ones.
                for (i, row) in state.rows.iter().enumerate() {
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
                    entries[state.first_joint + k] = column[row / 3].0[row % 3];
                }
                legs.push(entries);
                platform.push(closure.platform_row(row, arena));
            }
        }
        (legs, platform)
    }
}
