//! One step of forward kinematics: from a pose x towards the pose of given actuator positions.
//!
//! The Gauss-Newton step is Δx = J⁺ (q - q(x)) with J = J_p^inv, eq. (21). With as many actuators
//! as coordinates it is Newton's step, J Δx = q - q(x), which needs no normal equations:
//!
//! - The position of an actuator between two points is a length minus a constant, q = w - c, and
//!   its row of J contains the divisor w. Multiplying both sides by w removes all divisors.
//! - The system is solved by blocks of two and three columns, with the rows that are best
//!   conditioned at home. From [P Q; R S] (x, y) = (a, b) follow (S - R P⁻¹ Q) y = b - R P⁻¹ a and
//!   P x = a - Q y. P⁻¹ is adjugate over determinant: one division per block.
//!
//! For an angle q with the direction (c, s), and (c', s') at the pose, q - q(x) is the angle
//! between the two directions, that of (c c' + s s', s c' - c s'). Whole turns cancel, and a common
//! factor of c' and s' is irrelevant.
//!
//! The determinant d of a block may vanish although J is regular, and near there rounding errors
//! grow with 1/d². So its guard is stricter than that of other determinants; the caller then
//! continues with the normal equations.

use crate::cas::{CosineSine, Expr};
use crate::derivation::context::DerivationContext;
use crate::derivation::guard::GuardKind;
use crate::derivation::linear_algebra::elimination::{Rows, adjugate};
use crate::derivation::linear_algebra::linear::{apply, dot, product};
use crate::mechanism::numeric::best_conditioned;
use crate::mechanism::{Actuator, JointKind};
use nalgebra::DMatrix;
use overact_core::ActuatorGroup;

/// Factor by which a block's determinant is guarded more strictly than one that shows a singular J.
///
/// A step of the 6-UPS then has a relative error of at most 10⁻⁵. In single precision the home
/// configuration is still far from the bound.
const SOONER: f64 = 1e3;

/// Number of columns that are eliminated together.
const BLOCK: usize = 2;

/// Size of the largest block, which is solved at once in the end.
const LAST: usize = 3;

/// Rows of a linear system, with their right-hand sides.
struct System<'a> {
    rows: Rows<'a>,
    right: Vec<Expr<'a>>,
}

impl<'a> DerivationContext<'a, '_> {
    /// The step from the pose towards the actuator positions.
    pub(crate) fn pose_step(&mut self) -> Vec<Expr<'a>> {
        let positions = self.actuator_positions();
        let differences = self.differences();
        if positions.len() != self.robot.mechanism.dof() {
            return self.least_squares(&differences);
        }
        let system = self.without_divisors(&positions, &differences);
        if let Some(step) = self.solved_by_cofactors(&system.rows, &system.right) {
            return step;
        }
        let mut determinants = Vec::new();
        match self.by_blocks(&system, &mut determinants) {
            Some(step) => {
                // The last determinant vanishes where that of J does.
                if let Some((last, inner)) = determinants.split_last() {
                    self.guard_blocks(inner);
                    self.guard_platform(&[*last], ActuatorGroup::All);
                }
                step
            }
            None => self.least_squares(&differences),
        }
    }

    /// q - q(x); for angles, the angle between their directions, without whole turns.
    pub(crate) fn differences(&mut self) -> Vec<Expr<'a>> {
        let positions = self.actuator_positions();
        let measured = self.input("actuators", positions.len());
        let (arena, mechanism) = (self.robot.arena, self.robot.mechanism);
        let (configuration, joints) = (&self.robot.configuration, mechanism.joints());
        let actuators = mechanism.actuators().into_iter().enumerate();
        let difference = |(k, actuator): (usize, Actuator)| {
            // The position of a motor may be the sum of several angles, without whole turns.
            let unit = match actuator {
                Actuator::Joint(index)
                    if mechanism.joint(joints[index]).kind == JointKind::Revolute =>
                {
                    configuration.unit(&configuration.joint_angle(index))
                }
                _ => None,
            };
            let Some(CosineSine { cosine, sine }) = unit.map(unscaled) else {
                return measured[k] - positions[k];
            };
            let measured = arena.cosine_and_sine(&arena.input_angle("actuators", k));
            let (c, s) = (
                measured.cosine.named(&format!("c_actuator_{}", k + 1)),
                measured.sine.named(&format!("s_actuator_{}", k + 1)),
            );
            (s * cosine - c * sine).atan2(c * cosine + s * sine)
        };
        let named = |at: (usize, Actuator)| difference(at).named(&format!("missed_{}", at.0 + 1));
        actuators.map(named).collect()
    }

    /// Guards determinants of blocks that may vanish although J is regular.
    fn guard_blocks(&mut self, determinants: &[Expr<'a>]) {
        let before = self.guards.len();
        self.guard_platform(determinants, ActuatorGroup::All);
        for guard in &mut self.guards[before..] {
            if let GuardKind::Platform { home, .. } = &mut guard.kind {
                *home *= SOONER;
            }
        }
    }

    /// J Δx = Δq, with each row multiplied by its divisor, a length.
    fn without_divisors(&self, positions: &[Expr<'a>], differences: &[Expr<'a>]) -> System<'a> {
        let mechanism = self.robot.mechanism;
        let (mut rows, mut right) = (self.robot.inverse_jacobian(), differences.to_vec());
        let joints = mechanism.joints();
        for (k, index) in mechanism.actuated().into_iter().enumerate() {
            let of = joints[index];
            let state = &self.robot.legs[of.leg];
            let rate = state.rates.own(&[of.joint]);
            if let (Some(length), Some(closure), Some(&rate)) =
                (positions[k].root(), &state.closure, rate.first())
            {
                let row = closure.reduced_row(rate, length);
                rows[k] = self.robot.on_independent(row);
                right[k] = length * right[k];
            }
        }
        System { rows, right }
    }

    /// The solution of A x = b; appends the determinants by which it divides to those given.
    ///
    /// `None` if a block is singular at home.
    fn by_blocks(
        &self,
        system: &System<'a>,
        determinants: &mut Vec<Expr<'a>>,
    ) -> Option<Vec<Expr<'a>>> {
        let System { rows, right } = system;
        let size = rows.len();
        if size <= LAST {
            return Some(solved(rows, right, determinants));
        }
        let home = |row: usize, column: usize| self.robot.at_home(rows[row][column]);
        let chosen = best_conditioned(&DMatrix::from_fn(size, BLOCK, home));
        if chosen.len() < BLOCK {
            return None;
        }
        let is_chosen = |row: usize| chosen.contains(&row);
        let first = system.rows_where(is_chosen);
        let rest = system.rows_where(|row| !is_chosen(row));
        let [p, q] = halves(&first.rows);
        let [r, s] = halves(&rest.rows);
        let cofactors = adjugate(&p);
        let column: Vec<Expr<'a>> = cofactors.iter().map(|row| row[0]).collect();
        let determinant = dot(&p[0], &column);
        determinants.push(determinant);
        let reciprocal = determinant.reciprocal();
        // R P⁻¹
        let factors: Rows<'a> = product(&r, &cofactors)
            .into_iter()
            .map(|row| row.into_iter().map(|entry| entry * reciprocal).collect())
            .collect();
        let inner = subtracted(&s, &product(&factors, &q));
        let taken = apply(&factors, &first.right);
        let right = rest
            .right
            .iter()
            .zip(taken)
            .map(|(b, taken)| *b - taken)
            .collect();
        let inner = System { rows: inner, right };
        let y = self.by_blocks(&inner, determinants)?;
        let taken = apply(&q, &y);
        let remainder: Vec<Expr<'a>> = first
            .right
            .iter()
            .zip(taken)
            .map(|(a, taken)| *a - taken)
            .collect();
        let x = apply(&cofactors, &remainder).into_iter();
        Some(x.map(|x| x * reciprocal).chain(y).collect())
    }
}

/// A direction without the common constant factor of its components.
fn unscaled<'a>(direction: CosineSine<'a>) -> CosineSine<'a> {
    let (a, cosine) = direction.cosine.factor_and_base();
    let (b, sine) = direction.sine.factor_and_base();
    if a.value().abs() != b.value().abs() {
        return direction;
    }
    let signed = |sign: f64, base: Expr<'a>| if sign < 0.0 { -base } else { base };
    CosineSine {
        cosine: signed(a.value(), cosine),
        sine: signed(b.value(), sine),
    }
}

/// The solution of a small system by Cramer's rule.
fn solved<'a>(
    rows: &Rows<'a>,
    right: &[Expr<'a>],
    determinants: &mut Vec<Expr<'a>>,
) -> Vec<Expr<'a>> {
    let cofactors = adjugate(rows);
    let column: Vec<Expr<'a>> = cofactors.iter().map(|row| row[0]).collect();
    let determinant = dot(&rows[0], &column);
    determinants.push(determinant);
    let reciprocal = determinant.reciprocal();
    let scaled = apply(&cofactors, right).into_iter();
    scaled.map(|x| x * reciprocal).collect()
}

impl<'a> System<'a> {
    /// The system of some of the rows.
    fn rows_where(&self, is_wanted: impl Fn(usize) -> bool) -> Self {
        let (rows, right) = (0..self.rows.len())
            .filter(|&row| is_wanted(row))
            .map(|row| (self.rows[row].clone(), self.right[row]))
            .unzip();
        Self { rows, right }
    }
}

/// The columns that are eliminated together, and the others.
fn halves<'a>(rows: &Rows<'a>) -> [Rows<'a>; 2] {
    let left = rows.iter().map(|row| row[..BLOCK].to_vec());
    let right = rows.iter().map(|row| row[BLOCK..].to_vec());
    [left.collect(), right.collect()]
}

/// A - B
fn subtracted<'a>(a: &Rows<'a>, b: &Rows<'a>) -> Rows<'a> {
    let rows = a.iter().zip(b);
    rows.map(|(a, b)| a.iter().zip(b).map(|(a, b)| *a - *b).collect())
        .collect()
}
