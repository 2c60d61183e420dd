//! Writes a sketch as a description in TOML.

use super::{Attachment, Member, Placed, Placement, Shape, Sketch};
use crate::reference::{JointKind, Motion};
use overact_codegen::Source;
use std::fmt::Write;

const AXES: [&str; 3] = ["x", "y", "z"];

impl Sketch {
    /// The description.
    #[must_use]
    pub fn source(&self) -> Source {
        Source::new(format!("random{}.toml", self.seed), self.text())
    }

    /// The description's text.
    #[must_use]
    pub fn text(&self) -> String {
        let [gx, gy, gz] = self.gravity;
        let mut text = format!("name = \"Random\"\ngravity = [{gx:?}, {gy:?}, {gz:?}]\n");
        self.write_platform(&mut text);
        for (index, shape) in self.shapes.iter().enumerate() {
            shape.write_leg(&mut text, index);
        }
        let mut leg = 0;
        for (index, shape) in self.shapes.iter().enumerate() {
            for placed in &shape.places {
                leg += 1;
                shape.write_place(&mut text, index, leg, placed);
            }
        }
        line(&mut text, "\n[identification]");
        line(&mut text, &format!("friction = \"{}\"", self.friction));
        if let Some(kept) = &self.kept {
            let names = self.actuator_names();
            let names: Vec<&str> = kept.iter().map(|&at| names[at].as_str()).collect();
            line(&mut text, &format!("kept_actuators = {names:?}"));
        }
        text
    }

    fn write_platform(&self, text: &mut String) {
        let (word, axis) = match self.motion {
            Motion::None | Motion::Joints(_) => return,
            Motion::Slide { direction, .. } | Motion::Hinge { direction, .. } => {
                ("fixed axis", Some(direction.iamax()))
            }
            Motion::Point(axis) => ("point", Some(axis)),
            Motion::Planar(axis) => ("planar", Some(axis)),
            Motion::Translation => ("translation", None),
            Motion::Schoenflies(axis) => ("schoenflies", Some(axis)),
            Motion::Spherical => ("spherical", None),
            Motion::Spatial | Motion::Parasitic(_) => ("spatial", None),
        };
        line(text, &format!("\n[platform]\nmotion = \"{word}\""));
        let point = match self.motion {
            Motion::Slide { point, .. } => Some(("translation", point)),
            Motion::Hinge { point, .. } => Some(("rotation", point)),
            _ => None,
        };
        let axis = axis.map(|axis| AXES[axis]);
        match (axis, point) {
            (Some(axis), Some((motion, at))) => {
                let [x, y, z]: [f64; 3] = at.into();
                let at = format!("at = [{x:?}, {y:?}, {z:?}]");
                let of = format!("direction = \"{axis}\", motion = \"{motion}\", {at}");
                line(text, &format!("axis = {{ {of} }}"));
            }
            (Some(axis), None) => line(text, &format!("axis = \"{axis}\"")),
            _ => {}
        }
        let Placement { at, rotation } = self.home;
        let basis = self.motion.twist_basis();
        let name = |row: usize| match (row, self.motion) {
            (0..3, _) => AXES[row],
            (_, Motion::Hinge { .. } | Motion::Planar(_) | Motion::Schoenflies(_)) => "phi",
            (_, _) => ["rx", "ry", "rz"][row - 3],
        };
        let given = (0..6)
            .filter(|&row| basis.row(row).amax() > 0.0)
            .map(|row| {
                let value = match row {
                    0..3 => format!("{:?}", at[row] - point.map_or(0.0, |(_, p)| p[row])),
                    _ => angle(rotation[row - 3]),
                };
                format!("{} = {value}", name(row))
            });
        let given: Vec<String> = given.collect();
        line(text, &format!("home = {{ {} }}", given.join(", ")));
        line(text, &format!("parameters = {:?}", self.platform));
        if let Some(payload) = &self.payload {
            line(
                text,
                &format!("\n[platform.payload]\nparameters = {payload:?}"),
            );
        }
    }

    /// Names of legs and joints, as in `kept_actuators`.
    fn actuator_names(&self) -> Vec<String> {
        let mut names = Vec::new();
        let mut leg = 0;
        for shape in &self.shapes {
            for _ in &shape.places {
                leg += 1;
                let driven = |m: &Member| m.joint.actuated;
                let of: Vec<usize> = (0..shape.members.len())
                    .filter(|&at| driven(&shape.members[at]))
                    .collect();
                let several = of.len() > 1;
                names.extend(of.iter().map(|joint| {
                    if several {
                        format!("leg{leg}.{}", joint + 1)
                    } else {
                        format!("leg{leg}")
                    }
                }));
            }
        }
        names
    }
}

impl Shape {
    fn write_leg(&self, text: &mut String, index: usize) {
        let numbers: Vec<String> = (0..3)
            .flat_map(|at| ["base", "turn", "end", "tilt"].map(|of| format!("{of}{at}")))
            .collect();
        let is_rigid = matches!(self.places[0].end, Attachment::Rigid(_));
        let has_end = self.places[0].end != Attachment::Free;
        let used = |name: &&String| {
            name.starts_with("base")
                || name.starts_with("turn")
                || has_end && name.starts_with("end")
                || is_rigid && name.starts_with("tilt")
        };
        let used: Vec<&String> = numbers.iter().filter(used).collect();
        line(text, &format!("\n[leg.shape{index}]\nvariables = {used:?}"));
        line(
            text,
            &format!(
                "base = {{ at = {}, rotation = {} }}",
                list("base"),
                list("turn")
            ),
        );
        match self.places[0].end {
            Attachment::Free => {}
            Attachment::Rigid(_) => line(
                text,
                &format!(
                    "end = {{ type = \"rigid\", at = {}, rotation = {} }}",
                    list("end"),
                    list("tilt")
                ),
            ),
            Attachment::Point(_, along) => {
                let axes: Vec<&str> = (0..3).filter(|&a| along[a]).map(|a| AXES[a]).collect();
                let along = match axes.len() {
                    3 => String::new(),
                    _ => format!(", along = {axes:?}"),
                };
                let at = list("end");
                line(
                    text,
                    &format!("end = {{ type = \"point\", at = {at}{along} }}"),
                );
            }
        }
        for member in &self.members {
            write_joint(text, index, &self.members, member);
        }
    }

    fn write_place(&self, text: &mut String, index: usize, leg: usize, placed: &Placed) {
        line(
            text,
            &format!("\n[[place]]\nname = \"leg{leg}\"\nshape = \"shape{index}\""),
        );
        let (end, tilt) = match placed.end {
            Attachment::Free => (None, None),
            Attachment::Rigid(Placement { at, rotation }) => (Some(at), Some(rotation)),
            Attachment::Point(at, _) => (Some(at), None),
        };
        for k in 0..3 {
            line(text, &format!("base{k} = {:?}", placed.base.at[k]));
            line(
                text,
                &format!("turn{k} = {}", angle(placed.base.rotation[k])),
            );
            if let Some(end) = end {
                line(text, &format!("end{k} = {:?}", end[k]));
            }
            if let Some(tilt) = tilt {
                line(text, &format!("tilt{k} = {}", angle(tilt[k])));
            }
        }
        let homes = self.independent().into_iter().zip(&placed.home);
        let homes: Vec<String> = homes
            .map(|(joint, value)| {
                let value = match self.members[joint].joint.kind {
                    JointKind::Revolute => angle(*value),
                    _ => format!("{value:?}"),
                };
                format!("{} = {value}", joint + 1)
            })
            .collect();
        line(text, &format!("home = {{ {} }}", homes.join(", ")));
    }
}

fn write_joint(text: &mut String, shape: usize, members: &[Member], member: &Member) {
    let joint = &member.joint;
    let (kind, own) = match joint.kind {
        JointKind::Revolute => ("revolute", Some("theta")),
        JointKind::Prismatic => ("prismatic", Some("r")),
        JointKind::Fixed => ("fixed", None),
    };
    line(
        text,
        &format!("\n[[leg.shape{shape}.joint]]\ntype = \"{kind}\""),
    );
    let antecedent = joint
        .antecedent
        .map_or("base".to_owned(), |a| (a + 1).to_string());
    line(text, &format!("antecedent = \"{antecedent}\""));
    let steps = [
        ("gamma", angle(joint.gamma)),
        ("b", format!("{:?}", joint.b)),
        ("alpha", angle(joint.alpha)),
        ("d", format!("{:?}", joint.d)),
        ("theta", angle(joint.theta)),
        ("r", format!("{:?}", joint.r)),
    ];
    for (key, value) in steps {
        if own == Some(key) {
            let term = |&(of, factor): &(usize, f64)| {
                let unit = match (joint.kind, members[of].joint.kind) {
                    (JointKind::Prismatic, JointKind::Revolute) => " m/rad",
                    (JointKind::Revolute, JointKind::Prismatic) => " rad/m",
                    _ => "",
                };
                format!("{factor:?}{unit} * q{}", of + 1)
            };
            let terms: Vec<String> = joint.terms.iter().map(term).collect();
            let constant = value.trim_matches('"');
            line(
                text,
                &format!("{key} = \"{} + {constant}\"", terms.join(" + ")),
            );
        } else {
            line(text, &format!("{key} = {value}"));
        }
    }
    if joint.actuated {
        line(text, "actuated = true");
    }
    line(text, &format!("parameters = {:?}", member.parameters));
    if let Some(velocity) = joint.stribeck {
        line(text, &format!("stribeck = {velocity:?}"));
    }
    if let Some(load) = member.load {
        line(
            text,
            &format!("friction_load = {:?}", load.text(joint.kind)),
        );
    }
}

/// Angle: whole degrees in degrees, others in radians.
fn angle(value: f64) -> String {
    let degrees = value.to_degrees().round();
    if (degrees.to_radians() - value).abs() < 1e-15 {
        format!("\"{degrees} deg\"")
    } else {
        format!("{value:?}")
    }
}

/// List of three variables.
fn list(of: &str) -> String {
    format!("[\"{of}0\", \"{of}1\", \"{of}2\"]")
}

fn line(text: &mut String, line: &str) {
    // Writing to a string does not fail.
    let _ = writeln!(text, "{line}");
}
