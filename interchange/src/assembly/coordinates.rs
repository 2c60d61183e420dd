//! Coordinates of a skeleton: the rates of its joints, and those that chains determine.
//!
//! In groups of class III and higher of Assur, such as a link on three rods of unknown positions,
//! no chain can be solved alone. The skeleton then has more joints than the robot has degrees of
//! freedom. Its chains block as many directions as there are joints too many: these are dependent,
//! and the generated model finds them by Newton's method.

use super::{
    motion::{State, rank},
    network::{Network, Origin},
    solvable_chains::{follows, freedoms},
};
use crate::model::JointType;
use nalgebra::{DMatrix, Vector3};

/// Edges of a tree in order, each with the group that it starts from.
pub(crate) type Tree = Vec<(usize, usize)>;

/// Largest number of dependent joints of a description.
pub(super) const MOST: usize = 8;
/// Largest numbers of unknown joints of a chain in layouts with dependent joints, tried in order.
///
/// One suffices for rods in a plane, two for rods in space and legs of a 3-RPS.
pub(super) const CHAIN_JOINTS: [usize; 4] = [1, 2, 3, 6];
/// Condition number of the independent rates above which they are taken for dependent.
const SINGULAR: f64 = 1e4;

/// Number of a skeleton's freedoms that the others determine, in the configuration with most.
pub(super) fn surplus(network: &Network<'_>, skeleton: &[(usize, usize)]) -> usize {
    let freedoms: usize = skeleton_freedoms(network, skeleton).iter().sum();
    // Home may be singular.
    let looked_at = 1.min(network.states.len() - 1)..network.states.len();
    let ranks = looked_at.map(|state| rank_at(network, skeleton, state).0);
    freedoms - ranks.min().unwrap_or(freedoms).min(freedoms)
}

/// Edges of a skeleton that depend on the others; `None` if too few can be chosen.
///
/// Independent are the required edges, then motors, then others in order.
pub(super) fn choose(
    network: &Network<'_>,
    skeleton: &[(usize, usize)],
    required: &[usize],
) -> Option<Vec<usize>> {
    let order =
        |&(edge, _): &(usize, usize)| (!required.contains(&edge), !is_driven(network, edge));
    let mut ordered = skeleton.to_vec();
    // Stable, so that ties keep the order of the skeleton.
    ordered.sort_by_key(order);
    let mut independent: Tree = Vec::new();
    let mut dependent = Vec::new();
    for step in ordered {
        if follows(network, step.0) {
            continue;
        }
        let before: usize = skeleton_freedoms(network, &independent).iter().sum();
        independent.push(step);
        let count: usize = skeleton_freedoms(network, &independent).iter().sum();
        let ranks = (0..network.states.len()).map(|state| {
            let (rank, condition) = rank_at(network, &independent, state);
            if condition < SINGULAR { rank } else { before }
        });
        let least = ranks.min().unwrap_or(before);
        if least == count {
            continue;
        }
        // Of a ball joint, all axes are dependent or none.
        if least > before || network.edges[step.0].origin == Origin::Platform {
            return None;
        }
        independent.pop();
        dependent.push(step.0);
    }
    let count: usize = skeleton_freedoms(network, &independent).iter().sum();
    let is_independent = |edge: &usize| !dependent.contains(edge);
    (count == network.mobility && required.iter().all(is_independent)).then_some(dependent)
}

/// Whether an edge is a joint with a motor.
fn is_driven(network: &Network<'_>, edge: usize) -> bool {
    match network.edges[edge].origin {
        Origin::Joint(joint) => network.model.joints[joint].actuated,
        Origin::Closure(_) | Origin::Platform => false,
    }
}

/// Rank and condition number of a skeleton's rates in a configuration.
fn rank_at(network: &Network<'_>, skeleton: &[(usize, usize)], state: usize) -> (usize, f64) {
    let twists: &[DMatrix<f64>] = &network.twists[state];
    rank(&skeleton_rates(
        network,
        skeleton,
        &network.states[state],
        twists,
    ))
}

/// Number of one-degree-of-freedom joints for each edge of a skeleton.
pub(crate) fn skeleton_freedoms(network: &Network<'_>, skeleton: &[(usize, usize)]) -> Vec<usize> {
    let of = |&(edge, from): &(usize, usize)| {
        let groups = network.edges[edge].groups;
        freedoms(network, edge, groups[usize::from(groups[0] == from)], true)
    };
    skeleton.iter().map(of).collect()
}

/// Rates of the skeleton's joints for each motion of the network, given the groups' `twists`.
pub(crate) fn skeleton_rates(
    network: &Network<'_>,
    skeleton: &[(usize, usize)],
    state: &State,
    twists: &[DMatrix<f64>],
) -> DMatrix<f64> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for &(index, from) in skeleton {
        let edge = &network.edges[index];
        if follows(network, index) {
            continue;
        }
        let (to, sign) = if edge.groups[0] == from {
            (edge.groups[1], 1.0)
        } else {
            (edge.groups[0], -1.0)
        };
        let relative = &twists[to] - &twists[from];
        let axis = network.axis(edge, state);
        if let (Origin::Platform, Some(platform)) = (edge.origin, &network.platform) {
            rows.extend(platform.rates(&platform.at(network, state), &relative));
            continue;
        }
        let turning = |e: &Vector3<f64>| {
            (relative.rows(3, 3).transpose() * e)
                .iter()
                .copied()
                .collect()
        };
        match edge.kind {
            JointType::Revolute => rows.push(turning(&(axis.direction * sign))),
            JointType::Prismatic => {
                let velocity = relative.rows(0, 3).transpose() * axis.direction * sign;
                rows.push(velocity.iter().copied().collect());
            }
            JointType::Ball if network.groups[to].spins => {
                let line = network.line(to, state);
                let across = if line.x.abs() < 0.7 {
                    Vector3::x()
                } else {
                    Vector3::y()
                };
                let first = line.cross(&across).normalize();
                rows.extend([first, line.cross(&first)].iter().map(turning));
            }
            JointType::Ball => rows.extend((0..3).map(|i| turning(&Vector3::ith(i, 1.0)))),
        }
    }
    let columns = twists.first().map_or(0, DMatrix::ncols);
    DMatrix::from_fn(rows.len(), columns, |i, j| rows[i][j])
}
