//! Which joint a friction parameter belongs to, found out by the power that its column takes.

use overact::{Columns, Function, Model, StandardParameter};

use super::states::random_states;
use crate::error::{Error, Problem};

/// States from which the joint of a friction parameter is recognised.
const RECOGNITION_STATES: usize = 12;

/// Relative tolerance of that recognition.
const RECOGNITION_TOLERANCE: f64 = 1e-6;

/// Motion and regressor on random states, by which the joint of a friction parameter is recognised:
/// the power of friction is vᵀ W_fv = q̇_j² and vᵀ W_fs = |q̇_j|.
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
        let states = random_states(model, RECOGNITION_STATES, seed)?;
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

    /// Whether a friction column is that of a joint.
    fn matches(&self, joint: usize, column: usize, symbol: StandardParameter) -> bool {
        (0..self.samples).all(|sample| {
            let velocity = self.velocities[sample * self.joints + joint].abs();
            let expected = match symbol {
                StandardParameter::Fv => velocity * velocity,
                _ => velocity,
            };
            let difference = self.power(sample, column) - expected;
            difference.abs() <= RECOGNITION_TOLERANCE * expected.max(1e-3)
        })
    }
}

/// For each robot parameter, the joint of a friction parameter fv or fs, or `None`. Joints that
/// always move alike (a parallelogram) are told apart by their order.
pub(super) fn friction_joints(model: &dyn Model, seed: u64) -> Result<Vec<Option<usize>>, Error> {
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
        let joint = (0..info.sizes.joints)
            .filter(|joint| !taken.contains(&(symbol, *joint)))
            .find(|joint| friction.matches(*joint, column, symbol));
        match joint {
            Some(joint) => {
                taken.push((symbol, joint));
                found[column] = Some(joint);
            }
            None => problems.push(
                Problem::new(format!(
                    "no joint moves as the friction `{}` asks for",
                    parameter.name
                ))
                .column(parameter.name)
                .help(
                    "choose symmetric friction, sampled reversals and no dead band for this robot",
                ),
            ),
        }
    }
    Error::check(problems)?;
    Ok(found)
}
