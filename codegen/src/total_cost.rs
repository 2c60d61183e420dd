//! Operation count of a function with all that it calls.
//!
//! A function of the actuators calls forward kinematics; a function of a pose without closed-form
//! joints calls Newton's method. Both iterate, so the count has two parts: operations done once,
//! and operations of each step. Loops of the runtime are counted for the usual case: no step is
//! shortened, no quaternion is far from unit length, no pivot is exchanged.

use crate::derivation::MotionInput;
use crate::lowering::Cost;
use crate::model::{CompiledFunction, RobotModel};
use overact_core::Function;

/// An iteration that a function runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[non_exhaustive]
pub struct Iteration {
    /// The function that iterates.
    pub function: &'static str,
    /// The outer iteration whose steps run it; `None` if it runs once.
    pub within: Option<&'static str>,
    /// Number of runs in each step of the outer iteration.
    pub runs: usize,
    /// Operations of a step.
    pub operations: usize,
    /// Cost of a step.
    #[serde(flatten)]
    pub step: Cost,
}

/// Cost of a function, including all that it calls.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
#[non_exhaustive]
pub struct TotalCost {
    /// Cost of the part that is done once.
    #[serde(flatten)]
    pub once: Cost,
    /// The iterations.
    pub iterations: Vec<Iteration>,
    /// Cost of the program in SIMD lanes that replaces the function's own program in Rust.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side_by_side: Option<SideBySide>,
}

/// Operations of legs in SIMD lanes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[non_exhaustive]
pub struct SideBySide {
    /// Operations that are done once.
    pub once: usize,
    /// Operations per leg.
    pub each: usize,
    /// Number of legs.
    pub legs: usize,
    /// Smallest number of lanes; with fewer the function's own program runs.
    pub lanes: usize,
}

/// Names of the iterations: those of the functions that contain them.
const FORWARD: &str = "pose_from_actuators";
const INVERSE: &str = "joints";

impl From<Cost> for TotalCost {
    fn from(once: Cost) -> Self {
        Self {
            once,
            iterations: Vec::new(),
            side_by_side: None,
        }
    }
}

impl TotalCost {
    /// Adds a call.
    fn call(&mut self, other: Self) {
        self.once += other.once;
        for called in other.iterations {
            let known = self.iterations.iter_mut();
            let same = |one: &&mut Iteration| {
                (one.function, one.within) == (called.function, called.within)
            };
            match known.into_iter().find(same) {
                Some(known) => known.runs += called.runs,
                None => self.iterations.push(called),
            }
        }
    }

    /// Adds an iteration whose step has this cost.
    fn iterate(&mut self, function: &'static str, step: Self) {
        let within = |mut inner: Iteration| {
            inner.within = Some(function);
            inner
        };
        self.iterations.push(Iteration {
            function,
            within: None,
            runs: 1,
            operations: step.once.operations(),
            step: step.once,
        });
        self.iterations
            .extend(step.iterations.into_iter().map(within));
    }
}

impl RobotModel {
    /// Cost of a function with all that it calls. Functions that are not in the model cost nothing.
    #[must_use]
    pub fn cost(&self, function: &CompiledFunction) -> TotalCost {
        let newton = self.needs_joints(function) && function.computes == Function::Joints;
        let mut total = TotalCost::from(if newton {
            Cost::default()
        } else {
            function.program.cost()
        });
        total.side_by_side = function.lanes.as_ref().map(|lanes| {
            let (once, each) = lanes.operations();
            let legs = lanes.legs.len();
            SideBySide {
                once,
                each,
                legs,
                lanes: lanes.pays.least(),
            }
        });
        let takes_pose = function.program.inputs.iter().any(|i| i.name == "pose");
        if takes_pose && !self.finds_pose(function) {
            total.call(TotalCost::from(self.scaled_quaternion()));
        }
        if self.finds_pose(function) && self.needs_pose(function) {
            total.call(self.forward_kinematics());
        }
        if newton {
            total.call(self.newton());
        } else if self.needs_joints(function) {
            total.call(self.of(Function::Joints, MotionInput::Pose));
        }
        total
    }

    fn of(&self, function: Function, from: MotionInput) -> TotalCost {
        let found = self.function(function, from);
        found.map_or_else(
            || TotalCost::from(Cost::default()),
            |function| self.cost(function),
        )
    }

    fn has_quaternion(&self) -> bool {
        let platform = self.mechanism.platform.as_ref();
        platform.is_some_and(|p| p.motion.has_quaternion())
    }

    /// `guard::unit_quaternion` for a length that is 1 up to rounding.
    fn scaled_quaternion(&self) -> Cost {
        if self.has_quaternion() {
            Cost {
                additions: 5,
                multiplications: 9,
                guards: 1,
                ..Cost::default()
            }
        } else {
            Cost::default()
        }
    }

    /// `pose_from_actuators`: the closed form, if used, and Gauss-Newton steps for redundant
    /// actuators or without it.
    fn forward_kinematics(&self) -> TotalCost {
        let (n, r) = (self.mechanism.actuator_count(), self.mechanism.dof());
        let mut total = TotalCost::from(self.scaled_quaternion());
        let closed = self.function(Function::PoseInClosedForm, MotionInput::Actuators);
        if let Some(closed) = closed.filter(|_| n == r) {
            total.call(self.cost(closed));
            return total;
        }
        if let Some(closed) = closed {
            // It is compared with the start.
            total.call(self.cost(closed));
            total.once.additions += self.mechanism.pose_len();
            total.once.guards += self.mechanism.pose_len();
        }
        let mut step = TotalCost::from(Cost::default());
        // The bounds of the next step.
        step.once.multiplications += 3;
        if self.mechanism.has_dependent_coordinates() {
            // The start is checked. A short step leaves the closures once, and is checked after the
            // correction.
            let turn = self.displacement_with_correction();
            total.call(turn.clone());
            step.call(turn.clone());
            step.call(turn);
        } else {
            step.once += displacement(r, self.has_quaternion());
        }
        match self.function(Function::PoseStep, MotionInput::Pose) {
            Some(at_once) => step.call(self.cost(at_once)),
            None => {
                step.once += gauss_newton_step(n, r);
                step.call(self.of(Function::ActuatorPositions, MotionInput::Pose));
                step.call(self.of(Function::InverseJacobian, MotionInput::Pose));
            }
        }
        total.iterate(FORWARD, step);
        total
    }

    /// One iteration of `parasitic_motion::displace` or `dependent_joints::displace`: all components
    /// displace the start, and the dependent ones are corrected.
    fn displacement_with_correction(&self) -> TotalCost {
        if self.mechanism.has_dependent_joints() {
            let mut turn = TotalCost::from(displacement(self.mechanism.pose_len(), false));
            turn.once += elimination(self.mechanism.pose_len() - self.mechanism.dof());
            turn.call(self.of(Function::PoseError, MotionInput::Pose));
            turn.call(self.of(Function::PoseErrorJacobian, MotionInput::Pose));
            return turn;
        }
        let mut turn = TotalCost::from(displacement(6, true));
        turn.once += elimination(6 - self.mechanism.dof());
        turn.call(self.of(Function::BlockedError, MotionInput::Pose));
        turn.call(self.of(Function::BlockedJacobian, MotionInput::Pose));
        turn
    }

    /// `joints` by Newton's method, if one step leads from home to the pose.
    fn newton(&self) -> TotalCost {
        let legs = self.mechanism.legs.iter();
        let sizes: Vec<usize> = legs.map(|leg| leg.independent().count()).collect();
        let mut evaluation = self.of(Function::ClosureError, MotionInput::Joints).once;
        evaluation += self.of(Function::LegsJacobian, MotionInput::Joints).once;
        let mut total = TotalCost::from(Cost::default());
        if self.has_quaternion() {
            total.once += Cost {
                additions: 3,
                multiplications: 4,
                divisions: 4,
                square_roots: 1,
                ..Cost::default()
            };
        }
        let mut step = evaluation;
        for &size in &sizes {
            step += elimination(size);
            step.additions += size;
            step.multiplications += size;
            // The working mode is compared with that at home.
            for _ in 0..2 {
                total.once += evaluation;
                total.once += elimination(size);
            }
            total.once.multiplications += 1;
        }
        total.iterate(INVERSE, TotalCost::from(step));
        total
    }
}

/// A step of `forward::gauss_newton` for n actuators and r coordinates, without the evaluations.
fn gauss_newton_step(n: usize, r: usize) -> Cost {
    let half = r * (r + 1) / 2;
    let mut cost = Cost {
        // Differences, Jᵀ Δq and the upper triangle of JᵀJ; the bound of a pivot.
        additions: n * (1 + r + half),
        multiplications: n * (r + half) + r,
        guards: r,
        ..Cost::default()
    };
    for below in 0..r {
        // Elimination of the rows below a pivot, and substitution.
        let products = below * (below + 1) / 2 + below + below;
        cost.additions += products;
        cost.multiplications += products;
        cost.divisions += below + 1;
    }
    cost
}

/// `forward::displace` or `displace_quaternion`.
fn displacement(r: usize, quaternion: bool) -> Cost {
    if quaternion {
        // The position, the square of the angle, two series, the product, and the length, which is
        // 1 up to rounding.
        Cost {
            additions: (r - 3) + 2 + 6 + 12 + 5,
            multiplications: 3 + 6 + 3 + 16 + 9,
            guards: 2,
            ..Cost::default()
        }
    } else {
        Cost {
            additions: r,
            ..Cost::default()
        }
    }
}

/// `inverse::System::eliminate` for a leg with this number of joints.
fn elimination(size: usize) -> Cost {
    let mut cost = Cost {
        divisions: 1,
        guards: size,
        ..Cost::default()
    };
    for below in 0..size {
        let products = below * (below + 2) + below;
        cost.additions += products;
        cost.multiplications += products;
        cost.divisions += below + 1;
    }
    cost
}
