//! Fault hypotheses and their columns.

use std::ops::Range;

use overact::Model;

use super::misreading::Misreading;
use super::potential::FirstJoints;
use super::shapes::{ActuatorState, PositionRange, SHAPES, Shape, WAVES};
use crate::{
    filters::SampledSignals,
    kinematics::{Motion, conditioning::couples},
    regression::{columns::Reversal, projection::ModelKind},
};

/// A fault with one unknown size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FaultHypothesis {
    /// All torques are delayed by this time (s).
    Delay,
    /// The torques are smoother than the motion, with s = ½ Σ w t² of a symmetric filter w(t) (s²).
    ///
    /// Finds the fault: the column leaves out dry friction.
    Smoothing,
    /// The same with the effect on dry friction, to compute the harm.
    SmoothingWithFriction,
    /// Dry friction is smoother than the signs of the velocities, by s (s²).
    FrictionSmoothing,
    /// All signals are smoothed by s (s²).
    ///
    /// Only terms that are nonlinear in the motion change, such as dry friction.
    CommonFilter,
    /// The torque of one actuator is delayed by this time (s).
    DriveDelay(usize),
    /// Relative error of the measured torque of one actuator.
    Gain(usize),
    /// Relative error of the sampling frequency.
    Clock,
    /// Encoder offset of one actuator (rad, m).
    Offset(usize),
    /// Position error proportional to the sine or cosine of the position: eccentricity.
    Eccentric(usize, Misreading),
    /// Relative error of the position of one actuator.
    Scale(usize),
    /// Relative error of a gear ratio: positions too large and torques too small by the same part.
    Gear(usize),
    /// Common relative error of all positions.
    Scales,
    /// Position lag by half of a play (rad, m).
    Play(usize),
    /// Error of a described length (m).
    Length(usize),
    /// Torque of an actuator that the model lacks.
    Torque(usize, Shape),
    /// Force on a platform coordinate that the model lacks.
    Force(usize, Shape),
    /// Fraction of the torque of a neighbouring drive in the measured torque of a drive.
    Crosstalk {
        /// Drive with the wrong torque.
        to: usize,
        /// Its neighbour.
        from: usize,
    },
    /// Constant forces and weights on bodies of a tree, as far as the first joints feel them.
    Potential(FirstJoints),
    /// One product of these potentials, which few data can test alone.
    PotentialTerm(usize),
    /// Torques of this shape at all actuators, each of its own size.
    AllTorques(Shape),
    /// Crosstalk between all neighbours, each of its own size.
    AllCrosstalk,
}

impl FaultHypothesis {
    /// Shape of a torque or force that the model may lack; `None` for other faults.
    pub(crate) const fn shape(self) -> Option<Shape> {
        match self {
            Self::Torque(_, shape) | Self::Force(_, shape) | Self::AllTorques(shape) => Some(shape),
            _ => None,
        }
    }

    /// Whether it is crosstalk between drives.
    pub(crate) const fn is_crosstalk(self) -> bool {
        matches!(self, Self::Crosstalk { .. } | Self::AllCrosstalk)
    }

    /// Whether it is a torque or force that the model may lack.
    pub(crate) const fn is_missing_effect(self) -> bool {
        self.shape().is_some() || self.is_crosstalk() || self.is_potential()
    }

    /// Whether it is a potential of the first joints, or one of its products.
    pub(crate) const fn is_potential(self) -> bool {
        matches!(self, Self::Potential(_) | Self::PotentialTerm(_))
    }

    /// Whether it is one of several faults that this one joins, with a size for each.
    pub(crate) fn is_joined_by(self, all: Self) -> bool {
        match (all, self) {
            (Self::AllTorques(shape), Self::Torque(_, own)) => shape == own,
            (Self::AllCrosstalk, Self::Crosstalk { .. }) => true,
            _ => false,
        }
    }

    /// Number of columns of its own; several faults together, and parts of one, have none.
    pub(super) const fn width(self) -> usize {
        match self {
            Self::Torque(_, Shape::Waves | Shape::LoadWaves) => WAVES,
            Self::Potential(joints) => joints.products(),
            Self::PotentialTerm(_) | Self::AllTorques(_) | Self::AllCrosstalk => 0,
            _ => 1,
        }
    }
}

/// Column indices of base parameters, fault hypotheses and payload parameters.
///
/// Hypotheses with one column come first, then those with several, then those with none of their own.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    /// Number of base parameter columns, including friction rates.
    pub(super) base: usize,
    /// Number of decimated columns: base parameters, one-column hypotheses, payload.
    pub(super) decimated: usize,
    /// Columns of each hypothesis, then of the payload.
    pub(super) blocks: Vec<Vec<usize>>,
    /// For each block, the range of its products among the products of all blocks.
    pub(super) places: Vec<Range<usize>>,
    /// Number of these products.
    pub(super) squares: usize,
    /// Number of all columns.
    pub(super) columns: usize,
}

impl Layout {
    pub(super) fn new(base: usize, hypotheses: &[FaultHypothesis], payload: usize) -> Self {
        let narrow = hypotheses.iter().filter(|one| one.width() == 1).count();
        let decimated = base + narrow + payload;
        let (mut next, mut wide) = (base, decimated);
        let place = |hypothesis: &FaultHypothesis| {
            let width = hypothesis.width();
            let at = if width == 1 { &mut next } else { &mut wide };
            *at += width;
            (*at - width..*at).collect()
        };
        let mut blocks: Vec<Vec<usize>> = hypotheses.iter().map(place).collect();
        for (number, all) in hypotheses.iter().enumerate() {
            let joined = hypotheses.iter().zip(&blocks);
            let joined = joined.filter(|(one, _)| one.is_joined_by(*all));
            let joined: Vec<usize> = joined.flat_map(|(_, block)| block.clone()).collect();
            blocks[number].extend(joined);
        }
        let is_whole = |one: &FaultHypothesis| matches!(one, FaultHypothesis::Potential(_));
        let whole = hypotheses.iter().position(is_whole);
        let products = whole.map_or_else(Vec::new, |whole| blocks[whole].clone());
        for (number, one) in hypotheses.iter().enumerate() {
            if let FaultHypothesis::PotentialTerm(product) = *one {
                blocks[number].push(products[product]);
            }
        }
        blocks.push((base + narrow..decimated).collect());
        let mut squares = 0;
        let place = |block: &Vec<usize>| {
            squares += block.len().pow(2);
            squares - block.len().pow(2)..squares
        };
        let places = blocks.iter().map(place).collect();
        Self {
            base,
            decimated,
            places,
            squares,
            blocks,
            columns: wide,
        }
    }
}

/// The fault hypotheses of a robot for the model `kind`, with this number of `lengths`.
///
/// Waves come after those with one column, several faults together last.
pub(crate) fn fault_hypotheses(
    model: &dyn Model,
    lengths: usize,
    kind: ModelKind,
) -> Vec<FaultHypothesis> {
    let info = model.info();
    let sizes = info.sizes;
    let mut all = vec![
        FaultHypothesis::Delay,
        FaultHypothesis::Smoothing,
        FaultHypothesis::SmoothingWithFriction,
        FaultHypothesis::FrictionSmoothing,
        FaultHypothesis::CommonFilter,
        FaultHypothesis::Clock,
    ];
    // With a single drive, this equals the delay of all torques.
    if sizes.actuators > 1 {
        all.extend((0..sizes.actuators).map(FaultHypothesis::DriveDelay));
    }
    all.extend((0..sizes.actuators).map(FaultHypothesis::Gain));
    // With n > r, the closure determines these errors better.
    if sizes.actuators == sizes.dof {
        all.extend((0..sizes.actuators).map(FaultHypothesis::Offset));
        all.extend((0..sizes.actuators).map(FaultHypothesis::Scale));
        all.extend((0..sizes.actuators).map(FaultHypothesis::Gear));
        if sizes.actuators > 1 {
            all.push(FaultHypothesis::Scales);
        }
        all.extend((0..sizes.actuators).map(FaultHypothesis::Play));
        let revolute =
            (0..sizes.actuators).filter(|&i| info.actuator_is_revolute.get(i) == Some(&true));
        all.extend(revolute.flat_map(|i| {
            [Misreading::Sine, Misreading::Cosine].map(|error| FaultHypothesis::Eccentric(i, error))
        }));
    }
    all.extend((0..lengths).map(FaultHypothesis::Length));
    for actuator in 0..sizes.actuators {
        // A sine suits an unwrapped angle, where a spring does not; neither suits a length.
        let revolute = info.actuator_is_revolute.get(actuator) == Some(&true);
        let shapes = SHAPES
            .into_iter()
            .filter(|shape| revolute || !matches!(shape, Shape::Cosine | Shape::Sine));
        all.extend(shapes.map(|shape| FaultHypothesis::Torque(actuator, shape)));
    }
    if kind == ModelKind::Platform || couples(model) {
        for line in 0..sizes.dof {
            all.push(FaultHypothesis::Force(line, Shape::Constant));
            if sizes.pose == sizes.dof {
                all.push(FaultHypothesis::Force(line, Shape::Position));
            }
        }
    }
    all.extend(crosstalk(sizes.actuators));
    let first_joints = FirstJoints::new(model);
    all.extend(first_joints.map(FaultHypothesis::Potential));
    for shape in [Shape::Waves, Shape::LoadWaves] {
        all.extend((0..sizes.actuators).map(|i| FaultHypothesis::Torque(i, shape)));
    }
    if sizes.actuators > 1 {
        let is_of_all = |shape: &Shape| {
            let own = |i: usize| all.contains(&FaultHypothesis::Torque(i, *shape));
            (0..sizes.actuators).all(own)
        };
        let shapes: Vec<Shape> = SHAPES.into_iter().filter(is_of_all).collect();
        all.extend(shapes.into_iter().map(FaultHypothesis::AllTorques));
        all.push(FaultHypothesis::AllCrosstalk);
    }
    let products = first_joints.map_or(0, FirstJoints::products);
    all.extend((0..products).map(FaultHypothesis::PotentialTerm));
    all
}

/// The hypotheses that the gears of some drives have load-dependent friction.
///
/// The last one joins all; constant torques are the columns from which others are made.
pub(crate) fn gear_hypotheses(actuators: usize, gears: &[usize]) -> Vec<FaultHypothesis> {
    let of_each = (0..actuators).flat_map(|i| {
        let own = gears.contains(&i).then_some(Shape::Load);
        let shapes = [Some(Shape::Constant), own];
        shapes
            .into_iter()
            .flatten()
            .map(move |shape| FaultHypothesis::Torque(i, shape))
    });
    of_each
        .chain([FaultHypothesis::AllTorques(Shape::Load)])
        .collect()
}

/// Crosstalk between drives that follow each other, in both directions.
fn crosstalk(actuators: usize) -> impl Iterator<Item = FaultHypothesis> {
    (1..actuators).flat_map(|i| {
        [(i - 1, i), (i, i - 1)].map(|(to, from)| FaultHypothesis::Crosstalk { to, from })
    })
}

/// Data of one sample for the columns of the hypotheses.
pub(super) struct Sample<'a> {
    /// J_p^inv, n × r.
    pub(super) jacobian: &'a [f64],
    /// Torques without the residual, and their derivatives.
    pub(super) torques: &'a [f64],
    pub(super) torque_rates: &'a [f64],
    /// Second derivatives of the torques without residual and dry friction.
    pub(super) torque_bends: &'a [f64],
    /// Second derivatives of the torques without the residual.
    pub(super) torque_turns: &'a [f64],
    /// Motion of the actuators.
    pub(super) actuators: &'a [ActuatorState],
    /// Position ranges and largest speeds of the actuators.
    pub(super) position_ranges: &'a [PositionRange],
    /// Pose.
    pub(super) pose: &'a [f64],
    /// Derivative of the residual with respect to the clock, r entries; empty if not requested.
    pub(super) clock: &'a [f64],
    /// Derivative of the residual with respect to a smoothing of all signals, r entries.
    ///
    /// Then follow the derivatives with respect to position errors, n × errors × r, and to lengths.
    pub(super) common_filter: &'a [f64],
    pub(super) misread: &'a [f64],
    pub(super) lengths: &'a [f64],
}

impl Sample<'_> {
    /// Factor that the entries of a hypothesis have in common in all lines of Γ¹.
    pub(super) fn factor(&self, hypothesis: FaultHypothesis) -> f64 {
        let shaped =
            |i: usize, shape: Shape| shape.value(self.actuators[i], self.position_ranges[i]);
        match hypothesis {
            FaultHypothesis::Play(i) => shaped(i, Shape::Sign),
            FaultHypothesis::Torque(i, shape) => shaped(i, shape),
            FaultHypothesis::Force(own, shape) => {
                let here = ActuatorState {
                    position: self.pose.get(own).copied().unwrap_or(0.0),
                    ..ActuatorState::default()
                };
                shape.value(here, PositionRange::default())
            }
            _ => 1.0,
        }
    }

    /// Entries of one-column hypotheses in a line of Γ¹, from their factors.
    pub(super) fn entries(
        &self,
        hypotheses: &[FaultHypothesis],
        factors: &[f64],
        line: usize,
        entries: &mut [f64],
    ) {
        let r = self.jacobian.len() / self.torques.len();
        let of_one = |one: &FaultHypothesis, next: &FaultHypothesis| match (one, next) {
            (FaultHypothesis::Torque(i, _), FaultHypothesis::Torque(k, _)) => i == k,
            _ => false,
        };
        let mut first = 0;
        // Torque hypotheses of one actuator are adjacent.
        for group in hypotheses.chunk_by(of_one) {
            let places = first..first + group.len();
            first = places.end;
            let own = entries[places.clone()].iter_mut().zip(&factors[places]);
            match group {
                [FaultHypothesis::Torque(i, _), ..] => {
                    let share = self.jacobian[i * r + line];
                    own.for_each(|(entry, factor)| *entry = share * factor);
                }
                _ => own.zip(group).for_each(|((entry, factor), hypothesis)| {
                    *entry = self.entry(*hypothesis, *factor, line);
                }),
            }
        }
    }

    /// Entry of a hypothesis in a line of Γ¹, from its factor.
    fn entry(&self, hypothesis: FaultHypothesis, factor: f64, line: usize) -> f64 {
        let r = self.jacobian.len() / self.torques.len();
        let share = |actuator: usize| self.jacobian[actuator * r + line];
        let misread = |i: usize, error: Misreading| {
            let place = i * Misreading::ALL.len() + error as usize;
            self.misread[place * r + line]
        };
        match hypothesis {
            FaultHypothesis::Delay => {
                let rates = self.torque_rates.iter().enumerate();
                -rates.map(|(i, rate)| share(i) * rate).sum::<f64>()
            }
            FaultHypothesis::Smoothing | FaultHypothesis::SmoothingWithFriction => {
                let bends = match hypothesis {
                    FaultHypothesis::Smoothing => self.torque_bends,
                    _ => self.torque_turns,
                };
                let bends = bends.iter().enumerate();
                bends.map(|(i, bend)| share(i) * bend).sum::<f64>()
            }
            FaultHypothesis::FrictionSmoothing => {
                let both = self.torque_turns.iter().zip(self.torque_bends);
                let friction = both.enumerate().map(|(i, (all, rest))| (i, all - rest));
                friction.map(|(i, bend)| share(i) * bend).sum::<f64>()
            }
            FaultHypothesis::CommonFilter => self.common_filter[line],
            FaultHypothesis::DriveDelay(i) => -share(i) * self.torque_rates[i],
            FaultHypothesis::Gain(i) => share(i) * self.torques[i],
            FaultHypothesis::Clock => self.clock[line],
            FaultHypothesis::Offset(i) => misread(i, Misreading::Offset),
            FaultHypothesis::Eccentric(i, error) => misread(i, error),
            FaultHypothesis::Scale(i) => misread(i, Misreading::Scale),
            FaultHypothesis::Scales => {
                let all = 0..self.torques.len();
                all.map(|i| misread(i, Misreading::Scale)).sum::<f64>()
            }
            FaultHypothesis::Gear(i) => misread(i, Misreading::Scale) - share(i) * self.torques[i],
            FaultHypothesis::Play(i) => factor * misread(i, Misreading::Offset),
            FaultHypothesis::Length(length) => self.lengths[length * r + line],
            FaultHypothesis::Torque(i, _) => share(i) * factor,
            FaultHypothesis::Force(own, _) if own != line => 0.0,
            FaultHypothesis::Force(..) => factor,
            FaultHypothesis::Crosstalk { to, from } => share(to) * self.torques[from],
            // Their columns follow after decimation, or are those of the faults that they join.
            FaultHypothesis::Potential(_)
            | FaultHypothesis::PotentialTerm(_)
            | FaultHypothesis::AllTorques(_)
            | FaultHypothesis::AllCrosstalk => 0.0,
        }
    }
}

/// Signals of all actuators, samples × n.
pub(super) struct ActuatorSignals<'a> {
    pub(super) positions: &'a [f64],
    pub(super) velocities: &'a [f64],
    pub(super) accelerations: &'a [f64],
    pub(super) torques: &'a [f64],
}

impl ActuatorSignals<'_> {
    /// States of all actuators at all samples, samples × n.
    ///
    /// Velocity signs follow the dry friction columns.
    pub(super) fn states(&self, motion: &Motion, reversal: Reversal) -> Vec<ActuatorState> {
        let n = self.positions.len() / motion.samples.max(1);
        let state = |place: usize| {
            let (velocity, acceleration) = (self.velocities[place], self.accelerations[place]);
            let step = acceleration / motion.sampling_frequency;
            ActuatorState {
                position: self.positions[place],
                velocity,
                sign: reversal.sign(velocity, step).unwrap_or(0.0),
                acceleration,
                torque: self.torques[place],
                time: motion.time(place / n),
            }
        };
        (0..self.positions.len()).map(state).collect()
    }
}

/// Derivatives of `width` interleaved signals by central differences.
///
/// One-sided at both ends.
pub(super) fn rates(values: &[f64], width: usize, frequency: f64) -> Vec<f64> {
    let samples = values.len() / width.max(1);
    let signals = SampledSignals {
        values,
        width,
        start: 0,
        last: samples.saturating_sub(1),
    };
    let mut rates = signals.central_differences(0..samples, 1);
    rates.iter_mut().for_each(|rate| *rate *= frequency);
    rates
}
