//! Designs a virtual experiment for a robot whose file has none.
//!
//! Motions stay within joint limits and away from singular configurations. Noise is proportional to
//! the torques.

mod balls;
mod course;
mod guide;
mod harmonics;
mod torques;

use crate::{
    assembly::{layout::Layout, network::Network},
    model::JointType,
    plan::{Leg, Plan},
};
use course::{Course, InfeasibleRun};
use guide::Guide;
use harmonics::{PERIODS, Shape, ready};

/// Virtual experiment for `overact simulate`.
#[derive(Debug)]
pub(crate) struct Experiment {
    /// Frequency of the first harmonic, Hz.
    pub(crate) fundamental: f64,
    /// Duration of each run, s.
    pub(crate) duration: f64,
    /// Training runs, and as the last one the validation run.
    pub(crate) runs: [Vec<Term>; RUNS],
    /// Resolution of each actuator's encoder, rad or m, in the order of the description.
    pub(crate) encoders: Vec<f64>,
    /// Standard deviation of each actuator's measured torque, N m or N.
    pub(crate) noise: Vec<f64>,
    /// Notes for the reader of the description.
    pub(crate) notes: Vec<String>,
}

/// One harmonic of a coordinate.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Term {
    pub(crate) coordinate: String,
    pub(crate) is_angle: bool,
    pub(crate) harmonic: usize,
    /// Amplitude, degrees or metres.
    pub(crate) amplitude: f64,
    /// Phase, whole degrees.
    pub(crate) phase: f64,
}

/// Ratio of the validation run's speed to that of the training runs.
pub(crate) const FASTER: f64 = 1.2;

/// Number of runs, the last of which is the validation run.
const RUNS: usize = 3;
/// Largest number of coordinates for which runs are designed.
const MOST: usize = 40;
/// Largest amplitude of a coordinate, rad and m.
const LARGEST: [f64; 2] = [0.5, 0.1];
/// Smallest useful amplitude, rad or m.
const SMALLEST: f64 = 4e-3;
/// Largest admissible ratio of the mass matrix along a run to that at its start.
const GROWTH: f64 = 8.0;
/// Largest number of amplitude reductions.
const TRIES: usize = 30;
/// Frequencies of the first harmonic, Hz.
const FUNDAMENTALS: [f64; 7] = [1.0, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05];

/// Designs an experiment; the error is the reason why there is none.
pub(crate) fn design(
    network: &Network<'_>,
    layout: &Layout,
    plan: &Plan,
) -> Result<Experiment, String> {
    if plan.platform.is_some() {
        return Err("its legs block some motions of the platform. Write runs of the independent coordinates, and `overact excite` improves them".to_owned());
    }
    let coordinates = coordinates(plan);
    if coordinates.len() > MOST {
        return Err(format!("it has more than {MOST} coordinates"));
    }
    let guide = Guide::new(network, layout, plan).ok_or("home is a singular configuration")?;
    if coordinates.len() != guide.count() {
        return Err("its coordinates are not those of joints of the file".to_owned());
    }
    let shapes = |run: usize| {
        (0..coordinates.len())
            .map(move |at| Shape::new(at, run))
            .collect()
    };
    let shapes: [Vec<Shape>; RUNS] = std::array::from_fn(shapes);
    let mut sizes: Vec<f64> = coordinates
        .iter()
        .map(|(_, is_angle)| LARGEST[usize::from(!is_angle)])
        .collect();
    let mut courses = Vec::new();
    let is_tree = network.model.closures.is_empty();
    let mut tries = 0;
    while courses.len() < RUNS {
        let reason = match Course::along(&guide, &shapes[courses.len()], &sizes) {
            // In a serial robot, no configuration turns small motions into large ones.
            Ok(course) if is_tree || torques::growth(&guide, &course) < GROWTH => {
                courses.push(course);
                continue;
            }
            Ok(_) => {
                sizes.iter_mut().for_each(|size| *size *= 0.8);
                "its inertia varies strongly".to_owned()
            }
            Err(InfeasibleRun::Limit { joint, share }) => {
                shorten(&mut sizes, &share);
                format!("`{}` meets its limit", network.model.joints[joint].name)
            }
            Err(InfeasibleRun::Singular) => {
                sizes.iter_mut().for_each(|size| *size *= 0.8);
                "a singular configuration is near".to_owned()
            }
        };
        // A smaller amplitude is another motion, so all runs are traced again.
        courses.clear();
        tries += 1;
        if tries > TRIES || sizes.iter().all(|size| *size < SMALLEST) {
            return Err(format!("no motion around home is possible: {reason}"));
        }
    }
    let speeds = courses.iter().map(|course| course.fastest(&guide));
    let fastest = speeds.fold(0.0, f64::max);
    let fundamental = FUNDAMENTALS
        .iter()
        .copied()
        .find(|f| f * FASTER * fastest <= 1.0);
    let fundamental = fundamental.unwrap_or(FUNDAMENTALS[FUNDAMENTALS.len() - 1]);
    let sizes_of_torques = torques::sizes(&guide, &courses[0], fundamental)
        .ok_or("the masses and inertias of the file do not determine how it accelerates")?;
    let order = guide.actuators_in_order(&actuators(plan));
    let noise = order
        .iter()
        .map(|&at| ready(0.005 * sizes_of_torques[at], 1))
        .collect();
    let encoders = order
        .iter()
        .map(|&at| match network.model.joints[guide.actuators[at]].kind {
            JointType::Prismatic => 1e-6,
            JointType::Revolute | JointType::Ball => 1e-5,
        });
    let terms = |shapes: &[Shape]| {
        let named = coordinates.iter().zip(shapes).zip(&sizes);
        named
            .flat_map(|(((name, is_angle), shape), size)| shape.terms(name, *is_angle, *size))
            .collect()
    };
    Ok(Experiment {
        fundamental,
        duration: (PERIODS / fundamental).max(10.0).ceil(),
        runs: shapes.each_ref().map(|shapes| terms(shapes)),
        encoders: encoders.collect(),
        noise,
        notes: guide.notes(),
    })
}

/// Independent coordinates of the description: names of joints, and whether they are angles.
fn coordinates(plan: &Plan) -> Vec<(String, bool)> {
    let trees = plan.legs.iter().enumerate();
    let trees = trees.filter(|(_, leg)| leg.end.is_none());
    let of_tree = |(at, leg): (usize, &'_ Leg)| {
        let moved = leg.joints.iter();
        let moved = moved.filter(|joint| {
            joint.kind != "fixed" && joint.follows.is_none() && !joint.is_dependent
        });
        let named = moved.map(|joint| {
            let name = match at {
                0 => joint.name.clone(),
                _ => format!("{}.{}", leg.name, joint.name),
            };
            (name, joint.kind != "prismatic")
        });
        named.collect::<Vec<_>>()
    };
    trees.flat_map(of_tree).collect()
}

/// Actuated joints of the file, in the order of the description.
fn actuators(plan: &Plan) -> Vec<usize> {
    let joints = plan.legs.iter().flat_map(|leg: &Leg| &leg.joints);
    joints
        .filter(|joint| joint.actuated)
        .filter_map(|joint| joint.of)
        .collect()
}

/// Reduces the coordinates that contribute most to a joint's limit violation.
fn shorten(sizes: &mut [f64], share: &[f64]) {
    let largest = share.iter().copied().fold(0.0, f64::max);
    for (size, share) in sizes.iter_mut().zip(share) {
        if *share >= 0.5 * largest {
            *size *= 0.8;
        }
    }
}
