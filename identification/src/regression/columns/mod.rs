//! Columns of the identification model: standard parameters, payload, and friction by direction.
//!
//! **Asymmetric friction.** The columns fv, fs and off of a joint become fv_pos, fs_pos, fv_neg and
//! fs_neg. They equal the columns fv and fs for positive or negative joint velocity, and are zero
//! otherwise. The offset is then (fs_pos - fs_neg)/2 and has no column of its own.
//!
//! **Reversals.** The sign of a velocity changes between two samples. Torques and accelerations
//! represent means over the sampling intervals, so the columns fs can use the mean sign over the
//! interval. The sign at the sample itself is wrong by up to half an interval at every reversal.
//!
//! **Dead band.** Near standstill, the sign of a measured velocity is noise. Within a dead band the
//! columns fs can be zero.
//!
//! **Described asymmetric friction** is treated alike. If the velocity reverses within the interval,
//! its mean sign lies between -1 and 1. Both columns then get a share of their sum, which is the
//! column of the sign. Stribeck friction has its own mean over the interval.

mod held;

use std::cell::Cell;

use overact::{
    Body, Columns, Function, Info, Model, Parameter, SampleError, Sizes, StandardParameter,
};

use super::{
    collect_rows::{RowSource, collect_rows},
    friction::{Rate, friction_rates},
    states::SampledStates,
};
use crate::{kinematics::gears::mean_sign, settings::Settings};
use StandardParameter as P;
use overact_logs::{Error, Load};

thread_local! {
    /// Buffer for the numbers of the model's columns, reused between blocks.
    static NUMBERS: Cell<Vec<f64>> = const { Cell::new(Vec::new()) };
}

/// Source of the numbers of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Origin {
    /// A column of [`Function::IdmRedPlatform`].
    Robot(usize),
    /// The sum of two of them, friction of both directions.
    Both([usize; 2]),
    /// A column of [`Function::IdmRedPayload`].
    Payload(usize),
    /// A column of [`Function::IdmRedPlatform`] that counts only in loaded runs.
    Carried(usize),
}

impl Origin {
    const fn is_of_payload(self) -> bool {
        matches!(self, Self::Payload(_) | Self::Carried(_))
    }
}

/// Whether a parameter belongs to the payload of a robot without platform.
///
/// This is a body named `payload`, which the model has in all runs. If some runs are labelled as
/// loaded, its columns are zero in the others.
#[must_use]
pub fn is_carried(parameter: &Parameter) -> bool {
    let of_leg = matches!(parameter.body, Body::Leg { .. });
    let rest = parameter.name.strip_prefix(parameter.symbol.name());
    of_leg && parameter.symbol.is_inertial() && rest == Some("_payload")
}

/// Name of the payload that a parameter belongs to, if payloads have tables of their own.
///
/// Its parameters are named after it, `m_payload_tool`.
#[must_use]
pub fn load_of(parameter: &Parameter) -> Option<&'static str> {
    let rest = parameter.name.strip_prefix(parameter.symbol.name())?;
    let own = parameter.body == Body::Payload;
    rest.strip_prefix("_payload_").filter(|_| own)
}

/// Whether a robot can carry a payload.
pub(crate) fn has_payload(info: &Info<'_>) -> bool {
    !info.payload_parameters.is_empty() || info.parameters.iter().any(is_carried)
}

/// Direction of motion in which a friction parameter acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Direction {
    /// Positive joint velocity.
    Positive,
    /// Negative joint velocity.
    Negative,
}

/// One column of the identification model.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Column {
    /// Name of its parameter.
    pub name: String,
    /// Name of its standard parameter.
    pub standard: String,
    /// SI unit of the parameter.
    pub unit: &'static str,
    /// Symbol of its standard parameter.
    pub symbol: StandardParameter,
    /// Body of the parameter.
    pub body: Body,
    /// Direction of motion of a friction parameter, if split.
    pub direction: Option<Direction>,
    /// Rate of a joint, or of a combination of joints, that the column depends on.
    rate: Option<Rate>,
    /// Treatment of reversals, for a Coulomb parameter.
    reversal: Option<Reversal>,
    origin: Origin,
    /// Name of its payload, if there are several.
    pub(crate) load: Option<String>,
}

/// Treatment of the sign of a velocity around reversals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reversal {
    /// Speed below which there is no sign.
    band: f64,
    /// Whether it is the mean over the sampling interval.
    averaged: bool,
}

impl Reversal {
    /// From the settings.
    pub(crate) fn new(settings: &Settings) -> Self {
        Self {
            band: settings.velocity_dead_band,
            averaged: settings.averaged_reversals,
        }
    }

    /// Sign of a velocity that changes by `step` in a sampling interval; `None` in the dead band.
    pub(crate) fn sign(self, velocity: f64, step: f64) -> Option<f64> {
        (velocity.abs() >= self.band).then(|| mean_sign(velocity, self.step(step)))
    }

    /// Whether the velocity has one sign in the whole interval, outside the dead band.
    const fn is_steady(self, velocity: f64, step: f64) -> bool {
        let speed = velocity.abs();
        speed > 0.0 && speed >= self.band && 2.0 * speed >= self.step(step).abs()
    }

    /// Effective change of the velocity in the interval.
    const fn step(self, step: f64) -> f64 {
        if self.averaged { step } else { 0.0 }
    }
}

impl Column {
    /// The unsplit column of a standard parameter.
    fn new(parameter: &Parameter, origin: Origin) -> Self {
        Self {
            name: parameter.name.to_owned(),
            standard: parameter.name.to_owned(),
            unit: parameter.unit,
            symbol: parameter.symbol,
            body: parameter.body,
            direction: None,
            rate: None,
            reversal: None,
            origin,
            load: None,
        }
    }

    /// Index among the robot's parameters, if it is a column of the robot without payload.
    const fn index(&self) -> Option<usize> {
        match self.origin {
            Origin::Robot(index) => Some(index),
            _ => None,
        }
    }

    /// Whether it belongs to the payload.
    pub(crate) const fn is_of_payload(&self) -> bool {
        self.origin.is_of_payload()
    }

    /// Whether the column counts with this payload.
    fn counts(&self, carried: Load<'_>) -> bool {
        !self.origin.is_of_payload()
            || match (carried, &self.load) {
                (Load::Nothing, _) => false,
                (Load::Named(name), Some(own)) => name == own,
                (Load::Named(_), None) | (Load::Any, _) => true,
            }
    }

    /// The payload's column for the payload with this name.
    fn named(&self, load: &str) -> Self {
        Self {
            name: format!("{}_{load}", self.name),
            standard: format!("{}_{load}", self.standard),
            load: Some(load.to_owned()),
            ..self.clone()
        }
    }

    /// Factor of the model's column at a velocity of its coordinate.
    ///
    /// The velocity changes by `step` in a sampling interval.
    fn factor(&self, velocity: f64, step: f64) -> f64 {
        if let (Some(rate), Some(own)) = (&self.rate, self.reversal)
            && let Some(factor) = rate.mean_factor(velocity, own.step(step))
        {
            return if velocity.abs() < own.band {
                0.0
            } else {
                factor
            };
        }
        let sign = match self.reversal {
            // The usual case: one sign throughout the interval.
            Some(own) if self.direction.is_none() && own.is_steady(velocity, step) => return 1.0,
            Some(reversal) => reversal.sign(velocity, step),
            None => Some(mean_sign(velocity, 0.0)),
        };
        let Some(sign) = sign else {
            return 0.0;
        };
        // The model's column has the sign of the velocity, or for fv the velocity itself.
        match self.direction {
            None => sign * velocity.signum(),
            Some(Direction::Positive) => 0.5 * (1.0 + sign) * velocity.signum(),
            Some(Direction::Negative) => 0.5 * (1.0 - sign) * -velocity.signum(),
        }
    }

    /// Splits the column of a friction parameter by the direction of its rate.
    fn split(self, rate: &Rate) -> [Self; 2] {
        let symbol = self.symbol.name();
        [(Direction::Positive, "pos"), (Direction::Negative, "neg")].map(|(direction, suffix)| {
            let rest = self.standard.strip_prefix(symbol).unwrap_or(&self.standard);
            Self {
                name: format!("{symbol}_{suffix}{rest}"),
                direction: Some(direction),
                rate: Some(rate.clone()),
                ..self.clone()
            }
        })
    }
}

/// Columns of an identification, in the order of the model: the robot's, then the payload's.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnSet {
    columns: Vec<Column>,
    /// Held parameters without a column: index among the robot's parameters, and value.
    held: Vec<(usize, f64)>,
}

impl ColumnSet {
    /// Columns of a model, with those of the payload if a run carries it.
    ///
    /// Friction is split by direction on request.
    ///
    /// # Errors
    /// A friction parameter whose rate cannot be recognised.
    pub fn new(
        model: &dyn Model,
        payload: bool,
        asymmetric_friction: bool,
        seed: u64,
    ) -> Result<Self, Error> {
        let info = model.info();
        let rates = if asymmetric_friction {
            friction_rates(model, seed)?
        } else {
            vec![None; info.parameters.len()]
        };
        let has_fs = |body: Body| {
            info.parameters
                .iter()
                .any(|p| p.symbol == StandardParameter::Fs && p.body == body)
        };
        let mut columns = Vec::new();
        for (index, (parameter, rate)) in info.parameters.iter().zip(rates).enumerate() {
            let origin = if payload && is_carried(parameter) {
                Origin::Carried(index)
            } else {
                Origin::Robot(index)
            };
            let whole = Column::new(parameter, origin);
            match rate {
                Some(rate) if P::FRICTION.contains(&parameter.symbol) => {
                    columns.extend(whole.split(&rate));
                }
                None if asymmetric_friction
                    && parameter.symbol == StandardParameter::Off
                    && has_fs(parameter.body) => {}
                _ => columns.push(whole),
            }
        }
        if payload {
            let parameters = info.payload_parameters.iter().enumerate();
            columns.extend(parameters.map(|(k, parameter)| Column {
                load: load_of(parameter).map(str::to_owned),
                ..Column::new(parameter, Origin::Payload(k))
            }));
        }
        Ok(Self {
            columns,
            held: Vec::new(),
        })
    }

    /// Repeats the payload's columns for each of these payloads, such as `m_payload_A`.
    ///
    /// Without names the columns stay unchanged. Of payloads with tables of their own, whose columns
    /// have these names, only those of the given ones are kept.
    #[must_use]
    pub fn with_payloads(self, names: &[String]) -> Self {
        if names.is_empty() {
            return self;
        }
        let (loads, mut columns): (Vec<Column>, Vec<Column>) =
            { self.columns.iter().cloned() }.partition(|column| column.origin.is_of_payload());
        for name in names {
            let of_load = |column: &Column| match &column.load {
                Some(own) => (own == name).then(|| column.clone()),
                None => Some(column.named(name)),
            };
            columns.extend(loads.iter().filter_map(of_load));
        }
        Self { columns, ..self }
    }

    /// Whether there are columns for a payload of this name, or for an unnamed one.
    pub(crate) fn has_load(&self, name: &str) -> bool {
        let mut loads = { self.columns.iter() }.filter(|column| column.origin.is_of_payload());
        loads.any(|column| column.load.as_deref().is_none_or(|own| own == name))
    }

    /// Column indices of each payload.
    #[must_use]
    pub fn loads(&self) -> Vec<Vec<usize>> {
        let mut loads: Vec<(Option<&str>, Vec<usize>)> = Vec::new();
        for index in self.indices(true) {
            let own = self.columns[index].load.as_deref();
            match loads.iter_mut().find(|(load, _)| *load == own) {
                Some((_, all)) => all.push(index),
                None => loads.push((own, vec![index])),
            }
        }
        loads.into_iter().map(|(_, all)| all).collect()
    }

    /// Applies the settings for reversals to the columns of Coulomb friction.
    ///
    /// They are zero below the dead band of the joint's speed, and can use the mean sign over a
    /// sampling interval.
    ///
    /// # Errors
    /// A friction parameter whose rate cannot be recognised.
    pub fn with_friction_signs(
        mut self,
        model: &dyn Model,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let reversal = Reversal::new(settings);
        if reversal.band > 0.0 || reversal.averaged {
            let rates = friction_rates(model, settings.seed)?;
            let parameters = model.info().parameters;
            let of = |symbol: P, body: Body| {
                let mut all = parameters.iter();
                all.position(|one| one.symbol == symbol && one.body == body)
            };
            for column in &mut self.columns {
                let Origin::Robot(index) = column.origin else {
                    continue;
                };
                let (direction, other) = match column.symbol {
                    P::Fs | P::Fst | P::Fl => (column.direction, None),
                    P::FsPos => (Some(Direction::Positive), Some(P::FsNeg)),
                    P::FsNeg => (Some(Direction::Negative), Some(P::FsPos)),
                    _ => continue,
                };
                if let Some(other) = other {
                    // Friction of a single direction keeps the sign at the sample.
                    let Some(other) = of(other, column.body) else {
                        continue;
                    };
                    column.origin = Origin::Both([index, other]);
                }
                column.direction = direction;
                column.rate.clone_from(&rates[index]);
                column.reversal = Some(reversal);
            }
        }
        Ok(self)
    }

    /// All columns.
    #[must_use]
    pub fn as_slice(&self) -> &[Column] {
        &self.columns
    }

    /// Names and symbols of the columns.
    pub(crate) fn named(&self) -> Vec<(&str, StandardParameter)> {
        let columns = self.columns.iter();
        columns.map(|one| (one.name.as_str(), one.symbol)).collect()
    }

    /// Number of columns.
    #[must_use]
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// Whether there is no column.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// Indices of the robot's columns, or of the payload's.
    #[must_use]
    pub fn indices(&self, payload: bool) -> Vec<usize> {
        (0..self.columns.len())
            .filter(|&index| self.columns[index].origin.is_of_payload() == payload)
            .collect()
    }

    /// Values of the model's standard parameters, then of the payload, for values of some columns.
    ///
    /// Held parameters have their values, and those of other columns are zero.
    ///
    /// They reproduce the columns except for the treatment of reversals. `None` if a column is
    /// friction of one direction, for which the model has no parameter.
    pub(crate) fn parameters(
        &self,
        picked: &[usize],
        values: &[f64],
        sizes: &Sizes,
        carried: Load<'_>,
    ) -> Option<Vec<f64>> {
        let mut all = self.held(sizes);
        all.resize(sizes.parameters + sizes.payload_parameters, 0.0);
        for (&index, &value) in picked.iter().zip(values) {
            let column = self.columns.get(index)?;
            let place = match column.origin {
                Origin::Robot(_) if column.direction.is_some() => return None,
                Origin::Robot(k) | Origin::Both([k, _]) | Origin::Carried(k) => k,
                Origin::Payload(k) => sizes.parameters + k,
            };
            if column.counts(carried) {
                all[place] = value;
            }
        }
        Some(all)
    }

    /// Evaluates the columns `picked` of Γ¹.
    ///
    /// For each of the r lines, the result is samples × (picked + `more`), row-major, with zeros in
    /// the additional columns. Columns of payloads that are not carried are zero, eq. (49).
    ///
    /// # Errors
    /// The first sample at which the model has no value.
    pub fn evaluate(
        &self,
        model: &dyn Model,
        states: &SampledStates<'_>,
        picked: &[usize],
        more: usize,
    ) -> Result<Vec<Vec<f64>>, SampleError> {
        let sizes = model.info().sizes;
        let &SampledStates {
            samples,
            interval,
            pose,
            twist,
            acceleration,
            carried,
        } = states;
        let inputs = [pose, twist, acceleration];
        let fill = |function: Function, mut output: Vec<f64>| -> Result<Vec<f64>, SampleError> {
            let (rows, columns) = function.shape(&sizes);
            output.resize(samples * rows * columns, 0.0);
            if !output.is_empty() {
                let inputs = &inputs[..function.inputs().len()];
                model.evaluate(function, inputs, &mut output)?;
            }
            Ok(output)
        };
        let ask = |function: Function, wanted: bool| {
            if wanted {
                fill(function, Vec::new())
            } else {
                Ok(Vec::new())
            }
        };
        let columns = || picked.iter().filter_map(|&index| self.columns.get(index));
        let split = columns().any(|column| column.rate.is_some());
        let of_payload =
            |column: &Column| matches!(column.origin, Origin::Payload(_)) && column.counts(carried);
        let has_payload = columns().any(of_payload);
        let robot = fill(Function::IdmRedPlatform(Columns::Standard), NUMBERS.take())?;
        let payload = ask(Function::IdmRedPayload, has_payload)?;
        let averaged = columns().any(|column| column.reversal.is_some_and(|own| own.averaged));
        let velocities = ask(Function::JointVelocities, split)?;
        let accelerations = ask(Function::JointAccelerations, averaged)?;
        let width = picked.len() + more;
        // Sources of the numbers of a row: the robot's columns, then the payload's.
        let (mut own, mut load) = (Vec::new(), Vec::new());
        for (to, column) in columns().enumerate() {
            if !column.counts(carried) {
                continue;
            }
            match column.origin {
                Origin::Robot(k) => own.push((to, k)),
                Origin::Both(both) => own.extend(both.map(|k| (to, k))),
                Origin::Carried(k) => own.push((to, k)),
                Origin::Payload(k) => load.push((to, k)),
            }
        }
        let sources = [
            RowSource {
                numbers: &robot,
                count: sizes.parameters,
                places: own,
            },
            RowSource {
                numbers: &payload,
                count: sizes.payload_parameters,
                places: load,
            },
        ];
        let mut lines: Vec<Vec<f64>> = (0..sizes.dof)
            .map(|line| collect_rows(&sources, line, sizes.dof, samples, width))
            .collect();
        NUMBERS.set(robot);
        for (place, column) in columns().enumerate() {
            let Some(rate) = &column.rate else {
                continue;
            };
            let mut changes = accelerations.chunks_exact(sizes.joints);
            for (sample, joints) in velocities.chunks_exact(sizes.joints).enumerate() {
                let change = changes.next().map_or(0.0, |joints| rate.of(joints));
                let factor = column.factor(rate.of(joints), change * interval);
                if factor != 1.0 {
                    let place = sample * width + place;
                    lines.iter_mut().for_each(|rows| rows[place] *= factor);
                }
            }
        }
        Ok(lines)
    }
}
