//! Quantities of the estimates: densities, and ratios to prior values.

use super::motion::RunMotion;
use crate::{
    assessment::checks::Context,
    result::{ParameterEstimate, Stage},
    units::{Powers, Quantity, Range},
};
use overact_logs::Scales;

/// Possible densities of a robot, mass by cubed length, kg/m³.
const DENSITIES: Range = Range::new(0.01, 2e4);
const USUAL_DENSITIES: Range = Range::new(0.5, 3e3);

/// Possible ratios of estimates to prior values.
const BY_PRIOR: Range = Range::new(0.05, 20.0);

/// Estimates count if they differ from zero by this many standard deviations.
const CLEAR: f64 = 5.0;

/// Lengths (m) of a robot without described lengths.
///
/// The lower bound applies to densities that are too large, the upper one to those too small.
const AXIS: Range = Range::new(1.0, 5.0);

/// Lengths for the bounds on densities.
struct Lengths {
    /// For densities that are too large.
    long: f64,
    /// For densities that are too small.
    short: f64,
    /// Whether they are described, and thus independent of the unit of positions.
    are_described: bool,
}

impl Lengths {
    /// Lengths of a robot with these runs; `None` if its size is unknown.
    fn new(scales: &Scales, runs: &[RunMotion]) -> Option<Self> {
        let travel = runs.iter().fold(0.0, |most: f64, run| most.max(run.travel));
        match scales.reach() {
            Some(reach) => Some(Self {
                long: reach.max(travel),
                short: reach,
                are_described: true,
            }),
            None if travel > 0.0 => Some(Self {
                long: travel.max(AXIS.low),
                short: travel.min(AXIS.high),
                are_described: false,
            }),
            None => None,
        }
    }
}

/// Power of a length that converts an inertia to a density.
const INERTIA: i32 = 5;

/// Power of a length that converts a parameter to a density.
///
/// Masses have 3, first moments 4, inertias 5, friction `None`.
fn power(unit: &str) -> Option<i32> {
    match unit {
        "kg" => Some(3),
        "kg m" => Some(4),
        unit if unit.starts_with("kg m") && unit.chars().count() <= 6 => Some(INERTIA),
        _ => None,
    }
}

/// Quantities of the first model's base parameters that depend on units.
pub(super) fn quantities(
    context: &Context<'_>,
    scales: &Scales,
    runs: &[RunMotion],
) -> Vec<Quantity> {
    let Some(estimate) = context.estimates_of(Stage::Base).next() else {
        return Vec::new();
    };
    let half = |one: &ParameterEstimate| 0.5 * (one.interval_95[1] - one.interval_95[0]);
    let is_clear = |one: &&ParameterEstimate| 1.96 * one.value.abs() > CLEAR * half(one);
    let clear: Vec<&ParameterEstimate> = estimate.parameters.iter().filter(is_clear).collect();
    let lengths = Lengths::new(scales, runs);
    let densities = lengths.map(|lengths| densities(context, &clear, &lengths));
    let densities = densities.into_iter().flatten();
    densities.chain(by_prior(context, &clear)).collect()
}

/// The largest density, and the density of the heaviest parameter.
fn densities(
    context: &Context<'_>,
    clear: &[&ParameterEstimate],
    lengths: &Lengths,
) -> Vec<Quantity> {
    let columns = context.columns.as_slice();
    let volume = |column: usize, length: f64| {
        let column = columns.get(column)?;
        Some(length.powi(power(column.unit)?))
    };
    let mut densest: Option<(f64, &ParameterEstimate)> = None;
    let mut heaviest: Option<(f64, &ParameterEstimate)> = None;
    let larger = |best: &mut Option<(f64, _)>, value: f64, parameter| {
        if best.is_none_or(|(most, _)| value > most) {
            *best = Some((value, parameter));
        }
    };
    for one in clear {
        let base = context.base;
        let (Some(&kept), Some(terms)) = (
            base.columns.get(one.column),
            base.regroupings.get(one.column),
        ) else {
            continue;
        };
        let (Some(own), Some(small)) = (volume(kept, lengths.long), volume(kept, lengths.short))
        else {
            continue;
        };
        let regrouped = terms.iter().filter_map(|&(column, coefficient)| {
            Some(coefficient.abs() * volume(column, lengths.long)?)
        });
        let whole = own + regrouped.sum::<f64>();
        larger(&mut densest, one.value.abs() / whole, *one);
        larger(&mut heaviest, one.value.abs() / small, *one);
    }
    // A length that is a travel scales with the positions.
    let by_travel = if lengths.are_described { 0 } else { -3 };
    let quantity = |(value, of): (f64, &ParameterEstimate), length: f64, possible, usual, moved| {
        let name = &of.name;
        let length = overact_logs::significant(length, 3);
        Quantity {
            name: format!("the density implied by `{name}` for a robot of {length} m"),
            value,
            unit: "kg/m³",
            possible,
            usual,
            powers: Powers {
                time: 2,
                positions: -1 + moved,
                torques: 1,
            },
            is_by_weight: power(&of.unit).is_some_and(|power| power < INERTIA),
        }
    };
    let densest = densest.map(|found| {
        let possible = Range::new(0.0, DENSITIES.high);
        let usual = Range::new(0.0, USUAL_DENSITIES.high);
        quantity(found, lengths.long, possible, usual, 0)
    });
    let heaviest = heaviest.map(|found| {
        let possible = Range::new(DENSITIES.low, f64::INFINITY);
        let usual = Range::new(USUAL_DENSITIES.low, f64::INFINITY);
        quantity(found, lengths.short, possible, usual, by_travel)
    });
    densest.into_iter().chain(heaviest).collect()
}

/// Median ratio of the estimates to their prior or known values.
fn by_prior(context: &Context<'_>, clear: &[&ParameterEstimate]) -> Option<Quantity> {
    let columns = context.columns.as_slice();
    let settings = context.settings;
    let value = |column: usize| {
        let name = &columns.get(column)?.name;
        let believed = settings.prior.values.get(name);
        believed.or_else(|| settings.known.get(name)).copied()
    };
    let ratio = |one: &&ParameterEstimate| {
        power(&one.unit)?;
        let own = value(*context.base.columns.get(one.column)?)?;
        let terms = context.base.regroupings.get(one.column)?.iter();
        let mut parts = vec![own];
        for &(column, coefficient) in terms {
            parts.push(coefficient * value(column)?);
        }
        let (sum, size) = parts.iter().fold((0.0, 0.0), |(sum, size), part: &f64| {
            (sum + part, size + part.abs())
        });
        // A sum of terms that nearly cancel says nothing about the size.
        (sum.abs() > 0.1 * size).then(|| (one.value / sum).abs())
    };
    let mut ratios: Vec<f64> = clear.iter().filter_map(ratio).collect();
    ratios.sort_by(f64::total_cmp);
    let median = *ratios.get(ratios.len() / 2)?;
    Some(Quantity {
        name: String::from("the estimates by the values in `prior`"),
        value: median,
        unit: "",
        possible: BY_PRIOR,
        usual: Range::new(0.3, 3.0),
        powers: Powers {
            time: 2,
            positions: -1,
            torques: 1,
        },
        is_by_weight: true,
    })
}
