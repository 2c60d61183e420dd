//! Model of a robot as files describe it: a tree of bodies and joints, and loop closures.

use crate::files::Place;
use nalgebra::{IsometryMatrix3, Matrix3, Point3, Rotation3, Vector3};

/// Pose of a frame in another one; rotations by right angles are exact.
pub(crate) type Pose = IsometryMatrix3<f64>;

/// A robot.
#[derive(Debug, Clone)]
pub(crate) struct Model {
    /// Name.
    pub(crate) name: String,
    /// Gravitational acceleration in the world frame, m/s².
    pub(crate) gravity: [f64; 3],
    /// Bodies, parents before children; the first is the ground.
    pub(crate) bodies: Vec<Body>,
    /// Joints of the tree.
    pub(crate) joints: Vec<Joint>,
    /// Constraints that close loops.
    pub(crate) closures: Vec<Closure>,
    /// Whether the file specifies the actuated joints.
    pub(crate) says_motors: bool,
    /// Motors with a gear or that turn several joints, as far as the file describes them.
    pub(crate) motors: Vec<Motor>,
    /// Springs and dampers between two points.
    pub(crate) springs: Vec<PointSpring>,
    /// Whether the file has settings that change inertias after they are read.
    pub(crate) adjusts_inertias: bool,
    /// Closures and axes that were changed to close the loops.
    pub(crate) misfits: Vec<Misfit>,
    /// Notes on what was omitted or assumed.
    pub(crate) notes: Vec<String>,
}

/// A body.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    /// Name.
    pub(crate) name: String,
    /// Parent body; the ground is its own parent.
    pub(crate) parent: usize,
    /// Pose in the parent at the joint's reference position.
    pub(crate) placement: Pose,
    /// Location in the file; `None` for auxiliary bodies of joints with several axes.
    pub(crate) place: Option<Place>,
    /// Joint to the parent; `None` if fixed.
    pub(crate) joint: Option<usize>,
    /// Inertia; `None` for a massless body.
    pub(crate) inertia: Option<Inertia>,
    /// Whether the file says that the body has inertia without giving its value.
    pub(crate) has_unknown_inertia: bool,
}

/// Mass, centre of mass, and inertia about the centre in the body's axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inertia {
    pub(crate) mass: f64,
    pub(crate) centre: Point3<f64>,
    pub(crate) tensor: Matrix3<f64>,
}

/// Joint types.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum JointType {
    Revolute,
    Prismatic,
    /// Spherical joint.
    Ball,
}

/// Coupling to another joint: position = factor · leader + offset.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Follow {
    pub(crate) joint: usize,
    pub(crate) factor: f64,
    pub(crate) offset: f64,
}

/// A joint of the tree.
#[derive(Debug, Clone)]
pub(crate) struct Joint {
    /// Name.
    pub(crate) name: String,
    pub(crate) kind: JointType,
    /// Unit axis in the frame of the carried body.
    pub(crate) axis: Vector3<f64>,
    /// Point on the axis, or centre of a ball joint, in that frame.
    pub(crate) at: Point3<f64>,
    /// Position at the body's `placement`.
    pub(crate) reference: f64,
    /// Home position of the file.
    pub(crate) home: f64,
    /// Rotation of a ball joint at home.
    pub(crate) home_turn: Rotation3<f64>,
    /// Position and rotation in the file's keyframe.
    pub(crate) keyframe: Option<(f64, Rotation3<f64>)>,
    /// Lower and upper position limit.
    pub(crate) range: Option<[f64; 2]>,
    /// Speed limit, rad/s or m/s.
    pub(crate) speed: Option<f64>,
    /// Coupling, if the joint is not independent.
    pub(crate) follow: Option<Follow>,
    pub(crate) actuated: bool,
    /// Whether it is only actuated by motors that turn several joints of a robot with loops.
    pub(crate) is_turned: bool,
    /// Whether it only displaces a free body, which closures hold.
    pub(crate) is_virtual: bool,
    pub(crate) damping: f64,
    pub(crate) friction: f64,
    pub(crate) armature: f64,
    /// Armature, damping and friction of the joint's own element if actuators or tendons of the
    /// file may add to them.
    pub(crate) given: Option<[f64; 3]>,
    /// Stiffness and damping that the file gives by time constants.
    pub(crate) timed_spring: Option<[f64; 2]>,
    /// Spring stiffness and rest position.
    pub(crate) spring: Option<(f64, f64)>,
    /// Part of the stiffness that tendons contribute.
    pub(crate) tendon_stiffness: f64,
    /// Position at which springs of tendons have their length without force, if it is not home.
    pub(crate) rest: Option<f64>,
    /// Descriptions of the gears of its motors, for comments.
    pub(crate) gears: Vec<String>,
    pub(crate) place: Place,
}

/// A motor that turns a combination of joints.
#[derive(Debug, Clone)]
pub(crate) struct Motor {
    pub(crate) name: String,
    /// Joints and their factors in the combination.
    pub(crate) turns: Vec<(usize, f64)>,
    /// Position of the motor divided by the combination.
    pub(crate) ratio: f64,
    /// Rotor inertia of the combination's rate, behind the gear.
    pub(crate) armature: f64,
    pub(crate) damping: f64,
    pub(crate) friction: f64,
    pub(crate) place: Place,
}

/// A spring and damper between points of two bodies.
#[derive(Debug, Clone)]
pub(crate) struct PointSpring {
    pub(crate) name: String,
    pub(crate) bodies: [usize; 2],
    pub(crate) at: [Point3<f64>; 2],
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    /// Length without force.
    pub(crate) rest: f64,
    pub(crate) place: Place,
}

/// A constraint that closes a loop.
#[derive(Debug, Clone)]
pub(crate) struct Closure {
    /// Name, or the file's word for it.
    pub(crate) name: String,
    pub(crate) kind: ClosureKind,
    pub(crate) place: Place,
}

/// Change of a closure's frame or of a joint's axis that closes a loop.
#[derive(Debug, Clone)]
pub(crate) struct Misfit {
    /// Name of the closure or joint.
    pub(crate) name: String,
    pub(crate) place: Place,
    /// Displacement, m.
    pub(crate) length: f64,
    /// Rotation, rad.
    pub(crate) angle: f64,
}

/// Constraint between two frames on two bodies.
#[derive(Debug, Clone)]
pub(crate) enum ClosureKind {
    /// Coincident origins.
    Point {
        bodies: [usize; 2],
        at: [Point3<f64>; 2],
    },
    /// Coincident frames.
    Weld { bodies: [usize; 2], at: [Pose; 2] },
    /// Coincident origins and z axes: a revolute joint.
    Pin { bodies: [usize; 2], at: [Pose; 2] },
}

impl Closure {
    /// The two bodies.
    pub(crate) fn bodies(&self) -> [usize; 2] {
        match &self.kind {
            ClosureKind::Point { bodies, .. }
            | ClosureKind::Weld { bodies, .. }
            | ClosureKind::Pin { bodies, .. } => *bodies,
        }
    }
}

impl Model {
    /// A model with the ground only.
    pub(crate) fn new(name: &str) -> Self {
        let ground = Body {
            name: "ground".to_owned(),
            parent: 0,
            placement: Pose::identity(),
            place: None,
            joint: None,
            inertia: None,
            has_unknown_inertia: false,
        };
        Self {
            name: name.to_owned(),
            gravity: [0.0, 0.0, -9.81],
            bodies: vec![ground],
            joints: Vec::new(),
            closures: Vec::new(),
            says_motors: false,
            motors: Vec::new(),
            springs: Vec::new(),
            adjusts_inertias: false,
            misfits: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Joint with a name.
    pub(crate) fn joint_named(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.name == name)
    }

    /// Combinations of joints that the actuators of a robot with loops turn.
    pub(crate) fn drives(&self) -> Vec<Vec<(usize, f64)>> {
        let joints = self.joints.iter().enumerate();
        let own = joints.filter(|(_, joint)| joint.actuated && !joint.is_turned);
        let own = own.map(|(at, _)| vec![(at, 1.0)]);
        let motors = self.motors.iter().map(|motor| motor.turns.clone());
        own.chain(motors).collect()
    }

    /// Body with a name, other than the ground.
    pub(crate) fn body_named(&self, name: &str) -> Option<usize> {
        let mut bodies = self.bodies.iter().enumerate().skip(1);
        bodies.find_map(|(at, body)| (body.name == name).then_some(at))
    }

    /// Body that each joint carries; the ground for joints without a body.
    pub(crate) fn carried(&self) -> Vec<usize> {
        let mut carried = vec![0; self.joints.len()];
        for (at, body) in self.bodies.iter().enumerate().rev() {
            if let Some(joint) = body.joint {
                carried[joint] = at;
            }
        }
        carried
    }

    /// Body that a joint carries.
    pub(crate) fn carried_by(&self, joint: usize) -> usize {
        self.bodies
            .iter()
            .position(|body| body.joint == Some(joint))
            .unwrap_or(0)
    }
}

impl Model {
    /// Inserts a body; later bodies move up by one.
    pub(crate) fn insert_body(&mut self, at: usize, body: Body) {
        let moved = |own: &mut usize| *own += usize::from(*own >= at);
        for other in &mut self.bodies {
            moved(&mut other.parent);
        }
        for closure in &mut self.closures {
            match &mut closure.kind {
                ClosureKind::Point { bodies, .. }
                | ClosureKind::Weld { bodies, .. }
                | ClosureKind::Pin { bodies, .. } => bodies.iter_mut().for_each(moved),
            }
        }
        for spring in &mut self.springs {
            spring.bodies.iter_mut().for_each(moved);
        }
        self.bodies.insert(at, body);
    }

    /// Fixes the body of a joint and removes the joint; later joints move down by one.
    pub(crate) fn remove_joint(&mut self, at: usize) {
        let moved = |own: usize| (own != at).then_some(own - usize::from(own > at));
        for body in &mut self.bodies {
            body.joint = body.joint.and_then(moved);
        }
        self.motors
            .retain(|motor| motor.turns.iter().all(|(joint, _)| *joint != at));
        for (joint, _) in self.motors.iter_mut().flat_map(|motor| &mut motor.turns) {
            *joint -= usize::from(*joint > at);
        }
        self.joints.remove(at);
    }
}

impl Motor {
    /// A motor without a name, a gear, torques and joints.
    pub(crate) fn new(place: Place) -> Self {
        Self {
            name: String::new(),
            turns: Vec::new(),
            ratio: 1.0,
            armature: 0.0,
            damping: 0.0,
            friction: 0.0,
            place,
        }
    }

    /// Whether its rotor has inertia or friction.
    pub(crate) fn has_torques(&self) -> bool {
        [self.armature, self.damping, self.friction] != [0.0; 3]
    }
}

impl Joint {
    /// A passive, frictionless joint about z.
    pub(crate) fn new(name: &str, kind: JointType, place: Place) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            axis: Vector3::z(),
            at: Point3::origin(),
            reference: 0.0,
            home: 0.0,
            home_turn: Rotation3::identity(),
            keyframe: None,
            range: None,
            speed: None,
            follow: None,
            actuated: false,
            is_turned: false,
            is_virtual: false,
            damping: 0.0,
            friction: 0.0,
            armature: 0.0,
            given: None,
            timed_spring: None,
            spring: None,
            tendon_stiffness: 0.0,
            rest: None,
            gears: Vec::new(),
            place,
        }
    }
}

impl Joint {
    /// Adds a spring; two springs of a joint act like one.
    ///
    /// Returns whether the sum is a spring: opposite ones leave a constant torque.
    pub(crate) fn add_spring(&mut self, stiffness: f64, rest: f64) -> bool {
        let (own, at) = self.spring.unwrap_or((0.0, rest));
        let sum = own + stiffness;
        if sum == 0.0 {
            self.spring = None;
            return at == rest;
        }
        self.spring = Some((sum, (own * at + stiffness * rest) / sum));
        true
    }

    /// Part of a torque parameter that actuators and tendons of the file contribute.
    pub(crate) fn of_others(&self, symbol: &str) -> f64 {
        let Some([armature, damping, friction]) = self.given else {
            return 0.0;
        };
        match symbol {
            "ia" => self.armature - armature,
            "fv" => self.damping - damping - self.timed_spring.map_or(0.0, |[_, damping]| damping),
            "fs" => self.friction - friction,
            "k" => self.tendon_stiffness,
            _ => 0.0,
        }
    }
}

impl Inertia {
    /// Inertia of two welded bodies, both in the same frame.
    #[must_use]
    pub(crate) fn with(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        if mass == 0.0 {
            let tensor = self.tensor + other.tensor;
            return Self {
                mass,
                centre: Point3::origin(),
                tensor,
            };
        }
        let sum = self.centre.coords * self.mass + other.centre.coords * other.mass;
        let centre = Point3::from(sum / mass);
        let about = |body: &Self| body.tensor + point(body.mass, &(body.centre - centre));
        Self {
            mass,
            centre,
            tensor: about(self) + about(other),
        }
    }

    /// Inertia after removal of a part, both in the same frame.
    #[must_use]
    pub(crate) fn without(&self, other: &Self) -> Self {
        let negative = Self {
            mass: -other.mass,
            tensor: -other.tensor,
            ..*other
        };
        self.with(&negative)
    }

    /// Inertia in another frame, in which the body's frame has the pose `frame`.
    #[must_use]
    pub(crate) fn transformed(&self, frame: &Pose) -> Self {
        let rotation = frame.rotation;
        Self {
            mass: self.mass,
            centre: frame * self.centre,
            tensor: rotation * self.tensor * rotation.transpose(),
        }
    }

    /// Inertia about the origin of the frame.
    #[must_use]
    pub(crate) fn about_origin(&self) -> Matrix3<f64> {
        self.tensor + point(self.mass, &self.centre.coords)
    }
}

/// Inertia of a point mass about the origin.
fn point(mass: f64, at: &Vector3<f64>) -> Matrix3<f64> {
    (Matrix3::identity() * at.norm_squared() - at * at.transpose()) * mass
}
