//! Relative residual of the torques after a fault is corrected.
//!
//! Any linear change of the torques changes Γ¹ = Σ_i J_iᵀ τ_i to a combination of the products J_iᵀ
//! τ_j. The residual of any combination follows from the R factor of [W, J_1ᵀ τ_1, J_1ᵀ τ_2, …].
//! One pass over the starts of the runs therefore tests all torque faults. Position faults that the
//! closure does not show need one pass each.

use nalgebra::{DMatrix, DVector};
use overact::{Model, StandardParameter};

use crate::{
    blocks::{BLOCK, slice},
    estimation::base::{BaseParameters, PayloadUse, base_parameters},
    kinematics::Motions,
    regression::{
        columns::ColumnSet,
        factor::{Factor, ReducedFactor},
        states::SampledStates,
    },
    settings::Settings,
};
use overact_logs::{Error, Log};

/// Possible faults.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fault {
    /// The torque of a drive must be multiplied by a factor.
    Gain(usize, f64),
    /// The torques of two drives are swapped.
    Swapped(usize, usize),
    /// The payload label of a run is wrong.
    Label(usize),
}

/// Columns of the model, always with those of the payload.
pub(super) struct Columns {
    columns: ColumnSet,
    base: BaseParameters,
    /// Indices of the payload columns among the base parameters.
    payload: Vec<usize>,
}

impl Columns {
    pub(super) fn new(model: &dyn Model, settings: &Settings) -> Result<Self, Error> {
        let has_payload = !model.info().payload_parameters.is_empty();
        let columns = ColumnSet::new(
            model,
            has_payload,
            settings.asymmetric_friction,
            settings.seed,
        )?
        .holding(&settings.prior);
        let payload = if has_payload {
            PayloadUse::Separate
        } else {
            PayloadUse::Absent
        };
        let base = base_parameters(model, &columns, payload, settings.seed)?;
        let loads = columns.indices(true);
        let places = base.columns.iter().enumerate();
        let payload = places
            .filter(|(_, column)| loads.contains(column))
            .map(|(place, _)| place)
            .collect();
        Ok(Self {
            columns: columns.with_friction_signs(model, settings)?,
            base,
            payload,
        })
    }

    /// Number of base columns.
    pub(super) fn len(&self) -> usize {
        self.base.columns.len()
    }

    /// Rows of the base columns of each line, followed by `more` numbers.
    pub(super) fn evaluate(
        &self,
        model: &dyn Model,
        states: &SampledStates<'_>,
        more: usize,
    ) -> Result<Vec<Vec<f64>>, overact::SampleError> {
        self.columns
            .evaluate(model, states, &self.base.columns, more)
    }

    /// Reads runs and factorises their equations.
    pub(super) fn fault_residual(
        &self,
        model: &dyn Model,
        runs: &[Log],
        settings: &Settings,
        options: EquationOptions,
    ) -> Result<FaultResidual<'_>, Error> {
        let loaded = !model.info().payload_parameters.is_empty();
        let factors = |log: &Log| {
            let log = log.clone().with_payload(loaded);
            run_factors(model, &log, settings, self, options)
        };
        Ok(FaultResidual {
            columns: self,
            factors: runs.iter().map(factors).collect::<Result<_, _>>()?,
            labels: runs.iter().map(Log::payload).collect(),
            actuators: model.info().sizes.actuators,
            drives: options.drives,
        })
    }
}

/// R factors of all runs.
pub(super) struct FaultResidual<'a> {
    columns: &'a Columns,
    /// For each run and line, the factor of W and of the drives' columns.
    factors: Vec<Vec<Factor>>,
    /// Whether each run is labelled as carrying the payload.
    labels: Vec<bool>,
    actuators: usize,
    drives: Drives,
}

impl FaultResidual<'_> {
    /// Coefficients of the drives' columns that give the inputs after correcting a fault.
    fn share(&self, fault: Option<Fault>) -> DVector<f64> {
        let n = self.actuators;
        if self.drives == Drives::Together {
            return DVector::from_element(1, 1.0);
        }
        let mut share = DVector::zeros(n * n);
        for i in 0..n {
            let (from, gain) = match fault {
                Some(Fault::Gain(own, gain)) if own == i => (i, gain),
                Some(Fault::Swapped(a, b)) if a == i => (b, 1.0),
                Some(Fault::Swapped(a, b)) if b == i => (a, 1.0),
                _ => (i, 1.0),
            };
            share[i * n + from] = gain;
        }
        share
    }

    /// Relative residual after correcting a fault, each line being divided by its norm.
    pub(super) fn error(&self, fault: Option<Fault>) -> f64 {
        let (all, lines) = self.stacked(fault, fault);
        let selected: Vec<usize> = (0..self.columns.base.columns.len()).collect();
        all.smallest_residual(&selected) / f64::from(lines.max(1)).sqrt()
    }

    /// The same with each line divided by its norm before the correction.
    ///
    /// A gain of a redundant drive adds internal torques to the inputs, which makes any residual
    /// relatively small.
    pub(super) fn error_by_logged_inputs(&self, fault: Fault) -> f64 {
        let (all, lines) = self.stacked(Some(fault), None);
        let selected: Vec<usize> = (0..self.columns.base.columns.len()).collect();
        all.smallest_residual(&selected) / f64::from(lines.max(1)).sqrt()
    }

    /// Squared norm of the inputs of each line, without a correction.
    fn squared_inputs(&self) -> Vec<f64> {
        let (p, share) = (self.columns.base.columns.len(), self.share(None));
        let lines = self.factors.first().map_or(0, Vec::len);
        let of_line = |line: usize| {
            let factors = self.factors.iter().map(|factors| factors[line].matrix());
            let sums = factors.map(|r| (r.columns(p, share.len()) * &share).norm_squared());
            sums.sum()
        };
        (0..lines).map(of_line).collect()
    }

    /// Whether the inputs after a correction of the positions are so large that the residual is not
    /// smaller than with those of the `logged` positions, although it is relative to the inputs.
    ///
    /// Positions near a singularity project the torques of a few samples on large inputs, which any
    /// model explains.
    pub(super) fn is_inflated(&self, logged: &Self) -> bool {
        let largest = |inputs: Vec<f64>| inputs.into_iter().fold(0.0, f64::max).sqrt();
        let inflation = largest(self.squared_inputs()) / largest(logged.squared_inputs());
        inflation * self.error(None) > logged.error(None)
    }

    /// Symbol of a base column.
    fn symbol(&self, place: usize) -> Option<StandardParameter> {
        let Columns { columns, base, .. } = self.columns;
        let column = columns.as_slice().get(*base.columns.get(place)?)?;
        Some(column.symbol)
    }

    /// Base parameters after correcting a fault, and the triangle of their equations.
    fn solved(&self, fault: Fault) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let selected: Vec<usize> = (0..self.columns.base.columns.len()).collect();
        let ReducedFactor { triangle, rhs, .. } =
            self.stacked(Some(fault), Some(fault)).0.reduced(&selected);
        Some((triangle.solve_upper_triangular(&rhs)?, triangle))
    }

    /// Payload mass after correcting a fault; `None` if there is none or it is undetermined.
    pub(super) fn mass(&self, fault: Fault) -> Option<f64> {
        let is_mass = |place: &&usize| self.symbol(**place) == Some(StandardParameter::M);
        let place = *self.columns.payload.iter().find(is_mass)?;
        let (solved, _) = self.solved(fault)?;
        solved.get(place).copied().filter(|mass| mass.is_finite())
    }

    /// Whether friction opposes the motion after correcting a fault, as far as the data show.
    pub(super) fn has_positive_friction(&self, fault: Fault) -> bool {
        let Some((solved, triangle)) = self.solved(fault) else {
            return false;
        };
        let of_column = |(place, value): (usize, &f64)| {
            let symbol = self.symbol(place)?;
            let is_known = symbol.is_friction() && symbol.is_nonnegative();
            is_known.then(|| value * triangle.column(place).norm())
        };
        let friction: f64 = solved.iter().enumerate().filter_map(of_column).sum();
        friction > 0.0
    }

    /// Factor of all lines after correcting a fault, each divided by its norm after correcting
    /// `scaled_by`; number of lines.
    fn stacked(&self, fault: Option<Fault>, scaled_by: Option<Fault>) -> (Factor, u32) {
        let p = self.columns.base.columns.len();
        let (share, scales) = (self.share(fault), self.share(scaled_by));
        let lines = self.factors.first().map_or(0, Vec::len);
        let mut stacked: Vec<DMatrix<f64>> = Vec::new();
        let mut count = 0;
        for line in 0..lines {
            let mut of_line = Vec::new();
            let mut squares = 0.0;
            for (run, factors) in self.factors.iter().enumerate() {
                let r = factors[line].matrix();
                let sum = r.columns(p, share.len()) * &share;
                // Below the triangle of W, only the norm of the sum matters.
                let mut rows = DMatrix::zeros(p + 1, p + 1);
                rows.view_mut((0, 0), (p, p))
                    .copy_from(&r.view((0, 0), (p, p)));
                rows.view_mut((0, p), (p, 1)).copy_from(&sum.rows(0, p));
                rows[(p, p)] = sum.rows_range(p..).norm();
                squares += (r.columns(p, scales.len()) * &scales).norm_squared();
                let relabelled = fault == Some(Fault::Label(run));
                if self.labels[run] == relabelled {
                    for &column in &self.columns.payload {
                        rows.column_mut(column).fill(0.0);
                    }
                }
                of_line.push(rows);
            }
            if squares > 0.0 {
                count += 1;
                let scale = 1.0 / squares.sqrt();
                stacked.extend(of_line.into_iter().map(|rows| rows * scale));
            }
        }
        let mut all = Factor::new(p);
        stacked.iter().for_each(|rows| all.push(rows));
        (all, count)
    }
}

/// How the torques enter the factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Drives {
    /// Each J_iᵀ τ_j in a column of its own.
    OneByOne,
    /// Σ_i J_iᵀ τ_i in one column.
    Together,
}

/// Options of the equations.
#[derive(Debug, Clone, Copy)]
pub(super) struct EquationOptions {
    drives: Drives,
    /// Multiple of the gravity terms to subtract: 1 to remove gravity, 2 to reverse it.
    without_gravity: f64,
}

impl EquationOptions {
    pub(super) const ONE_BY_ONE: Self = Self {
        drives: Drives::OneByOne,
        without_gravity: 0.0,
    };
    pub(super) const TOGETHER: Self = Self {
        drives: Drives::Together,
        without_gravity: 0.0,
    };

    /// The same, with a multiple of the gravity terms subtracted.
    pub(super) const fn without_gravity(self, times: f64) -> Self {
        Self {
            without_gravity: times,
            ..self
        }
    }
}

/// Factor of each line of a run: W, then the drives' columns.
fn run_factors(
    model: &dyn Model,
    log: &Log,
    settings: &Settings,
    Columns { columns, base, .. }: &Columns,
    EquationOptions {
        drives,
        without_gravity,
    }: EquationOptions,
) -> Result<Vec<Factor>, Error> {
    let info = model.info();
    let (n, r) = (info.sizes.actuators, info.sizes.dof);
    let mut motions = Motions::new(model, log, settings)?.unwatched();
    let decimator = settings.decimator(settings.decimation, log.sampling_frequency())?;
    let more = match drives {
        Drives::OneByOne => n * n,
        Drives::Together => 1,
    };
    let (p, width) = (base.columns.len(), base.columns.len() + more);
    let is_heavy = |place: &usize| {
        let column = columns.as_slice().get(base.columns[*place]);
        column.is_some_and(|column| column.symbol.is_inertial())
    };
    let heavy: Vec<usize> = (0..p).filter(is_heavy).collect();
    let mut streams = (0..r)
        .map(|_| decimator.stream(width, motions.samples()))
        .collect::<Result<Vec<_>, _>>()?;
    let mut factors = vec![Factor::new(width - 1); r];
    while let Some(motion) = motions.next()? {
        for first in (0..motion.samples).step_by(BLOCK) {
            let count = BLOCK.min(motion.samples - first);
            let at = |error: overact::SampleError| {
                Error::from(motion.outside(first + error.sample, error.error))
            };
            let states = SampledStates::of_motion(&motion, first, count);
            let evaluate = |states: &SampledStates<'_>| {
                let lines = columns.evaluate(model, states, &base.columns, more);
                lines.map_err(at)
            };
            let mut lines = evaluate(&states)?;
            if without_gravity > 0.0 {
                // At rest, the columns of masses contain gravity only.
                let rest = vec![0.0; r * count];
                let at_rest = evaluate(&SampledStates {
                    twist: &rest,
                    acceleration: &rest,
                    ..states
                })?;
                for (own, rest) in lines.iter_mut().zip(&at_rest) {
                    let rows = own.chunks_exact_mut(width).zip(rest.chunks_exact(width));
                    for (own, rest) in rows {
                        for place in heavy.iter().copied() {
                            own[place] -= without_gravity * rest[place];
                        }
                    }
                }
            }
            let jacobians = motion.inverse_jacobians(model, first, count)?;
            let torques = slice(&motion.torques, n, first, count);
            for (line, rows) in lines.iter_mut().enumerate() {
                for (sample, row) in rows.chunks_exact_mut(width).enumerate() {
                    let jacobian = slice(&jacobians, n * r, sample, 1);
                    let torques = slice(torques, n, sample, 1);
                    let share = |i: usize| jacobian[i * r + line];
                    if drives == Drives::Together {
                        let all = torques.iter().enumerate();
                        row[p] = all.map(|(i, torque)| share(i) * torque).sum();
                        continue;
                    }
                    let products =
                        (0..n).flat_map(|i| torques.iter().map(move |torque| share(i) * torque));
                    row[p..]
                        .iter_mut()
                        .zip(products)
                        .for_each(|(to, x)| *to = x);
                }
            }
            for ((stream, rows), factor) in streams.iter_mut().zip(&lines).zip(&mut factors) {
                let mut kept = Vec::new();
                stream.push(rows, &mut kept);
                if !kept.is_empty() {
                    factor.push_rows(&kept);
                }
            }
        }
    }
    Ok(factors)
}
