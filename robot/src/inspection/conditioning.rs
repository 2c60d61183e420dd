//! Conditioning at home of the actuators and of every partition.

use crate::{identification::partitions::partitions, interpreted::InterpretedRobot};
use nalgebra::DMatrix;
use overact::{Function, Model};
use serde::Serialize;

/// Condition numbers at home; angular columns are in rad.
#[derive(Debug, Serialize)]
#[non_exhaustive]
pub struct Conditioning {
    /// Condition number of J_p^inv; `None` if singular.
    pub home: Option<f64>,
    /// Condition number of J_a for every partition, best first.
    pub partitions: Vec<Partition>,
}

/// A choice of kept actuators.
#[derive(Debug, Serialize)]
#[non_exhaustive]
pub struct Partition {
    /// Names of the kept actuators.
    pub kept_actuators: Vec<String>,
    /// Whether the description chooses it.
    pub chosen: bool,
    /// Condition number; `None` if the actuators do not determine the platform's motion.
    pub condition: Option<f64>,
}

impl Conditioning {
    pub(super) fn new(robot: &InterpretedRobot) -> Self {
        let info = robot.info();
        let (n, r) = (info.sizes.actuators, info.sizes.dof);
        let mut values = vec![0.0; n * r];
        let inputs = [info.home_pose];
        if robot
            .evaluate(Function::InverseJacobian, &inputs, &mut values)
            .is_err()
        {
            return Self {
                home: None,
                partitions: Vec::new(),
            };
        }
        let jacobian = DMatrix::from_row_slice(n, r, &values);
        let mut chosen = info.kept_actuators.to_vec();
        chosen.sort_unstable();
        let partition = |kept: Vec<usize>| Partition {
            kept_actuators: kept.iter().map(|&i| info.actuators[i].to_owned()).collect(),
            chosen: kept == chosen,
            condition: condition(&jacobian.select_rows(&kept)),
        };
        let choices = if n > r { partitions(n, r) } else { Vec::new() };
        let mut partitions: Vec<Partition> = choices.into_iter().map(partition).collect();
        let key = |p: &Partition| p.condition.unwrap_or(f64::INFINITY);
        partitions.sort_by(|a, b| key(a).total_cmp(&key(b)));
        Self {
            home: condition(&jacobian),
            partitions,
        }
    }
}

/// Ratio of the largest to the smallest singular value; `None` if singular.
fn condition(matrix: &DMatrix<f64>) -> Option<f64> {
    if matrix.is_empty() {
        return None;
    }
    let values = matrix.singular_values();
    let condition = values.max() / values.min();
    (condition < 1e14).then_some(condition)
}
