//! Random mechanisms as descriptions, reproducible on any machine.
//!
//! A mechanism is drawn from its platform inwards. Legs are chains of random modified
//! Denavit-Hartenberg steps whose structure can follow the platform's motion. Joints are placed
//! anywhere, and the leg's end determines the attachment on the platform, so that every loop closes
//! at home. A draw near a singularity at home is rejected, because a comparison would measure its
//! conditioning instead of the model.
//!
//! A [`Sketch`] is written twice from the same numbers: as TOML for the generator, and as plain
//! data of the numeric [`reference`](mod@crate::reference).

mod chain;
mod defect;
mod dice;
pub mod features;
mod friction;
mod leg;
mod parasitic_motion;
mod plain;
mod skeleton;
mod text;

pub use defect::Defect;
pub use dice::Dice;
pub use friction::Load;
pub use parasitic_motion::parasitic_motion;
pub use skeleton::skeleton;

use crate::reference::linear::{condition, singular_values};
use crate::reference::states::MAX_CONDITION;
use crate::reference::{Joint, JointKind, Motion, State};
use leg::{Structure, draw_shape};
use nalgebra::{DVector, Vector3};

/// A position and an orientation Rz(rz) Ry(ry) Rx(rx).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    /// Coordinates of the origin, m.
    pub at: [f64; 3],
    /// The angles rx, ry, rz.
    pub rotation: [f64; 3],
}

/// A joint with the parameters of its body.
#[derive(Clone, Debug)]
pub struct Member {
    /// Geometry and variable.
    pub joint: Joint,
    /// Symbols and groups of the parameters that are present.
    pub parameters: Vec<&'static str>,
    /// Load that increases dry friction.
    pub load: Option<Load>,
}

/// Attachment of a leg to the platform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Attachment {
    /// None: a tree.
    Free,
    /// The last frame is fixed to the platform.
    Rigid(Placement),
    /// The last frame's origin coincides with a point of the platform along axes of the base frame.
    Point([f64; 3], [bool; 3]),
}

/// A placed leg.
#[derive(Clone, Debug)]
pub struct Placed {
    /// The leg's base frame.
    pub base: Placement,
    /// Positions at home of the joints that own a variable.
    pub home: Vec<f64>,
    /// Its end.
    pub end: Attachment,
}

/// A leg that is described once, and its placements.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Structure of the leg.
    pub structure: Structure,
    /// The joints; antecedents come first, the last one carries the end.
    pub members: Vec<Member>,
    /// Placements of the leg.
    pub places: Vec<Placed>,
}

impl Shape {
    /// Number of actuated joints of one placement.
    #[must_use]
    pub fn actuators(&self) -> usize {
        self.members.iter().filter(|m| m.joint.actuated).count()
    }

    /// Indices of the joints with a variable of their own.
    #[must_use]
    pub fn independent(&self) -> Vec<usize> {
        let own = |at: &usize| self.members[*at].joint.terms.iter().any(|t| t.0 == *at);
        (0..self.members.len()).filter(own).collect()
    }
}

/// A drawn mechanism.
#[derive(Clone, Debug)]
pub struct Sketch {
    /// Seed.
    pub seed: u64,
    /// Motion of the platform.
    pub motion: Motion,
    /// Home pose: the platform's x, y, z and rx, ry, rz or, for one rotation, that angle.
    pub home: Placement,
    /// Gravity.
    pub gravity: [f64; 3],
    /// The legs.
    pub shapes: Vec<Shape>,
    /// The platform's parameters.
    pub platform: Vec<&'static str>,
    /// Parameters of the payload, if there may be one.
    pub payload: Option<Vec<&'static str>>,
    /// Kept actuators; `None` leaves the choice to the generator.
    pub kept: Option<Vec<usize>>,
    /// The friction model of `[identification]`.
    pub friction: &'static str,
}

/// Largest number of joints; larger mechanisms take the generator seconds.
const MAX_JOINTS: usize = 12;

impl Sketch {
    /// A regular mechanism.
    ///
    /// # Panics
    ///
    /// If thousands of draws are all singular.
    #[must_use]
    pub fn draw(seed: u64) -> Self {
        let mut dice = Dice::new(seed);
        let motion = draw_motion(&mut dice, seed);
        for _ in 0..20_000 {
            if let Some(mut sketch) = Self::attempt(&mut dice, seed, motion) {
                sketch.draw_friction();
                return sketch;
            }
        }
        panic!("seed {seed}: no regular mechanism with {motion:?}")
    }

    fn attempt(dice: &mut Dice, seed: u64, motion: Motion) -> Option<Self> {
        let home = draw_home(dice, motion);
        let mut sketch = Self {
            seed,
            motion,
            home,
            gravity: draw_gravity(dice),
            shapes: Vec::new(),
            platform: draw_inertia(dice),
            payload: None,
            kept: None,
            friction: dice.pick(&["symmetric", "asymmetric"]),
        };
        if motion == Motion::None {
            sketch
                .shapes
                .push(draw_shape(dice, &sketch, Structure::Tree)?);
            return Some(sketch);
        }
        if dice.chance(0.3) {
            sketch.payload = Some(draw_inertia(dice));
        }
        let dof = motion.dof();
        let actuators = dof + dice.pick(&[0, 0, 1, 1, 2, 3]);
        while sketch.actuators() < actuators {
            let structure = Structure::draw(dice, motion);
            let shape = draw_shape(dice, &sketch, structure)?;
            sketch.shapes.push(shape);
            if sketch.joints() > MAX_JOINTS {
                return None;
            }
        }
        if sketch.actuators() > dof + 3 || !sketch.is_regular() {
            return None;
        }
        if dice.chance(0.5) {
            sketch.kept = sketch.draw_kept(dice);
        }
        Some(sketch)
    }

    /// Number of actuators.
    #[must_use]
    pub fn actuators(&self) -> usize {
        let of = |shape: &Shape| shape.actuators() * shape.places.len();
        self.shapes.iter().map(of).sum()
    }

    /// Number of joint variables.
    #[must_use]
    pub fn joints(&self) -> usize {
        let of = |shape: &Shape| shape.independent().len() * shape.places.len();
        self.shapes.iter().map(of).sum()
    }

    /// Whether legs and inverse Jacobian are well conditioned at home, with a margin for the states
    /// around it.
    fn is_regular(&self) -> bool {
        let mechanism = self.mechanism();
        let still = DVector::zeros(mechanism.dof());
        let state = State::solve(&mechanism, &mechanism.home, &still, &still);
        let jacobians = state.and_then(|state| state.jacobians(&mechanism));
        jacobians.is_ok_and(|j| {
            let least = |matrix| singular_values(matrix).min() * MAX_CONDITION;
            // A single joint or coordinate has no condition number, so its size matters.
            least(&j.legs) > 1.0
                && least(&j.inverse) > 1.0
                && j.worst_leg_condition(&mechanism) < MAX_CONDITION / 3.0
                && condition(&j.inverse) < MAX_CONDITION / 3.0
                && condition(&j.a_p) < MAX_CONDITION / 2.0
        })
    }

    /// Draws kept actuators that determine the platform's motion at home.
    fn draw_kept(&self, dice: &mut Dice) -> Option<Vec<usize>> {
        let mechanism = self.mechanism();
        let still = DVector::zeros(mechanism.dof());
        let state = State::solve(&mechanism, &mechanism.home, &still, &still).ok()?;
        let inverse = state.jacobians(&mechanism).ok()?.inverse;
        let largest = singular_values(&inverse).max();
        let mut order: Vec<usize> = (0..inverse.nrows()).collect();
        (0..20).find_map(|_| {
            dice.shuffle(&mut order);
            let kept = &order[..inverse.ncols()];
            let values = singular_values(&inverse.select_rows(kept));
            let regular = values.min() > largest / MAX_CONDITION;
            regular.then(|| kept.to_vec())
        })
    }
}

/// Every motion in turn, with random axes.
fn draw_motion(dice: &mut Dice, seed: u64) -> Motion {
    let axis = dice.below(3);
    match seed % 8 {
        0 => {
            let point = Vector3::from_fn(|_, _| dice.length(0.3));
            let direction = Vector3::ith(axis, 1.0);
            if dice.chance(0.5) {
                Motion::Slide { point, direction }
            } else {
                Motion::Hinge { point, direction }
            }
        }
        1 => Motion::Point(axis),
        2 => Motion::Planar(axis),
        3 => Motion::Translation,
        4 => Motion::Schoenflies(axis),
        5 => Motion::Spherical,
        6 => Motion::Spatial,
        _ => Motion::None,
    }
}

/// Draws a home pose; coordinates that the motion lacks stay zero.
fn draw_home(dice: &mut Dice, motion: Motion) -> Placement {
    let mut home = Placement::default();
    if let Motion::Slide { point, .. } | Motion::Hinge { point, .. } = motion {
        home.at = point.into();
    }
    if dice.chance(0.2) {
        return home;
    }
    let basis = motion.twist_basis();
    for row in (0..6).filter(|&row| basis.row(row).amax() > 0.0) {
        match row {
            0..3 => home.at[row] += dice.length(0.2),
            _ => home.rotation[row - 3] = dice.angle(0.5),
        }
    }
    home
}

fn draw_gravity(dice: &mut Dice) -> [f64; 3] {
    match dice.below(6) {
        0 => [0.0; 3],
        1 => [0.0, 0.0, -9.81],
        2 => {
            let mut along = [0.0; 3];
            along[dice.below(3)] = 9.81;
            along
        }
        _ => std::array::from_fn(|_| dice.length(9.0)),
    }
}

/// Draws the parameters of a free body.
fn draw_inertia(dice: &mut Dice) -> Vec<&'static str> {
    match dice.below(3) {
        0 => vec!["inertia"],
        1 => vec!["m"],
        _ => dice.some(&crate::reference::parameters::SYMBOLS[..10]),
    }
}

/// Draws the parameters of a leg body and its joint.
fn draw_parameters(dice: &mut Dice, kind: JointKind) -> Vec<&'static str> {
    if kind == JointKind::Fixed {
        return draw_inertia(dice);
    }
    match dice.below(5) {
        0 => vec!["all"],
        1 => Vec::new(),
        2 => vec!["inertia", "ia"],
        3 => vec!["m", "zz", "friction"],
        // The last symbols, spring coefficient and other kinds of friction, are for joints with a
        // spring only.
        _ => dice.some(&crate::reference::parameters::SYMBOLS[..14]),
    }
}
