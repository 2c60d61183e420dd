//! At which rate the coordinate of a friction parameter moves, found out by the power that its column takes.
//!
//! A joint of its own has its own rate. One that follows others, and a motor that turns several joints, has
//! a constant combination of their rates, c·q̇. The power of its friction gives (c·q̇)² = q̇ᵀ (c cᵀ) q̇ at every
//! state, which is linear in the matrix c cᵀ; c is its only eigenvector whose eigenvalue isn't zero.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use overact::{Columns, Function, Model, StandardParameter};

use super::states::random_states;
use crate::error::{Error, Problem};

/// States from which the rate of a friction parameter is recognised, beyond those that a combination of
/// joints needs.
const RECOGNITION_STATES: usize = 12;

/// Relative tolerance of that recognition.
const RECOGNITION_TOLERANCE: f64 = 1e-6;

/// Factors of joints in a combination below this part of the largest one are rounding.
const NEGLIGIBLE: f64 = 1e-7;

/// A rate as a constant combination of joint rates: joints with their factors.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rate(Vec<(usize, f64)>);

impl Rate {
    /// Its value where all joints have these rates, or accelerations.
    pub(crate) fn of(&self, joints: &[f64]) -> f64 {
        let terms = self.0.iter();
        terms.map(|(joint, factor)| factor * joints[*joint]).sum()
    }
}

/// Motion and regressor on random states, by which the rate u of a friction parameter is recognised: the
/// power of friction is vᵀ W_fv = u² and vᵀ W_fs = |u|.
struct FrictionPower {
    samples: usize,
    dof: usize,
    joints: usize,
    parameters: usize,
    twist: Vec<f64>,
    regressor: Vec<f64>,
    velocities: Vec<f64>,
}

impl FrictionPower {
    /// Evaluates the model on random states.
    fn new(model: &dyn Model, seed: u64) -> Result<Self, Error> {
        let sizes = model.info().sizes;
        let unknown = sizes.joints * (sizes.joints + 1) / 2;
        let states = random_states(model, RECOGNITION_STATES + unknown, seed)?;
        let inputs: [&[f64]; 3] = [&states.pose, &states.twist, &states.acceleration];
        let ask = |function: Function| -> Result<Vec<f64>, Error> {
            let (rows, columns) = function.shape(&sizes);
            let mut output = vec![0.0; states.samples * rows * columns];
            model
                .evaluate(function, &inputs[..function.inputs().len()], &mut output)
                .map_err(|error| Problem::new(error.to_string()))?;
            Ok(output)
        };
        Ok(Self {
            samples: states.samples,
            dof: sizes.dof,
            joints: sizes.joints,
            parameters: sizes.parameters,
            regressor: ask(Function::IdmRedPlatform(Columns::Standard))?,
            velocities: ask(Function::JointVelocities)?,
            twist: states.twist,
        })
    }

    /// vᵀ W of a column at a state.
    fn power(&self, sample: usize, column: usize) -> f64 {
        let rows = sample * self.dof..(sample + 1) * self.dof;
        rows.map(|row| self.twist[row] * self.regressor[row * self.parameters + column])
            .sum()
    }

    /// The rates of all joints at a state.
    fn joints(&self, sample: usize) -> &[f64] {
        &self.velocities[sample * self.joints..(sample + 1) * self.joints]
    }

    /// |u| of a friction column at a state.
    fn speed(&self, sample: usize, column: usize, symbol: StandardParameter) -> f64 {
        let power = self.power(sample, column).max(0.0);
        match symbol {
            StandardParameter::Fv => power.sqrt(),
            _ => power,
        }
    }

    /// Whether a friction column is that of a rate.
    fn matches(&self, rate: &Rate, column: usize, symbol: StandardParameter) -> bool {
        (0..self.samples).all(|sample| {
            let expected = rate.of(self.joints(sample)).abs();
            let difference = self.speed(sample, column, symbol) - expected;
            difference.abs() <= RECOGNITION_TOLERANCE * expected.max(1e-3)
        })
    }

    /// The combination of joint rates that a friction column is about; its first factor is positive.
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
        let rate = Rate(all.map(|(joint, factor)| (joint, sign * factor)).collect());
        self.matches(&rate, column, symbol).then_some(rate)
    }
}

/// For each robot parameter, the rate of a friction parameter fv or fs, or `None`. Joints that always move
/// alike (a parallelogram) are told apart by their order.
pub(super) fn friction_rates(model: &dyn Model, seed: u64) -> Result<Vec<Option<Rate>>, Error> {
    let info = model.info();
    let friction = FrictionPower::new(model, seed)?;
    let mut problems = Vec::new();
    let mut taken: Vec<(StandardParameter, usize)> = Vec::new();
    let mut found = vec![None; info.parameters.len()];
    for (column, parameter) in info.parameters.iter().enumerate() {
        let symbol = parameter.symbol;
        if !matches!(symbol, StandardParameter::Fv | StandardParameter::Fs) {
            continue;
        }
        let own = |joint: usize| Rate(vec![(joint, 1.0)]);
        let joint = (0..info.sizes.joints)
            .filter(|joint| !taken.contains(&(symbol, *joint)))
            .find(|joint| friction.matches(&own(*joint), column, symbol));
        taken.extend(joint.map(|joint| (symbol, joint)));
        found[column] = match joint {
            Some(joint) => Some(own(joint)),
            None => friction.combination(column, symbol),
        };
        if found[column].is_none() {
            let message = format!(
                "no combination of joints moves as the friction `{}` asks for",
                parameter.name
            );
            let help =
                "choose symmetric friction, sampled reversals and no dead band for this robot";
            problems.push(Problem::new(message).column(parameter.name).help(help));
        }
    }
    Error::check(problems)?;
    Ok(found)
}
