//! Residuals for any choice of velocities, from one R factor.

use super::joint::POINTS;
use crate::{regression::factor::Factor, result::Estimate};

/// Largest number of rounds through all joints for the minimum.
const ROUNDS: usize = 20;

/// Columns of the velocities of a joint.
pub(super) struct Candidates {
    /// Index of the parameter f in the estimate.
    pub(super) parameter: usize,
    /// Place of the first of them in the factor.
    pub(super) first: usize,
}

/// Residuals for any choice of one velocity for each joint.
pub(super) struct Profiles<'a> {
    pub(super) factor: Factor,
    pub(super) estimate: &'a Estimate,
    pub(super) candidates: Vec<Candidates>,
}

impl Profiles<'_> {
    /// Columns of the factor for these points of the joints, in the order of the estimate.
    fn selected(&self, points: &[usize]) -> Vec<usize> {
        let mut selected = self.estimate.columns();
        for (own, point) in self.candidates.iter().zip(points) {
            selected[own.parameter] = own.first + point;
        }
        selected
    }

    /// Smallest sum of squared residuals.
    pub(super) fn squares(&self, points: &[usize]) -> f64 {
        let selected = self.selected(points);
        self.factor.smallest_residual(&selected).powi(2)
    }

    /// Points with the smallest sum, joint by joint.
    pub(super) fn minimum(&self) -> Vec<usize> {
        let mut points = vec![POINTS / 2; self.candidates.len()];
        for _ in 0..ROUNDS {
            let before = points.clone();
            for joint in 0..points.len() {
                let value = |point: usize| {
                    let mut points = points.clone();
                    points[joint] = point;
                    self.squares(&points)
                };
                let best = (0..POINTS).map(|point| (value(point), point));
                let best = best.min_by(|a, b| a.0.total_cmp(&b.0));
                points[joint] = best.map_or(points[joint], |(_, point)| point);
            }
            if points == before {
                break;
            }
        }
        points
    }

    /// Variance of the weighted residuals.
    pub(super) fn variance(&self, points: &[usize]) -> f64 {
        let unknowns = self.estimate.parameters.len() + points.len();
        let freedom = self.factor.equations().saturating_sub(unknowns);
        self.squares(points) / freedom.max(1) as f64
    }

    /// Coefficient f of a joint.
    pub(super) fn coefficient(&self, points: &[usize], joint: usize) -> f64 {
        let reduced = self.factor.reduced(&self.selected(points));
        let values = reduced.triangle.solve_upper_triangular(&reduced.rhs);
        let parameter = self.candidates[joint].parameter;
        values.map_or(0.0, |values| values[parameter])
    }
}
