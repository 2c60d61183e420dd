//! Platforms whose directions of motion change with their pose, as that of the 3-RPS.
//!
//! No joints and no displacements of such a platform determine all others chain by chain. In a
//! description it is a platform in space, of which some coordinates are independent; each leg
//! follows its pose.

use super::{
    network::Network,
    platform_search::platforms,
    solvable_chains::{Ending, SolvableChain, chain_freedoms, follows},
};
use crate::model::JointType;
use nalgebra::{DMatrix, DVector, Point3};

/// Smallest part of a coordinate's motion that is independent of the others, relative.
const INDEPENDENT: f64 = 1e-2;
/// Largest number of joints of a leg.
const MOST: usize = 6;

/// A platform in space on legs, some motions of which the legs block.
#[derive(Debug)]
pub(crate) struct ParasiticPlatform {
    pub(crate) group: usize,
    /// Legs from the ground to the platform.
    pub(crate) legs: Vec<SolvableChain>,
    /// Independent ones of the coordinates x, y, z, rx, ry, rz.
    pub(crate) independent: Vec<usize>,
}

/// Platform of a network that consists of legs between the ground and one body.
pub(crate) fn find(network: &Network<'_>) -> Option<ParasiticPlatform> {
    if !(1..6).contains(&network.mobility) {
        return None;
    }
    let has_legs = |group: &usize| network.edges_at[*group].len() > 2;
    let group = (1..network.groups.len()).find(has_legs)?;
    if platforms(network).iter().any(|own| own.group == group) {
        return None;
    }
    let edges = network.edges_at[group].iter();
    let legs: Option<Vec<SolvableChain>> = edges.map(|&edge| leg(network, group, edge)).collect();
    let legs = legs?;
    let inner: usize = legs.iter().map(|leg| leg.groups.len() - 2).sum();
    let used: usize = legs.iter().map(|leg| leg.edges.len()).sum();
    if inner + 2 != network.groups.len() || used != network.edges.len() {
        return None;
    }
    let independent = independent(network, group)?;
    Some(ParasiticPlatform {
        group,
        legs,
        independent,
    })
}

/// Leg that ends with an edge at the platform; `None` if it branches or has no joints.
fn leg(network: &Network<'_>, platform: usize, last: usize) -> Option<SolvableChain> {
    let (mut groups, mut edges) = (vec![platform], vec![last]);
    let mut at = other(network, last, platform);
    while at != 0 {
        let [a, b] = network.edges_at[at][..] else {
            return None;
        };
        if groups.contains(&at) {
            return None;
        }
        groups.push(at);
        let next = if edges.last() == Some(&a) { b } else { a };
        edges.push(next);
        at = other(network, next, at);
    }
    groups.push(0);
    groups.reverse();
    edges.reverse();
    if edges.iter().any(|&edge| follows(network, edge)) {
        return None;
    }
    let freedoms = chain_freedoms(network, &groups, &edges);
    let all: usize = freedoms.iter().sum();
    let ending = match network.edges[last].kind {
        JointType::Ball => Ending::Point,
        JointType::Revolute | JointType::Prismatic => Ending::Rigid,
    };
    let unknowns = match ending {
        Ending::Point => all - freedoms.last().copied().unwrap_or(0),
        Ending::Rigid => all,
    };
    (1..=MOST).contains(&unknowns).then_some(SolvableChain {
        groups,
        edges,
        ending,
        unknowns,
    })
}

/// Group at the other end of an edge.
fn other(network: &Network<'_>, edge: usize, group: usize) -> usize {
    let ends = network.edges[edge].groups;
    ends[usize::from(ends[0] == group)]
}

/// Coordinates whose velocities at home determine the others best.
///
/// Elimination with pivots: the coordinate with the largest part that is independent of those
/// chosen before.
fn independent(network: &Network<'_>, group: usize) -> Option<Vec<usize>> {
    let (state, twists) = (network.states.first()?, network.twists.first()?);
    let first = network.groups[group].bodies[0];
    let at = state.poses[first].translation.vector;
    let own = &twists[group];
    if own.ncols() != network.mobility {
        return None;
    }
    let angular = own.rows(3, 3).into_owned();
    let linear = own.rows(0, 3) - at.cross_matrix() * &angular;
    let joints = network.edges_at[group].iter();
    let reach = joints.map(|&edge| {
        let point = network.axis(&network.edges[edge], state).point;
        (point - Point3::from(at)).norm()
    });
    let reach = reach.fold(1e-6, f64::max);
    let mut rows = DMatrix::zeros(6, own.ncols());
    rows.rows_mut(0, 3).copy_from(&linear);
    rows.rows_mut(3, 3).copy_from(&(angular * reach));
    let largest = rows.row_iter().map(|row| row.norm()).fold(0.0, f64::max);
    let mut chosen: Vec<usize> = Vec::new();
    for _ in 0..network.mobility {
        let best = (0..6).max_by(|&a, &b| rows.row(a).norm().total_cmp(&rows.row(b).norm()))?;
        let length = rows.row(best).norm();
        if length < INDEPENDENT * largest {
            return None;
        }
        chosen.push(best);
        let unit: DVector<f64> = rows.row(best).transpose() / length;
        let along = &rows * &unit;
        rows -= along * unit.transpose();
    }
    chosen.sort_unstable();
    Some(chosen)
}
