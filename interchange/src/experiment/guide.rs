//! Maps motions of the description's coordinates to motions of the file's tree.

use super::balls::Ball;
use crate::{
    assembly::{
        coordinates::skeleton_rates,
        layout::Layout,
        motion::{Motion, State},
        network::{Network, Origin},
        platform::Platform,
        solvable_chains::freedoms,
    },
    model::JointType,
    plan::Plan,
};
use nalgebra::{DMatrix, DVector};

/// Kinematics of a robot driven along its coordinates.
pub(super) struct Guide<'g, 'm> {
    pub(super) network: &'g Network<'m>,
    layout: &'g Layout,
    /// Ball joints of the skeleton, by edge.
    balls: Vec<(usize, Ball)>,
    pub(super) motion: Motion<'m>,
    /// Actuated joints of the file.
    pub(super) actuators: Vec<usize>,
    /// Limits of each joint, extended if home is at a limit.
    pub(super) limits: Vec<Option<[f64; 2]>>,
    smallest: [f64; 2],
}

/// Velocities in a configuration for unit rates of the coordinates.
pub(super) struct Rates {
    /// Velocities of the tree's coordinates.
    pub(super) tree: DMatrix<f64>,
    /// Velocities of the actuated joints.
    pub(super) actuators: DMatrix<f64>,
}

/// Smallest admissible ratio of singular values to those at home.
const NEARER: f64 = 0.35;
/// Distance from a limit within which home counts as at the limit, rad or m.
const AT_LIMIT: f64 = 1e-3;

impl<'g, 'm> Guide<'g, 'm> {
    /// Creates a guide; `None` if the coordinates do not determine the motion at home.
    pub(super) fn new(network: &'g Network<'m>, layout: &'g Layout, plan: &Plan) -> Option<Self> {
        let model = network.model;
        let limits = model.joints.iter().enumerate().map(|(at, joint)| {
            let home = network.states[0].positions[at];
            let [low, high] = joint.range?;
            let low = if low > home - AT_LIMIT {
                f64::NEG_INFINITY
            } else {
                low
            };
            let high = if high < home + AT_LIMIT {
                f64::INFINITY
            } else {
                high
            };
            Some([low, high])
        });
        let actuators = (0..model.joints.len())
            .filter(|&at| model.joints[at].actuated && model.joints[at].kind != JointType::Ball);
        let mut own = Self {
            network,
            layout,
            balls: balls(network, layout, plan)?,
            motion: Motion::new(model),
            actuators: actuators.collect(),
            limits: limits.collect(),
            smallest: [0.0; 2],
        };
        own.smallest = own.raw(&network.states[0])?.1.map(|value| NEARER * value);
        (own.smallest[0] > 1e-9).then_some(own)
    }

    /// Number of coordinates.
    pub(super) fn count(&self) -> usize {
        self.network.mobility
    }

    /// Velocities in a configuration; `None` if it is nearly singular.
    pub(super) fn rates(&self, state: &State) -> Option<Rates> {
        let (rates, sizes) = self.raw(state)?;
        (sizes[0] >= self.smallest[0] && sizes[1] >= self.smallest[1]).then_some(rates)
    }

    /// Velocities, and the smallest singular values of coordinates and actuators.
    fn raw(&self, state: &State) -> Option<(Rates, [f64; 2])> {
        let basis = self.network.motions(&self.motion, state);
        let bodies = self.motion.twists(state);
        let groups: Vec<DMatrix<f64>> = self
            .network
            .groups
            .iter()
            .map(|group| &*bodies[group.bodies[0]] * &basis)
            .collect();
        let own = self.own_rates(state, &groups)?;
        if own.nrows() != own.ncols() || own.nrows() != self.count() {
            return None;
        }
        let size = own.clone().singular_values().amin();
        let tree = &basis * own.try_inverse()?;
        let actuators = DMatrix::from_fn(self.actuators.len(), tree.ncols(), |i, j| {
            let joint = self.actuators[i];
            let follow = self.network.model.joints[joint].follow;
            let (leader, factor) = follow.map_or((joint, 1.0), |f| (f.joint, f.factor));
            let at = self
                .motion
                .coordinates
                .iter()
                .position(|c| c.joint == leader);
            at.map_or(0.0, |at| factor * tree[(at, j)])
        });
        let driven = if actuators.nrows() >= actuators.ncols() {
            actuators.clone().singular_values().amin()
        } else {
            0.0
        };
        Some((Rates { tree, actuators }, [size, driven]))
    }

    /// Rates of the coordinates for each motion.
    fn own_rates(&self, state: &State, groups: &[DMatrix<f64>]) -> Option<DMatrix<f64>> {
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for step in &self.layout.independent() {
            if let Some(platform) = self.platform(step.0) {
                let at = platform.at(self.network, state);
                let mut own = platform.rates(&at, &groups[platform.group]);
                if let Some((_, ball)) = self.balls.iter().find(|(edge, _)| *edge == step.0) {
                    own.truncate(platform.translations.len());
                    own.extend(ball.rates(self.network, state, groups)?);
                }
                rows.extend(own);
                continue;
            }
            match self.balls.iter().find(|(edge, _)| *edge == step.0) {
                Some((_, ball)) => rows.extend(ball.rates(self.network, state, groups)?),
                None => {
                    let own = skeleton_rates(self.network, &[*step], state, groups);
                    rows.extend(
                        own.row_iter()
                            .map(|row| row.iter().copied().collect::<Vec<_>>()),
                    );
                }
            }
        }
        let columns = groups.first().map_or(0, DMatrix::ncols);
        Some(DMatrix::from_fn(rows.len(), columns, |i, j| rows[i][j]))
    }

    /// Platform whose displacements an edge represents.
    fn platform(&self, edge: usize) -> Option<&Platform> {
        let platform = self.network.platform.as_ref();
        platform.filter(|_| self.network.edges[edge].origin == Origin::Platform)
    }

    /// Displacements of a platform from home: along its translations, then its angles.
    ///
    /// `None` for a single angle, which is not needed.
    fn displacements(&self, edge: usize, platform: &Platform, state: &State) -> Vec<Option<f64>> {
        let home = platform.at(self.network, &self.network.states[0]);
        let moved = platform.at(self.network, state) - home;
        let along = platform.translations.iter().map(|axis| moved.dot(axis));
        let mut all: Vec<Option<f64>> = along.map(Some).collect();
        match self.balls.iter().find(|(own, _)| *own == edge) {
            Some((_, ball)) => all.extend(ball.angles(self.network, state).into_iter().map(Some)),
            None => all.extend(platform.rotations.iter().map(|_| None)),
        }
        all
    }

    /// Configuration after a step of the coordinates; `None` if the loops do not close.
    pub(super) fn step(&self, state: &State, rates: &Rates, by: &DVector<f64>) -> Option<State> {
        let moved = self.motion.moved_by(state, &(&rates.tree * by));
        self.motion.closed(&moved).ok()
    }

    /// Displacement of the coordinates from home; `None` for closures, which are no joints of the
    /// file.
    pub(super) fn positions(&self, state: &State) -> Vec<Option<f64>> {
        let of = |&(index, from): &(usize, usize)| {
            if let Some(platform) = self.platform(index) {
                return self.displacements(index, platform, state);
            }
            if let Some((_, ball)) = self.balls.iter().find(|(edge, _)| *edge == index) {
                return ball
                    .angles(self.network, state)
                    .into_iter()
                    .map(Some)
                    .collect();
            }
            let edge = &self.network.edges[index];
            let to = edge.groups[usize::from(edge.groups[0] == from)];
            let count = freedoms(self.network, index, to, true);
            match edge.origin {
                Origin::Joint(joint) => {
                    let home = self.network.states[0].positions[joint];
                    vec![Some(state.positions[joint] - home); count]
                }
                Origin::Closure(_) | Origin::Platform => vec![None; count],
            }
        };
        self.layout.independent().iter().flat_map(of).collect()
    }

    /// First joint beyond its limits.
    pub(super) fn beyond(&self, state: &State) -> Option<usize> {
        let is_beyond = |joint: usize| {
            self.limits[joint].is_some_and(|[low, high]| {
                let at = state.positions[joint];
                at < low || at > high
            })
        };
        (0..self.limits.len()).find(|&joint| is_beyond(joint))
    }

    /// Indices of actuated joints in another order.
    pub(super) fn actuators_in_order(&self, joints: &[usize]) -> Vec<usize> {
        let at = |joint: &usize| self.actuators.iter().position(|own| own == joint);
        joints.iter().filter_map(at).collect()
    }

    /// Notes on joint limits at home, which the motion therefore passes.
    pub(super) fn notes(&self) -> Vec<String> {
        let joints = self.network.model.joints.iter().enumerate();
        let passed =
            joints.filter(|(at, joint)| joint.range.is_some() && self.limits[*at] != joint.range);
        let names: Vec<String> = passed
            .map(|(_, joint)| format!("`{}`", joint.name))
            .collect();
        if names.is_empty() {
            Vec::new()
        } else {
            vec![format!(
                "Home is at a limit of {}, which these runs exceed: change home with `overact import --home`.",
                names.join(", ")
            )]
        }
    }
}

/// Ball joints of the skeleton with the description's axes; `None` if the axes do not match.
fn balls(network: &Network<'_>, layout: &Layout, plan: &Plan) -> Option<Vec<(usize, Ball)>> {
    let mut axes = plan.axes.iter();
    let mut balls = Vec::new();
    for (index, from) in layout.coordinates() {
        let edge = &network.edges[index];
        let to = edge.groups[usize::from(edge.groups[0] == from)];
        let count = if edge.kind == JointType::Ball {
            freedoms(network, index, to, true)
        } else {
            1
        };
        let own: Vec<_> = axes.by_ref().take(count).copied().collect();
        if let (Origin::Platform, Some(platform)) = (edge.origin, &network.platform) {
            let turning = &own[platform.translations.len()..];
            if turning.len() == 3 {
                let ball = Ball::new(network, from, to, turning, &balls)?;
                balls.push((index, ball));
            }
        } else if edge.kind == JointType::Ball {
            let ball = Ball::new(network, from, to, &own, &balls)?;
            balls.push((index, ball));
        }
    }
    Some(balls)
}
