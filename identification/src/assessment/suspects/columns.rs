//! The suspects and their columns.

use overact::{Info, Model};

use crate::{kinematics::Motion, regression::projection::ModelKind};

/// A fault of one unknown size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Suspect {
    /// Torques are late by so many seconds.
    Delay,
    /// The measured torque of an actuator is too large by this part of itself.
    Gain(usize),
    /// The sampling frequency is too high by this part of itself.
    Clock,
    /// The position of an actuator is too large by this angle or length.
    Offset(usize),
    /// The position of an actuator is behind by this half of a play.
    Play(usize),
    /// A torque of an actuator that the model lacks.
    Torque(usize, Shape),
    /// A force on a coordinate of the platform that the model lacks.
    Force(usize, Shape),
}

/// How something that the model lacks depends on the motion of its actuator or coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    /// 1: an offset of the torque, or friction that differs by direction.
    Constant,
    /// The velocity.
    Velocity,
    /// The sign of the velocity.
    Sign,
    /// The magnitude of the velocity: viscous friction that differs by direction.
    Speed,
    /// The square of the velocity, with its sign: a drag.
    Drag,
    /// The acceleration.
    Acceleration,
    /// The position: a spring.
    Position,
    /// The cosine of the position.
    Cosine,
    /// The sine of the position.
    Sine,
    /// The time since the beginning of the run: a drift.
    Time,
    /// The time where the velocity is positive, less the time where it is negative: friction that changes.
    TimeSign,
}

/// Shapes of an actuator.
const SHAPES: [Shape; 11] = [
    Shape::Constant,
    Shape::Velocity,
    Shape::Sign,
    Shape::Speed,
    Shape::Drag,
    Shape::Acceleration,
    Shape::Position,
    Shape::Cosine,
    Shape::Sine,
    Shape::Time,
    Shape::TimeSign,
];

impl Shape {
    /// What it is called in a sentence.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::Constant => "a constant, as an offset or friction that differs by direction",
            Self::Velocity => "the velocity, as viscous friction",
            Self::Sign => "the sign of the velocity, as dry friction",
            Self::Speed => {
                "the magnitude of the velocity, as viscous friction that differs by direction"
            }
            Self::Drag => "the square of the velocity, as drag",
            Self::Acceleration => "the acceleration, as inertia",
            Self::Position => "the position, as a spring",
            Self::Cosine => "the cosine of the position, as gravity",
            Self::Sine => "the sine of the position, as gravity",
            Self::Time => "time, as a drift",
            Self::TimeSign => "time and the sign of the velocity, as friction that changes",
        }
    }

    /// Its value at a motion.
    fn value(self, motion: Moment) -> f64 {
        let Moment {
            position,
            velocity,
            acceleration,
            time,
        } = motion;
        let sign = if velocity == 0.0 {
            0.0
        } else {
            velocity.signum()
        };
        match self {
            Self::Constant => 1.0,
            Self::Velocity => velocity,
            Self::Sign => sign,
            Self::Speed => velocity.abs(),
            Self::Drag => velocity * velocity.abs(),
            Self::Acceleration => acceleration,
            Self::Position => position,
            Self::Cosine => position.cos(),
            Self::Sine => position.sin(),
            Self::Time => time,
            Self::TimeSign => time * sign,
        }
    }
}

/// The motion of an actuator or a coordinate at one time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Moment {
    pub(super) position: f64,
    pub(super) velocity: f64,
    pub(super) acceleration: f64,
    pub(super) time: f64,
}

/// The suspects of a robot whose estimate explains the inputs of a model.
pub(super) fn suspects(model: &dyn Model, kind: ModelKind) -> Vec<Suspect> {
    let info = model.info();
    let sizes = info.sizes;
    let mut all = vec![Suspect::Delay, Suspect::Clock];
    all.extend((0..sizes.actuators).map(Suspect::Gain));
    // With more actuators than degrees of freedom the closure tells.
    if sizes.actuators == sizes.dof {
        all.extend((0..sizes.actuators).map(Suspect::Offset));
        all.extend((0..sizes.actuators).map(Suspect::Play));
    }
    for actuator in 0..sizes.actuators {
        // An angle that is unwound has no place among springs, but its sine has; a length has neither.
        let revolute = info.actuator_is_revolute.get(actuator) == Some(&true);
        let shapes = SHAPES
            .into_iter()
            .filter(|shape| revolute || !matches!(shape, Shape::Cosine | Shape::Sine));
        all.extend(shapes.map(|shape| Suspect::Torque(actuator, shape)));
    }
    if kind == ModelKind::Platform {
        for line in 0..sizes.dof {
            all.push(Suspect::Force(line, Shape::Constant));
            if sizes.pose == sizes.dof {
                all.push(Suspect::Force(line, Shape::Position));
            }
        }
    }
    all
}

/// What the columns of a sample are made of.
pub(super) struct Sample<'a> {
    /// J_p^inv, n x r.
    pub(super) jacobian: &'a [f64],
    /// Torques freed of the residual, and their derivatives.
    pub(super) torques: &'a [f64],
    pub(super) torque_rates: &'a [f64],
    /// The motion of the actuators.
    pub(super) actuators: &'a [Moment],
    /// The pose.
    pub(super) pose: &'a [f64],
    /// By how much Γ¹ would change with the clock, and with the position of each actuator, n x r; empty
    /// where that is not asked for.
    pub(super) clock: &'a [f64],
    pub(super) offsets: &'a [f64],
}

impl Sample<'_> {
    /// The entry of a suspect's column in a line of Γ¹.
    pub(super) fn entry(&self, suspect: Suspect, line: usize) -> f64 {
        let r = self.jacobian.len() / self.torques.len();
        let share = |actuator: usize| self.jacobian[actuator * r + line];
        match suspect {
            Suspect::Delay => {
                let rates = self.torque_rates.iter().enumerate();
                -rates.map(|(i, rate)| share(i) * rate).sum::<f64>()
            }
            Suspect::Gain(i) => share(i) * self.torques[i],
            Suspect::Clock => self.clock[line],
            Suspect::Offset(i) => self.offsets[i * r + line],
            Suspect::Play(i) => Shape::Sign.value(self.actuators[i]) * self.offsets[i * r + line],
            Suspect::Torque(i, shape) => share(i) * shape.value(self.actuators[i]),
            Suspect::Force(own, _) if own != line => 0.0,
            Suspect::Force(own, shape) => shape.value(Moment {
                position: self.pose.get(own).copied().unwrap_or(0.0),
                ..Moment::default()
            }),
        }
    }
}

/// The motion of all actuators at all samples of a motion, samples x n.
pub(super) fn moments(
    info: &Info<'_>,
    motion: &Motion,
    positions: &[f64],
    jacobians: &[f64],
) -> Vec<Moment> {
    let (n, r) = (info.sizes.actuators, info.sizes.dof);
    let velocity = |sample: usize, actuator: usize| -> f64 {
        let first = (sample * n + actuator) * r;
        let row = &jacobians[first..first + r];
        let twist = &motion.twist[sample * r..(sample + 1) * r];
        row.iter().zip(twist).map(|(a, b)| a * b).sum()
    };
    let velocities: Vec<f64> = (0..motion.samples * n)
        .map(|place| velocity(place / n, place % n))
        .collect();
    let rates = rates(&velocities, n, motion.sampling_frequency);
    (0..motion.samples * n)
        .map(|place| Moment {
            position: positions[place],
            velocity: velocities[place],
            acceleration: rates[place],
            time: motion.time(place / n),
        })
        .collect()
}

/// Derivatives of `width` signals that stand side by side, by central differences; one-sided at both
/// ends.
pub(super) fn rates(values: &[f64], width: usize, frequency: f64) -> Vec<f64> {
    let samples = values.len() / width.max(1);
    let last = samples.saturating_sub(1);
    (0..values.len())
        .map(|place| {
            let (sample, column) = (place / width, place % width);
            let (before, behind) = (sample.saturating_sub(1), (sample + 1).min(last));
            let span = (behind - before).max(1) as f64;
            frequency * (values[behind * width + column] - values[before * width + column]) / span
        })
        .collect()
}
