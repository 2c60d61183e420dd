//! The skeleton as a tree of moving bodies, with its dynamics as columns of inertial parameters.

use super::Refusal;
use nalgebra::{DMatrix, Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};
use overact_codegen::mechanism::{JointKind, Leg, Mechanism};

/// Numbers of inertial parameters of a body.
pub(super) const INERTIAL: usize = 10;

/// A moving body and its joint.
#[derive(Debug, Clone)]
pub(super) struct TreeBody {
    /// Name of the joint.
    pub(super) name: String,
    /// Index of the joint in its leg.
    pub(super) joint: usize,
    /// The moving body that carries it; `None` for the base.
    pub(super) parent: Option<usize>,
    /// Its frame in the parent's frame at joint position zero.
    pub(super) placement: Isometry3<f64>,
    /// Whether the joint turns; otherwise it slides.
    pub(super) is_revolute: bool,
    /// The joint's position as a combination of coordinates.
    pub(super) terms: Vec<(usize, f64)>,
}

/// The bodies that the independent coordinates move; parents come first.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    pub(super) bodies: Vec<TreeBody>,
    coordinates: usize,
}

/// Motion of a body in the base frame.
#[derive(Clone)]
struct Motion {
    frame: Isometry3<f64>,
    rate: Vector3<f64>,
    angular: Vector3<f64>,
    linear: Vector3<f64>,
    /// Velocity of the frame's origin and angular velocity, per coordinate.
    partial: Vec<[Vector3<f64>; 2]>,
}

impl Tree {
    /// The skeleton of a mechanism, or the whole robot if it has no loops.
    pub(super) fn new(mechanism: &Mechanism) -> Result<Self, Refusal> {
        if mechanism.platform.is_some() {
            return Err(Refusal {
                message: "the robot has a platform on legs, and no skeleton that could be a serial robot".to_owned(),
                help: "describe the platform by joints, as a leg without an `end`, and the other legs as chains that end on it".to_owned(),
            });
        }
        let free = mechanism.legs.iter().skip(1).find(|leg| leg.end.is_none());
        if let Some(branch) = free {
            return Err(Refusal {
                message: format!(
                    "the branch `{}` moves with a body of a chain, which a serial robot does not have",
                    branch.name
                ),
                help: "attach the branch to a body of the skeleton".to_owned(),
            });
        }
        if mechanism.has_dependent_joints() {
            return Err(Refusal {
                message:
                    "joints of the skeleton depend on others, which those of a serial robot do not"
                        .to_owned(),
                help: "export skeletons without `dependent` joints only".to_owned(),
            });
        }
        let Some(leg) = mechanism.legs.first() else {
            return Err(Refusal {
                message: "the robot has no joints".to_owned(),
                help: "describe a leg with joints".to_owned(),
            });
        };
        Self::of_leg(leg)
    }

    fn of_leg(leg: &Leg) -> Result<Self, Refusal> {
        let independent: Vec<usize> = leg.independent().collect();
        let at_zero = leg.frames(&vec![0.0; independent.len()]);
        // The moving body that each joint's body belongs to.
        let mut body_of: Vec<Option<usize>> = Vec::new();
        let mut bodies: Vec<TreeBody> = Vec::new();
        for (index, joint) in leg.joints.iter().enumerate() {
            let parent = joint.antecedent.and_then(|at| body_of[at]);
            if joint.kind == JointKind::Fixed || joint.motor.is_some() {
                body_of.push(parent);
                continue;
            }
            let carrier =
                parent.map_or_else(Isometry3::identity, |at: usize| at_zero[bodies[at].joint]);
            let position = |joint: usize| independent.iter().position(|own| *own == joint);
            let terms = joint.variable.iter();
            let terms = terms.filter_map(|(of, factor)| Some((position(*of)?, factor.value())));
            let terms: Vec<(usize, f64)> = terms.collect();
            if !joint.is_independent(index) && terms.len() != 1 {
                return Err(Refusal {
                    message: format!(
                        "the joint `{}` follows several joints, which neither MJCF nor URDF can express",
                        joint.name
                    ),
                    help: "no serial file can describe this robot".to_owned(),
                });
            }
            body_of.push(Some(bodies.len()));
            bodies.push(TreeBody {
                name: joint.name.clone(),
                joint: index,
                parent,
                placement: carrier.inverse() * at_zero[index],
                is_revolute: joint.kind == JointKind::Revolute,
                terms,
            });
        }
        Ok(Self {
            bodies,
            coordinates: independent.len(),
        })
    }

    /// Index of the moving body that carries a joint's body of the leg, with that body's frame in
    /// it; `None` if it is fixed on the base.
    pub(super) fn carrier(&self, leg: &Leg, joint: usize) -> Option<(usize, Isometry3<f64>)> {
        let at_zero = leg.frames(&vec![0.0; self.coordinates]);
        let mut at = Some(joint);
        while let Some(own) = at {
            if let Some(body) = self.bodies.iter().position(|body| body.joint == own) {
                return Some((body, at_zero[own].inverse() * at_zero[joint]));
            }
            at = leg.joints[own].antecedent;
        }
        None
    }

    /// Torques of the coordinates per inertial parameter, r × 10 B.
    ///
    /// The order of a body's parameters is xx, xy, xz, yy, yz, zz, mx, my, mz, m.
    pub(super) fn columns(
        &self,
        position: &[f64],
        velocity: &[f64],
        acceleration: &[f64],
        gravity: &Vector3<f64>,
    ) -> DMatrix<f64> {
        let r = self.coordinates;
        let mut all = DMatrix::zeros(r, INERTIAL * self.bodies.len());
        let base = Motion {
            frame: Isometry3::identity(),
            rate: Vector3::zeros(),
            angular: Vector3::zeros(),
            linear: -gravity,
            partial: vec![[Vector3::zeros(); 2]; r],
        };
        let mut motions: Vec<Motion> = Vec::new();
        for (index, body) in self.bodies.iter().enumerate() {
            let parent = body.parent.map_or(&base, |at| &motions[at]);
            let sum = |of: &[f64]| body.terms.iter().map(|(at, factor)| factor * of[*at]).sum();
            let own = parent.moved(body, sum(position), sum(velocity), sum(acceleration));
            let wrenches = own.wrenches();
            let inverse = own.frame.rotation.inverse();
            for (row, [linear, angular]) in own.partial.iter().enumerate() {
                let (linear, angular) = (inverse * linear, inverse * angular);
                for (column, [force, moment]) in wrenches.iter().enumerate() {
                    all[(row, INERTIAL * index + column)] = linear.dot(force) + angular.dot(moment);
                }
            }
            motions.push(own);
        }
        all
    }
}

impl Motion {
    /// Motion of a body on this one.
    fn moved(&self, body: &TreeBody, q: f64, v: f64, a: f64) -> Self {
        let mut frame = self.frame * body.placement;
        let axis = frame.rotation * Vector3::z();
        if body.is_revolute {
            frame.rotation *= UnitQuaternion::from_axis_angle(&Vector3::z_axis(), q);
        } else {
            frame.translation = Translation3::from(frame.translation.vector + axis * q);
        }
        let arm = frame.translation.vector - self.frame.translation.vector;
        let centripetal = self.rate.cross(&self.rate.cross(&arm));
        let carried = self.linear + self.angular.cross(&arm) + centripetal;
        let mut partial: Vec<[Vector3<f64>; 2]> = { self.partial.iter() }
            .map(|[linear, angular]| [linear + angular.cross(&arm), *angular])
            .collect();
        let kind = usize::from(body.is_revolute);
        for (at, factor) in &body.terms {
            partial[*at][kind] += axis * *factor;
        }
        let turning = self.rate.cross(&axis) * v;
        let (rate, angular, linear) = if body.is_revolute {
            (
                self.rate + axis * v,
                self.angular + axis * a + turning,
                carried,
            )
        } else {
            (self.rate, self.angular, carried + axis * a + turning * 2.0)
        };
        Self {
            frame,
            rate,
            angular,
            linear,
            partial,
        }
    }

    /// Force and moment about the origin that each inertial parameter needs, in the body's frame.
    fn wrenches(&self) -> [[Vector3<f64>; 2]; INERTIAL] {
        let inverse = self.frame.rotation.inverse();
        let [w, e, c] = [self.rate, self.angular, self.linear].map(|vector| inverse * vector);
        let second = |i: usize, j: usize| {
            let mut inertia = Matrix3::zeros();
            inertia[(i, j)] = 1.0;
            inertia[(j, i)] = 1.0;
            [Vector3::zeros(), inertia * e + w.cross(&(inertia * w))]
        };
        let first = |i: usize| {
            let mut moment = Vector3::zeros();
            moment[i] = 1.0;
            [
                e.cross(&moment) + w.cross(&w.cross(&moment)),
                moment.cross(&c),
            ]
        };
        [
            second(0, 0),
            second(0, 1),
            second(0, 2),
            second(1, 1),
            second(1, 2),
            second(2, 2),
            first(0),
            first(1),
            first(2),
            [c, Vector3::zeros()],
        ]
    }
}
