//! One draw: simulated, disturbed, identified, counted.

use crate::{Failure, Noise, Subject, draw};
use overact_identification::{
    Estimate, ModelKind, ParameterEstimate, Stage, estimate_projection, prepare,
};

/// The intervals of one estimate of one draw, counted.
#[derive(Debug, Clone, PartialEq)]
pub struct Counted {
    /// Multiples of the description's noise.
    pub noise: Noise,
    /// Which inputs were explained.
    pub model: ModelKind,
    /// Which parameters were estimated.
    pub stage: Stage,
    /// The parameters of which the true value is known.
    pub parameters: Vec<Interval>,
}

/// One interval.
#[derive(Debug, Clone, PartialEq)]
pub struct Interval {
    /// Name of the parameter.
    pub name: String,
    /// Whether it contains the true value.
    pub covers: bool,
    /// Its width by that of the base model's interval of the parameter.
    pub relative_width: f64,
    /// Error by half of the width.
    pub miss: f64,
}

/// Makes draw number `draw` of a subject under each noise.
///
/// # Errors
/// A draw that can't be simulated or identified.
pub fn measure(subject: &Subject, draw: u64, noises: &[Noise]) -> Result<Vec<Counted>, Failure> {
    let experiment = draw::varied(subject, draw)?;
    let mut encoders: Vec<f64> = noises.iter().map(|noise| noise.encoder).collect();
    encoders.sort_by(f64::total_cmp);
    encoders.dedup();
    let mut counted = Vec::new();
    for encoder in encoders {
        let records = draw::records(subject, &experiment, encoder)?;
        for &noise in noises.iter().filter(|noise| noise.encoder == encoder) {
            let logs = draw::logs(subject, &records, noise.torque, draw)?;
            let projections = subject.projections();
            let prepared = prepare(
                subject.model(),
                &logs,
                &projections,
                &subject.settings,
                &|_| {},
            )?;
            for projection in 0..projections.len() {
                let truth = Some(&subject.truth);
                let outcome = estimate_projection(&prepared, projection, &subject.settings, truth)?;
                for estimate in [&outcome.base, &outcome.recommended, &outcome.essential] {
                    counted.push(Counted {
                        noise,
                        model: estimate.model,
                        stage: estimate.stage,
                        parameters: intervals(estimate, &outcome.base),
                    });
                }
            }
        }
    }
    Ok(counted)
}

/// All intervals of an estimate beside those of the base model.
fn intervals(estimate: &Estimate, base: &Estimate) -> Vec<Interval> {
    let width = |parameter: &ParameterEstimate| {
        let [low, high] = parameter.interval_95;
        high - low
    };
    let one = |parameter: &ParameterEstimate| {
        let truth = parameter.true_value?;
        let whole = base
            .parameters
            .iter()
            .find(|one| one.column == parameter.column)?;
        let [low, high] = parameter.interval_95;
        Some(Interval {
            name: parameter.name.clone(),
            covers: low <= truth && truth <= high,
            relative_width: width(parameter) / width(whole),
            miss: (parameter.value - truth) / (0.5 * width(parameter)),
        })
    };
    estimate.parameters.iter().filter_map(one).collect()
}
