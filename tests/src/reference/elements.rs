//! Forces between two points of two bodies, by virtual work with differences of the length.
//!
//! In the opened robot, whose joints and platform are free, the length l is a function of all joint
//! positions and of the platform's displacement. A force f that pulls the points together needs the
//! loads f ∂l/∂q at the joints and f times the derivative along each direction of the platform.
//! Seven-point differences give the derivatives, and the length's rate is their product with the
//! velocities.

use super::closure::State;
use super::kinematics::{BodyMotion, all_legs};
use super::mechanism::{Element, ElementBody, ElementEnd, Law, Mechanism};
use super::parameters::element_start;
use super::placement::{Frame, exponential};
use nalgebra::{DMatrix, DVector, Vector3, Vector6};

/// Step of the differences, m and rad.
const STEP: f64 = 1e-3;
/// Weights of seven-point differences, of odd order.
const WEIGHTS: [f64; 3] = [0.75, -0.15, 1.0 / 60.0];

/// Bodies of the opened robot at joint positions, and its platform.
struct Opened {
    legs: Vec<Vec<BodyMotion>>,
    platform: Frame,
}

impl Opened {
    fn new(mechanism: &Mechanism, q: &DVector<f64>, platform: Frame) -> Self {
        let still = DVector::zeros(q.len());
        Self {
            legs: all_legs(mechanism, q, &still, &still),
            platform,
        }
    }

    fn point(&self, end: &ElementEnd) -> Vector3<f64> {
        let frame = match end.body {
            ElementBody::Ground => return end.at,
            ElementBody::Platform => self.platform,
            ElementBody::Joint(leg, joint) => self.legs[leg][joint].frame,
        };
        frame.position + frame.rotation * end.at
    }

    fn length(&self, element: &Element) -> f64 {
        let [from, to] = &element.ends;
        (self.point(to) - self.point(from)).norm()
    }
}

/// Directions in which the platform's wrench is projected, 6 × columns; none without a platform.
fn directions(mechanism: &Mechanism) -> DMatrix<f64> {
    if mechanism.motion.has_platform() {
        mechanism.motion.free_basis()
    } else {
        DMatrix::zeros(6, 0)
    }
}

/// The platform displaced along a spatial direction.
fn displaced(frame: &Frame, along: &Vector6<f64>) -> Frame {
    let turn = Vector3::new(along[3], along[4], along[5]);
    Frame::new(
        exponential(turn) * frame.rotation,
        frame.position + Vector3::new(along[0], along[1], along[2]),
    )
}

/// Length of an element in a state.
#[must_use]
pub fn length(mechanism: &Mechanism, state: &State, element: &Element) -> f64 {
    let platform = mechanism.motion.placement(&state.pose);
    Opened::new(mechanism, &state.q, platform).length(element)
}

/// Derivatives of the length along all joints and directions of the platform.
fn gradient(mechanism: &Mechanism, state: &State, element: &Element) -> DVector<f64> {
    let platform = mechanism.motion.placement(&state.pose);
    let basis = directions(mechanism);
    let joints = state.q.len();
    let at = |index: usize, step: f64| {
        let (mut q, mut frame) = (state.q.clone(), platform);
        match index.checked_sub(joints) {
            None => q[index] += step,
            Some(column) => {
                let along = Vector6::from_iterator(basis.column(column).iter().map(|b| b * step));
                frame = displaced(&platform, &along);
            }
        }
        Opened::new(mechanism, &q, frame).length(element)
    };
    let slope = |index: usize| -> f64 {
        let term = |(n, weight): (usize, &f64)| {
            let step = (n + 1) as f64 * STEP;
            weight * (at(index, step) - at(index, -step)) / STEP
        };
        WEIGHTS.iter().enumerate().map(term).sum()
    };
    DVector::from_fn(joints + basis.ncols(), |index, _| slope(index))
}

/// Loads [τ_t; τ_pr] of one element by one of its laws.
fn loads(
    mechanism: &Mechanism,
    state: &State,
    element: &Element,
    law: &Law,
    rows: usize,
) -> DVector<f64> {
    let slopes = gradient(mechanism, state, element);
    let basis = directions(mechanism);
    let mut rates = DVector::zeros(slopes.len());
    rates.rows_mut(0, state.qd.len()).copy_from(&state.qd);
    if mechanism.motion.has_platform() {
        let platform = state.platform(mechanism);
        let (v, w) = (platform.velocity, platform.angular_velocity);
        let twist = DVector::from_vec(vec![v.x, v.y, v.z, w.x, w.y, w.z]);
        let own = basis.transpose() * twist;
        rates.rows_mut(state.qd.len(), own.len()).copy_from(&own);
    }
    let force = law.force(length(mechanism, state, element), slopes.dot(&rates));
    let mut all = DVector::zeros(rows);
    all.rows_mut(0, slopes.len()).copy_from(&(slopes * force));
    all
}

/// Adds the columns of the elements' coefficients to a regressor.
pub(super) fn add_columns(mechanism: &Mechanism, state: &State, columns: &mut DMatrix<f64>) {
    let rows = columns.nrows();
    for (index, element) in mechanism.elements.iter().enumerate() {
        if let Some(law) = &element.force {
            let own = loads(mechanism, state, element, law, rows);
            columns.set_column(element_start(mechanism) + index, &own);
        }
    }
}

/// Loads of all elements for given parameters, known forces included.
pub(super) fn all_loads(
    mechanism: &Mechanism,
    state: &State,
    parameters: &DVector<f64>,
    rows: usize,
) -> DVector<f64> {
    let mut sum = DVector::zeros(rows);
    for (index, element) in mechanism.elements.iter().enumerate() {
        let coefficient = parameters[element_start(mechanism) + index];
        for (law, factor) in [(&element.force, coefficient), (&element.known, 1.0)] {
            if let Some(law) = law {
                sum += loads(mechanism, state, element, law, rows) * factor;
            }
        }
    }
    sum
}
