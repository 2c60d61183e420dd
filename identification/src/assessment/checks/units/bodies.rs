//! Quantities of the estimates: densities, and values by those that are believed beforehand.

use super::motion::RunMotion;
use crate::{
    assessment::checks::Context,
    data::Scales,
    result::{ParameterEstimate, Stage},
    units::{Powers, Quantity, Range},
};

/// Densities of a robot, mass by cubed length, kg/m³: between those of foam in a frame and lead.
const DENSITIES: Range = Range::new(0.01, 2e4);
const USUAL_DENSITIES: Range = Range::new(0.5, 3e3);

/// Values by those that are believed beforehand.
const BY_PRIOR: Range = Range::new(0.05, 20.0);

/// Deviations from which on an estimate is clear of zero.
const CLEAR: f64 = 5.0;

/// Lengths of a robot without described ones, m: for densities that are too large at least, too small at most.
const AXIS: Range = Range::new(1.0, 5.0);

/// The lengths by which densities are judged.
struct Lengths {
    /// For those that are too large.
    long: f64,
    /// For those that are too small.
    short: f64,
    /// Whether they are described, and do not change with the unit of the positions.
    are_described: bool,
}

impl Lengths {
    /// Of a robot that moves so in its runs; none where nothing says how large it is.
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

/// The power of a length that makes a density of a parameter: of masses 3, of first moments 4, of inertias 5; none
/// of friction.
fn power(unit: &str) -> Option<i32> {
    match unit {
        "kg" => Some(3),
        "kg m" => Some(4),
        unit if unit.starts_with("kg m") && unit.chars().count() <= 6 => Some(5),
        _ => None,
    }
}

/// What the base parameters of the first model say of the units.
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

/// The largest density, and that of the heaviest parameter.
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
    let mut densest: Option<(f64, &str)> = None;
    let mut heaviest: Option<(f64, &str)> = None;
    let larger = |best: &mut Option<(f64, _)>, value: f64, name| {
        if best.is_none_or(|(most, _)| value > most) {
            *best = Some((value, name));
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
        let name = one.name.as_str();
        larger(&mut densest, one.value.abs() / whole, name);
        larger(&mut heaviest, one.value.abs() / small, name);
    }
    // A length that is a travel grows with the positions.
    let by_travel = if lengths.are_described { 0 } else { -3 };
    let quantity = |name: &str, value: f64, length: f64, possible: Range, usual: Range, moved| {
        let length = crate::significant(length, 3);
        Quantity {
            name: format!("the density that `{name}` means for a robot of {length} m"),
            value,
            unit: "kg/m³",
            possible,
            usual,
            powers: Powers {
                time: 2,
                positions: -1 + moved,
                torques: 1,
            },
        }
    };
    let densest = densest.map(|(value, name)| {
        let possible = Range::new(0.0, DENSITIES.high);
        let usual = Range::new(0.0, USUAL_DENSITIES.high);
        quantity(name, value, lengths.long, possible, usual, 0)
    });
    let heaviest = heaviest.map(|(value, name)| {
        let possible = Range::new(DENSITIES.low, f64::INFINITY);
        let usual = Range::new(USUAL_DENSITIES.low, f64::INFINITY);
        quantity(name, value, lengths.short, possible, usual, by_travel)
    });
    densest.into_iter().chain(heaviest).collect()
}

/// The median of the estimates by what is believed or known of them beforehand.
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
        // Parts that cancel say nothing of the size.
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
    })
}
