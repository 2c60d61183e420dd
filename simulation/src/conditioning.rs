//! How well a motion determines the parameters (section 4.1) and every partition of the actuators.
//!
//! *Parameters.* The columns of the stacked regressor W of case 1, eq. (30), are scaled to unit norm, so
//! the condition does not depend on the parameters' units. Columns that depend on earlier ones are left
//! out (a Cholesky factorisation of WᵀW in column order leaves no pivot for them), which makes the rest
//! a set of base columns. The reciprocal condition number is sqrt(λ_min / λ_max) of their WᵀW.
//!
//! *Partitions.* Case 2 keeps r of the n actuators; the r rows J_a of J_p^inv have to be regular along
//! the motion for each choice, or case 2 meets a singularity that the robot does not have. Columns of
//! J_p^inv are divided by their norms at home, which makes metres and radians comparable.

use nalgebra::{DMatrix, SymmetricEigen};
use overact::{Columns, Function, Model, SampleError};

/// Poses, twists and accelerations of many samples.
pub(crate) struct Motion {
    pub(crate) pose: Vec<f64>,
    pub(crate) twist: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
}

/// A pivot of the unit-norm columns' Gram matrix below this belongs to a dependent column.
const DEPENDENT: f64 = 1e-10;

/// WᵀW of case 1 over a motion, own columns first, then the payload's if asked for.
pub(crate) fn gram(
    model: &dyn Model,
    motion: &Motion,
    payload: bool,
) -> Result<DMatrix<f64>, SampleError> {
    let sizes = model.info().sizes;
    let samples = motion.twist.len() / sizes.dof;
    let inputs: [&[f64]; 3] = [&motion.pose, &motion.twist, &motion.acceleration];
    let block = |function, columns: usize| -> Result<DMatrix<f64>, SampleError> {
        let mut values = vec![0.0; samples * sizes.dof * columns];
        if columns > 0 {
            model.evaluate(function, &inputs, &mut values)?;
        }
        Ok(DMatrix::from_row_slice(
            samples * sizes.dof,
            columns,
            &values,
        ))
    };
    let own = block(
        Function::IdmRedPlatform(Columns::Standard),
        sizes.parameters,
    )?;
    let count = if payload { sizes.payload_parameters } else { 0 };
    let added = block(Function::IdmRedPayload, count)?;
    let mut regressor = own.resize_horizontally(sizes.parameters + count, 0.0);
    regressor
        .columns_mut(sizes.parameters, count)
        .copy_from(&added);
    Ok(regressor.tr_mul(&regressor))
}

/// Of the wanted columns, those that do not depend on earlier ones, by Cholesky in the order given.
pub(crate) fn independent(gram: &DMatrix<f64>, wanted: &[usize]) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    // Rows of the factor L of the kept columns, each as long as its place.
    let mut factor: Vec<Vec<f64>> = Vec::new();
    for column in wanted {
        let norm = gram[(*column, *column)].sqrt();
        if norm.is_nan() || norm <= 0.0 {
            continue;
        }
        let mut row: Vec<f64> = Vec::with_capacity(kept.len() + 1);
        for (other, earlier) in kept.iter().zip(&factor) {
            let product = gram[(*column, *other)] / (norm * gram[(*other, *other)].sqrt());
            let known: f64 = row.iter().zip(earlier).map(|(a, b)| a * b).sum();
            row.push((product - known) / earlier[row.len()]);
        }
        let pivot = 1.0 - row.iter().map(|l| l * l).sum::<f64>();
        if pivot > DEPENDENT {
            row.push(pivot.sqrt());
            factor.push(row);
            kept.push(*column);
        }
    }
    kept
}

/// Reciprocal condition number of the given columns, scaled to unit norm; 0 when one vanishes.
pub(crate) fn reciprocal_condition(gram: &DMatrix<f64>, columns: &[usize]) -> f64 {
    let norm = |k: usize| gram[(columns[k], columns[k])].sqrt();
    let n = columns.len();
    if (0..n).any(|k| norm(k).is_nan() || norm(k) <= 0.0) {
        return 0.0;
    }
    let scaled = DMatrix::from_fn(n, n, |a, b| {
        gram[(columns[a], columns[b])] / (norm(a) * norm(b))
    });
    let eigenvalues = SymmetricEigen::new(scaled).eigenvalues;
    let (least, largest) = eigenvalues
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(low, high), value| {
            (low.min(*value), high.max(*value))
        });
    (least.max(0.0) / largest).sqrt()
}

/// All choices of r among n actuators.
pub(crate) fn partitions(n: usize, r: usize) -> Vec<Vec<usize>> {
    let mut choices = vec![Vec::new()];
    for _ in 0..r {
        choices = choices
            .iter()
            .flat_map(|choice: &Vec<usize>| {
                let first = choice.last().map_or(0, |last| last + 1);
                (first..n).map(|next| choice.iter().copied().chain([next]).collect())
            })
            .collect();
    }
    choices
}

/// Inverse norms of the columns of J_p^inv at home.
pub(crate) fn column_scales(model: &dyn Model) -> Result<Vec<f64>, SampleError> {
    let info = model.info();
    let sizes = info.sizes;
    let mut jacobian = vec![0.0; sizes.actuators * sizes.dof];
    model.evaluate(Function::InverseJacobian, &[info.home_pose], &mut jacobian)?;
    let norm = |c: usize| {
        jacobian
            .iter()
            .skip(c)
            .step_by(sizes.dof)
            .map(|j| j * j)
            .sum::<f64>()
    };
    Ok((0..sizes.dof).map(|c| 1.0 / norm(c).sqrt()).collect())
}

/// Largest condition number of any partition's J_a along a motion; infinite where a determinant changes
/// its sign, because the motion then crosses a singularity, be it between two samples.
pub(crate) fn worst_partition(
    model: &dyn Model,
    poses: &[f64],
    scales: &[f64],
) -> Result<f64, SampleError> {
    let sizes = model.info().sizes;
    let (n, r) = (sizes.actuators, sizes.dof);
    let mut jacobians = vec![0.0; poses.len() / sizes.pose * n * r];
    model.evaluate(Function::InverseJacobian, &[poses], &mut jacobians)?;
    let mut worst = 1.0_f64;
    for choice in partitions(n, r) {
        let mut side = 0.0;
        for jacobian in jacobians.chunks_exact(n * r) {
            let kept = DMatrix::from_fn(r, r, |a, b| jacobian[choice[a] * r + b] * scales[b]);
            let determinant = kept.determinant();
            let values = kept.singular_values();
            let condition = values.max() / values.min();
            if side * determinant < 0.0 || condition.is_nan() {
                return Ok(f64::INFINITY);
            }
            side = determinant;
            worst = worst.max(condition);
        }
    }
    Ok(worst)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::{Robot, mechanisms::DualV};

    #[test]
    fn a_singular_partition_inside_the_workspace_is_seen() {
        let model = Robot::new(DualV);
        let scales = column_scales(&model).unwrap();
        let at = |poses: &[f64]| worst_partition(&model, poses, &scales).unwrap();
        // At this pose of the DualV the closure equations of legs 1 to 3 are dependent, although
        // those of all four have a condition number of 2.
        assert!(at(&[-0.10, 0.16, -0.105_792]) > 1e4);
        // On both sides every partition is regular, but the way between crosses the singularity.
        let [one, other] = [[-0.10, 0.16, -0.2], [-0.10, 0.16, 0.1]];
        assert!(at(&one) < 30.0 && at(&other) < 30.0);
        assert_eq!(at(&[one, other].concat()), f64::INFINITY);
    }

    #[test]
    fn partitions_are_the_combinations() {
        assert_eq!(partitions(3, 2), [vec![0, 1], vec![0, 2], vec![1, 2]]);
        assert_eq!(partitions(8, 6).len(), 28);
        assert_eq!(partitions(3, 3), [vec![0, 1, 2]]);
    }

    #[test]
    fn dependent_columns_are_left_out_and_scaling_does_not_matter() {
        // Columns a, 3 a, b, a + b, 0 with a and b at 60 degrees.
        let (a, b) = ([2.0, 0.0], [0.5, 0.75_f64.sqrt()]);
        let columns = [a, [6.0, 0.0], b, [a[0] + b[0], b[1]], [0.0, 0.0]];
        let w = DMatrix::from_fn(2, 5, |i, j| columns[j][i]);
        let gram = w.tr_mul(&w);
        assert_eq!(independent(&gram, &[0, 1, 2, 3, 4]), [0, 2]);
        assert_eq!(independent(&gram, &[3, 0, 2]), [3, 0]);
        // Eigenvalues 1 ± cos 60° give sqrt(0.5 / 1.5).
        let reciprocal = reciprocal_condition(&gram, &[0, 2]);
        assert!((reciprocal - (1.0_f64 / 3.0).sqrt()).abs() < 1e-14);
    }
}
