//! Finds solvable chains: paths between bodies of known motion through bodies of unknown motion.

use super::{
    motion::rank,
    network::{Network, Origin},
    platform::Platform,
};
use crate::model::JointType;
use nalgebra::{DMatrix, Vector3};

/// Kind of closure at a chain's end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ending {
    /// Point closure: the last edge is a ball joint, or a revolute joint whose angle is not needed.
    Point,
    /// Rigid closure: the last edge carries the final body.
    Rigid,
}

/// A chain: groups from one of known motion to another, and the edges between them.
#[derive(Debug, Clone)]
pub(crate) struct SolvableChain {
    pub(crate) groups: Vec<usize>,
    pub(crate) edges: Vec<usize>,
    pub(crate) ending: Ending,
    /// Number of joint coordinates to solve for.
    pub(crate) unknowns: usize,
}

impl SolvableChain {
    /// Approximate cost of solving the chain.
    pub(crate) fn cost(&self) -> usize {
        let n = self.unknowns;
        match self.ending {
            Ending::Point => n * n,
            Ending::Rigid => n * n * n,
        }
    }
}

/// Largest number of unknowns of a chain.
pub(super) const UNKNOWNS: usize = 6;
/// Condition number above which a chain counts as singular.
const SINGULAR: f64 = 1e6;
/// Largest number of paths explored from one group.
const WAYS: usize = 20_000;

/// Number of one-degree-of-freedom joints that represent an edge entered from a group.
pub(crate) fn freedoms(network: &Network<'_>, edge: usize, to: usize, is_first: bool) -> usize {
    match network.edges[edge].kind {
        _ if follows(network, edge) => 0,
        _ if network.edges[edge].origin == Origin::Platform => {
            network.platform.as_ref().map_or(0, Platform::count)
        }
        JointType::Revolute | JointType::Prismatic => 1,
        JointType::Ball if network.groups[to].spins && is_first => 2,
        JointType::Ball => 3,
    }
}

/// Whether an edge's joint is coupled to another.
pub(crate) fn follows(network: &Network<'_>, edge: usize) -> bool {
    match network.edges[edge].origin {
        Origin::Joint(joint) => network.model.joints[joint].follow.is_some(),
        Origin::Closure(_) | Origin::Platform => false,
    }
}

/// Known part of a network, from which a search for chains starts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Known<'s> {
    /// Groups of known motion.
    pub(crate) solved: &'s [bool],
    /// Groups that no chain may contain.
    pub(crate) kept: &'s [bool],
    /// Edges that are part of the layout already.
    pub(crate) used: &'s [bool],
    /// Whether free joints between known groups are chains, too, since they block directions.
    pub(crate) needs_all: bool,
    /// Largest number of unknown joints of a chain.
    pub(crate) most: usize,
}

/// Cheapest chain between known groups, and the number of explored paths.
pub(crate) fn cheapest(network: &Network<'_>, known: Known<'_>) -> (Option<SolvableChain>, usize) {
    let mut best: Option<SolvableChain> = None;
    let mut paths = 0;
    for start in (0..known.solved.len()).filter(|&group| known.solved[group]) {
        let mut search = Search {
            network,
            known,
            best: &mut best,
            ways: 0,
        };
        search.extend(&mut vec![start], &mut Vec::new());
        paths += search.ways;
    }
    (best, paths)
}

struct Search<'s, 'm> {
    network: &'s Network<'m>,
    known: Known<'s>,
    best: &'s mut Option<SolvableChain>,
    ways: usize,
}

impl Search<'_, '_> {
    fn extend(&mut self, groups: &mut Vec<usize>, edges: &mut Vec<usize>) {
        self.ways += 1;
        let Some(&at) = groups.last() else { return };
        if self.ways > WAYS || self.unknowns(groups, edges) > UNKNOWNS + 3 {
            return;
        }
        for &index in &self.network.edges_at[at] {
            let edge = &self.network.edges[index];
            let is_platform = edge.origin == Origin::Platform;
            if self.known.used[index] || edges.contains(&index) || is_platform {
                continue;
            }
            let next = edge.groups[usize::from(edge.groups[0] == at)];
            if next == at || groups.contains(&next) || follows(self.network, index) {
                continue;
            }
            // A single edge between two solved groups matters only if it has a motor or friction, or
            // if joints of the skeleton depend on it.
            let is_single = self.known.solved[next] && groups.len() == 1;
            if is_single && edge.is_free && !self.known.needs_all {
                continue;
            }
            groups.push(next);
            edges.push(index);
            // Chains start at the ground and never end there.
            if next == 0 {
            } else if self.known.solved[next] {
                self.try_ends(groups, edges);
            } else if !self.known.kept[next] {
                self.extend(groups, edges);
            }
            groups.pop();
            edges.pop();
        }
    }

    fn unknowns(&self, groups: &[usize], edges: &[usize]) -> usize {
        chain_freedoms(self.network, groups, edges).iter().sum()
    }

    fn try_ends(&mut self, groups: &[usize], edges: &[usize]) {
        for ending in [Ending::Point, Ending::Rigid] {
            let Some(&last) = edges.last() else { return };
            let freedoms = chain_freedoms(self.network, groups, edges);
            let all: usize = freedoms.iter().sum();
            let unknowns = match ending {
                Ending::Point => all - freedoms.last().copied().unwrap_or(0),
                Ending::Rigid => all,
            };
            let edge = &self.network.edges[last];
            let ends = match ending {
                Ending::Point => {
                    edge.kind == JointType::Ball && edge.is_free_ball(self.network)
                        || edge.kind == JointType::Revolute && edge.is_free
                }
                Ending::Rigid => edge.kind != JointType::Ball,
            };
            let limit = if ending == Ending::Point { 3 } else { UNKNOWNS };
            let limit = limit.min(self.known.most);
            if !ends || unknowns == 0 || unknowns > limit {
                continue;
            }
            let ear = SolvableChain {
                groups: groups.to_vec(),
                edges: edges.to_vec(),
                ending,
                unknowns,
            };
            let is_better = self
                .best
                .as_ref()
                .is_none_or(|best| ear.cost() < best.cost());
            if is_better && is_determined(self.network, &ear) {
                *self.best = Some(ear);
            }
        }
    }
}

impl super::network::Edge {
    /// Whether the edge is a ball joint without torques.
    fn is_free_ball(&self, network: &Network<'_>) -> bool {
        match self.origin {
            Origin::Closure(_) | Origin::Platform => true,
            Origin::Joint(joint) => {
                let joint = &network.model.joints[joint];
                !joint.actuated && joint.damping == 0.0 && joint.friction == 0.0
            }
        }
    }
}

/// Number of joints for each edge of a chain; a rod's first ball joint is a universal joint.
pub(crate) fn chain_freedoms(
    network: &Network<'_>,
    groups: &[usize],
    edges: &[usize],
) -> Vec<usize> {
    let numbered = edges.iter().enumerate();
    numbered
        .map(|(at, &edge)| freedoms(network, edge, groups[at + 1], true))
        .collect()
}

/// Whether the ends' motion determines the chain's joints in all sampled configurations.
fn is_determined(network: &Network<'_>, ear: &SolvableChain) -> bool {
    network.states.iter().enumerate().all(|(state, _)| {
        let matrix = jacobian(network, ear, state);
        let (rank, condition) = rank(&matrix);
        rank == ear.unknowns && condition < SINGULAR
    })
}

/// Jacobian of a chain's end: point velocity, and angular velocity for a rigid closure.
///
/// Lengths are scaled by the chain's own size.
fn jacobian(network: &Network<'_>, ear: &SolvableChain, state: usize) -> DMatrix<f64> {
    let state = &network.states[state];
    let mut lines = Vec::new();
    let last = ear.edges.len() - 1;
    for (at, &index) in ear.edges.iter().enumerate() {
        if at == last && ear.ending == Ending::Point {
            break;
        }
        let edge = &network.edges[index];
        let axis = network.axis(edge, state);
        match edge.kind {
            JointType::Ball => {
                let to = ear.groups[at + 1];
                let spins = network.groups[to].spins;
                let line = network.line(to, state);
                let across = if line.x.abs() < 0.7 {
                    Vector3::x()
                } else {
                    Vector3::y()
                };
                let first = line.cross(&across).normalize();
                let axes = [first, line.cross(&first), line];
                let count = if spins { 2 } else { 3 };
                lines.extend(
                    axes[..count]
                        .iter()
                        .map(|&e| (axis.point, e, JointType::Revolute)),
                );
            }
            kind => lines.push((axis.point, axis.direction, kind)),
        }
    }
    let end = network.axis(&network.edges[ear.edges[last]], state).point;
    let reach = lines
        .iter()
        .map(|(point, ..)| (end - point).norm())
        .fold(1e-6, f64::max);
    let rows = if ear.ending == Ending::Point { 3 } else { 6 };
    DMatrix::from_fn(rows, lines.len(), |i, j| {
        let (point, axis, kind) = &lines[j];
        let velocity = match kind {
            JointType::Prismatic => *axis,
            _ => axis.cross(&(end - point)) / reach,
        };
        match (i < 3, kind) {
            (true, _) => velocity[i],
            (false, JointType::Prismatic) => 0.0,
            (false, _) => axis[i - 3],
        }
    })
}
