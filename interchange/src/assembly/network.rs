//! Graph of rigid groups and joints, sampled at several closed configurations.

use super::{
    blocks::Blocks,
    infinitesimal,
    motion::{Motion, Open, State, null_space},
    platform::Platform,
    simple::{is_free, is_weld},
};
use crate::{
    files::Files,
    listing::listed,
    model::{ClosureKind, Inertia, JointType, Model, PointSpring, Pose},
};
use nalgebra::{DMatrix, DVector, Point3, Vector3};
use std::collections::BTreeMap;

/// Largest velocity of a joint that counts as held, relative to unit motions of the robot.
const STILL: f64 = 1e-9;

/// A group of bodies that are fixed together.
#[derive(Debug, Clone)]
pub(crate) struct Group {
    /// Bodies; the first gives the group its name.
    pub(crate) bodies: Vec<usize>,
    /// Inertia in the world frame at home.
    pub(crate) inertia: Option<Inertia>,
    /// Whether a body of the group has inertia of unknown value.
    pub(crate) has_unknown_inertia: bool,
    /// Whether the group is part of a rod between two ball joints, with an idle spin about their
    /// line.
    pub(crate) spins: bool,
    /// Ball joints at the ends of its rod.
    pub(crate) rod_ends: Option<[usize; 2]>,
}

/// Origin of an edge in the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Origin {
    Joint(usize),
    Closure(usize),
    /// Displacement of the network's platform.
    Platform,
}

/// A joint or closure between two groups.
#[derive(Debug, Clone)]
pub(crate) struct Edge {
    pub(crate) groups: [usize; 2],
    pub(crate) kind: JointType,
    pub(crate) origin: Origin,
    /// Whether it moves without friction, spring or motor torque.
    pub(crate) is_free: bool,
}

/// Axis or centre of an edge in a configuration.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axis {
    pub(crate) point: Point3<f64>,
    pub(crate) direction: Vector3<f64>,
}

/// Graph of groups and edges, with sampled configurations.
#[derive(Debug)]
pub(crate) struct Network<'m> {
    pub(crate) model: &'m Model,
    pub(crate) groups: Vec<Group>,
    pub(crate) edges: Vec<Edge>,
    /// Edges of each group, in ascending order.
    pub(crate) edges_at: Vec<Vec<usize>>,
    pub(crate) blocks: Blocks,
    /// Body that each joint carries.
    carried: Vec<usize>,
    /// Closed configurations, home first.
    pub(crate) states: Vec<State>,
    /// For each configuration: a basis of the twists of each group, as columns.
    pub(crate) twists: Vec<Vec<DMatrix<f64>>>,
    /// Number of independent motions.
    pub(crate) mobility: usize,
    /// Joints that the loops allow to move only infinitesimally from home.
    pub(super) infinitesimal: Vec<usize>,
    /// Platform whose displacements are coordinates.
    pub(crate) platform: Option<Platform>,
}

/// Number of sampled configurations in addition to home.
const SAMPLES: usize = 3;

impl<'m> Network<'m> {
    /// Builds the network of a model; `None` after an error.
    pub(crate) fn new(files: &Files, model: &'m Model) -> Option<Self> {
        match Self::closed(model) {
            Ok(network) if network.infinitesimal.is_empty() => Some(network),
            Ok(network) => {
                network.refuse_infinitesimal(files);
                None
            }
            Err(open) => {
                not_closed(files, model, open.gap, open.row);
                None
            }
        }
    }

    /// Builds the network of a model, or returns the configuration in which its loops stay open.
    pub(crate) fn closed(model: &'m Model) -> Result<Self, Open> {
        let motion = Motion::new(model);
        let home = motion.closed(&motion.start())?;
        let of_body = grouped(model);
        let groups = groups(model, &of_body, &home);
        let edges = edges(model, &of_body);
        let edges_at = edges_at(groups.len(), &edges);
        let ends: Vec<[usize; 2]> = edges.iter().map(|edge| edge.groups).collect();
        let mut network = Self {
            model,
            groups,
            blocks: Blocks::new(&edges_at, &ends),
            edges_at,
            edges,
            carried: model.carried(),
            states: vec![home],
            twists: Vec::new(),
            mobility: 0,
            infinitesimal: Vec::new(),
            platform: None,
        };
        network.find_spins();
        network.sample(&motion);
        Ok(network)
    }

    /// Whether the robot has more motions at home than elsewhere.
    pub(super) fn has_singular_home(&self) -> bool {
        let at_home = self.twists.first().and_then(|twists| twists.first());
        at_home.is_some_and(|basis| basis.ncols() > self.mobility)
    }

    /// Whether the closures hold an edge's joint in place, in all sampled configurations.
    pub(super) fn is_held(&self, edge: usize) -> bool {
        let [a, b] = self.edges[edge].groups;
        let mut samples = self.twists.iter();
        samples.all(|twists| (&twists[a] - &twists[b]).amax() < STILL)
    }

    /// Names of the rods with an idle spin.
    pub(crate) fn spins(&self) -> Vec<&str> {
        let mut ends = Vec::new();
        let mut names = Vec::new();
        for (at, group) in self.groups.iter().enumerate() {
            if let Some(own) = group.rod_ends.filter(|own| !ends.contains(own)) {
                ends.push(own);
                names.push(self.group_name(at));
            }
        }
        names
    }

    /// Adds an edge for the displacements of a platform.
    pub(crate) fn add_platform(&mut self, platform: Platform) {
        let edge = self.edges.len();
        let group = platform.group;
        self.edges.push(Edge {
            groups: [0, group],
            kind: JointType::Ball,
            origin: Origin::Platform,
            is_free: true,
        });
        for end in [0, group] {
            self.edges_at[end].push(edge);
        }
        self.blocks.is_bridge.push(false);
        self.platform = Some(platform);
    }

    /// Removes the edge of the platform.
    pub(crate) fn remove_platform(&mut self) {
        let Some(platform) = self.platform.take() else {
            return;
        };
        self.edges.pop();
        self.blocks.is_bridge.pop();
        for end in [0, platform.group] {
            self.edges_at[end].pop();
        }
    }

    /// Marks the groups of rods: paths of slides between two ball joints.
    fn find_spins(&mut self) {
        for start in 0..self.edges.len() {
            for end in self.edges[start].groups {
                let Some((groups, last)) = self.rod(start, end) else {
                    continue;
                };
                // Each rod is found from both ends.
                let holds = |own: &PointSpring| {
                    let on = |&body: &usize| {
                        groups
                            .iter()
                            .any(|&at| self.groups[at].bodies.contains(&body))
                    };
                    own.bodies.iter().any(on)
                };
                // A spring may resist the spin.
                if start < last && !self.model.springs.iter().any(holds) {
                    for group in groups {
                        self.groups[group].spins = true;
                        self.groups[group].rod_ends = Some([start, last]);
                    }
                }
            }
        }
    }

    /// Groups between a ball joint and the next one, and that joint; `None` if there is no rod.
    fn rod(&self, start: usize, first: usize) -> Option<(Vec<usize>, usize)> {
        if self.edges[start].kind != JointType::Ball {
            return None;
        }
        let (mut groups, mut entry, mut at) = (Vec::new(), start, first);
        loop {
            let [a, b] = self.edges_at[at][..] else {
                return None;
            };
            if at == 0 || groups.contains(&at) {
                return None;
            }
            groups.push(at);
            let exit = if a == entry { b } else { a };
            match self.edges[exit].kind {
                JointType::Ball => return (exit != start).then_some((groups, exit)),
                JointType::Prismatic => {
                    let ends = self.edges[exit].groups;
                    at = ends[usize::from(ends[0] == at)];
                    entry = exit;
                }
                JointType::Revolute => return None,
            }
        }
    }

    /// Samples closed configurations near home and the motions in each.
    fn sample(&mut self, motion: &Motion<'_>) {
        let mut random = Random(1);
        let home = self.states[0].clone();
        let free = self.motions(motion, &home);
        let mut is_suspicious = false;
        for attempt in 0..4 * SAMPLES {
            if self.states.len() > SAMPLES {
                break;
            }
            let size = 0.15 / (1.0 + attempt as f64 / 4.0);
            let weights = DVector::from_fn(free.ncols(), |_, _| size * random.next());
            let moved = motion.moved_by(&home, &(&free * &weights));
            if let Ok(closed) = motion.closed(&moved) {
                is_suspicious |=
                    infinitesimal::is_suspicious(motion, &home, &free, &weights, &closed);
                self.states.push(closed);
            }
        }
        let mut ranks = Vec::new();
        for state in &self.states {
            let basis = self.motions(motion, state);
            let bodies = motion.twists(state);
            let of = |group: &Group| &*bodies[group.bodies[0]] * &basis;
            self.twists.push(self.groups.iter().map(of).collect());
            ranks.push(basis.ncols());
        }
        // Home may be singular and then has additional motions; take the smallest rank.
        self.mobility = ranks.iter().copied().min().unwrap_or(0);
        if is_suspicious {
            self.infinitesimal = infinitesimal::joints(motion, &home, &free, self.mobility);
        }
    }

    /// Reports the joints that move only infinitesimally, at the first of them.
    fn refuse_infinitesimal(&self, files: &Files) {
        let joints = &self.model.joints;
        let names = self.infinitesimal.iter();
        let names = listed(names.map(|&joint| joints[joint].name.as_str()));
        let message =
            format!("the loops close only where rods are at their full reach: {names} can't move");
        let help = "check the lengths between these joints, or start in another configuration, `--home JOINT=POSITION`";
        if let Some(&first) = self.infinitesimal.first() {
            files.report(&joints[first].place, message, help);
        }
    }

    /// Basis of the coordinate rates that keep loops closed and rods without spin.
    pub(crate) fn motions(&self, motion: &Motion<'_>, state: &State) -> DMatrix<f64> {
        if self.model.closures.is_empty() && !self.groups.iter().any(|group| group.spins) {
            let count = motion.coordinates.len();
            return DMatrix::identity(count, count);
        }
        let (_, closure) = motion.closure(state);
        let bodies = motion.twists(state);
        let mut rows: Vec<Vec<f64>> = closure
            .row_iter()
            .map(|row| row.iter().copied().collect())
            .collect();
        for (at, group) in self
            .groups
            .iter()
            .enumerate()
            .filter(|(_, group)| group.spins)
        {
            let line = self.line(at, state);
            let spin = bodies[group.bodies[0]].rows(3, 3).transpose() * line;
            rows.push(spin.iter().copied().collect());
        }
        let matrix = DMatrix::from_fn(rows.len(), motion.coordinates.len(), |i, j| rows[i][j]);
        null_space(&matrix)
    }

    /// Direction from one ball joint of a rod to the other.
    pub(crate) fn line(&self, group: usize, state: &State) -> Vector3<f64> {
        let line = self.groups[group].rod_ends.map(|ends| {
            let [a, b] = ends.map(|edge| self.axis(&self.edges[edge], state).point);
            b - a
        });
        line.and_then(|line| line.try_normalize(1e-9))
            .unwrap_or_else(Vector3::x)
    }

    /// Axis of an edge; it has the direction of a rotation of the second group relative to the
    /// first.
    pub(crate) fn axis(&self, edge: &Edge, state: &State) -> Axis {
        match edge.origin {
            Origin::Platform => Axis {
                point: state.poses[self.groups[edge.groups[1]].bodies[0]]
                    .translation
                    .vector
                    .into(),
                direction: Vector3::z(),
            },
            Origin::Joint(joint) => {
                let own = &self.model.joints[joint];
                let pose = state.poses[self.carried[joint]];
                Axis {
                    point: pose * own.at,
                    direction: pose.rotation * own.axis,
                }
            }
            Origin::Closure(closure) => match &self.model.closures[closure].kind {
                ClosureKind::Point { bodies, at } => Axis {
                    point: state.poses[bodies[0]] * at[0],
                    direction: Vector3::z(),
                },
                ClosureKind::Weld { bodies, at } | ClosureKind::Pin { bodies, at } => {
                    let frame: Pose = state.poses[bodies[0]] * at[0];
                    let point = Point3::from(frame.translation.vector);
                    Axis {
                        point,
                        direction: frame.rotation * Vector3::z(),
                    }
                }
            },
        }
    }

    /// Name of an edge.
    pub(crate) fn edge_name(&self, edge: &Edge) -> &str {
        match edge.origin {
            Origin::Joint(joint) => &self.model.joints[joint].name,
            Origin::Closure(closure) => &self.model.closures[closure].name,
            Origin::Platform => self.group_name(edge.groups[1]),
        }
    }

    /// Name of a group.
    pub(crate) fn group_name(&self, group: usize) -> &str {
        &self.model.bodies[self.groups[group].bodies[0]].name
    }
}

/// Deterministic pseudo-random numbers between −1 and 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let bits = u32::try_from(self.0 >> 33).unwrap_or(0);
        f64::from(bits) / f64::from(1_u32 << 30) - 1.0
    }
}

/// Whether a joint displaces a massless body that carries a free body.
fn is_carrier(model: &Model, joint: usize) -> bool {
    let joint = &model.joints[joint];
    joint.is_virtual && joint.kind == JointType::Prismatic
}

/// Group of each body.
pub(super) fn grouped(model: &Model) -> Vec<usize> {
    let mut of_body: Vec<usize> = (0..model.bodies.len()).collect();
    let root = |of: &[usize], mut at: usize| {
        while of[at] != at {
            at = of[at];
        }
        at
    };
    let welds = model
        .closures
        .iter()
        .filter(|closure| is_weld(&closure.kind));
    let welds = welds.map(|closure| closure.bodies());
    let fixed = model
        .bodies
        .iter()
        .enumerate()
        .filter(|(_, body)| body.joint.is_none_or(|joint| is_carrier(model, joint)));
    let fixed = fixed.map(|(at, body)| [at, body.parent]);
    for [a, b] in fixed.chain(welds).collect::<Vec<_>>() {
        let (a, b) = (root(&of_body, a), root(&of_body, b));
        of_body[a.max(b)] = a.min(b);
    }
    let mut numbers: BTreeMap<usize, usize> = BTreeMap::new();
    (0..of_body.len())
        .map(|at| {
            let next = numbers.len();
            *numbers.entry(root(&of_body, at)).or_insert(next)
        })
        .collect()
}

fn groups(model: &Model, of_body: &[usize], home: &State) -> Vec<Group> {
    let count = of_body.iter().copied().max().unwrap_or(0) + 1;
    let empty = Group {
        bodies: Vec::new(),
        inertia: None,
        has_unknown_inertia: false,
        spins: false,
        rod_ends: None,
    };
    let mut groups = vec![empty; count];
    for (at, body) in model.bodies.iter().enumerate() {
        let group = &mut groups[of_body[at]];
        group.bodies.push(at);
        group.has_unknown_inertia |= body.has_unknown_inertia;
        let own = body
            .inertia
            .map(|inertia| inertia.transformed(&home.poses[at]));
        group.inertia = match (group.inertia, own) {
            (Some(all), Some(own)) => Some(all.with(&own)),
            (all, own) => all.or(own),
        };
    }
    groups
}

pub(super) fn edges(model: &Model, of_body: &[usize]) -> Vec<Edge> {
    let joints = model
        .bodies
        .iter()
        .enumerate()
        .skip(1)
        .filter_map(|(at, body)| {
            let joint = body.joint?;
            if model.joints[joint].is_virtual {
                return None;
            }
            Some(Edge {
                groups: [of_body[body.parent], of_body[at]],
                kind: model.joints[joint].kind,
                origin: Origin::Joint(joint),
                is_free: is_free(&model.joints[joint]),
            })
        });
    let closures = model
        .closures
        .iter()
        .enumerate()
        .filter_map(|(at, closure)| {
            let kind = match closure.kind {
                ClosureKind::Point { .. } => JointType::Ball,
                ClosureKind::Pin { .. } => JointType::Revolute,
                ClosureKind::Weld { .. } => return None,
            };
            let groups = closure.bodies().map(|body| of_body[body]);
            Some(Edge {
                groups,
                kind,
                origin: Origin::Closure(at),
                is_free: true,
            })
        });
    joints
        .chain(closures)
        .filter(|edge| edge.groups[0] != edge.groups[1])
        .collect()
}

/// Edges of each group.
pub(super) fn edges_at(groups: usize, edges: &[Edge]) -> Vec<Vec<usize>> {
    let mut at = vec![Vec::new(); groups];
    for (index, edge) in edges.iter().enumerate() {
        for group in edge.groups {
            at[group].push(index);
        }
    }
    at
}

fn not_closed(files: &Files, model: &Model, gap: f64, row: usize) {
    let mut rest = row;
    for closure in &model.closures {
        let rows = match closure.kind {
            ClosureKind::Point { .. } => 3,
            ClosureKind::Weld { .. } => 6,
            ClosureKind::Pin { .. } => 5,
        };
        if rest < rows {
            let message = format!(
                "the loop of `{}` can't close: {gap:.2e} m or rad remain",
                closure.name
            );
            let help = "check the frames of the closure, or start closer: `--home JOINT=POSITION`";
            files.report(&closure.place, message, help);
            return;
        }
        rest -= rows;
    }
}
