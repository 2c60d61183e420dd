//! The suspects and their columns.

use std::ops::Range;

use overact::Model;

use super::misreading::Misreading;
use super::shapes::{Moment, Reach, SHAPES, Shape, WAVES};
use crate::{
    filters::central_differences,
    kinematics::Motion,
    regression::{columns::Reversal, projection::ModelKind},
};

/// A fault of one unknown size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Suspect {
    /// Torques are late by so many seconds.
    Delay,
    /// Torques are smoother than the motion by this time squared (s²): a symmetric filter of the weights w(t) has
    /// half of Σ w t². As it is told, without what it does to dry friction.
    Smoothing,
    /// The same with what it does to dry friction, which tells the harm.
    Rounding,
    /// Dry friction is smoother by this time squared (s²) than the signs of the velocities.
    Dulled,
    /// All signals are smoother than they were by this time squared (s²): what that does to dry friction, and to
    /// everything else that is not linear in the motion.
    Alike,
    /// The torque of one actuator is late by so many seconds.
    Late(usize),
    /// The measured torque of an actuator is too large by this part of itself.
    Gain(usize),
    /// The sampling frequency is too high by this part of itself.
    Clock,
    /// The position of an actuator is too large by this angle or length.
    Offset(usize),
    /// The position of an actuator is too large by this times its sine, or its cosine.
    Eccentric(usize, Misreading),
    /// The position of an actuator is too large by this part of itself.
    Scale(usize),
    /// The positions of all actuators are.
    Scales,
    /// The position of an actuator is behind by this half of a play.
    Play(usize),
    /// A length is too large by this.
    Length(usize),
    /// A torque of an actuator that the model lacks.
    Torque(usize, Shape),
    /// A force on a coordinate of the platform that the model lacks.
    Force(usize, Shape),
}

impl Suspect {
    /// How many columns it has.
    const fn width(self) -> usize {
        match self {
            Self::Torque(_, Shape::Waves) => WAVES,
            _ => 1,
        }
    }
}

/// Where the columns of base parameters, suspects and the payload's parameters stand beside each other:
/// first those of one column each, then waves.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    /// Base parameters.
    pub(super) base: usize,
    /// Columns that are decimated: base parameters, suspects of one column, payload.
    pub(super) decimated: usize,
    /// The columns of each suspect, then of the payload.
    pub(super) blocks: Vec<Range<usize>>,
    /// Where the products of a block's columns with each other stand among those of all blocks.
    pub(super) places: Vec<Range<usize>>,
    /// How many such products there are.
    pub(super) squares: usize,
    /// All columns.
    pub(super) columns: usize,
}

impl Layout {
    pub(super) fn new(base: usize, suspects: &[Suspect], payload: usize) -> Self {
        let narrow = suspects.iter().filter(|one| one.width() == 1).count();
        let decimated = base + narrow + payload;
        let (mut next, mut wide) = (base, decimated);
        let place = |suspect: &Suspect| {
            let width = suspect.width();
            let at = if width == 1 { &mut next } else { &mut wide };
            *at += width;
            *at - width..*at
        };
        let mut blocks: Vec<Range<usize>> = suspects.iter().map(place).collect();
        blocks.push(base + narrow..decimated);
        let mut squares = 0;
        let place = |block: &Range<usize>| {
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

/// The suspects of a robot whose estimate explains the inputs of a model, and of which so many lengths are
/// asked for; waves come last.
pub(super) fn suspects(model: &dyn Model, lengths: usize, kind: ModelKind) -> Vec<Suspect> {
    let info = model.info();
    let sizes = info.sizes;
    let mut all = vec![
        Suspect::Delay,
        Suspect::Smoothing,
        Suspect::Rounding,
        Suspect::Dulled,
        Suspect::Alike,
        Suspect::Clock,
    ];
    // Of one drive alone that is the delay of all.
    if sizes.actuators > 1 {
        all.extend((0..sizes.actuators).map(Suspect::Late));
    }
    all.extend((0..sizes.actuators).map(Suspect::Gain));
    // With more actuators than degrees of freedom the closure tells.
    if sizes.actuators == sizes.dof {
        all.extend((0..sizes.actuators).map(Suspect::Offset));
        all.extend((0..sizes.actuators).map(Suspect::Scale));
        if sizes.actuators > 1 {
            all.push(Suspect::Scales);
        }
        all.extend((0..sizes.actuators).map(Suspect::Play));
        let revolute =
            (0..sizes.actuators).filter(|&i| info.actuator_is_revolute.get(i) == Some(&true));
        all.extend(revolute.flat_map(|i| {
            [Misreading::Sine, Misreading::Cosine].map(|error| Suspect::Eccentric(i, error))
        }));
    }
    all.extend((0..lengths).map(Suspect::Length));
    for actuator in 0..sizes.actuators {
        // An angle that is unwound has no place among springs, but its sine has; a length has neither.
        let revolute = info.actuator_is_revolute.get(actuator) == Some(&true);
        let shapes = SHAPES
            .into_iter()
            .filter(|shape| revolute || !matches!(shape, Shape::Cosine | Shape::Sine));
        all.extend(shapes.map(|shape| Suspect::Torque(actuator, shape)));
    }
    if kind == ModelKind::Platform {
        for line in 0..sizes.dof {
            all.push(Suspect::Force(line, Shape::Constant));
            if sizes.pose == sizes.dof {
                all.push(Suspect::Force(line, Shape::Position));
            }
        }
    }
    all.extend((0..sizes.actuators).map(|i| Suspect::Torque(i, Shape::Waves)));
    all
}

/// What the columns of a sample are made of.
pub(super) struct Sample<'a> {
    /// J_p^inv, n x r.
    pub(super) jacobian: &'a [f64],
    /// Torques freed of the residual, and their derivatives.
    pub(super) torques: &'a [f64],
    pub(super) torque_rates: &'a [f64],
    /// Second derivatives of torques that are freed of dry friction, too.
    pub(super) torque_bends: &'a [f64],
    /// Those of the torques as they are.
    pub(super) torque_turns: &'a [f64],
    /// The motion of the actuators.
    pub(super) actuators: &'a [Moment],
    /// Where they move.
    pub(super) reaches: &'a [Reach],
    /// The pose.
    pub(super) pose: &'a [f64],
    /// By how much Γ¹ would change with the clock, with each error of the position of each actuator, n x errors x
    /// r, and with each length; empty where that is not asked for.
    pub(super) clock: &'a [f64],
    /// By how much the residual would change with a smoothing of all signals.
    pub(super) alike: &'a [f64],
    pub(super) misread: &'a [f64],
    pub(super) lengths: &'a [f64],
}

impl Sample<'_> {
    /// What the entries of a suspect's column have in common in all lines of Γ¹.
    pub(super) fn factor(&self, suspect: Suspect) -> f64 {
        let shaped = |i: usize, shape: Shape| shape.value(self.actuators[i], self.reaches[i]);
        match suspect {
            Suspect::Play(i) => shaped(i, Shape::Sign),
            Suspect::Torque(i, shape) => shaped(i, shape),
            Suspect::Force(own, shape) => {
                let here = Moment {
                    position: self.pose.get(own).copied().unwrap_or(0.0),
                    ..Moment::default()
                };
                shape.value(here, Reach::default())
            }
            _ => 1.0,
        }
    }

    /// The entries of suspects' columns of one column each in a line of Γ¹, of their factors.
    pub(super) fn entries(
        &self,
        suspects: &[Suspect],
        factors: &[f64],
        line: usize,
        entries: &mut [f64],
    ) {
        let r = self.jacobian.len() / self.torques.len();
        let of_one = |one: &Suspect, next: &Suspect| match (one, next) {
            (Suspect::Torque(i, _), Suspect::Torque(k, _)) => i == k,
            _ => false,
        };
        let mut first = 0;
        // Torques of one actuator stand together.
        for group in suspects.chunk_by(of_one) {
            let places = first..first + group.len();
            first = places.end;
            let own = entries[places.clone()].iter_mut().zip(&factors[places]);
            match group {
                [Suspect::Torque(i, _), ..] => {
                    let share = self.jacobian[i * r + line];
                    own.for_each(|(entry, factor)| *entry = share * factor);
                }
                _ => own.zip(group).for_each(|((entry, factor), suspect)| {
                    *entry = self.entry(*suspect, *factor, line);
                }),
            }
        }
    }

    /// The entry of a suspect's column in a line of Γ¹, of its factor.
    fn entry(&self, suspect: Suspect, factor: f64, line: usize) -> f64 {
        let r = self.jacobian.len() / self.torques.len();
        let share = |actuator: usize| self.jacobian[actuator * r + line];
        let misread = |i: usize, error: Misreading| {
            let place = i * Misreading::ALL.len() + error as usize;
            self.misread[place * r + line]
        };
        match suspect {
            Suspect::Delay => {
                let rates = self.torque_rates.iter().enumerate();
                -rates.map(|(i, rate)| share(i) * rate).sum::<f64>()
            }
            Suspect::Smoothing | Suspect::Rounding => {
                let bends = match suspect {
                    Suspect::Smoothing => self.torque_bends,
                    _ => self.torque_turns,
                };
                let bends = bends.iter().enumerate();
                bends.map(|(i, bend)| share(i) * bend).sum::<f64>()
            }
            Suspect::Dulled => {
                let both = self.torque_turns.iter().zip(self.torque_bends);
                let friction = both.enumerate().map(|(i, (all, rest))| (i, all - rest));
                friction.map(|(i, bend)| share(i) * bend).sum::<f64>()
            }
            Suspect::Alike => self.alike[line],
            Suspect::Late(i) => -share(i) * self.torque_rates[i],
            Suspect::Gain(i) => share(i) * self.torques[i],
            Suspect::Clock => self.clock[line],
            Suspect::Offset(i) => misread(i, Misreading::Offset),
            Suspect::Eccentric(i, error) => misread(i, error),
            Suspect::Scale(i) => misread(i, Misreading::Scale),
            Suspect::Scales => {
                let all = 0..self.torques.len();
                all.map(|i| misread(i, Misreading::Scale)).sum::<f64>()
            }
            Suspect::Play(i) => factor * misread(i, Misreading::Offset),
            Suspect::Length(length) => self.lengths[length * r + line],
            Suspect::Torque(i, _) => share(i) * factor,
            Suspect::Force(own, _) if own != line => 0.0,
            Suspect::Force(..) => factor,
        }
    }
}

/// The motion of all actuators at all samples of a motion, samples x n: positions, velocities, accelerations
/// and torques, the signs of velocities being taken as for dry friction.
pub(super) fn moments(
    (motion, reversal): (&Motion, Reversal),
    [positions, velocities, accelerations, torques]: [&[f64]; 4],
) -> Vec<Moment> {
    let n = positions.len() / motion.samples.max(1);
    let moment = |place: usize| {
        let (velocity, acceleration) = (velocities[place], accelerations[place]);
        let step = acceleration / motion.sampling_frequency;
        Moment {
            position: positions[place],
            velocity,
            sign: reversal.sign(velocity, step).unwrap_or(0.0),
            acceleration,
            torque: torques[place],
            time: motion.time(place / n),
        }
    };
    (0..positions.len()).map(moment).collect()
}

/// Derivatives of `width` signals that stand side by side, by central differences; one-sided at both
/// ends.
pub(super) fn rates(values: &[f64], width: usize, frequency: f64) -> Vec<f64> {
    let samples = values.len() / width.max(1);
    let run = (width, samples.saturating_sub(1));
    let mut rates = central_differences(values, 0, 0..samples, run, 1);
    rates.iter_mut().for_each(|rate| *rate *= frequency);
    rates
}
