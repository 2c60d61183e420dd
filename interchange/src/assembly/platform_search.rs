//! Finds bodies whose displacements may serve as independent coordinates.

use super::{motion::State, network::Network, platform::Platform};
use nalgebra::{Matrix3, Point3, Vector3};

/// Singular values below this fraction of the largest are rounding errors.
const RANK: f64 = 1e-7;

/// Groups whose displacements have constant directions, those with most joints first.
pub(crate) fn platforms(network: &Network<'_>) -> Vec<Platform> {
    let has_branches = |group: &usize| network.edges_at[*group].len() > 1;
    let mut groups: Vec<usize> = (1..network.groups.len()).filter(has_branches).collect();
    groups.sort_by_key(|&group| std::cmp::Reverse(network.edges_at[group].len()));
    let each = groups.into_iter();
    each.filter_map(|group| platform(network, group)).collect()
}

/// Displacements of a group; `None` if their directions change with the configuration.
fn platform(network: &Network<'_>, group: usize) -> Option<Platform> {
    let first = network.groups[group].bodies[0];
    let (mut turning, mut moving) = (Vec::new(), Vec::new());
    let mut count = 0;
    for (state, twists) in network.states.iter().zip(&network.twists).skip(1) {
        let at: Matrix3<f64> = state.poses[first].translation.vector.cross_matrix();
        let own = &twists[group];
        let angular = own.rows(3, 3);
        // Velocity of the origin of the body's frame: v + ω × p.
        let linear = own.rows(0, 3) - at * angular;
        count = count.max(super::motion::rank(own).0);
        let vector = |column: usize, of: &[f64]| Vector3::from_column_slice(&of[3 * column..][..3]);
        let angular = angular.into_owned();
        for column in 0..own.ncols() {
            turning.push(vector(column, angular.as_slice()));
            moving.push(vector(column, linear.as_slice()));
        }
    }
    let rotations = span(&turning);
    let translations = span(&moving);
    let all = rotations.len() + translations.len();
    let is_plain = [0, 1, 3].contains(&rotations.len()) && all > 0;
    (is_plain && all == count).then_some(Platform {
        group,
        translations,
        rotations,
    })
}

/// Orthonormal directions that span the vectors: x, y and z if they span all.
fn span(vectors: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let squares = vectors.iter().map(|v| v * v.transpose());
    let square: Matrix3<f64> = squares.sum();
    let eigen = square.symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    if largest < 1e-18 {
        return Vec::new();
    }
    let kept: Vec<usize> = (0..3)
        .filter(|&i| eigen.eigenvalues[i] > largest * RANK * RANK * 1e2)
        .collect();
    let vector = |i: usize| clean(eigen.eigenvectors.column(i).into_owned());
    let units = || (0..3).map(|axis| Vector3::ith(axis, 1.0));
    match kept.len() {
        3 => units().collect(),
        2 => {
            let normal = (0..3).find(|i| !kept.contains(i)).map(vector);
            let Some(normal) = normal else {
                return Vec::new();
            };
            // The coordinate axis nearest to the plane gives the first direction.
            let first = units()
                .map(|axis| axis - normal * normal.dot(&axis))
                .max_by(|a, b| {
                    a.norm()
                        .total_cmp(&b.norm())
                        .then(std::cmp::Ordering::Greater)
                });
            let Some(first) = first.map(|first| first.normalize()) else {
                return Vec::new();
            };
            vec![first, normal.cross(&first)]
        }
        _ => kept.into_iter().map(vector).collect(),
    }
}

/// Unit vector without rounding errors of its components.
fn clean(direction: Vector3<f64>) -> Vector3<f64> {
    let round = |v: f64| {
        let whole = v.round();
        if (v - whole).abs() < 1e-7 { whole } else { v }
    };
    direction.map(round).normalize()
}

impl Platform {
    /// Point that the translations displace: the origin of the first body, in the world.
    pub(crate) fn at(&self, network: &Network<'_>, state: &State) -> Point3<f64> {
        let first = network.groups[self.group].bodies[0];
        state.poses[first].translation.vector.into()
    }
}
