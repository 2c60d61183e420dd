//! Inertia adjustments of `<compiler>`, and springs given by `springdamper`.
//!
//! They are applied after all bodies were read, in MuJoCo's order: bounds, balance, total mass,
//! springs.

use super::{BOOLEAN, Compiler};
use crate::{
    assembly::motion::Motion,
    files::Files,
    model::{Inertia, Model},
    xml::Element,
};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use std::collections::BTreeMap;

/// Attributes of `<compiler>` that change inertias.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Adjustments {
    least_mass: f64,
    least_inertia: f64,
    is_balanced: bool,
    /// Total mass of all bodies; `None` keeps the masses.
    total_mass: Option<f64>,
    /// Whether static bodies are fused into the world, so that their mass does not count.
    is_static_fused: bool,
}

impl Adjustments {
    /// Overrides the settings with the element's attributes.
    pub(super) fn read(&mut self, files: &Files, compiler: &Element) {
        self.least_mass = compiler.number(files, "boundmass", self.least_mass);
        self.least_inertia = compiler.number(files, "boundinertia", self.least_inertia);
        if let Some(word) = compiler.keyword(files, "balanceinertia", BOOLEAN) {
            self.is_balanced = word == "true";
        }
        if let Some(word) = compiler.keyword(files, "fusestatic", BOOLEAN) {
            self.is_static_fused = word == "true";
        }
        if compiler.get("settotalmass").is_some() {
            let total = compiler.number(files, "settotalmass", -1.0);
            self.total_mass = (total > 0.0).then_some(total);
        }
    }

    /// Whether masses or moments have lower bounds.
    pub(super) fn has_bounds(&self) -> bool {
        self.least_mass > 0.0 || self.least_inertia > 0.0
    }

    /// Whether bounds or balance change the inertias of single bodies.
    fn changes_single_inertias(&self) -> bool {
        self.has_bounds() || self.is_balanced
    }

    /// Whether the settings change inertias at all.
    fn changes_inertias(&self) -> bool {
        self.changes_single_inertias() || self.total_mass.is_some()
    }
}

/// Applies bounds, balance and total mass to all inertias.
pub(super) fn inertias(files: &Files, root: &Element, compiler: &Compiler, model: &mut Model) {
    let adjustments = compiler.adjustments;
    model.adjusts_inertias =
        adjustments.changes_inertias() || compiler.inertia_from_geometry == Some(true);
    let is_moving = moving(model);
    // Bodies without a location are auxiliary bodies between joints and do not exist in MuJoCo.
    let is_own = |at: usize| {
        model.bodies[at].place.is_some() && (is_moving[at] || !adjustments.is_static_fused)
    };
    let own: Vec<usize> = (1..model.bodies.len()).filter(|&at| is_own(at)).collect();
    if adjustments.changes_single_inertias() {
        for &at in &own {
            let body = &mut model.bodies[at];
            if !body.has_unknown_inertia {
                let inertia = body.inertia.unwrap_or(NOTHING);
                body.inertia = Some(bounded(inertia, &adjustments));
            }
        }
    }
    let Some(total) = adjustments.total_mass else {
        return;
    };
    let all = own.iter().map(|&at| &model.bodies[at]);
    let sum: f64 = all.filter_map(|body| Some(body.inertia?.mass)).sum();
    if own.iter().any(|&at| model.bodies[at].has_unknown_inertia) || sum <= 0.0 {
        let element = root
            .all("compiler")
            .find(|own| own.get("settotalmass").is_some());
        if let Some(element) = element {
            let reason = "masses of some bodies are unknown, so the others are not scaled";
            files.demote(&element.place, "compiler", Some("settotalmass"), reason);
        }
        return;
    }
    for at in own {
        if let Some(inertia) = &mut model.bodies[at].inertia {
            inertia.mass *= total / sum;
            inertia.tensor *= total / sum;
        }
    }
}

const NOTHING: Inertia = Inertia {
    mass: 0.0,
    centre: nalgebra::Point3::new(0.0, 0.0, 0.0),
    tensor: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
};

/// Bodies that a joint moves.
pub(super) fn moving(model: &Model) -> Vec<bool> {
    let mut moving = vec![false; model.bodies.len()];
    for (at, body) in model.bodies.iter().enumerate().skip(1) {
        moving[at] = body.joint.is_some() || moving[body.parent];
    }
    moving
}

/// Inertia with mass and principal moments at or above their bounds.
///
/// `balanceinertia` also enforces the triangle inequality of the moments.
fn bounded(inertia: Inertia, adjustments: &Adjustments) -> Inertia {
    let principal = inertia.tensor.symmetric_eigen();
    let least = adjustments.least_inertia;
    let mut moments = principal.eigenvalues.map(|moment| moment.max(least));
    let largest = moments.max();
    let is_impossible = moments.sum() - largest < largest;
    if adjustments.is_balanced && is_impossible {
        moments = Vector3::repeat(moments.mean());
    }
    let axes = principal.eigenvectors;
    // Unchanged moments keep their digits.
    let tensor = if moments == principal.eigenvalues {
        inertia.tensor
    } else {
        axes * Matrix3::from_diagonal(&moments) * axes.transpose()
    };
    Inertia {
        mass: inertia.mass.max(adjustments.least_mass),
        tensor,
        ..inertia
    }
}

/// Spring and damper given by time constant and damping ratio.
#[derive(Debug, Clone, Copy)]
pub(super) struct SpringDamper {
    pub(super) joint: usize,
    pub(super) time_constant: f64,
    pub(super) damping_ratio: f64,
    /// Rest position of the spring.
    pub(super) rest: f64,
}

/// Sets stiffness and damping: k = M / (T² ζ²), d = 2 M / T.
///
/// M is the inertia at a joint in the file's configuration while all other joints are free. Damping
/// of actuators adds to d.
pub(super) fn springs(files: &Files, model: &mut Model, springs: &[SpringDamper]) {
    if springs.is_empty() {
        return;
    }
    let inverse = inverse_masses(model);
    for spring in springs {
        let inertia = inverse
            .as_ref()
            .and_then(|inverse| inverse.get(&spring.joint))
            .map(|inverse| 1.0 / inverse);
        let joint = &mut model.joints[spring.joint];
        let Some(inertia) = inertia else {
            let message = "`springdamper` needs the inertia of all bodies that move";
            let help = "give each of them an <inertial>, or write `stiffness` and `damping`";
            files.report(&joint.place, message, help);
            return;
        };
        let square = (spring.time_constant * spring.damping_ratio).powi(2);
        let [stiffness, damping] = [inertia / square, 2.0 * inertia / spring.time_constant];
        if !joint.add_spring(stiffness, spring.rest) {
            let message =
                "`springdamper` and a tendon leave a constant torque, which is not supported";
            files.report(&joint.place, message, "remove one of them");
        }
        joint.timed_spring = Some([stiffness, damping]);
        joint.damping += damping;
    }
}

/// Diagonal of the inverse mass matrix in the file's configuration, for joints with one coordinate.
///
/// Couplings are ignored; `None` if the matrix is singular.
fn inverse_masses(model: &Model) -> Option<BTreeMap<usize, f64>> {
    if model.bodies.iter().any(|body| body.has_unknown_inertia) {
        return None;
    }
    let mut free = model.clone();
    free.joints.iter_mut().for_each(|joint| joint.follow = None);
    let motion = Motion::new(&free);
    let state = motion.start();
    let twists = motion.twists(&state);
    let rotors = motion.coordinates.iter();
    let rotors = rotors.map(|coordinate| free.joints[coordinate.joint].armature);
    let rotors: Vec<f64> = rotors.collect();
    let mut masses = DMatrix::from_diagonal(&DVector::from_vec(rotors));
    for (at, body) in free.bodies.iter().enumerate().skip(1) {
        let Some(inertia) = body.inertia else {
            continue;
        };
        let placed = inertia.transformed(&state.poses[at]);
        let angular = twists[at].rows(3, 3);
        // Velocity of the centre of mass c: v + ω × c.
        let centre = placed.centre.coords.cross_matrix();
        let linear = twists[at].rows(0, 3) - centre * angular;
        masses += linear.transpose() * &linear * placed.mass;
        masses += angular.transpose() * placed.tensor * angular;
    }
    let inverse = masses.cholesky()?.inverse();
    let coordinates = motion.coordinates.iter().enumerate();
    let diagonal = coordinates.map(|(at, own)| (own.joint, inverse[(at, at)]));
    Some(diagonal.collect())
}
