//! Columns of the identification model: standard parameters, payload, and friction by direction.

mod column;
mod evaluate;
mod held;

use super::friction::friction_rates;
use crate::settings::Settings;
use StandardParameter as P;
use column::Origin;
use overact::{Body, Model, Sizes, StandardParameter};
use overact_logs::{Error, Load};

pub use column::{Column, Direction, is_carried, load_of};
pub(crate) use column::{Reversal, has_payload};

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
    /// sampling interval. Stribeck friction has the velocities of the settings.
    ///
    /// # Errors
    /// A friction parameter whose rate cannot be recognised.
    pub fn with_friction_signs(
        mut self,
        model: &dyn Model,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let reversal = Reversal::new(settings);
        let velocities = &settings.stribeck_velocities;
        if reversal.band > 0.0 || reversal.averaged || !velocities.is_empty() {
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
                if let Some(&velocity) = velocities.get(&column.name) {
                    column.set_stribeck(velocity);
                }
            }
        }
        Ok(self)
    }

    /// Adds a column of Stribeck friction with another velocity, and returns its index.
    pub(crate) fn add_stribeck(&mut self, column: usize, velocity: f64) -> usize {
        let mut own = self.columns[column].clone();
        own.set_stribeck(velocity);
        self.columns.push(own);
        self.columns.len() - 1
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
}
