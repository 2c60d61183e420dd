//! Bodies whose displacements in the world serve as independent coordinates.
//!
//! Robots such as the Stewart platform or the Delta with six rods have no joints that determine all
//! others chain by chain. The displacement of their platform does.

use crate::model::JointType;
use nalgebra::{DMatrix, Matrix3xX, Point3, Vector3};

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

impl Platform {
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
