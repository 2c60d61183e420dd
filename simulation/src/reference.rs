//! Desired motion of platform and actuators, block by block.
//!
//! In blocks, a model evaluates many samples in one call, and memory does not grow with the run.
//!
//! If the platform coordinates are additive, twist and acceleration are the derivatives of the
//! trajectory's displacement. With a quaternion they are computed from the actuators' motion,
//! whatever chart the model's `displace` defines. q(t) comes from inverse kinematics and its
//! derivatives from central differences of sixth order. Then v follows from eq. (21) and v̇ from
//! eq. (24), which are exact for consistent q̇ and q̈.
//!
//! For periodic trajectories the relative error of the differences is about 1e-9. For
//! point-to-point motions of a robot with a quaternion, it is larger near the points, where the
//! jerk jumps.

use overact::{Columns, Function, Info, Model, math::wrap_angle};

use crate::{
    controller::Desired,
    trajectory::{Displacement, Trajectory},
};

/// Samples per block.
pub(crate) const BLOCK: usize = 256;

/// Sample of the run and error of the model there.
pub(crate) type AtSample = (usize, overact::Error);

/// A desired motion at equal time steps, with one row of numbers per sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// Poses.
    pub pose: Vec<f64>,
    /// Twists, r numbers each, m/s or rad/s.
    pub twist: Vec<f64>,
    /// Their derivatives, r numbers each, m/s² or rad/s².
    pub acceleration: Vec<f64>,
    /// Positions of the n actuators, m or rad, unwrapped.
    pub positions: Vec<f64>,
}

/// First `samples` samples of a trajectory, `1 / sampling_hz` seconds apart.
///
/// # Errors
/// The model's error at the first sample that the robot does not reach.
pub fn sample(
    model: &dyn Model,
    trajectory: &Trajectory,
    sampling_hz: f64,
    samples: usize,
) -> Result<Sampled, overact::Error> {
    let mut reference = Reference::new(model, trajectory, sampling_hz, None);
    reference.fill(0, samples).map_err(|(_, error)| error)?;
    let Reference {
        pose,
        twist,
        acceleration,
        positions,
        ..
    } = reference;
    Ok(Sampled {
        pose,
        twist,
        acceleration,
        positions,
    })
}

/// The desired motion of one run.
pub(crate) struct Reference<'a> {
    model: &'a dyn Model,
    info: Info<'a>,
    trajectory: &'a Trajectory,
    sampling_hz: f64,
    /// Parameters for feed-forward, if it is on.
    parameters: Option<&'a [f64]>,
    /// Poses of the block.
    pub(crate) pose: Vec<f64>,
    /// Twists of the block, r each.
    pub(crate) twist: Vec<f64>,
    /// Their derivatives, r each.
    pub(crate) acceleration: Vec<f64>,
    /// Actuator positions of the block, n each, continuous across blocks.
    pub(crate) positions: Vec<f64>,
    /// Least-norm torques of the inverse dynamics, n each; zero without feed-forward.
    pub(crate) torques: Vec<f64>,
    /// Positions of the actuators at the sample before the block.
    last: Option<Vec<f64>>,
}

impl<'a> Reference<'a> {
    pub(crate) fn new(
        model: &'a dyn Model,
        trajectory: &'a Trajectory,
        sampling_hz: f64,
        parameters: Option<&'a [f64]>,
    ) -> Self {
        Self {
            info: model.info(),
            model,
            trajectory,
            sampling_hz,
            parameters,
            pose: Vec::new(),
            twist: Vec::new(),
            acceleration: Vec::new(),
            positions: Vec::new(),
            torques: Vec::new(),
            last: None,
        }
    }

    /// Fills the block with the samples `first .. first + count`; blocks must be consecutive.
    pub(crate) fn fill(&mut self, first: usize, count: usize) -> Result<(), AtSample> {
        let sizes = self.info.sizes;
        self.pose.resize(count * sizes.pose, 0.0);
        self.twist.resize(count * sizes.dof, 0.0);
        self.acceleration.resize(count * sizes.dof, 0.0);
        self.positions.resize(count * sizes.actuators, 0.0);
        self.torques.resize(count * sizes.actuators, 0.0);
        self.motion(first)
            .map_err(|(sample, error)| (first + sample, error))?;
        let located = |e: overact::SampleError| (first + e.sample, e.error);
        self.model
            .evaluate(
                Function::ActuatorPositions,
                &[&self.pose],
                &mut self.positions,
            )
            .map_err(located)?;
        if let Some(parameters) = self.parameters {
            let inputs: [&[f64]; 4] = [&self.pose, &self.twist, &self.acceleration, parameters];
            self.model
                .evaluate(
                    Function::InverseDynamics(Columns::Standard),
                    &inputs,
                    &mut self.torques,
                )
                .map_err(located)?;
        }
        self.make_continuous();
        Ok(())
    }

    /// Desired motion at one sample of the block.
    pub(crate) fn row(&self, row: usize) -> Desired<'_> {
        let sizes = self.info.sizes;
        let actuators = row * sizes.actuators..(row + 1) * sizes.actuators;
        let platform = row * sizes.dof..(row + 1) * sizes.dof;
        Desired {
            pose: &self.pose[row * sizes.pose..(row + 1) * sizes.pose],
            twist: &self.twist[platform.clone()],
            acceleration: &self.acceleration[platform],
            positions: &self.positions[actuators.clone()],
            torques: &self.torques[actuators],
        }
    }

    /// Poses, twists and accelerations of the block.
    fn motion(&mut self, first: usize) -> Result<(), AtSample> {
        let sizes = self.info.sizes;
        let additive = sizes.pose == sizes.dof;
        let mut displacement = vec![0.0; sizes.dof];
        for sample in 0..self.twist.len() / sizes.dof {
            let t = (first + sample) as f64 / self.sampling_hz;
            let row = sample * sizes.dof..(sample + 1) * sizes.dof;
            let mut out = Displacement {
                position: &mut displacement,
                velocity: &mut self.twist[row.clone()],
                acceleration: &mut self.acceleration[row.clone()],
            };
            self.trajectory.evaluate(self.info.coordinates, t, &mut out);
            let pose = &mut self.pose[sample * sizes.pose..(sample + 1) * sizes.pose];
            pose.copy_from_slice(self.info.home_pose);
            self.model.displace(pose, &displacement);
            if !additive {
                self.differentiate(sample, t)
                    .map_err(|error| (sample, error))?;
            }
        }
        Ok(())
    }

    /// Twist and acceleration of one sample from the actuators' motion around it.
    fn differentiate(&mut self, sample: usize, t: f64) -> Result<(), overact::Error> {
        const FIRST: [f64; 3] = [45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0];
        const SECOND: [f64; 3] = [270.0 / 180.0, -27.0 / 180.0, 2.0 / 180.0];
        let sizes = self.info.sizes;
        let h = 0.03 * self.trajectory.time_scale();
        let centre = self.actuators_at(t)?;
        let mut velocity = vec![0.0; sizes.actuators];
        let mut acceleration = vec![0.0; sizes.actuators];
        for (k, (first, second)) in FIRST.iter().zip(SECOND).enumerate() {
            let away = h * (k + 1) as f64;
            let (after, before) = (self.actuators_at(t + away)?, self.actuators_at(t - away)?);
            for i in 0..sizes.actuators {
                let revolute = self.info.actuator_is_revolute[i];
                let ahead = difference(after[i], centre[i], revolute);
                let behind = difference(before[i], centre[i], revolute);
                velocity[i] += first * (ahead - behind) / h;
                acceleration[i] += second * (ahead + behind) / (h * h);
            }
        }
        let pose = &self.pose[sample * sizes.pose..(sample + 1) * sizes.pose];
        let row = sample * sizes.dof..(sample + 1) * sizes.dof;
        let twist = &mut self.twist[row.clone()];
        self.model
            .evaluate(Function::TwistFromActuators, &[pose, &velocity], twist)
            .map_err(|e| e.error)?;
        self.model
            .evaluate(
                Function::AccelerationFromActuators,
                &[pose, twist, &acceleration],
                &mut self.acceleration[row],
            )
            .map_err(|e| e.error)
    }

    /// Actuator positions of the desired pose at a time.
    fn actuators_at(&self, t: f64) -> Result<Vec<f64>, overact::Error> {
        let pose = pose_at(self.model, self.trajectory, t);
        let mut positions = vec![0.0; self.info.sizes.actuators];
        self.model
            .evaluate(Function::ActuatorPositions, &[&pose], &mut positions)
            .map_err(|e| e.error)?;
        Ok(positions)
    }

    /// Unwraps the angles of the actuators.
    fn make_continuous(&mut self) {
        let n = self.info.sizes.actuators;
        let mut last = self.last.take();
        for row in self.positions.chunks_exact_mut(n) {
            let previous = last.get_or_insert_with(|| row.to_vec());
            follow(row, previous, self.info.actuator_is_revolute);
            previous.copy_from_slice(row);
        }
        self.last = last;
    }
}

/// The desired pose at a time.
pub(crate) fn pose_at(model: &dyn Model, trajectory: &Trajectory, t: f64) -> Vec<f64> {
    let info = model.info();
    let mut rows = vec![0.0; 3 * info.sizes.dof];
    let (position, rest) = rows.split_at_mut(info.sizes.dof);
    let (velocity, acceleration) = rest.split_at_mut(info.sizes.dof);
    trajectory.evaluate(
        info.coordinates,
        t,
        &mut Displacement {
            position,
            velocity,
            acceleration,
        },
    );
    let mut pose = info.home_pose.to_vec();
    model.displace(&mut pose, position);
    pose
}

/// Shifts each angle by full turns to be nearest to the previous value.
pub(crate) fn follow(positions: &mut [f64], previous: &[f64], revolute: &[bool]) {
    for ((position, previous), revolute) in positions.iter_mut().zip(previous).zip(revolute) {
        if *revolute {
            let step = *position - previous;
            // An angle without jump keeps all its digits.
            if step.abs() > std::f64::consts::PI {
                *position = previous + wrap_angle(step);
            }
        }
    }
}

/// Difference of two positions; angles modulo a turn.
fn difference(a: f64, b: f64, revolute: bool) -> f64 {
    if revolute { wrap_angle(a - b) } else { a - b }
}
