//! Assembles the result of a calibration.

use overact::Info;

use super::{
    deviations::{Deviations, variance},
    elimination::Normal,
    fit::{Fit, restricted, solved},
    geometry::{Geometry, ParameterKind},
    result::{CalibratedParameter, Calibration, CalibrationScope, HeldParameter, SensorNoise},
    selection::{Choice, INDEPENDENT, independent_part},
};
use crate::estimation::intervals::MISSES;

/// Residual in units of the sensors' noise above which it is more than noise.
const UNEXPLAINED: f64 = 1.5;

/// Smallest squared fraction of a parameter's effect for which another one is named.
const NAMED: f64 = 1e-3;

/// A finished fit to report.
pub(super) struct Report<'a> {
    pub(super) scope: CalibrationScope,
    pub(super) choice: &'a Choice<'a>,
    pub(super) fit: &'a Fit,
    /// Equations of the described robot.
    pub(super) described: &'a Normal,
}

/// Identity of a parameter.
struct ParameterIdentity {
    name: String,
    unit: &'static str,
    kind: ParameterKind,
    described: f64,
    index: usize,
}

fn unit(revolute: bool) -> &'static str {
    if revolute { "rad" } else { "m" }
}

/// All parameters: encoder offsets, then lengths.
fn named(info: &Info<'_>, geometry: &dyn Geometry) -> Vec<ParameterIdentity> {
    let sensors = info.actuators.iter().zip(info.actuator_is_revolute);
    let offsets = sensors
        .enumerate()
        .map(|(index, (name, revolute))| ParameterIdentity {
            name: format!("offset_{name}"),
            unit: unit(*revolute),
            kind: ParameterKind::EncoderOffset,
            described: 0.0,
            index,
        });
    let lengths = geometry.parameters().iter().enumerate();
    let lengths = lengths.map(|(index, one)| ParameterIdentity {
        name: one.name.clone(),
        unit: unit(false),
        kind: one.kind,
        described: one.described,
        index,
    });
    offsets.chain(lengths).collect()
}

/// Result for a robot without redundant sensors.
pub(super) fn without_redundancy(
    info: &Info<'_>,
    geometry: &dyn Geometry,
    scope: CalibrationScope,
) -> Calibration {
    let (n, r) = (info.sizes.actuators, info.sizes.dof);
    let reason = String::from(
        "there are no more sensors than coordinates, so every reading is consistent with a pose",
    );
    let held = named(info, geometry).into_iter().map(|one| HeldParameter {
        name: one.name,
        unit: one.unit,
        kind: one.kind,
        described: one.described,
        deviation_of_a_change: None,
        reason: Some(reason.clone()),
    });
    Calibration {
        scope,
        sensors: n,
        coordinates: r,
        samples: 0,
        noise: Vec::new(),
        misfit_before: 0.0,
        misfit_after: 0.0,
        estimated: Vec::new(),
        held: held.collect(),
        converged: true,
        warnings: Vec::new(),
        remarks: vec![format!(
            "nothing can be calibrated: with {n} sensors for as many coordinates every reading is consistent with a pose for any offsets and lengths; calibration requires more sensors than coordinates"
        )],
    }
}

impl Report<'_> {
    /// The result.
    pub(super) fn calibration(&self) -> Calibration {
        let problem = self.choice.problem;
        let info = problem.model.info();
        let named = named(&info, problem.geometry);
        let (estimated, held): (Vec<_>, Vec<_>) = named
            .iter()
            .enumerate()
            .partition(|(place, _)| self.fit.selected.contains(place));
        let sensors = info.actuators.iter().zip(info.actuator_is_revolute);
        let noise = sensors.zip(&problem.samples.noise);
        Calibration {
            scope: self.scope,
            sensors: info.sizes.actuators,
            coordinates: info.sizes.dof,
            samples: problem.samples.count(),
            noise: noise
                .map(|((name, revolute), deviation)| SensorNoise {
                    actuator: (*name).to_owned(),
                    unit: unit(*revolute),
                    standard_deviation: *deviation,
                })
                .collect(),
            misfit_before: self.misfit(self.described, 0),
            misfit_after: self.misfit(&self.fit.normal, self.fit.selected.len()),
            estimated: self.estimated(&estimated, &named),
            held: held
                .iter()
                .map(|(place, one)| self.held(*place, one, &named))
                .collect(),
            converged: self.fit.converged,
            remarks: self.scale(&named).into_iter().collect(),
            warnings: self.warnings(&named),
        }
    }

    /// Root mean square residual in units of the noise.
    fn misfit(&self, normal: &Normal, parameters: usize) -> f64 {
        variance(normal.square, self.equations(), parameters).sqrt()
    }

    fn equations(&self) -> usize {
        self.choice.problem.samples.count() * self.choice.redundancy
    }

    fn estimated(
        &self,
        places: &[(usize, &ParameterIdentity)],
        all: &[ParameterIdentity],
    ) -> Vec<CalibratedParameter> {
        let of_runs = &self.choice.problem.samples.of_runs;
        let deviations = Deviations::new(self.fit, of_runs, self.choice.redundancy);
        let values = self.fit.values();
        let each = places.iter().zip(values).enumerate();
        let parameter =
            |(order, ((place, one), change)): (usize, (&(usize, &ParameterIdentity), f64))| {
                // A parameter that the fit does not determine has infinite standard deviation.
                let half = |misses| {
                    let known = deviations.as_ref();
                    known.map_or(f64::INFINITY, |known| known.half(order, misses))
                };
                let known = deviations.as_ref();
                let half = half(MISSES);
                // If all parameters are estimated together, right ones need no alternatives.
                let others = match self.scope {
                    CalibrationScope::Smallest => self.choice.alternatives(self.fit, *place),
                    _ => Vec::new(),
                };
                CalibratedParameter {
                    name: one.name.clone(),
                    unit: one.unit,
                    kind: one.kind,
                    described: one.described,
                    change,
                    standard_deviation: known.map_or(f64::INFINITY, |known| known.each[order]),
                    interval_95: [change - half, change + half],
                    alternatives: others
                        .iter()
                        .map(|&other| all[other].name.clone())
                        .collect(),
                    index: one.index,
                }
            };
        each.map(parameter).collect()
    }

    fn held(
        &self,
        place: usize,
        one: &ParameterIdentity,
        all: &[ParameterIdentity],
    ) -> HeldParameter {
        let normal = &self.fit.normal;
        let variance = variance(normal.square, self.equations(), self.fit.selected.len());
        let own = independent_part(normal, &self.fit.selected, place);
        HeldParameter {
            name: one.name.clone(),
            unit: one.unit,
            kind: one.kind,
            described: one.described,
            deviation_of_a_change: own.map(|own| (variance / own).sqrt()),
            reason: own.is_none().then(|| self.reason(place, all)),
        }
    }

    /// Why a parameter is undetermined.
    fn reason(&self, place: usize, all: &[ParameterIdentity]) -> String {
        let (normal, selected) = (&self.fit.normal, &self.fit.selected);
        let whole = normal.matrix[(place, place)];
        let largest = normal.matrix.diagonal().max();
        if whole <= INDEPENDENT * largest {
            return String::from("it has no effect on the sensors");
        }
        let among = normal.matrix.column(place).select_rows(selected);
        let factors = solved(&restricted(&normal.matrix, selected), &among);
        let of = factors.map_or_else(Vec::new, |factors| {
            let each = selected.iter().zip(factors.iter());
            let large = each.filter(|(own, factor)| {
                factor.powi(2) * normal.matrix[(**own, **own)] > NAMED * whole
            });
            large.map(|(own, _)| all[*own].name.as_str()).collect()
        });
        format!("its effect equals that of changes of {}", of.join(", "))
    }

    fn warnings(&self, all: &[ParameterIdentity]) -> Vec<String> {
        let mut warnings = Vec::new();
        if !self.fit.converged {
            warnings.push(String::from(
                "calibration: the estimation has not converged; its numbers are not used",
            ));
        }
        let after = self.misfit(&self.fit.normal, self.fit.selected.len());
        if after > UNEXPLAINED {
            warnings.push(format!(
                "calibration: the closure residual is {after:.1} times the noise of the sensors: other errors remain (directions of axes, play, flexible parts, filtered positions), which the standard deviations do not cover"
            ));
        }
        if self.scope == CalibrationScope::Smallest {
            for &place in &self.fit.selected {
                let others = self.choice.alternatives(self.fit, place);
                if others.is_empty() {
                    continue;
                }
                let others: Vec<&str> = others.iter().map(|&one| all[one].name.as_str()).collect();
                warnings.push(format!(
                    "calibration: a change of `{}` is estimated, but one of {} instead explains the data equally well; measure which one is wrong",
                    all[place].name,
                    others.join(", ")
                ));
            }
        }
        warnings
    }

    /// Remark if a common factor of all lengths is undetermined.
    fn scale(&self, all: &[ParameterIdentity]) -> Option<String> {
        let lengths = all.iter().map(|one| one.described);
        let direction = nalgebra::DVector::from_iterator(all.len(), lengths);
        let normal = self.described;
        let seen = direction.dot(&(&normal.matrix * &direction));
        let each = direction.component_mul(&direction);
        let whole = each.dot(&normal.matrix.diagonal());
        let unseen = whole > 0.0 && seen <= INDEPENDENT * whole;
        let held = all
            .iter()
            .enumerate()
            .filter(|(place, one)| one.described != 0.0 && !self.fit.selected.contains(place));
        let held: Vec<&str> = held.map(|(_, one)| one.name.as_str()).take(3).collect();
        unseen.then(|| {
            format!(
                "angles do not determine the scale: all lengths are relative to those that are fixed as described ({}, …)",
                held.join(", ")
            )
        })
    }
}
