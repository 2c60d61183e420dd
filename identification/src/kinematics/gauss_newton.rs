//! Gauss-Newton steps of many samples in parallel.
//!
//! Each sample has the step of [`overact::forward::gauss_newton`].

use overact::{
    Function, Model,
    float::Float,
    forward::{STEPS, TOLERANCE},
    math::wrap_angle,
};
use pulp::NullaryFnOnce;

use super::dense::{LANES, Lanes, lanes, solved};
use crate::with_avx::with_avx2;

/// Refines poses by Gauss-Newton for all samples at once.
///
/// The stopping rule is that of [`overact::forward::gauss_newton`]. `None` if a sample does not
/// converge.
pub(super) fn refine_poses(model: &dyn Model, positions: &[f64], poses: &mut [f64]) -> Option<()> {
    let info = model.info();
    let (n, r) = (info.sizes.actuators, info.sizes.dof);
    let samples = positions.len() / n;
    let mut reached = vec![0.0; samples * n];
    let mut jacobians = vec![0.0; samples * n * r];
    let mut steps = vec![0.0; samples * r];
    let mut before = 0.0;
    for _ in 0..STEPS {
        model
            .evaluate(Function::ActuatorPositions, &[poses], &mut reached)
            .ok()?;
        model
            .evaluate(Function::InverseJacobian, &[poses], &mut jacobians)
            .ok()?;
        // Replace positions by their residuals.
        for (left, measured) in reached.iter_mut().zip(positions) {
            *left = measured - *left;
        }
        let angles = reached
            .iter_mut()
            .zip(info.actuator_is_revolute.iter().cycle());
        for (left, _) in angles.filter(|(_, is_revolute)| **is_revolute) {
            *left = wrap_angle(*left);
        }
        let is_regular = with_avx2(Steps {
            left: &reached,
            jacobians: &jacobians,
            sizes: (n, r),
            steps: &mut steps,
        });
        if !is_regular {
            return None;
        }
        let rows = steps.chunks_exact(r);
        let moved = poses.chunks_exact_mut(poses.len() / samples).zip(rows);
        moved.for_each(|(pose, step)| model.displace(pose, step));
        let largest = steps.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        // `f64::max` ignores NaN, so check separately.
        if !steps.iter().fold(true, |all, s| all & s.is_finite()) {
            return None;
        }
        // The next step of any sample is at most largest²/before.
        if largest < TOLERANCE || largest * largest < 0.1 * TOLERANCE * before {
            return Some(());
        }
        before = largest;
    }
    None
}

/// Vectorised computation of the steps (JᵀJ)^-1 Jᵀ Δq.
struct Steps<'a> {
    /// Δq, n per sample.
    left: &'a [f64],
    /// J_p^inv, n × r per sample.
    jacobians: &'a [f64],
    /// n and r.
    sizes: (usize, usize),
    /// Steps, r per sample.
    steps: &'a mut [f64],
}

impl NullaryFnOnce for Steps<'_> {
    /// Whether all samples have a step.
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        // Constant lengths let the compiler unroll short loops.
        match self.sizes.1 {
            2 => self.all([[0.0; LANES]; 4], [[0.0; LANES]; 2]),
            3 => self.all([[0.0; LANES]; 9], [[0.0; LANES]; 3]),
            6 => self.all([[0.0; LANES]; 36], [[0.0; LANES]; 6]),
            r => self.all(vec![[0.0; LANES]; r * r], vec![[0.0; LANES]; r]),
        }
    }
}

impl Steps<'_> {
    /// Computes the steps with workspace for normal matrices and steps.
    #[inline(always)]
    fn all(self, mut normal: impl AsMut<[Lanes]>, mut step: impl AsMut<[Lanes]>) -> bool {
        let (normal, step) = (normal.as_mut(), step.as_mut());
        let (n, r) = (self.sizes.0, step.len());
        let groups = self.left.chunks(LANES * n);
        let groups = groups.zip(self.jacobians.chunks(LANES * n * r));
        let mut all_regular = true;
        for ((left, jacobians), steps) in groups.zip(self.steps.chunks_mut(LANES * r)) {
            normal.fill([0.0; LANES]);
            step.fill([0.0; LANES]);
            for actuator in 0..n {
                let left = lanes(left, n, |own| own[actuator]);
                for k in 0..r {
                    let entry = |at: usize| lanes(jacobians, n * r, |own| own[actuator * r + at]);
                    let own = entry(k);
                    // Only the upper triangle of the normal matrix is used.
                    for at in k..r {
                        let other = entry(at);
                        for lane in 0..LANES {
                            normal[k * r + at][lane] += own[lane] * other[lane];
                        }
                    }
                    for lane in 0..LANES {
                        step[k][lane] += own[lane] * left[lane];
                    }
                }
            }
            let is_regular = solved(normal, step, <f64 as Float>::LIMITS.pivot);
            all_regular &= is_regular.iter().fold(true, |all, own| all & own);
            for (lane, own) in steps.chunks_exact_mut(r).enumerate() {
                for (to, from) in own.iter_mut().zip(&*step) {
                    *to = from[lane];
                }
            }
        }
        all_regular
    }
}
