//! The columns of the identification model: standard parameters, the payload's, and friction split
//! by the direction of motion.
//!
//! With asymmetric friction the columns fv, fs and off of a joint become fv_pos, fs_pos, fv_neg and
//! fs_neg: the columns fv and fs where the joint's velocity is positive or negative, zero
//! elsewhere. The offset is (fs_pos - fs_neg)/2 then and has no column of its own.
//!
//! Around standstill the sign of a measured velocity is noise. Within a dead band the columns fs can
//! be zero.

use overact::{Body, Function, Model, Parameter, SampleError, Symbol};

use crate::{
    error::{Error, Problem},
    states::random_states,
};

/// States from which the joint of a friction parameter is recognised.
const RECOGNITION_STATES: usize = 12;

/// Relative tolerance of that recognition.
const RECOGNITION_TOLERANCE: f64 = 1e-6;

/// Where the numbers of a column come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    /// A column of [`Function::IdmRedPlatform`].
    Robot(usize),
    /// A column of [`Function::IdmRedPayload`].
    Payload(usize),
}

/// The direction of motion in which a friction parameter acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Direction {
    /// Where the joint's velocity is positive.
    Positive,
    /// Where the joint's velocity is negative.
    Negative,
}

/// One column of the identification model.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name of its parameter.
    pub name: String,
    /// Name of the standard parameter that it comes from.
    pub standard: String,
    /// SI unit of the parameter.
    pub unit: &'static str,
    /// Which standard parameter it is.
    pub symbol: Symbol,
    /// Where its body is.
    pub body: Body,
    /// The joint, and the direction of its motion, to which a friction parameter is confined.
    pub direction: Option<(usize, Direction)>,
    /// The joint of a Coulomb parameter and the speed below which its column is zero.
    dead_band: Option<(usize, f64)>,
    source: Source,
}

impl Column {
    /// The whole column of a standard parameter.
    fn new(parameter: &Parameter, source: Source) -> Self {
        Self {
            name: parameter.name.to_owned(),
            standard: parameter.name.to_owned(),
            unit: parameter.unit,
            symbol: parameter.symbol,
            body: parameter.body,
            direction: None,
            dead_band: None,
            source,
        }
    }

    /// The joint on whose velocity it depends whether the column is zero.
    fn joint(&self) -> Option<usize> {
        let split = self.direction.map(|(joint, _)| joint);
        split.or(self.dead_band.map(|(joint, _)| joint))
    }

    /// Whether the column is not zero at a velocity of its joint.
    fn acts(&self, velocity: f64) -> bool {
        let moves = self
            .dead_band
            .is_none_or(|(_, band)| velocity.abs() >= band);
        moves
            && match self.direction {
                None => true,
                Some((_, Direction::Positive)) => velocity > 0.0,
                Some((_, Direction::Negative)) => velocity < 0.0,
            }
    }

    /// The column of a friction parameter split by the direction of its joint.
    fn split(self, joint: usize) -> [Self; 2] {
        let symbol = self.symbol.name();
        [(Direction::Positive, "pos"), (Direction::Negative, "neg")].map(|(direction, suffix)| {
            let rest = self.standard.strip_prefix(symbol).unwrap_or(&self.standard);
            Self {
                name: format!("{symbol}_{suffix}{rest}"),
                direction: Some((joint, direction)),
                ..self.clone()
            }
        })
    }
}

/// The columns of an identification, in the order of the model: the robot's, then the payload's.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnSet {
    columns: Vec<Column>,
}

impl ColumnSet {
    /// The columns of a model, with those of the payload when a run carries it, and with
    /// friction split by direction on request.
    ///
    /// # Errors
    /// A friction parameter whose joint can't be recognised.
    pub fn new(
        model: &dyn Model,
        payload: bool,
        asymmetric_friction: bool,
        seed: u64,
    ) -> Result<Self, Error> {
        let info = model.info();
        let joints = if asymmetric_friction {
            friction_joints(model, seed)?
        } else {
            vec![None; info.parameters.len()]
        };
        let has_fs = |body: Body| {
            info.parameters
                .iter()
                .any(|p| p.symbol == Symbol::Fs && p.body == body)
        };
        let mut columns = Vec::new();
        for (index, (parameter, joint)) in info.parameters.iter().zip(joints).enumerate() {
            let whole = Column::new(parameter, Source::Robot(index));
            match joint {
                Some(joint) => columns.extend(whole.split(joint)),
                None if asymmetric_friction
                    && parameter.symbol == Symbol::Off
                    && has_fs(parameter.body) => {}
                None => columns.push(whole),
            }
        }
        if payload {
            let parameters = info.payload_parameters.iter().enumerate();
            columns.extend(parameters.map(|(k, p)| Column::new(p, Source::Payload(k))));
        }
        Ok(Self { columns })
    }

    /// The same columns, those of Coulomb friction being zero where the speed of their joint is below
    /// `band` (rad/s or m/s).
    ///
    /// # Errors
    /// A friction parameter whose joint can't be recognised.
    pub fn with_dead_band(
        mut self,
        model: &dyn Model,
        band: f64,
        seed: u64,
    ) -> Result<Self, Error> {
        if band > 0.0 {
            let joints = friction_joints(model, seed)?;
            for column in &mut self.columns {
                if let (Source::Robot(index), Symbol::Fs) = (column.source, column.symbol) {
                    column.dead_band = joints[index].map(|joint| (joint, band));
                }
            }
        }
        Ok(self)
    }

    /// The columns.
    #[must_use]
    pub fn as_slice(&self) -> &[Column] {
        &self.columns
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
            .filter(|&index| matches!(self.columns[index].source, Source::Payload(_)) == payload)
            .collect()
    }

    /// Evaluates the columns `picked` in case 1: for each of the r lines, samples x (picked + `more`),
    /// row-major, with room for more columns behind. The payload's are zero in an unloaded run,
    /// eq. (49).
    ///
    /// # Errors
    /// The first sample at which the model has no value.
    pub fn evaluate(
        &self,
        model: &dyn Model,
        states: &[&[f64]; 3],
        samples: usize,
        loaded: bool,
        (picked, more): (&[usize], usize),
    ) -> Result<Vec<Vec<f64>>, SampleError> {
        let sizes = model.info().sizes;
        let ask = |function: Function, wanted: bool| -> Result<Vec<f64>, SampleError> {
            let (rows, columns) = function.shape(&sizes);
            let mut output = vec![0.0; if wanted { samples * rows * columns } else { 0 }];
            if !output.is_empty() {
                model.evaluate(function, states, &mut output)?;
            }
            Ok(output)
        };
        let columns = || picked.iter().filter_map(|&index| self.columns.get(index));
        let split = columns().any(|column| column.joint().is_some());
        let has_payload = columns().any(|column| matches!(column.source, Source::Payload(_)));
        let robot = ask(Function::IdmRedPlatform, true)?;
        let payload = ask(Function::IdmRedPayload, loaded && has_payload)?;
        let velocities = ask(Function::JointVelocities, split)?;
        let width = picked.len() + more;
        let mut lines = vec![vec![0.0; samples * width]; sizes.dof];
        // Where the numbers of a row come from: places of the robot's columns, then the payload's.
        let place = |wanted: fn(Source) -> Option<usize>| -> Vec<(usize, usize)> {
            let all = columns().enumerate();
            all.filter_map(|(to, column)| Some((to, wanted(column.source)?)))
                .collect()
        };
        let own = place(|source| match source {
            Source::Robot(k) => Some(k),
            Source::Payload(_) => None,
        });
        let load = place(|source| match source {
            Source::Payload(k) => Some(k),
            Source::Robot(_) => None,
        });
        let sources = [
            (&robot, sizes.parameters, own),
            (&payload, sizes.payload_parameters, load),
        ];
        for (values, count, places) in &sources {
            if values.is_empty() {
                continue;
            }
            for (row, from) in values.chunks_exact(*count).enumerate() {
                let start = row / sizes.dof * width;
                let to = &mut lines[row % sizes.dof][start..start + width];
                for &(place, index) in places {
                    to[place] = from[index];
                }
            }
        }
        for (place, column) in columns().enumerate() {
            let Some(joint) = column.joint() else {
                continue;
            };
            let rates = velocities[joint..].iter().step_by(sizes.joints);
            for (sample, _) in rates.enumerate().filter(|(_, rate)| !column.acts(**rate)) {
                lines
                    .iter_mut()
                    .for_each(|rows| rows[sample * width + place] = 0.0);
            }
        }
        Ok(lines)
    }
}

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
                .evaluate(function, &inputs, &mut output)
                .map_err(|error| Problem::new(error.to_string()))?;
            Ok(output)
        };
        Ok(Self {
            samples: states.samples,
            dof: sizes.dof,
            joints: sizes.joints,
            parameters: sizes.parameters,
            regressor: ask(Function::IdmRedPlatform)?,
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
    fn matches(&self, joint: usize, column: usize, symbol: Symbol) -> bool {
        (0..self.samples).all(|sample| {
            let velocity = self.velocities[sample * self.joints + joint].abs();
            let expected = match symbol {
                Symbol::Fv => velocity * velocity,
                _ => velocity,
            };
            let difference = self.power(sample, column) - expected;
            difference.abs() <= RECOGNITION_TOLERANCE * expected.max(1e-3)
        })
    }
}

/// For each robot parameter, the joint of a friction parameter fv or fs, or `None`. Joints that
/// always move alike (a parallelogram) are told apart by their order.
fn friction_joints(model: &dyn Model, seed: u64) -> Result<Vec<Option<usize>>, Error> {
    let info = model.info();
    let friction = FrictionPower::new(model, seed)?;
    let mut problems = Vec::new();
    let mut taken: Vec<(Symbol, usize)> = Vec::new();
    let mut found = vec![None; info.parameters.len()];
    for (column, parameter) in info.parameters.iter().enumerate() {
        let symbol = parameter.symbol;
        if !matches!(symbol, Symbol::Fv | Symbol::Fs) {
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
                .help("turn asymmetric friction off for this robot"),
            ),
        }
    }
    Error::check(problems)?;
    Ok(found)
}
