//! Bodies whose displacements in the world serve as independent coordinates.
//!
//! Robots such as the Stewart platform or the Delta with six rods have no joints that determine all
//! others chain by chain. The displacement of their platform does.

use super::{motion::State, network::Network};
use crate::model::JointType;
use nalgebra::{DMatrix, Matrix3, Matrix3xX, Point3, Vector3};

/// A platform: independent displacements of a group.
#[derive(Debug, Clone)]
pub(crate) struct Platform {
    pub(crate) group: usize,
    /// Directions of translation in the world.
    pub(crate) translations: Vec<Vector3<f64>>,
    /// Axes of successive rotations at home, in the world.
    pub(crate) rotations: Vec<Vector3<f64>>,
}

impl Platform {
    /// Number of coordinates.
    pub(crate) fn count(&self) -> usize {
        self.translations.len() + self.rotations.len()
    }
}

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
    let is_plain = [0, 1, 3].contains(&rotations.len()) && translations.len() > 1;
    (is_plain && rotations.len() + translations.len() == count).then_some(Platform {
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

    /// Velocities along the translations, then about the rotation axes at home, for each motion.
    pub(crate) fn rates(&self, at: &Point3<f64>, relative: &DMatrix<f64>) -> Vec<Vec<f64>> {
        let angular: Matrix3xX<f64> = relative.fixed_rows::<3>(3).into_owned();
        let linear: Matrix3xX<f64> =
            relative.fixed_rows::<3>(0) - at.coords.cross_matrix() * &angular;
        let row = |matrix: &Matrix3xX<f64>, axis: &Vector3<f64>| -> Vec<f64> {
            (matrix.transpose() * axis).iter().copied().collect()
        };
        let translations = self.translations.iter().map(|axis| row(&linear, axis));
        let rotations = self.rotations.iter().map(|axis| row(&angular, axis));
        translations.chain(rotations).collect()
    }

    /// Kind of each coordinate's joint, with its axis at home.
    pub(crate) fn axes(&self) -> Vec<(JointType, Vector3<f64>)> {
        let translations = self.translations.iter();
        let translations = translations.map(|axis| (JointType::Prismatic, *axis));
        let rotations = self
            .rotations
            .iter()
            .map(|axis| (JointType::Revolute, *axis));
        translations.chain(rotations).collect()
    }
}
