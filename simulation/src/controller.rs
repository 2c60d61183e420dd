//! Controller of Fig. 4: PD control of every actuator with filtered derivative, and feed-forward.
//!
//! It also removes internal torques by eq. (50) and limits the torques.
//!
//! **Gains.** The error of a controlled mass m obeys m (ë + 2ξω_c ė + ω_c² e) = 0 with K_p = ω_c²
//! m, K_d = 2ξω_c m and ω_c = 2πf_c. A parallel robot has no mass per actuator but the mass matrix
//! M on the platform. With J = J_p^inv, least squares gives the actuators' inertia matrix J^{+T} M
//! J^+. Its diagonal d at home distributes the inertia over the actuators, scaled as m_i = c d_i.
//!
//! Small errors of the platform obey M δẍ + Jᵀ K_d J δẋ + Jᵀ K_p J δx = 0. Its squared natural
//! frequencies are ω_c² times the eigenvalues of M^-1 Jᵀ diag(m) J. The factor c makes the largest
//! of them, over poses along the run, equal to 1: no mode is faster than the chosen bandwidth. This
//! matters because the derivative filter (70 Hz, like the bandwidth) leaves a phase margin of about
//! 15 degrees. A mode of twice the frequency would have none. For the paper's Fig. 1 (two motors on
//! one mass) each motor gets half of the mass.
//!
//! **Derivative.** d_k = a d_{k-1} + (1 - a)(e_k - e_{k-1})/T with a = exp(-2π f_d T).
//!
//! **Cables.** The feed-forward contains the internal torques that keep all cables taut, so only
//! the feedback is projected. A force on a cable's length is the negative tension, and tensions are
//! not negative.
//!
//! **Projection.** (50) is evaluated at the desired pose, which needs no forward kinematics. The
//! torque limit comes last, as in an amplifier.

use nalgebra::{DMatrix, Matrix4, SymmetricEigen};
use overact::{Columns, Function, Model};
use std::f64::consts::TAU;

use crate::{error::Cause, experiment::Experiment};

/// Controller in the loop: the simulation's own, or one under test.
pub trait Control {
    /// Writes the n torques of one sample from the desired motion and the measured positions.
    ///
    /// # Errors
    /// A motion for which the controller's model has no value; the run ends there.
    fn step(
        &mut self,
        desired: &Desired<'_>,
        measured: &[f64],
        torques: &mut [f64],
    ) -> Result<(), overact::Error>;
}

/// Controller of one run; allocates in `new` only.
pub(crate) struct Controller<'a> {
    model: &'a dyn Model,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    sampling_hz: f64,
    /// a of the filtered derivative.
    smoothing: f64,
    project: bool,
    limit: Option<&'a [f64]>,
    /// Whether each actuator is a cable; empty if none is.
    pulls: &'a [bool],
    /// Errors of the previous sample, unused before the first.
    previous: Vec<f64>,
    started: bool,
    derivative: Vec<f64>,
    command: Vec<f64>,
}

impl<'a> Controller<'a> {
    /// Controller for actuators with given effective inertias (kg m² or kg).
    pub(crate) fn new(model: &'a dyn Model, experiment: &'a Experiment, inertia: &[f64]) -> Self {
        let dof = model.info().sizes.dof;
        let rate = TAU * experiment.bandwidth_hz;
        Self {
            model,
            stiffness: inertia.iter().map(|m| rate * rate * m).collect(),
            damping: inertia
                .iter()
                .map(|m| 2.0 * experiment.damping * rate * m)
                .collect(),
            sampling_hz: experiment.sampling_hz,
            smoothing: smoothing(experiment),
            // Without redundancy there are no internal torques.
            project: experiment.project_internal && inertia.len() > dof,
            limit: experiment.torque_limit.as_deref(),
            pulls: model.pulls(),
            previous: vec![0.0; inertia.len()],
            started: false,
            derivative: vec![0.0; inertia.len()],
            command: vec![0.0; inertia.len()],
        }
    }
}

impl Control for Controller<'_> {
    fn step(
        &mut self,
        desired: &Desired<'_>,
        measured: &[f64],
        torques: &mut [f64],
    ) -> Result<(), overact::Error> {
        for (i, position) in measured.iter().enumerate() {
            let error = desired.positions[i] - position;
            let rate = if self.started {
                (error - self.previous[i]) * self.sampling_hz
            } else {
                0.0
            };
            self.previous[i] = error;
            self.derivative[i] += (1.0 - self.smoothing) * (rate - self.derivative[i]);
            let feedback = self.stiffness[i] * error + self.damping[i] * self.derivative[i];
            self.command[i] = match self.pulls.get(i) {
                None => {
                    desired.torques[i]
                        + self.stiffness[i] * error
                        + self.damping[i] * self.derivative[i]
                }
                Some(true) => -feedback,
                Some(false) => feedback,
            };
        }
        self.started = true;
        if self.project {
            let inputs: [&[f64]; 2] = [desired.pose, &self.command];
            self.model
                .evaluate(Function::ProjectTorques, &inputs, torques)
                .map_err(|e| e.error)?;
        } else {
            torques.copy_from_slice(&self.command);
        }
        if !self.pulls.is_empty() {
            let all = torques.iter_mut().zip(desired.torques);
            all.for_each(|(torque, forward)| *torque += forward);
        }
        for (torque, limit) in torques.iter_mut().zip(self.limit.unwrap_or(&[])) {
            *torque = torque.clamp(-limit, *limit);
        }
        let cables = torques.iter_mut().zip(self.pulls);
        for (tension, _) in cables.filter(|(_, pulls)| **pulls) {
            *tension = tension.max(0.0);
        }
        Ok(())
    }
}

/// Desired motion at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Desired<'a> {
    /// Platform pose.
    pub pose: &'a [f64],
    /// Twist, r numbers, m/s or rad/s.
    pub twist: &'a [f64],
    /// Its derivative, m/s² or rad/s².
    pub acceleration: &'a [f64],
    /// Positions of the n actuators, m or rad, unwrapped.
    pub positions: &'a [f64],
    /// Feed-forward torques, N m or N; zero without feed-forward.
    pub torques: &'a [f64],
}

/// a of the filtered derivative.
fn smoothing(experiment: &Experiment) -> f64 {
    (-TAU * experiment.derivative_cutoff_hz / experiment.sampling_hz).exp()
}

/// Spectral radius of one mode at the chosen bandwidth, sampled with held torques.
///
/// The loop is stable below one. The state is (x, v, x_{k-1}, d_{k-1}) of a unit mass.
pub(crate) fn spectral_radius(experiment: &Experiment) -> f64 {
    let (t, a) = (1.0 / experiment.sampling_hz, smoothing(experiment));
    let rate = TAU * experiment.bandwidth_hz;
    let difference = (1.0 - a) / t;
    let gain = 2.0 * experiment.damping * rate;
    let force = [
        -rate * rate - gain * difference,
        0.0,
        gain * difference,
        gain * a,
    ];
    let half = 0.5 * t * t;
    #[rustfmt::skip]
    let transition = Matrix4::new(
        1.0 + half * force[0], t, half * force[2], half * force[3],
        t * force[0], 1.0, t * force[2], t * force[3],
        1.0, 0.0, 0.0, 0.0,
        -difference, 0.0, difference, a,
    );
    let poles = transition.complex_eigenvalues();
    poles.iter().map(|pole| pole.norm()).fold(0.0, f64::max)
}

/// Effective inertias m_i = c d_i of the actuators; `poses` are spread along the run.
pub(crate) fn effective_inertia<'p>(
    model: &dyn Model,
    parameters: &[f64],
    poses: impl Iterator<Item = &'p [f64]>,
) -> Result<Vec<f64>, Cause> {
    let info = model.info();
    let (jacobian, mass) = jacobian_and_mass(model, parameters, info.home_pose)?;
    let normal = jacobian.tr_mul(&jacobian).cholesky().ok_or(Cause::Model(
        overact::Error::SingularPlatform {
            actuators: overact::ActuatorGroup::All,
            condition: f64::INFINITY,
        },
    ))?;
    let inverse = normal.solve(&jacobian.transpose());
    let inertia = inverse.tr_mul(&mass) * &inverse;
    let shares = inertia.diagonal();
    let mut largest = highest_ratio(&jacobian, &mass, shares.as_slice())?;
    for pose in poses {
        // The reference reports unreachable poses with their exact time.
        let Ok((jacobian, mass)) = jacobian_and_mass(model, parameters, pose) else {
            continue;
        };
        largest = largest.max(highest_ratio(&jacobian, &mass, shares.as_slice())?);
    }
    Ok(shares.iter().map(|share| share / largest).collect())
}

/// J_p^inv and M at a pose.
fn jacobian_and_mass(
    model: &dyn Model,
    parameters: &[f64],
    pose: &[f64],
) -> Result<(DMatrix<f64>, DMatrix<f64>), Cause> {
    let sizes = model.info().sizes;
    let failed = |e: overact::SampleError| Cause::Model(e.error);
    let mut jacobian = vec![0.0; sizes.actuators * sizes.dof];
    model
        .evaluate(Function::InverseJacobian, &[pose], &mut jacobian)
        .map_err(failed)?;
    let mut mass = vec![0.0; sizes.dof * sizes.dof];
    model
        .evaluate(
            Function::MassMatrix(Columns::Standard),
            &[pose, parameters],
            &mut mass,
        )
        .map_err(failed)?;
    Ok((
        DMatrix::from_row_slice(sizes.actuators, sizes.dof, &jacobian),
        DMatrix::from_row_slice(sizes.dof, sizes.dof, &mass),
    ))
}

/// Largest eigenvalue of M^-1 Jᵀ diag(m) J, by M = L Lᵀ as that of the symmetric L^-1 Jᵀ diag(m) J L^-T.
fn highest_ratio(
    jacobian: &DMatrix<f64>,
    mass: &DMatrix<f64>,
    inertia: &[f64],
) -> Result<f64, Cause> {
    let factor = mass.clone().cholesky().ok_or(Cause::MassMatrix)?.unpack();
    let scaled = factor
        .solve_lower_triangular(&jacobian.transpose())
        .ok_or(Cause::MassMatrix)?;
    let weights = DMatrix::from_diagonal(&nalgebra::DVector::from_column_slice(inertia));
    let ratios = SymmetricEigen::new(&scaled * weights * scaled.transpose()).eigenvalues;
    let highest = ratios.iter().copied().fold(0.0, f64::max);
    if highest.is_finite() && highest > 0.0 {
        Ok(highest)
    } else {
        Err(Cause::MassMatrix)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::{
        Robot,
        mechanisms::{DualV, Tripod, TwoMotors},
    };

    #[test]
    fn two_motors_share_the_inertia_of_one_mass() {
        let parameters = [0.3, 0.0, 0.0, 0.3, 0.0, 0.0, 1.0, 0.4];
        let inertia = effective_inertia(&Robot::new(TwoMotors), &parameters, std::iter::empty());
        // 2.0 kg in total.
        for m in inertia.unwrap() {
            assert!((m - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn no_mode_is_faster_than_the_bandwidth() {
        let model = Robot::new(DualV);
        let mut parameters = [0.0; 20];
        for (i, zz) in [4.45e-2, 4.81e-2, 4.81e-2, 5.07e-2].into_iter().enumerate() {
            parameters[3 * i] = zz;
        }
        parameters[12..16].copy_from_slice(&[1.92, 0.0, 0.0, 2.06e-2]);
        let poses = [[0.05, 0.02, 0.2], [-0.04, 0.03, -0.1]];
        let inertia =
            effective_inertia(&model, &parameters, poses.iter().map(|p| p.as_slice())).unwrap();
        let highest = poses.iter().map(|pose| {
            let (jacobian, mass) = jacobian_and_mass(&model, &parameters, pose).unwrap();
            highest_ratio(&jacobian, &mass, &inertia).unwrap()
        });
        assert!(highest.fold(0.0, f64::max) < 1.0 + 1e-12);
        assert!(inertia.iter().all(|m| *m > 0.02 && *m < 0.2), "{inertia:?}");
    }

    #[test]
    fn projection_removes_internal_torques_and_limits_are_kept() {
        let model = Robot::new(Tripod);
        let pose = [0.1, 0.2];
        let mut jacobian = [0.0; 6];
        model
            .evaluate(Function::InverseJacobian, &[&pose], &mut jacobian)
            .unwrap();
        let jacobian = DMatrix::from_row_slice(3, 2, &jacobian);
        let range = &jacobian * jacobian.clone().pseudo_inverse(1e-12).unwrap();
        let experiment = Experiment::default();
        let internal = |experiment: &Experiment| {
            let mut controller = Controller::new(&model, experiment, &[1.0, 1.0, 1.0]);
            let desired = Desired {
                pose: &pose,
                twist: &[0.0; 2],
                acceleration: &[0.0; 2],
                positions: &[1.0; 3],
                torques: &[1.0, 2.0, 3.0],
            };
            let mut torques = [0.0; 3];
            controller
                .step(&desired, &[0.999, 1.0, 1.001], &mut torques)
                .unwrap();
            let torques = DMatrix::from_column_slice(3, 1, &torques);
            ((&range * &torques - &torques).norm(), torques.amax())
        };
        assert!(internal(&experiment).0 < 1e-11);
        let free = Experiment {
            project_internal: false,
            ..experiment.clone()
        };
        assert!(internal(&free).0 > 1.0);
        let limited = Experiment {
            torque_limit: Some(vec![7.0; 3]),
            ..experiment
        };
        assert_eq!(internal(&limited).1, 7.0);
    }

    #[test]
    fn the_published_loop_is_stable_at_5_khz_but_not_at_600_hz() {
        let paper = Experiment::default();
        // The slowest pole of the continuous loop s³ + s² + 2.4 s + 1 (in units of ω_c) has the
        // real part −0.267. Sampling at 5 kHz adds delay but keeps the loop stable.
        let radius = spectral_radius(&paper);
        assert!(
            radius < 1.0 && radius > (-0.267 * TAU * 70.0 / 5000.0_f64).exp(),
            "{radius}"
        );
        let continuous = spectral_radius(&Experiment {
            sampling_hz: 1e6,
            ..paper.clone()
        });
        assert!((continuous.ln() * 1e6 / (TAU * 70.0) + 0.267).abs() < 2e-3);
        assert!(
            spectral_radius(&Experiment {
                sampling_hz: 600.0,
                ..paper
            }) > 1.0
        );
    }
}
