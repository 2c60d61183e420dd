//! Sizes and limits of the description, to check the units of a log.

use crate::robot::Robot;
use overact::{Info, Model};
use overact_codegen::{
    description::Experiment,
    mechanism::{Joint, JointKind, Leg},
};
use overact_identification::{ActuatorRange, Scales};
use std::f64::consts::TAU;

impl Robot {
    /// Reach, sampling and limits of the description.
    #[must_use]
    pub fn scales(&self) -> Scales {
        let description = self.description();
        let info = self.model().info();
        let experiment = description.experiment.as_ref();
        let excitation = description.excitation.as_ref();
        let swept = experiment.map(|table| Sweep::new(table, &info));
        let swept = swept.unwrap_or_default();
        let limit = |own: Option<&Vec<f64>>, otherwise: Vec<f64>| own.cloned().unwrap_or(otherwise);
        let torque = experiment.and_then(|table| table.torque_limit.clone());
        Scales {
            length: reach(&self.model().model().mechanism.legs, info.home_joints),
            sampling: experiment.map(|table| table.sampling),
            torque: torque.unwrap_or_default(),
            travel: limit(excitation.and_then(|one| one.travel.as_ref()), swept.travel),
            velocity: limit(
                excitation.and_then(|one| one.velocity.as_ref()),
                swept.velocity,
            ),
        }
    }
}

impl Robot {
    /// Enters the described limits of the motion: those of the table `excitation`.
    pub(crate) fn set_limits(&self, ranges: &mut [ActuatorRange]) {
        let Some(table) = &self.description().excitation else {
            return;
        };
        let info = self.model().info();
        let at = |values: &Option<Vec<f64>>, place: usize| values.as_ref()?.get(place).copied();
        for (place, range) in ranges.iter_mut().enumerate() {
            let home = self.model().of_actuator(place, info.home_joints);
            let travel = at(&table.travel, place);
            range.position_limits = travel.map(|travel| [home - travel, home + travel]);
            range.velocity_limit = at(&table.velocity, place);
            range.acceleration_limit = at(&table.acceleration, place);
        }
    }
}

/// Largest of: length of a leg, distance between leg bases, distance between leg ends, m.
fn reach(legs: &[Leg], home_joints: &[f64]) -> f64 {
    let mut home = home_joints.iter().copied();
    let sums = legs.iter().map(|leg| {
        let of_joint = |(index, joint): (usize, &Joint)| {
            let is_independent = leg.independent().any(|own| own == index);
            let position = if is_independent { home.next() } else { None };
            length(joint, position.unwrap_or(0.0))
        };
        leg.joints.iter().enumerate().map(of_joint).sum::<f64>()
    });
    let longest = sums.fold(0.0, f64::max);
    let bases = legs.iter().map(|leg| leg.base.at.map(|one| one.value()));
    let ends =
        { legs.iter() }.filter_map(|leg| Some(leg.end.as_ref()?.point().map(|one| one.value())));
    longest
        .max(spread(&bases.collect::<Vec<_>>()))
        .max(spread(&ends.collect::<Vec<_>>()))
}

/// Distance of a joint's frame from the previous one, m.
fn length(joint: &Joint, position: f64) -> f64 {
    let slide = if joint.kind == JointKind::Prismatic {
        position
    } else {
        0.0
    };
    let along = joint.r.value() + slide;
    joint.d.value().hypot(joint.b.value()).hypot(along)
}

/// The largest distance between two points, m.
fn spread(points: &[[f64; 3]]) -> f64 {
    let distance = |a: &[f64; 3], b: &[f64; 3]| {
        let square = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
        square.sum::<f64>().sqrt()
    };
    let pairs = points.iter().enumerate();
    let pairs = pairs.flat_map(|(place, a)| points[place + 1..].iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| distance(a, b)).fold(0.0, f64::max)
}

/// Travel and speed of the drives in the virtual experiment; empty if its coordinates are not the
/// drives.
#[derive(Default)]
struct Sweep {
    travel: Vec<f64>,
    velocity: Vec<f64>,
}

impl Sweep {
    fn new(table: &Experiment, info: &Info<'_>) -> Self {
        if info.coordinates != info.actuators {
            return Self::default();
        }
        let mut sweep = Self {
            travel: vec![0.0; info.actuators.len()],
            velocity: vec![0.0; info.actuators.len()],
        };
        for run in &table.runs {
            let mut own = [
                vec![0.0; info.actuators.len()],
                vec![0.0; info.actuators.len()],
            ];
            for term in &run.terms {
                let rate = TAU * f64::from(term.harmonic) * run.fundamental;
                own[0][term.index] += term.amplitude.abs();
                own[1][term.index] += rate * term.amplitude.abs();
            }
            let [travel, velocity] = own;
            let larger = |all: &mut Vec<f64>, own: Vec<f64>| {
                all.iter_mut()
                    .zip(own)
                    .for_each(|(most, own)| *most = most.max(own));
            };
            larger(&mut sweep.travel, travel);
            larger(&mut sweep.velocity, velocity);
        }
        sweep
    }
}
