//! Builds the joints of a leg: axes at home, names, parameters and their values.

use super::{Joint, names::Names};
use crate::{
    assembly::{
        coordinates::Tree,
        network::{Edge, Network, Origin},
        platform::Platform,
        solvable_chains::{Ending, SolvableChain},
    },
    files::Files,
    frames::{
        leg::{Framed, Node, any_across},
        step::Step,
    },
    model::{Inertia, JointType, Motor, Pose},
};
use nalgebra::{Point3, Vector3};

/// A leg under construction.
pub(super) struct Draft<'d, 'm> {
    files: &'d Files,
    network: &'d Network<'m>,
    /// Edges whose joints the chains determine.
    dependent: &'d [usize],
    pub(super) nodes: Vec<Node>,
    /// Group that each node carries; `None` for massless bodies within a universal or ball joint.
    pub(super) groups: Vec<Option<usize>>,
    pub(super) names: Vec<String>,
    /// Edge of each node, and which of the edge's axes.
    origins: Vec<(usize, usize)>,
    pub(super) used: Names,
}

impl<'d, 'm> Draft<'d, 'm> {
    pub(super) fn new(files: &'d Files, network: &'d Network<'m>, dependent: &'d [usize]) -> Self {
        Self {
            files,
            network,
            dependent,
            nodes: Vec::new(),
            groups: Vec::new(),
            names: Vec::new(),
            origins: Vec::new(),
            used: Names::default(),
        }
    }

    /// Adds the axes of all edges of a tree.
    pub(super) fn push_tree(&mut self, tree: &Tree, may_shorten: bool) {
        for &(edge, from) in tree {
            let groups = self.network.edges[edge].groups;
            let to = groups[usize::from(groups[0] == from)];
            self.push(edge, from, to, may_shorten);
        }
    }

    /// Adds the axes of an edge that is traversed from one group to another.
    pub(super) fn push(&mut self, index: usize, from: usize, to: usize, may_shorten: bool) {
        let edge = &self.network.edges[index];
        let antecedent = self.groups.iter().position(|group| *group == Some(from));
        let home = &self.network.states[0];
        let axis = self.network.axis(edge, home);
        let sign = if edge.groups[0] == from { 1.0 } else { -1.0 };
        let position = match edge.origin {
            // The variable of a coupled joint excludes the constant, which is part of the joint's
            // expression.
            Origin::Joint(joint) => home.positions[joint] - self.constant(joint),
            Origin::Closure(_) | Origin::Platform => 0.0,
        };
        let name = self.network.edge_name(edge).to_owned();
        if let (Origin::Platform, Some(platform)) = (edge.origin, &self.network.platform) {
            self.push_platform(index, to, platform);
            return;
        }
        if edge.kind != JointType::Ball {
            self.nodes.push(Node {
                antecedent,
                is_prismatic: edge.kind == JointType::Prismatic,
                is_screw: self.is_screw(edge),
                point: axis.point,
                direction: axis.direction * sign,
                home: position,
            });
            self.finish(index, 0, Some(to), &name);
            return;
        }
        let is_rod = self.network.groups[to].spins && may_shorten;
        let axes = self.ball_axes(
            antecedent,
            axis.point,
            is_rod.then(|| self.network.line(to, home)),
        );
        for (at, direction) in axes.iter().enumerate() {
            let antecedent = if at == 0 {
                antecedent
            } else {
                Some(self.nodes.len() - 1)
            };
            let node = Node {
                antecedent,
                is_prismatic: false,
                is_screw: false,
                point: axis.point,
                direction: *direction,
                home: 0.0,
            };
            self.nodes.push(node);
            let group = (at + 1 == axes.len()).then_some(to);
            self.finish(index, at, group, &format!("{name}_{}", at + 1));
        }
    }

    /// Adds the displacements of a platform as joints.
    fn push_platform(&mut self, index: usize, to: usize, platform: &Platform) {
        let name = self.network.group_name(to).to_owned();
        let point = platform.at(self.network, &self.network.states[0]);
        let axes = platform.axes();
        for (at, (kind, direction)) in axes.iter().enumerate() {
            self.nodes.push(Node {
                antecedent: (at > 0).then(|| self.nodes.len() - 1),
                is_prismatic: *kind == JointType::Prismatic,
                is_screw: false,
                point,
                direction: *direction,
                home: 0.0,
            });
            let group = (at + 1 == axes.len()).then_some(to);
            self.finish(index, at, group, &format!("{name}_{}", at + 1));
        }
    }

    /// Whether an edge is the slide of a screw.
    fn is_screw(&self, edge: &Edge) -> bool {
        let Origin::Joint(joint) = edge.origin else {
            return false;
        };
        let joints = &self.network.model.joints;
        let leader = joints[joint].follow.map(|follow| joints[follow.joint].kind);
        edge.kind == JointType::Prismatic && leader == Some(JointType::Revolute)
    }

    /// Whether every motor of a joint turns other joints as well.
    fn is_turned_with_others(&self, joint: usize) -> bool {
        let motors = self.network.model.motors.iter();
        let turns = |motor: &&Motor| motor.turns.iter().any(|(own, _)| *own == joint);
        let counts: Vec<usize> = motors
            .filter(turns)
            .map(|motor| motor.turns.len())
            .collect();
        !counts.is_empty() && counts.iter().all(|count| *count > 1)
    }

    /// Constant offset of a coupled joint's position.
    fn constant(&self, joint: usize) -> f64 {
        let follow = self.network.model.joints[joint].follow;
        follow.map_or(0.0, |follow| follow.offset)
    }

    fn finish(&mut self, edge: usize, axis: usize, group: Option<usize>, name: &str) {
        self.groups.push(group);
        self.origins.push((edge, axis));
        let name = self.used.unique(name);
        self.names.push(name);
    }

    /// Marks that the body of the last joint is described elsewhere.
    pub(super) fn end_without_body(&mut self) {
        if let Some(last) = self.groups.last_mut() {
            *last = None;
        }
    }

    /// Successive axes of a ball joint; two if the rod after it may spin.
    ///
    /// The first axis is parallel to the preceding joint if possible; none is along the rod.
    fn ball_axes(
        &self,
        antecedent: Option<usize>,
        centre: Point3<f64>,
        line: Option<Vector3<f64>>,
    ) -> Vec<Vector3<f64>> {
        let before = antecedent.map(|at| &self.nodes[at]).filter(|node| {
            let arm = (centre - node.point).cross(&node.direction).norm();
            !node.is_prismatic && arm > 1e-6
        });
        let before = before.map(|node| node.direction);
        match line {
            Some(line) => {
                let first = before.filter(|first| first.cross(&line).norm() > 0.3);
                let first = first.unwrap_or_else(|| any_across(&line));
                vec![first, first.cross(&line).normalize()]
            }
            None => {
                let first = before.unwrap_or_else(Vector3::z);
                let second = any_across(&first);
                vec![first, second, first.cross(&second)]
            }
        }
    }

    /// Joints in the form of the description.
    pub(super) fn joints(&self, framed: &[Framed]) -> Vec<Joint> {
        let mut all: Vec<Joint> = Vec::new();
        let mut taken = Names::default();
        for name in &self.names {
            taken.unique(name);
        }
        let mut last: Option<usize> = None;
        for (at, framed) in framed.iter().enumerate() {
            let own = self.nodes[at].antecedent;
            let mut antecedent = (own != last)
                .then(|| own.map_or_else(|| "base".to_owned(), |own| self.names[own].clone()));
            if framed.is_behind_turn {
                let name = taken.unique(&format!("{}_turn", self.names[at]));
                all.push(quarter(name, antecedent.take()));
            }
            all.push(self.joint(at, framed.step, antecedent));
            last = Some(at);
        }
        self.add_bodies(framed, &mut all);
        super::screws::join(self.network.model, &mut all);
        all
    }

    fn joint(&self, at: usize, step: Step, antecedent: Option<String>) -> Joint {
        let (index, axis) = self.origins[at];
        let edge = &self.network.edges[index];
        let node = &self.nodes[at];
        let mut joint = Joint {
            name: self.names[at].clone(),
            kind: if node.is_prismatic {
                "prismatic"
            } else {
                "revolute"
            },
            pitch: None,
            antecedent,
            step,
            follows: None,
            is_dependent: self.dependent.contains(&index),
            actuated: false,
            parameters: Some(Vec::new()),
            values: Vec::new(),
            spring: None,
            home: node.home,
            of: None,
            carries: None,
            comment: Vec::new(),
        };
        if axis == 0 {
            joint.comment.push(self.described(edge));
            if edge.kind == JointType::Ball {
                joint.comment.extend(at_home(self.network, edge));
            }
        }
        self.torques(edge, &mut joint);
        joint
    }

    /// Comment that names the edge of the file.
    fn described(&self, edge: &Edge) -> String {
        let between = edge.groups.map(|group| self.network.group_name(group));
        let bodies = format!("from `{}` to `{}`", between[0], between[1]);
        let name = self.network.edge_name(edge);
        let line = match edge.origin {
            Origin::Joint(joint) => self.files.line(&self.network.model.joints[joint].place),
            Origin::Closure(closure) => {
                self.files.line(&self.network.model.closures[closure].place)
            }
            Origin::Platform => {
                return format!(
                    "Displacements of the platform `{}` from home, in the world",
                    self.network.group_name(edge.groups[1])
                );
            }
        };
        let kind = match edge.kind {
            JointType::Ball => "ball ",
            JointType::Revolute | JointType::Prismatic => "",
        };
        format!("{kind}`{name}` of line {line}, {bodies}")
    }

    /// Sets motor, friction, spring and coupling of a joint.
    fn torques(&self, edge: &Edge, joint: &mut Joint) {
        let Origin::Joint(at) = edge.origin else {
            return;
        };
        let own = &self.network.model.joints[at];
        if edge.kind == JointType::Ball {
            return;
        }
        joint.of = Some(at);
        joint.actuated = own.actuated && !own.is_turned;
        let mut symbols = Vec::new();
        let given = [
            ("ia", own.armature),
            ("fv", own.damping),
            ("fs", own.friction),
        ];
        for (symbol, value) in given {
            if value != 0.0 {
                joint.values.push((symbol, value));
            }
            // The rotor of a motor that turns several joints is a parameter of the motor.
            let is_of_motor = symbol == "ia" && self.is_turned_with_others(at);
            if value != 0.0 || joint.actuated && !is_of_motor {
                symbols.push(symbol);
            }
        }
        if joint.actuated {
            symbols.push("off");
        }
        if let Some((stiffness, rest)) = own.spring {
            joint.spring = Some(rest - self.constant(at));
            joint.values.push(("k", stiffness));
        }
        if let Some(follow) = own.follow {
            let leader = self.origins.iter().position(|(edge, _)| {
                self.network.edges[*edge].origin == Origin::Joint(follow.joint)
            });
            if leader.is_none() {
                let other = &self.network.model.joints[follow.joint].name;
                let message = format!(
                    "`{}` is coupled to `{other}`, which is in another leg here",
                    own.name
                );
                let help = "a joint can only be coupled to one of its own leg: remove the coupling from the file and drive the joint by a motor, or fix the joint";
                self.files.report(&own.place, message, help);
            }
            let leader = leader.map_or("", |at| self.names[at].as_str());
            let factor = crate::geometry::digits::fine(follow.factor, follow.factor);
            let unit = match (own.kind, self.network.model.joints[follow.joint].kind) {
                (JointType::Prismatic, JointType::Revolute) => " m/rad",
                (JointType::Revolute, JointType::Prismatic) => " rad/m",
                _ => "",
            };
            joint.follows = Some(format!("{factor}{unit} * q_{leader}"));
        }
        joint.comment.extend(own.gears.iter().cloned());
        joint.parameters = Some(symbols);
    }

    /// Adds the parameters of the carried bodies.
    fn add_bodies(&self, framed: &[Framed], joints: &mut [Joint]) {
        for (at, group) in self.groups.iter().enumerate() {
            let Some(group) = *group else { continue };
            let Some(joint) = joints.iter_mut().find(|joint| joint.name == self.names[at]) else {
                continue;
            };
            let inertia = self.network.groups[group].inertia;
            let inertia = inertia.filter(|i| !crate::assembly::simple::is_massless(Some(i)));
            if inertia.is_some() || self.network.groups[group].has_unknown_inertia {
                joint.parameters = match joint.parameters.take() {
                    Some(symbols) if symbols == ["ia", "fv", "fs", "off"] => None,
                    symbols => {
                        let own = symbols.unwrap_or_default();
                        Some(std::iter::once("inertia").chain(own).collect())
                    }
                };
            }
            let Some(inertia) = inertia else { continue };
            joint.carries = Some((group, framed[at].frame));
            let own = inertia.transformed(&framed[at].frame.inverse());
            let values = inertial(&own);
            joint.values.splice(0..0, values);
        }
    }
}

/// Inertial parameters about the origin of the frame, by symbol.
pub(super) fn inertial(own: &Inertia) -> [(&'static str, f64); 10] {
    let about = own.about_origin();
    let first = own.centre.coords * own.mass;
    [
        ("xx", about[(0, 0)]),
        ("xy", about[(0, 1)]),
        ("xz", about[(0, 2)]),
        ("yy", about[(1, 1)]),
        ("yz", about[(1, 2)]),
        ("zz", about[(2, 2)]),
        ("mx", first.x),
        ("my", first.y),
        ("mz", first.z),
        ("m", own.mass),
    ]
}

/// A massless body that is rotated by 90° about x.
fn quarter(name: String, antecedent: Option<String>) -> Joint {
    let step = Step {
        alpha: std::f64::consts::FRAC_PI_2,
        ..Step::default()
    };
    let comment = "Two nearly parallel axes: a rotation between them preserves the precision of the constants.";
    fixed(name, antecedent, step, vec![comment.to_owned()])
}

fn fixed(name: String, antecedent: Option<String>, step: Step, comment: Vec<String>) -> Joint {
    Joint {
        name,
        kind: "fixed",
        pitch: None,
        antecedent,
        step,
        follows: None,
        is_dependent: false,
        actuated: false,
        parameters: Some(Vec::new()),
        values: Vec::new(),
        spring: None,
        home: 0.0,
        of: None,
        carries: None,
        comment,
    }
}

/// Closure point in the frame of the last joint.
pub(super) fn tip(frame: &Pose, point: &Point3<f64>, used: &mut Names) -> Option<Joint> {
    let at = frame.inverse_transform_point(point);
    if at.coords.norm() < 1e-14 {
        return None;
    }
    let to = Pose::from_parts(at.coords.into(), nalgebra::Rotation3::identity());
    let mut step = Step::between(&Pose::identity(), &to)?;
    // Only the origin matters.
    step.theta = 0.0;
    (step.b, step.r) = (step.r, 0.0);
    Some(fixed(used.unique("tip"), None, step, Vec::new()))
}

/// Comment on a chain.
pub(super) fn chain_comment(network: &Network<'_>, ear: &SolvableChain) -> Vec<String> {
    let names: Vec<String> = ear
        .groups
        .iter()
        .map(|&group| format!("`{}`", network.group_name(group)))
        .collect();
    let mut lines = vec![format!("A chain {}.", names.join(" - "))];
    if let (Ending::Point, Some(&last)) = (ear.ending, ear.edges.last()) {
        let edge = &network.edges[last];
        let name = network.edge_name(edge);
        lines.push(match edge.kind {
            JointType::Ball => format!("It ends in the ball `{name}`."),
            _ => format!("It ends on the pin `{name}`, whose angle is dependent and not listed."),
        });
        lines.extend(at_home(network, edge));
    }
    let rods = ear
        .groups
        .iter()
        .filter(|&&group| network.groups[group].spins);
    for &rod in rods {
        lines.push(format!(
            "`{}` spins freely between its balls; by convention it does not, and its first ball is a universal joint.",
            network.group_name(rod)
        ));
    }
    lines
}

/// Comment on the home position of a joint that is not a coordinate of the description.
pub(super) fn at_home(network: &Network<'_>, edge: &Edge) -> Option<String> {
    let Origin::Joint(joint) = edge.origin else {
        return None;
    };
    let (own, home) = (&network.model.joints[joint], &network.states[0]);
    let shown = match own.kind {
        JointType::Ball => {
            let turn = home.turns[joint].scaled_axis();
            if turn.norm() < 1e-14 {
                return None;
            }
            format!("[{:?}, {:?}, {:?}]", turn.x, turn.y, turn.z)
        }
        JointType::Revolute | JointType::Prismatic => format!("{:?}", home.positions[joint]),
    };
    Some(format!("Home: `{}` = {shown}", own.name))
}
