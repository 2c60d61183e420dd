//! Columns that may be wrapped angles, and their possible periods.

use std::f64::consts::TAU;

use super::Rotation;
use crate::mapping::expression::Expression;

/// Periods of counters, in counts: encoders and registers of 8 to 32 bits.
pub(super) const COUNTERS: [f64; 25] = {
    let mut all = [0.0; 25];
    let mut bits = 0;
    while bits < all.len() {
        all[bits] = (1_u64 << (bits + 8)) as f64;
        bits += 1;
    }
    all
};

/// One turn in units of angles: radians, degrees, gons and turns.
const UNITS: [f64; 4] = [TAU, 360.0, 400.0, 1.0];

/// Largest relative excess of the motor's turn over the joint's.
const ROUNDING: f64 = 1e-6;

/// Position of a rotating joint, or of its motor, as a function of columns.
pub(crate) struct Position<'a> {
    pub(crate) text: &'a str,
    pub(crate) expression: &'a Expression,
    /// Factor to rad.
    pub(crate) scale: f64,
}

impl Rotation {
    /// The columns of a position that is linear in them; empty otherwise.
    pub(crate) fn of_columns(position: &Position<'_>, names: &[&str]) -> Vec<Self> {
        let Some(slopes) = slopes(position.expression, names.len()) else {
            return Vec::new();
        };
        let one = |(column, slope): (usize, f64)| Self {
            column,
            name: names[column].to_owned(),
            periods: periods(TAU / (slope * position.scale).abs()),
            period: None,
        };
        slopes.into_iter().map(one).collect()
    }

    /// A position that is a nonlinear function, such as atan2, by its index among all positions.
    pub(crate) fn of_value(position: &Position<'_>, place: usize, width: usize) -> Option<Self> {
        slopes(position.expression, width).is_none().then(|| Self {
            column: place,
            name: position.text.to_owned(),
            periods: vec![TAU * position.scale.abs(), TAU],
            period: None,
        })
    }
}

/// Possible periods of a column whose value for one turn of the joint is `joint`.
///
/// They are that of the joint, those of a motor before a gear, and those of counters.
fn periods(joint: f64) -> Vec<f64> {
    let units = UNITS.into_iter();
    let motors = units.filter(|turn| *turn <= joint * (1.0 + ROUNDING));
    let all = std::iter::once(joint).chain(motors).chain(COUNTERS);
    all.filter(|period| period.is_finite() && *period > 0.0)
        .collect()
}

/// Slopes of a linear expression in each of its columns; `None` for other expressions.
fn slopes(expression: &Expression, width: usize) -> Option<Vec<(usize, f64)>> {
    if let Expression::Column(place) = expression {
        return Some(vec![(*place, 1.0)]);
    }
    let at = |column: usize, value: f64| {
        let mut row = vec![0.0; width];
        row[column] = value;
        expression.evaluate(&row)
    };
    let origin = expression.evaluate(&vec![0.0; width]);
    let slopes = (0..width).map(|column| at(column, 1.0) - origin);
    let slopes: Vec<f64> = slopes.collect();
    // Test points that only a linear function satisfies.
    let is_linear = [0.7, -3.3, 41.0].into_iter().all(|factor| {
        let row: Vec<f64> = (0..width)
            .map(|column| factor * (1.0 + 0.61 * column as f64))
            .collect();
        let sum: f64 = row.iter().zip(&slopes).map(|(x, slope)| x * slope).sum();
        let size = origin.abs()
            + row
                .iter()
                .zip(&slopes)
                .map(|(x, slope)| (x * slope).abs())
                .sum::<f64>();
        (expression.evaluate(&row) - origin - sum).abs() <= 1e-9 * size
    });
    let own = slopes.into_iter().enumerate();
    is_linear.then(|| own.filter(|(_, slope)| *slope != 0.0).collect())
}
