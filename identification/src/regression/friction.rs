//! Finds the joint rate of each friction parameter from the power of its column.
//!
//! A friction parameter usually belongs to the rate of a joint. Coupled joints, and motors that
//! move several joints, have a constant combination of joint rates, c·q̇. The power of viscous
//! friction is (c·q̇)² = q̇ᵀ (c cᵀ) q̇ at every state, linear in the matrix c cᵀ. c is its only
//! eigenvector with a non-zero eigenvalue.
//!
//! The states are so slow that Stribeck friction has its full height, like dry friction. Its
//! decrease is seen at speed. Load-dependent friction has the power |load| |u|, and the load is
//! equal for two motions at the same pose, so their ratio is that of the rates.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use overact::Code;
use overact::{Columns, Effect, Function, Model, StandardParameter};

use super::states::{States, random_states};
use overact_logs::{Error, Problem};

/// States for the recognition of a rate, in addition to those for a combination of joints.
const RECOGNITION_STATES: usize = 12;

/// Relative tolerance of the recognition.
const RECOGNITION_TOLERANCE: f64 = 1e-6;

/// Fraction of the speed of random states at which friction is recognised, a power of two.
const SLOW: f64 = 1.0 / (1u64 << 30) as f64;

/// Factors in a combination below this fraction of the largest one are rounding errors.
const NEGLIGIBLE: f64 = 1e-7;

/// A rate as a constant combination of joint rates.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rate {
    /// Joints with their factors.
    joints: Vec<(usize, f64)>,
    /// Stribeck velocity of the model, if it has one.
    stribeck: Option<f64>,
    /// Stribeck velocity instead of that of the model.
    estimated: Option<f64>,
}

impl Rate {
    fn new(joints: Vec<(usize, f64)>) -> Self {
        Self {
            joints,
            stribeck: None,
            estimated: None,
        }
    }

    /// The same rate with another Stribeck velocity than that of the model.
    pub(crate) fn with_stribeck(&self, velocity: f64) -> Self {
        Self {
            estimated: Some(velocity),
            ..self.clone()
        }
    }

    /// Value for these rates, or accelerations, of all joints.
    pub(crate) fn of(&self, joints: &[f64]) -> f64 {
        let terms = self.joints.iter();
        terms.map(|(joint, factor)| factor * joints[*joint]).sum()
    }

    fn reversed(self) -> Self {
        let joints = self.joints.into_iter();
        Self::new(joints.map(|(joint, factor)| (joint, -factor)).collect())
    }

    /// Ratio of the mean friction over an interval to that of the model at its centre, for Stribeck
    /// friction.
    ///
    /// The rate changes by `step` in the interval.
    pub(crate) fn mean_factor(&self, rate: f64, step: f64) -> Option<f64> {
        let of_model = self.stribeck?;
        let velocity = self.estimated.unwrap_or(of_model);
        let at_centre = |velocity: f64| rate.signum() / (1.0 + (rate / velocity).powi(2));
        if rate == 0.0 || step == 0.0 {
            return Some(at_centre(velocity) / at_centre(of_model));
        }
        // ∫ sign(u)/(1 + (u/v)²) du = v atan(|u|/v), and the difference of two such values.
        let [before, after] = [rate - step / 2.0, rate + step / 2.0].map(|u| u.abs() / velocity);
        let mean = velocity * ((after - before) / (1.0 + after * before)).atan() / step;
        Some(mean / at_centre(of_model))
    }
}

/// The part of a rate that affects a friction column.
fn part(rate: f64, symbol: StandardParameter) -> f64 {
    use StandardParameter as P;
    match symbol {
        P::FvPos | P::FsPos => rate.max(0.0),
        P::FvNeg | P::FsNeg => (-rate).max(0.0),
        _ => rate.abs(),
    }
}

/// Motion and regressor on random states, to recognise the rate u of a friction parameter.
///
/// The power of friction is vᵀ W_fv = u², vᵀ W_fs = |u| and vᵀ W_fq = |u|³, or that of one direction.
struct FrictionPower {
    samples: usize,
    dof: usize,
    joints: usize,
    parameters: usize,
    twist: Vec<f64>,
    /// Regressors at these states, and at the same poses with a small fraction of the twist.
    regressors: [Vec<f64>; 2],
    velocities: Vec<f64>,
    /// The motion at each state's pose with the next state's twist, for load-dependent friction.
    other: Option<Box<FrictionPower>>,
}

impl FrictionPower {
    /// Evaluates the model on random states.
    fn new(model: &dyn Model, seed: u64) -> Result<Self, Error> {
        let sizes = model.info().sizes;
        let unknown = sizes.joints * (sizes.joints + 1) / 2;
        let friction = |one: &overact::Parameter| part(-1.0, one.symbol) != part(1.0, one.symbol);
        // Friction of one direction appears in half of the states.
        let times = 1 + usize::from(model.info().parameters.iter().any(friction));
        let states = random_states(model, times * (RECOGNITION_STATES + unknown), seed)?;
        let is_load = |one: &overact::Parameter| one.symbol == StandardParameter::Fl;
        let mut turned = states.twist.clone();
        turned.rotate_left(sizes.dof);
        let other = model
            .info()
            .parameters
            .iter()
            .any(is_load)
            .then_some(turned);
        let mut own = Self::at(model, &states, &states.twist)?;
        own.other = match other {
            Some(twist) => Some(Box::new(Self::at(model, &states, &twist)?)),
            None => None,
        };
        Ok(own)
    }

    /// Evaluates the model at the poses of some states, with these twists.
    fn at(model: &dyn Model, states: &States, twist: &[f64]) -> Result<Self, Error> {
        let sizes = model.info().sizes;
        let slow: Vec<f64> = twist.iter().map(|v| SLOW * v).collect();
        let ask = |function: Function, twist: &[f64]| -> Result<Vec<f64>, Error> {
            let inputs: [&[f64]; 3] = [&states.pose, twist, &states.acceleration];
            let (rows, columns) = function.shape(&sizes);
            let mut output = vec![0.0; states.samples * rows * columns];
            model
                .evaluate(function, &inputs[..function.inputs().len()], &mut output)
                .map_err(|error| Problem::new(Code::NO_EFFECT, error.to_string()))?;
            Ok(output)
        };
        let regressor = |twist: &[f64]| ask(Function::IdmRedPlatform(Columns::Standard), twist);
        Ok(Self {
            samples: states.samples,
            dof: sizes.dof,
            joints: sizes.joints,
            parameters: sizes.parameters,
            regressors: [regressor(twist)?, regressor(&slow)?],
            velocities: ask(Function::JointVelocities, twist)?,
            twist: twist.to_vec(),
            other: None,
        })
    }

    /// vᵀ W of a column at a state, at its speed or at a small fraction of it.
    fn power(&self, slow: bool, sample: usize, column: usize) -> f64 {
        let rows = sample * self.dof..(sample + 1) * self.dof;
        let regressor = &self.regressors[usize::from(slow)];
        rows.map(|row| self.twist[row] * regressor[row * self.parameters + column])
            .sum()
    }

    /// Rates of all joints at a state.
    fn joints(&self, sample: usize) -> &[f64] {
        &self.velocities[sample * self.joints..(sample + 1) * self.joints]
    }

    /// The part of u that affects a friction column, at a state.
    fn speed(&self, sample: usize, column: usize, symbol: StandardParameter) -> f64 {
        let power = self.power(true, sample, column).max(0.0);
        match symbol.effect() {
            Effect::Friction { exponent: 1 } => (power / SLOW).sqrt(),
            Effect::Friction { exponent: 2 } => (power / (SLOW * SLOW)).cbrt(),
            _ => power,
        }
    }

    /// Whether a friction column belongs to a rate.
    fn matches(&self, rate: &Rate, column: usize, symbol: StandardParameter) -> bool {
        (0..self.samples).all(|sample| {
            let expected = part(rate.of(self.joints(sample)), symbol);
            let difference = self.speed(sample, column, symbol) - expected;
            difference.abs() <= RECOGNITION_TOLERANCE * expected.max(1e-3)
        })
    }

    /// Whether a column of load-dependent friction belongs to a rate.
    fn matches_load(&self, rate: &Rate, column: usize) -> bool {
        let Some(other) = self.other.as_deref() else {
            return false;
        };
        (0..self.samples).all(|sample| {
            let [own, others] = [self, other].map(|all| {
                let speed = rate.of(all.joints(sample)).abs();
                [speed, all.power(true, sample, column)]
            });
            let (a, b) = (own[0] * others[1], own[1] * others[0]);
            (a - b).abs() <= RECOGNITION_TOLERANCE * a.abs().max(b.abs()).max(1e-3)
        })
    }

    /// Stribeck velocity v of a column: friction at speed u is 1/(1 + (u/v)²) of that at
    /// standstill.
    fn stribeck(&self, rate: &Rate, column: usize) -> Option<f64> {
        let velocity = |sample: usize| {
            let speed = rate.of(self.joints(sample)).abs();
            let fallen = speed / self.power(false, sample, column) - 1.0;
            (fallen > 1e-6).then(|| speed / fallen.sqrt())
        };
        let found = (0..self.samples).filter_map(velocity);
        found
            .reduce(f64::min)
            .filter(|velocity| velocity.is_normal())
    }

    /// Combination of joint rates of a friction column; its first factor is positive.
    fn combination(&self, column: usize, symbol: StandardParameter) -> Option<Rate> {
        let pairs: Vec<(usize, usize)> = (0..self.joints)
            .flat_map(|i| (i..self.joints).map(move |j| (i, j)))
            .collect();
        let products = DMatrix::from_fn(self.samples, pairs.len(), |sample, pair| {
            let (rates, (i, j)) = (self.joints(sample), pairs[pair]);
            rates[i] * rates[j] * if i == j { 1.0 } else { 2.0 }
        });
        let squares = DVector::from_fn(self.samples, |sample, _| {
            self.speed(sample, column, symbol).powi(2)
        });
        // States with friction of the other direction do not show the rate.
        let seen = (0..self.samples).filter(|&sample| squares[sample] > 0.0);
        let seen: Vec<usize> = seen.collect();
        let (products, squares) = (products.select_rows(&seen), squares.select_rows(&seen));
        let found = products.svd(true, true).solve(&squares, 1e-10).ok()?;
        let mut matrix = DMatrix::zeros(self.joints, self.joints);
        for (&(i, j), value) in pairs.iter().zip(found.iter()) {
            (matrix[(i, j)], matrix[(j, i)]) = (*value, *value);
        }
        let eigen = SymmetricEigen::new(matrix);
        let largest = eigen.eigenvalues.imax();
        let length = eigen.eigenvalues[largest].max(0.0).sqrt();
        let factors = eigen.eigenvectors.column(largest) * length;
        let significant = |factor: &f64| factor.abs() > NEGLIGIBLE * factors.amax();
        let sign = factors.iter().copied().find(significant)?.signum();
        let all = factors
            .iter()
            .enumerate()
            .filter(|(_, factor)| significant(factor));
        let rate = Rate::new(all.map(|(joint, factor)| (joint, sign * factor)).collect());
        let mut both = [rate.clone(), rate.reversed()].into_iter();
        both.find(|rate| self.matches(rate, column, symbol))
    }
}

/// Rate of each friction parameter of the robot; `None` for other parameters.
///
/// Joints that always have equal rates (a parallelogram) are distinguished by their order.
pub(super) fn friction_rates(model: &dyn Model, seed: u64) -> Result<Vec<Option<Rate>>, Error> {
    let info = model.info();
    let friction = FrictionPower::new(model, seed)?;
    let mut problems = Vec::new();
    let mut taken: Vec<(StandardParameter, usize)> = Vec::new();
    let mut found: Vec<Option<Rate>> = vec![None; info.parameters.len()];
    for (column, parameter) in info.parameters.iter().enumerate() {
        let symbol = parameter.symbol;
        if !symbol.is_friction() {
            continue;
        }
        let own = |joint: usize| Rate::new(vec![(joint, 1.0)]);
        let under_load = symbol == StandardParameter::Fl;
        let joint = (0..info.sizes.joints)
            .filter(|joint| !taken.contains(&(symbol, *joint)))
            .find(|joint| {
                if under_load {
                    friction.matches_load(&own(*joint), column)
                } else {
                    friction.matches(&own(*joint), column, symbol)
                }
            });
        taken.extend(joint.map(|joint| (symbol, joint)));
        // The rate of a coupled joint follows from its friction without load.
        let same_joint = || {
            let before = info.parameters.iter().zip(&found);
            let mut rates = before.filter(|(one, _)| one.body == parameter.body);
            let rate = Rate::new(rates.find_map(|(_, rate)| rate.clone())?.joints);
            friction.matches_load(&rate, column).then_some(rate)
        };
        let rate = match joint {
            Some(joint) => Some(own(joint)),
            None if under_load => same_joint(),
            None => friction.combination(column, symbol),
        };
        found[column] = rate;
        if let (Some(rate), StandardParameter::Fst) = (&mut found[column], symbol) {
            rate.stribeck = friction.stribeck(rate, column);
        }
        if found[column].is_none() {
            let message = format!(
                "no combination of joints has the motion that the friction `{}` needs",
                parameter.name
            );
            let help =
                "choose symmetric friction, sampled reversals and no dead band for this robot";
            problems.push(
                Problem::new(Code::SETTINGS, message)
                    .column(parameter.name)
                    .help(help),
            );
        }
    }
    Error::check(problems)?;
    Ok(found)
}

/// Stribeck velocities of the model by parameter (rad/s or m/s).
///
/// # Errors
/// A friction parameter whose rate cannot be recognised.
pub(crate) fn stribeck_velocities(
    model: &dyn Model,
    seed: u64,
) -> Result<Vec<(&'static str, f64)>, Error> {
    let rates = friction_rates(model, seed)?;
    let parameters = model.info().parameters.iter().zip(rates);
    let velocity = |(parameter, rate): (&overact::Parameter, Option<Rate>)| {
        Some((parameter.name, rate?.stribeck?))
    };
    Ok(parameters.filter_map(velocity).collect())
}
