//! Traces a run in small steps and checks closures, singularities and joint limits.

use super::{guide::Guide, harmonics::Shape};
use crate::{assembly::motion::State, model::JointType};
use nalgebra::{DMatrix, DVector};

/// Reason why a run is not feasible.
pub(super) enum InfeasibleRun {
    /// A joint exceeds its limits; `share` is the contribution of each coordinate.
    Limit { joint: usize, share: Vec<f64> },
    /// The configuration is nearly singular, or the loops do not close.
    Singular,
}

/// Configurations of a run over one period.
pub(super) struct Course {
    pub(super) stops: Vec<Stop>,
}

/// One configuration of a run.
pub(super) struct Stop {
    pub(super) state: State,
    /// Velocities of the tree's coordinates for unit rates of the coordinates.
    pub(super) tree: DMatrix<f64>,
    /// Velocities of the actuated joints for unit rates of the coordinates.
    pub(super) actuators: DMatrix<f64>,
    /// Rates and accelerations of the coordinates, with the period of the first harmonic as time
    /// unit.
    pub(super) rates: DVector<f64>,
    pub(super) accelerations: DVector<f64>,
}

/// Default speed limit, rad/s and m/s, if the file gives none.
const USUAL: [f64; 2] = [6.0, 1.0];
/// Steps of one period, and steps from home to its start.
const STEPS: u32 = 120;
const APPROACH: u32 = 8;

impl Course {
    /// Traces the run with given shapes and amplitudes about home.
    pub(super) fn along(
        guide: &Guide<'_, '_>,
        shapes: &[Shape],
        sizes: &[f64],
    ) -> Result<Self, InfeasibleRun> {
        let wanted = |part: f64| {
            let all = shapes
                .iter()
                .zip(sizes)
                .map(|(shape, size)| shape.at(part).0 * size);
            DVector::from_iterator(sizes.len(), all)
        };
        let begin = wanted(0.0);
        let mut state = guide.network.states[0].clone();
        let mut now = DVector::zeros(sizes.len());
        let mut stops = Vec::new();
        let mut rates = guide.rates(&state).ok_or(InfeasibleRun::Singular)?;
        for step in 1..=APPROACH + STEPS {
            let next = if step <= APPROACH {
                &begin * (f64::from(step) / f64::from(APPROACH))
            } else {
                wanted(f64::from(step - APPROACH) / f64::from(STEPS))
            };
            state = guide
                .step(&state, &rates, &(&next - &now))
                .ok_or(InfeasibleRun::Singular)?;
            // Read positions back from the joints, so that small errors do not accumulate.
            let positions = guide.positions(&state).into_iter().enumerate();
            now =
                DVector::from_iterator(sizes.len(), positions.map(|(at, p)| p.unwrap_or(next[at])));
            rates = guide.rates(&state).ok_or(InfeasibleRun::Singular)?;
            if let Some(joint) = guide.beyond(&state) {
                let share = share(guide, &rates.tree, joint, sizes);
                return Err(InfeasibleRun::Limit { joint, share });
            }
            if step >= APPROACH {
                let part = f64::from(step - APPROACH) / f64::from(STEPS);
                let of = |which: fn((f64, f64, f64)) -> f64| {
                    let all = shapes
                        .iter()
                        .zip(sizes)
                        .map(|(shape, size)| which(shape.at(part)) * size);
                    DVector::from_iterator(sizes.len(), all)
                };
                stops.push(Stop {
                    state: state.clone(),
                    tree: rates.tree.clone(),
                    actuators: rates.actuators.clone(),
                    rates: of(|v| v.1),
                    accelerations: of(|v| v.2),
                });
            }
        }
        Ok(Self { stops })
    }

    /// Largest ratio of joint speed to its limit, at one period per second.
    pub(super) fn fastest(&self, guide: &Guide<'_, '_>) -> f64 {
        let joints = &guide.network.model.joints;
        let coordinates = &guide.motion.coordinates;
        let of = |stop: &Stop| {
            let speeds = &stop.tree * &stop.rates;
            let parts = speeds.iter().zip(coordinates).map(|(speed, c)| {
                let joint = &joints[c.joint];
                let usual = match joint.kind {
                    JointType::Prismatic => USUAL[1],
                    JointType::Revolute | JointType::Ball => USUAL[0],
                };
                speed.abs() / joint.speed.map_or(usual, |own| 0.8 * own)
            });
            parts.fold(0.0, f64::max)
        };
        self.stops.iter().map(of).fold(0.0, f64::max)
    }
}

/// Contribution of each coordinate to the motion of a joint at its limit.
fn share(guide: &Guide<'_, '_>, tree: &DMatrix<f64>, joint: usize, sizes: &[f64]) -> Vec<f64> {
    let follow = guide.network.model.joints[joint].follow;
    let leader = follow.map_or(joint, |f| f.joint);
    let row = guide
        .motion
        .coordinates
        .iter()
        .position(|c| c.joint == leader);
    let part = |at: usize| row.map_or(1.0, |row| (tree[(row, at)] * sizes[at]).abs());
    (0..sizes.len()).map(part).collect()
}
