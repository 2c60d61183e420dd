//! Tendons: fixed ones are linear combinations of joints.
//!
//! As targets of actuators they become motors of several joints, in equalities couplings of joints.
//! Forces that tendons exert by themselves are supported for those of a single joint, springs and
//! dampers also for spatial tendons between two sites.

use super::{Reader, Sites, bodies::first, defaults::MAIN};
use crate::{
    assembly::motion::Motion,
    files::{Files, Place},
    model::{JointType, Model, Motor, PointSpring, Pose},
    motors::independent,
    xml::Element,
};
use nalgebra::Point3;

/// Tag of tendon defaults.
const TENDON: &str = "tendon";

/// A tendon.
#[derive(Debug)]
pub(super) struct Tendon {
    pub(super) name: String,
    /// Joints and their coefficients in its length; `None` for a path in space.
    pub(super) joints: Option<Vec<(usize, f64)>>,
    /// Body and point of each site; `None` for a path around geoms or over pulleys.
    path: Option<Vec<(usize, Point3<f64>)>>,
    stiffness: f64,
    /// Smallest and largest length without force; `None` for that of the springs' positions.
    rest: Option<[f64; 2]>,
    damping: f64,
    friction: f64,
    armature: f64,
    tag: String,
    place: Place,
    /// Whether an actuator has taken over its inertia and friction, or an equality uses it.
    is_used: bool,
}

/// All tendons of a file.
#[derive(Debug, Default)]
pub(super) struct Tendons(Vec<Tendon>);

impl Tendons {
    pub(super) fn read(reader: &Reader<'_>, root: &Element, sites: &Sites, model: &Model) -> Self {
        let mut all = Vec::new();
        for section in root.all("tendon") {
            for element in &section.children {
                let whole = reader
                    .defaults
                    .apply_as(TENDON, reader.files, element, MAIN);
                all.push(tendon(reader.files, &whole, sites, model));
            }
        }
        Self(all)
    }

    /// Tendon with a name; reports an error if there is none.
    pub(super) fn find(&mut self, files: &Files, name: &str, place: &Place) -> Option<&mut Tendon> {
        let Some(at) = self.0.iter().position(|own| own.name == name) else {
            let near = files.did_you_mean(name, self.0.iter().map(|own| own.name.as_str()));
            let help = near.unwrap_or_else(|| "name a tendon".to_owned());
            files.report(place, format!("there is no tendon `{name}`"), help);
            return None;
        };
        self.0[at].is_used = true;
        Some(&mut self.0[at])
    }

    /// Adds inertia, friction and springs of tendons without an actuator to their joints, and springs
    /// and dampers between two sites to the model.
    ///
    /// Rejects tendons that exert other forces, and reports those without a use.
    pub(super) fn finish(self, files: &Files, model: &mut Model) {
        let poses = Motion::new(model).at_rest();
        for own in self.0 {
            if own.has_spring() && own.joints.is_some() {
                own.add_to_joint(files, model);
            } else if (own.has_spring() || own.damping != 0.0) && own.joints.is_none() {
                if let Some(spring) = own.between_points(files, &poses) {
                    model.springs.push(spring);
                }
                if [own.friction, own.armature] == [0.0; 2] {
                    continue;
                }
            }
            let damping = own.joints.as_ref().map_or(0.0, |_| own.damping);
            let has_forces = [damping, own.friction, own.armature] != [0.0; 3];
            let is_used = own.is_used || own.has_spring();
            let turns = own.joints.map(|joints| independent(model, &joints));
            match turns.as_deref() {
                Some([(joint, factor)]) if has_forces => {
                    let joint = &mut model.joints[*joint];
                    joint.damping += factor * factor * own.damping;
                    joint.friction += factor.abs() * own.friction;
                    joint.armature += factor * factor * own.armature;
                }
                _ if has_forces => {
                    let message = format!(
                        "the tendon `{}` exerts forces, which is not supported without a motor of its joints",
                        own.name
                    );
                    let help = "remove its damping, frictionloss and armature";
                    files.report(&own.place, message, help);
                }
                _ if !is_used => {
                    let reason = "exerts no force; its limits are not used";
                    files.demote(&own.place, &own.tag, None, reason);
                }
                _ => {}
            }
        }
    }
}

impl Tendon {
    fn has_spring(&self) -> bool {
        self.stiffness != 0.0
    }

    /// The only length without force; reports an interval of lengths.
    fn single_rest(&self, files: &Files) -> Option<Option<f64>> {
        match self.rest {
            None => Some(None),
            Some([low, high]) if low == high => Some(Some(low)),
            Some(_) => {
                let name = &self.name;
                let message = format!(
                    "the spring of the tendon `{name}` has an interval without force, which is not supported"
                );
                let help = "write one `springlength`, or remove the `stiffness`";
                files.report(&self.place, message, help);
                None
            }
        }
    }

    /// Adds the spring of a fixed tendon of one joint to the joint.
    fn add_to_joint(&self, files: &Files, model: &mut Model) {
        let Some(rest) = self.single_rest(files) else {
            return;
        };
        let joints = self.joints.as_deref().unwrap_or_default();
        let &[(joint, factor)] = joints else {
            let name = &self.name;
            let message = format!(
                "the spring of the tendon `{name}` acts on several joints, which is not supported"
            );
            let help = "write `stiffness` and `springref` at a joint, or remove the `stiffness`";
            files.report(&self.place, message, help);
            return;
        };
        if factor == 0.0 {
            return;
        }
        let own = &mut model.joints[joint];
        let at_rest = own.rest.unwrap_or(own.home);
        // Lengths are sums of positions of joints.
        let rest = rest.map_or(at_rest, |length| length / factor);
        own.tendon_stiffness += factor * factor * self.stiffness;
        if !own.add_spring(factor * factor * self.stiffness, rest) {
            let joint = own.name.clone();
            let message = format!(
                "the springs of the joint `{joint}` and of the tendon `{}` leave a constant torque, which is not supported",
                self.name
            );
            files.report(&self.place, message, "remove one of them");
        }
    }

    /// Spring and damper of a spatial tendon between two sites.
    ///
    /// `poses` are those of the bodies where it exerts no force by default.
    fn between_points(&self, files: &Files, poses: &[Pose]) -> Option<PointSpring> {
        let name = &self.name;
        let Some(&[(a, at_a), (b, at_b)]) = self.path.as_deref() else {
            let message = format!(
                "the tendon `{name}` exerts forces along a path that is no straight line, which is not supported"
            );
            let help = "let it connect two sites, or remove its stiffness and damping";
            files.report(&self.place, message, help);
            return None;
        };
        let rest = self.single_rest(files)?;
        let length = || (poses[a] * at_a - poses[b] * at_b).norm();
        Some(PointSpring {
            name: name.clone(),
            bodies: [a, b],
            at: [at_a, at_b],
            stiffness: self.stiffness,
            damping: self.damping,
            rest: rest.unwrap_or_else(length),
            place: self.place.clone(),
        })
    }

    /// Motor that pulls at the tendon, with the tendon's own inertia and friction.
    ///
    /// Later motors of the same tendon do not have them again.
    pub(super) fn motor(&mut self, joints: &[(usize, f64)], place: &Place) -> Motor {
        let taken = std::mem::take;
        Motor {
            turns: joints.to_vec(),
            armature: taken(&mut self.armature),
            damping: taken(&mut self.damping),
            friction: taken(&mut self.friction),
            ..Motor::new(place.clone())
        }
    }
}

fn tendon(files: &Files, element: &Element, sites: &Sites, model: &Model) -> Tendon {
    let joints = (element.name == "fixed").then(|| {
        let joints = element.all("joint");
        joints.filter_map(|own| term(files, own, model)).collect()
    });
    let rest = element.list(files, "springlength").unwrap_or_default();
    let rest = match rest[..] {
        [both] => Some([both; 2]),
        [low, high, ..] => Some([low, high]),
        [] => None,
    };
    let [stiffness, damping, friction, armature] =
        ["stiffness", "damping", "frictionloss", "armature"].map(|key| first(files, element, key));
    Tendon {
        name: element.get("name").unwrap_or("unnamed").to_owned(),
        joints,
        path: path(files, element, sites),
        stiffness,
        // Negative lengths are computed from the positions of springs.
        rest: rest.filter(|rest| *rest != [-1.0; 2]),
        damping,
        friction,
        armature,
        tag: element.name.clone(),
        place: element.place.clone(),
        is_used: false,
    }
}

/// Points of a spatial tendon on their bodies; `None` for another path, or for a fixed tendon.
fn path(files: &Files, element: &Element, sites: &Sites) -> Option<Vec<(usize, Point3<f64>)>> {
    if element.name == "fixed" {
        return None;
    }
    let has_other = ["geom", "pulley"].map(|tag| element.all(tag).next().is_some());
    if has_other.contains(&true) {
        return None;
    }
    let ends: Vec<&Element> = element.all("site").collect();
    if ends.len() != 2 {
        return None;
    }
    let point = |own: &Element| {
        let name = own.required(files, "site")?;
        let Some((body, frame)) = sites.get(name) else {
            let near = files.did_you_mean(name, sites.keys().map(String::as_str));
            let help = near.unwrap_or_else(|| "name a site of a body".to_owned());
            files.report(&own.place, format!("there is no site `{name}`"), help);
            return None;
        };
        Some((*body, Point3::from(frame.translation.vector)))
    };
    Some(ends.into_iter().filter_map(point).collect())
}

/// Joint and coefficient of a fixed tendon.
fn term(files: &Files, element: &Element, model: &Model) -> Option<(usize, f64)> {
    let name = element.required(files, "joint")?;
    let Some(joint) = model.joint_named(name) else {
        let help = files.joint_help(name, model.joints.iter().map(|own| own.name.as_str()));
        files.report(&element.place, format!("there is no joint `{name}`"), help);
        return None;
    };
    if model.joints[joint].kind == JointType::Ball {
        let message = format!("`{name}` is a ball joint, of which no tendon can consist");
        files.report(&element.place, message, "name hinges and slides");
        return None;
    }
    Some((joint, element.number(files, "coef", 0.0)))
}
