//! Forward dynamics of the robot under given torques, with the true parameters.
//!
//! v̇ = M(x)^-1 (Γ¹(τ) - h(x, v)), with Γ¹ = (J_p^inv)ᵀ τ of eq. (30) and the bias h (Coriolis,
//! gravity, friction, offsets).
//!
//! Torques are held between samples, and the state advances by the classical fourth-order
//! Runge-Kutta method with a fixed step. If the platform coordinates are additive, ẋ = v and the
//! method is of fourth order. With a quaternion, the stages and the step are displacements along
//! the mean twist. The pose is then of second order in rotations about a turning axis. The error of
//! a step is |ω x ω̇| h³ / 12, for example about 1e-12 rad for ω = 1 rad/s, ω̇ = 10 rad/s², h = 0.1
//! ms.
//!
//! Coulomb friction is fs sign(q̇) with sign(0) = 0, without regularisation. A joint that should
//! stick is decelerated across zero within a step and back in the next. Its velocity chatters
//! within about (friction force / inertia) h around zero, with the mean friction force of sticking.

use overact::{Columns, Error as ModelError, Function, Model};

use crate::error::Cause;

/// State of the robot and memory of one step; allocates in `new` only.
pub(crate) struct Plant<'a> {
    model: &'a dyn Model,
    parameters: &'a [f64],
    /// Platform pose x.
    pub(crate) pose: Vec<f64>,
    /// Twist coordinates v, r.
    pub(crate) twist: Vec<f64>,
    stage_pose: Vec<f64>,
    stage_twist: Vec<f64>,
    /// Sum of the stages' twists with the weights 1, 2, 2, 1.
    twist_sum: Vec<f64>,
    /// Sum of the stages' accelerations with the same weights.
    acceleration_sum: Vec<f64>,
    acceleration: Vec<f64>,
    step: Vec<f64>,
}

impl<'a> Plant<'a> {
    pub(crate) fn new(
        model: &'a dyn Model,
        parameters: &'a [f64],
        pose: &[f64],
        twist: &[f64],
    ) -> Self {
        let zeros = twist.iter().map(|_| 0.0).collect::<Vec<_>>();
        Self {
            model,
            parameters,
            pose: pose.to_vec(),
            twist: twist.to_vec(),
            stage_pose: pose.to_vec(),
            stage_twist: twist.to_vec(),
            twist_sum: zeros.clone(),
            acceleration_sum: zeros.clone(),
            acceleration: zeros.clone(),
            step: zeros,
        }
    }

    /// Advances by `steps` steps of `h` seconds under constant torques.
    pub(crate) fn advance(&mut self, torques: &[f64], h: f64, steps: usize) -> Result<(), Cause> {
        for _ in 0..steps {
            self.runge_kutta(torques, h)?;
        }
        Ok(())
    }

    /// Pose after `time` seconds with the current twist.
    pub(crate) fn ahead(&self, time: f64) -> Vec<f64> {
        let mut pose = self.pose.clone();
        let step: Vec<f64> = self.twist.iter().map(|twist| time * twist).collect();
        self.model.displace(&mut pose, &step);
        pose
    }

    fn runge_kutta(&mut self, torques: &[f64], h: f64) -> Result<(), Cause> {
        // Each stage starts from the step's start, moved along the previous stage by its fraction.
        const FRACTION: [f64; 4] = [0.0, 0.5, 0.5, 1.0];
        const WEIGHT: [f64; 4] = [1.0, 2.0, 2.0, 1.0];
        self.twist_sum.fill(0.0);
        self.acceleration_sum.fill(0.0);
        for (fraction, weight) in FRACTION.into_iter().zip(WEIGHT) {
            self.stage_pose.copy_from_slice(&self.pose);
            if fraction > 0.0 {
                for (step, twist) in self.step.iter_mut().zip(&self.stage_twist) {
                    *step = fraction * h * twist;
                }
                self.model.displace(&mut self.stage_pose, &self.step);
            }
            for (i, twist) in self.stage_twist.iter_mut().enumerate() {
                *twist = self.twist[i] + fraction * h * self.acceleration[i];
            }
            self.accelerate(torques)?;
            for i in 0..self.twist.len() {
                self.twist_sum[i] += weight * self.stage_twist[i];
                self.acceleration_sum[i] += weight * self.acceleration[i];
            }
        }
        for (i, step) in self.step.iter_mut().enumerate() {
            *step = h / 6.0 * self.twist_sum[i];
            self.twist[i] += h / 6.0 * self.acceleration_sum[i];
        }
        self.model.displace(&mut self.pose, &self.step);
        if self
            .twist
            .iter()
            .chain(&self.pose)
            .all(|value| value.is_finite())
        {
            Ok(())
        } else {
            Err(Cause::Model(ModelError::Overflow))
        }
    }

    /// Writes the acceleration of the stage's state.
    fn accelerate(&mut self, torques: &[f64]) -> Result<(), Cause> {
        let state = [
            &self.stage_pose,
            &self.stage_twist,
            torques,
            self.parameters,
        ];
        let found = self.model.evaluate(
            Function::ForwardDynamics(Columns::Standard),
            &state,
            &mut self.acceleration,
        );
        found.map_err(|failed| match failed.error {
            ModelError::MassMatrix => Cause::MassMatrix,
            error => Cause::Model(error),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::{
        Robot,
        mechanisms::{Shaft, Tripod, TwoMotors},
    };

    /// Parameters of the tripod: ia, fv, fs of each leg, m, payload's m.
    const TRIPOD: [f64; 11] = [0.8, 0.0, 0.0, 1.3, 0.0, 0.0, 0.4, 0.0, 0.0, 2.0, 0.5];

    fn kinetic_energy(plant: &Plant<'_>) -> f64 {
        let r = plant.twist.len();
        let mut mass = vec![0.0; r * r];
        let inputs: [&[f64]; 2] = [&plant.pose, plant.parameters];
        plant
            .model
            .evaluate(Function::MassMatrix(Columns::Standard), &inputs, &mut mass)
            .unwrap();
        let moment = |a: usize| -> f64 { (0..r).map(|b| mass[a * r + b] * plant.twist[b]).sum() };
        0.5 * (0..r).map(|a| plant.twist[a] * moment(a)).sum::<f64>()
    }

    /// Gain of kinetic energy minus the work of the torques over 0.2 s; held torques do the work τ
    /// Δq.
    fn energy_residual(h: f64, steps: usize) -> f64 {
        let model = Robot::new(Tripod);
        let mut plant = Plant::new(&model, &TRIPOD, &[0.05, -0.02], &[0.7, -0.4]);
        let positions = |pose: &[f64]| {
            let mut q = [0.0; 3];
            model
                .evaluate(Function::ActuatorPositions, &[pose], &mut q)
                .unwrap();
            q
        };
        let start = kinetic_energy(&plant);
        let mut work = 0.0;
        for k in 0..10 {
            let angle = f64::from(k);
            let torques = [
                6.0 * angle.cos(),
                9.0 * angle.sin(),
                -4.0 * (2.0 * angle).cos(),
            ];
            let before = positions(&plant.pose);
            plant.advance(&torques, h, steps).unwrap();
            let after = positions(&plant.pose);
            work += (0..3)
                .map(|i| torques[i] * (after[i] - before[i]))
                .sum::<f64>();
        }
        (kinetic_energy(&plant) - start - work).abs()
    }

    #[test]
    fn torque_work_equals_the_kinetic_energy_gain() {
        // The step of a 5 kHz experiment with two steps per sample; energies are about 1 J.
        assert!(energy_residual(1e-4, 200) < 1e-13);
        // Fourth order: a step ten times as long has about 1e4 times the error.
        let (long, short) = (energy_residual(2e-2, 1), energy_residual(2e-3, 10));
        assert!(
            (3.0..5.0).contains(&(long / short).log10()),
            "{long:e} {short:e}"
        );
    }

    #[test]
    fn viscous_friction_gives_exponential_decay() {
        let model = Robot::new(TwoMotors);
        let parameters = [0.3, 1.5, 0.0, 0.2, 2.5, 0.0, 1.0, 0.5];
        let (mass, friction, force) = (2.0, 4.0, 3.0);
        let mut plant = Plant::new(&model, &parameters, &[0.0], &[0.0]);
        plant.advance(&[1.0, 2.0], 1e-3, 500).unwrap();
        let decay = (-friction / mass * 0.5_f64).exp();
        let velocity = force / friction * (1.0 - decay);
        let position = force / friction * (0.5 - mass / friction * (1.0 - decay));
        assert!((plant.twist[0] - velocity).abs() < 1e-13);
        assert!((plant.pose[0] - position).abs() < 1e-13);
    }

    #[test]
    fn coulomb_friction_stops_and_holds_the_mass() {
        let model = Robot::new(TwoMotors);
        let parameters = [0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 2.0, 0.0];
        let mut plant = Plant::new(&model, &parameters, &[0.0], &[0.6]);
        plant.advance(&[0.0, 0.0], 1e-4, 10_000).unwrap();
        // m v² / (2 fs) = 0.12 m; one step of uncertainty at the stop.
        assert!(
            (plant.pose[0] - 0.12).abs() < 1e-4 * 0.6,
            "{}",
            plant.pose[0]
        );
        assert!(plant.twist[0].abs() < 3.0 / 2.0 * 1e-4 * 2.0);
        // A force below friction moves it no more than chatter.
        let held = plant.pose[0];
        plant.advance(&[1.0, 1.0], 1e-4, 10_000).unwrap();
        assert!(
            (plant.pose[0] - held).abs() < 2e-4,
            "{}",
            plant.pose[0] - held
        );
        // A force above friction moves it: (4 - 3) / 2 m/s² for 1 s.
        plant.advance(&[2.0, 2.0], 1e-4, 10_000).unwrap();
        assert!((plant.pose[0] - held - 0.25).abs() < 5e-4);
    }

    #[test]
    fn non_additive_poses_are_integrated() {
        let model = Robot::new(Shaft);
        let parameters = [0.1, 0.0, 0.0, 0.2, 0.0, 0.0, 0.1, 0.0];
        let mut plant = Plant::new(&model, &parameters, &[1.0, 0.0], &[1.0]);
        // Inertia 0.1 + 9 * 0.2 + 0.1 = 2, torque 1 + 3 * 1 = 4: φ = t + t².
        plant.advance(&[1.0, 1.0], 1e-4, 10_000).unwrap();
        assert!((plant.twist[0] - 3.0).abs() < 1e-11);
        // The chart of each displacement is exact to s³/12.
        let angle = plant.pose[1].atan2(plant.pose[0]);
        assert!((angle - 2.0).abs() < 1e-7, "{angle}");
    }

    #[test]
    fn a_body_without_mass_is_an_error() {
        let model = Robot::new(TwoMotors);
        let mut plant = Plant::new(&model, &[0.0; 8], &[0.0], &[0.0]);
        assert_eq!(plant.advance(&[1.0, 0.0], 1e-4, 1), Err(Cause::MassMatrix));
    }
}
