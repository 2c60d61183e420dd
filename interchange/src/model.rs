//! A robot as files describe it: a tree of bodies with joints, and closures between them.

use crate::files::Place;
use nalgebra::{IsometryMatrix3, Matrix3, Point3, Vector3};

/// A frame in another, with rotations by right angles exact.
pub(crate) type Pose = IsometryMatrix3<f64>;

/// A robot.
#[derive(Debug, Clone)]
pub(crate) struct Model {
    /// Its name.
    pub(crate) name: String,
    /// Acceleration of gravity in the world.
    pub(crate) gravity: [f64; 3],
    /// The bodies; the first is the ground, parents come before their children.
    pub(crate) bodies: Vec<Body>,
    /// Joints of the tree.
    pub(crate) joints: Vec<Joint>,
    /// What closes loops.
    pub(crate) closures: Vec<Closure>,
    /// Whether the file says which joints are driven.
    pub(crate) says_motors: bool,
    /// What a reader has to know of what was left out or assumed.
    pub(crate) notes: Vec<String>,
}

/// A body.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    /// Its name.
    pub(crate) name: String,
    /// The body that carries it; the ground carries itself.
    pub(crate) parent: usize,
    /// Its frame in that of the parent where the joint stands at its reference.
    pub(crate) placement: Pose,
    /// Where the file describes it; none of bodies that stand for parts of joints.
    pub(crate) place: Option<Place>,
    /// The joint between the two; none where they are fixed together.
    pub(crate) joint: Option<usize>,
    /// Mass and inertia, none of a massless body.
    pub(crate) inertia: Option<Inertia>,
    /// Whether the file says that it has mass and inertia, but not how much.
    pub(crate) has_unknown_inertia: bool,
}

/// Mass, centre and inertia about the centre in the axes of the body.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inertia {
    pub(crate) mass: f64,
    pub(crate) centre: Point3<f64>,
    pub(crate) tensor: Matrix3<f64>,
}

/// Kinds of joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Revolute,
    Prismatic,
    /// Turns in all directions about a point.
    Ball,
}

/// A joint that follows another: factor times its position and an offset.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Follow {
    pub(crate) joint: usize,
    pub(crate) factor: f64,
    pub(crate) offset: f64,
}

/// A joint of the tree.
#[derive(Debug, Clone)]
pub(crate) struct Joint {
    /// Its name.
    pub(crate) name: String,
    pub(crate) kind: Kind,
    /// Axis of length 1 in the frame of the body that it carries.
    pub(crate) axis: Vector3<f64>,
    /// A point of the axis, or the ball's centre, in that frame.
    pub(crate) at: Point3<f64>,
    /// Its position where the body stands as it is placed.
    pub(crate) reference: f64,
    /// Its position in the file's usual configuration.
    pub(crate) home: f64,
    /// Its smallest and largest position.
    pub(crate) range: Option<[f64; 2]>,
    /// Its largest speed, rad/s or m/s.
    pub(crate) speed: Option<f64>,
    /// What it follows.
    pub(crate) follow: Option<Follow>,
    pub(crate) actuated: bool,
    pub(crate) damping: f64,
    pub(crate) friction: f64,
    pub(crate) armature: f64,
    /// Stiffness of a spring and where it rests.
    pub(crate) spring: Option<(f64, f64)>,
    /// What a motor's transmission is, for people.
    pub(crate) drive: String,
    pub(crate) place: Place,
}

/// What closes a loop.
#[derive(Debug, Clone)]
pub(crate) struct Closure {
    /// Its name, or what the file calls it.
    pub(crate) name: String,
    pub(crate) kind: ClosureKind,
    pub(crate) place: Place,
}

/// Two frames of two bodies that meet.
#[derive(Debug, Clone)]
pub(crate) enum ClosureKind {
    /// Their origins.
    Point {
        bodies: [usize; 2],
        at: [Point3<f64>; 2],
    },
    /// Origins and axes.
    Weld { bodies: [usize; 2], at: [Pose; 2] },
    /// Origins and the axis z: a pin.
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
    /// The ground and nothing else.
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
            notes: Vec::new(),
        }
    }

    /// The joint of a name.
    pub(crate) fn joint_named(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.name == name)
    }

    /// The body of a name.
    pub(crate) fn body_named(&self, name: &str) -> Option<usize> {
        self.bodies.iter().position(|body| body.name == name)
    }

    /// The body that a joint carries.
    pub(crate) fn carried_by(&self, joint: usize) -> usize {
        self.bodies
            .iter()
            .position(|body| body.joint == Some(joint))
            .unwrap_or(0)
    }
}

impl Joint {
    /// A passive joint about z without friction.
    pub(crate) fn new(name: &str, kind: Kind, place: Place) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            axis: Vector3::z(),
            at: Point3::origin(),
            reference: 0.0,
            home: 0.0,
            range: None,
            speed: None,
            follow: None,
            actuated: false,
            damping: 0.0,
            friction: 0.0,
            armature: 0.0,
            spring: None,
            drive: String::new(),
            place,
        }
    }
}

impl Inertia {
    /// Both bodies as one, in the same frame.
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

    /// What is left of a body without another that is part of it, in the same frame.
    #[must_use]
    pub(crate) fn without(&self, other: &Self) -> Self {
        let negative = Self {
            mass: -other.mass,
            tensor: -other.tensor,
            ..*other
        };
        self.with(&negative)
    }

    /// The same body seen from a frame in which its own stands.
    #[must_use]
    pub(crate) fn seen(&self, frame: &Pose) -> Self {
        let rotation = frame.rotation;
        Self {
            mass: self.mass,
            centre: frame * self.centre,
            tensor: rotation * self.tensor * rotation.transpose(),
        }
    }

    /// The inertia about the origin.
    #[must_use]
    pub(crate) fn about_origin(&self) -> Matrix3<f64> {
        self.tensor + point(self.mass, &self.centre.coords)
    }
}

/// The inertia of a mass in a point about the origin.
fn point(mass: f64, at: &Vector3<f64>) -> Matrix3<f64> {
    (Matrix3::identity() * at.norm_squared() - at * at.transpose()) * mass
}
