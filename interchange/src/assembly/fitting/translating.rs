//! Makes platforms translate whose rods rounding leaves unequal or not parallel.
//!
//! The platform of a Delta with six rods keeps its orientation only if the two rods of each pair are
//! parallel and of one length. Rounded, it also turns a little, and no chain determines its joints.

use super::redundant::consistent;
use crate::assembly::{layout, network::Network};
use crate::model::Model;
use nalgebra::Point3;

/// Largest rotation of a platform that translates but for rounding, for each displacement by the
/// size of the mechanism.
const TURNING: f64 = 0.05;
/// Smallest displacement for a motion, as a fraction of the largest, in an independent direction.
const DISPLACED: f64 = 0.02;
/// Rotations below this are rounding errors.
const STILL: f64 = 1e-7;

/// Model whose platform translates, if it nearly does and no chains determine its joints otherwise.
pub(crate) fn translating(model: &Model, tolerance: f64) -> Option<Model> {
    let mut network = Network::closed(model).ok()?;
    let mut groups: Vec<usize> = (1..network.groups.len())
        .filter(|&group| network.edges_at[group].len() > 2 && nearly_translates(&network, group))
        .collect();
    if groups.is_empty() || layout::exists(&mut network) {
        return None;
    }
    groups.sort_by_key(|&group| std::cmp::Reverse(network.edges_at[group].len()));
    groups.into_iter().find_map(|group| {
        let body = network.groups[group].bodies[0];
        let changed = consistent(model, tolerance, Some(body))?;
        let exists = layout::exists(&mut Network::closed(&changed).ok()?);
        exists.then_some(changed)
    })
}

/// Whether a group turns little but not exactly not at all, and is displaced in two directions or
/// more.
fn nearly_translates(network: &Network<'_>, group: usize) -> bool {
    let first = network.groups[group].bodies[0];
    let mut is_still = true;
    let states = network.states.iter().zip(&network.twists).skip(1);
    let all = states.clone().all(|(state, twists)| {
        let own = &twists[group];
        if own.ncols() < 2 {
            return false;
        }
        let at = state.poses[first].translation.vector;
        let angular = own.rows(3, 3).into_owned();
        let linear = own.rows(0, 3) - at.cross_matrix() * &angular;
        let joints = network.edges_at[group].iter();
        let reach = joints.map(|&edge| {
            let point = network.axis(&network.edges[edge], state).point;
            (point - Point3::from(at)).norm()
        });
        let turning = angular.amax() * reach.fold(0.0, f64::max);
        let moving = linear.clone().singular_values();
        let moving = moving
            .iter()
            .filter(|value| **value > DISPLACED * moving.max());
        let least = moving.clone().copied().fold(f64::INFINITY, f64::min);
        is_still &= turning < STILL * linear.amax();
        moving.count() > 1 && turning < TURNING * least
    });
    all && !is_still && network.states.len() > 1
}
