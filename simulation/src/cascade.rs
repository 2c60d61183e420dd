//! Robot under the position and velocity loops of industrial drives, along a recorded reference.
//!
//! At each sample the drive of every actuator computes
//!
//! ```text
//! u = k_v (k_p (q_d - q) - q̇),   |u| <= u_max,   τ = g u
//! ```
//!
//! from the exact position and velocity, and holds the torque until the next sample. Between
//! samples the plant is integrated by the fourth-order Runge-Kutta method, one step per sampling
//! period. The robot starts at rest at the start of the reference. Sensors are ideal: the result is
//! the robot's motion without measurement errors.

use overact::{Function, Model};

use crate::{
    error::{Cause, Error, RunError, Stage},
    plant::Plant,
    reference::follow,
    run::Record,
};

/// Tracking error (rad or m) at which an actuator has left its reference.
const LOST: f64 = 1.0;

/// Loops of all drives, with one value per actuator.
#[derive(Debug, Clone, PartialEq)]
pub struct Cascade {
    /// k_p, 1/s.
    pub position_gain: Vec<f64>,
    /// k_v, units of u in (m/s) or (rad/s).
    pub velocity_gain: Vec<f64>,
    /// g, N or N m for each unit of u.
    pub drive_gain: Vec<f64>,
    /// u_max; `None` for no limit.
    pub limit: Option<Vec<f64>>,
}

/// A recorded reference.
#[derive(Debug, Clone, Copy)]
pub struct Recorded<'a> {
    /// Name of the run.
    pub run: &'a str,
    /// Whether the payload is on the platform.
    pub payload: bool,
    /// Sampling frequency, Hz.
    pub sampling_hz: f64,
    /// Desired actuator positions, samples x n (m, rad).
    pub positions: &'a [f64],
}

/// Motion of a robot along a reference.
///
/// The payload's parameters come last and are zero in a run without payload.
///
/// # Errors
/// A reference that the robot cannot start from, a robot that leaves it, or parameters without
/// mass.
pub fn follow_recorded(
    model: &dyn Model,
    cascade: &Cascade,
    parameters: &[f64],
    reference: Recorded<'_>,
) -> Result<Record, Error> {
    let info = model.info();
    let (sizes, n) = (info.sizes, info.sizes.actuators);
    let located = |sample: usize, stage: Stage| {
        move |cause| {
            Error::Runs(vec![RunError {
                run: reference.run.to_owned(),
                time_s: sample as f64 / reference.sampling_hz,
                stage,
                cause,
            }])
        }
    };
    let samples = reference.positions.len() / n;
    let mut record = empty(&reference, info.actuators, samples);
    let mut pose = info.home_pose.to_vec();
    let start = reference.positions.get(..n).unwrap_or(&[]);
    model
        .pose_from_actuators(start, &mut pose)
        .map_err(|error| located(0, Stage::Trajectory)(Cause::Model(error)))?;
    let mut plant = Plant::new(model, parameters, &pose, &vec![0.0; sizes.dof]);
    let mut last = start.to_vec();
    let mut torques = vec![0.0; n];
    for (sample, desired) in reference.positions.chunks_exact(n).enumerate() {
        let at = located(sample, Stage::Plant);
        let (mut positions, velocities) = actuators(model, &plant).map_err(&at)?;
        follow(&mut positions, &last, info.actuator_is_revolute);
        for i in 0..n {
            let error = desired[i] - positions[i];
            if error.is_nan() || error.abs() > LOST {
                let actuator = info.actuators[i].to_owned();
                return Err(at(Cause::Lost { actuator, error }));
            }
            record.tracking_error[i] = record.tracking_error[i].max(error.abs());
            torques[i] = cascade.torque(i, error, velocities[i]);
        }
        record.positions.extend_from_slice(&positions);
        record.torques.extend_from_slice(&torques);
        last = positions;
        plant
            .advance(&torques, 1.0 / reference.sampling_hz, 1)
            .map_err(&at)?;
    }
    Ok(record)
}

impl Cascade {
    /// Torque τ of an actuator.
    fn torque(&self, actuator: usize, error: f64, velocity: f64) -> f64 {
        let wanted = self.position_gain[actuator] * error - velocity;
        let signal = self.velocity_gain[actuator] * wanted;
        let limited = self.limit.as_ref().map_or(signal, |limit| {
            signal.clamp(-limit[actuator], limit[actuator])
        });
        self.drive_gain[actuator] * limited
    }
}

/// A record without samples.
fn empty(reference: &Recorded<'_>, actuators: &[&str], samples: usize) -> Record {
    let n = actuators.len();
    let time = (0..samples).map(|k| k as f64 / reference.sampling_hz);
    Record {
        name: reference.run.to_owned(),
        payload: reference.payload,
        sampling_hz: reference.sampling_hz,
        actuators: actuators.iter().map(ToString::to_string).collect(),
        time: time.collect(),
        positions: Vec::with_capacity(samples * n),
        torques: Vec::with_capacity(samples * n),
        tracking_error: vec![0.0; n],
    }
}

/// Positions and velocities q̇ = J_p^inv v of the actuators.
fn actuators(model: &dyn Model, plant: &Plant<'_>) -> Result<(Vec<f64>, Vec<f64>), Cause> {
    let sizes = model.info().sizes;
    let failed = |error: overact::SampleError| Cause::Model(error.error);
    let mut positions = vec![0.0; sizes.actuators];
    let pose: [&[f64]; 1] = [&plant.pose];
    model
        .evaluate(Function::ActuatorPositions, &pose, &mut positions)
        .map_err(failed)?;
    let mut jacobian = vec![0.0; sizes.actuators * sizes.dof];
    model
        .evaluate(Function::InverseJacobian, &pose, &mut jacobian)
        .map_err(failed)?;
    let rate = |row: &[f64]| row.iter().zip(&plant.twist).map(|(a, b)| a * b).sum();
    let velocities = jacobian.chunks_exact(sizes.dof).map(rate).collect();
    Ok((positions, velocities))
}

#[cfg(test)]
mod tests {
    use super::{Cascade, Recorded, follow_recorded};
    use crate::support::{Robot, mechanisms::TwoMotors};
    use overact::{Error, Function, Info, Model, SampleError};

    /// Two motors on one mass; the pose is the position of the first motor.
    struct Slide(Robot<TwoMotors>);

    impl Model for Slide {
        fn info(&self) -> Info<'_> {
            self.0.info()
        }

        fn evaluate(
            &self,
            function: Function,
            inputs: &[&[f64]],
            output: &mut [f64],
        ) -> Result<(), SampleError> {
            self.0.evaluate(function, inputs, output)
        }

        fn pose_from_actuators(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error> {
            pose[0] = actuators[0];
            Ok(())
        }
    }

    #[test]
    fn cascaded_drives_follow_the_expected_step_response() {
        let model = Slide(Robot::new(TwoMotors));
        // 2 kg in total, no friction: half of it for each drive.
        let parameters = [0.3, 0.0, 0.0, 0.3, 0.0, 0.0, 1.0, 0.4];
        let cascade = Cascade {
            position_gain: vec![10.0; 2],
            velocity_gain: vec![20.0; 2],
            drive_gain: vec![2.0; 2],
            limit: Some(vec![1.0; 2]),
        };
        let step: Vec<f64> = (0..2 * 2000)
            .map(|k| if k < 2 { 0.0 } else { 0.1 })
            .collect();
        let reference = Recorded {
            run: "step",
            payload: true,
            sampling_hz: 1000.0,
            positions: &step,
        };
        let record = follow_recorded(&model, &cascade, &parameters, reference).unwrap();
        // At first limited: 2 N from each drive, 2 m/s².
        assert!((record.torques[2] - 2.0).abs() < 1e-12);
        assert!((record.positions[2 * 51] - 0.5 * 2.0 * 0.05_f64.powi(2)).abs() < 1e-9);
        let last = record.positions[record.positions.len() - 1];
        assert!((last - 0.1).abs() < 1e-6, "{last}");
    }
}
