//! Fleet of different robots of one description over many days, with faults.
//!
//! The masses of a robot's bodies vary, with moments and inertias in proportion, so that bodies
//! stay physically consistent. Friction varies between robots and from day to day. Two builds
//! alternate; in the second, the last body of the first leg is 3 % heavier. A given share of the
//! robots has each [`Fault`]. Everything follows from the seed, the robot's number and the day.

use overact::{Body, Info, StandardParameter as P};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use crate::run::Record;

/// Relative standard deviation of body masses.
const MASS_SPREAD: f64 = 0.02;

/// Standard deviation of the logarithm of friction, between robots and between days.
const FRICTION_SPREAD: [f64; 2] = [0.15, 0.01];

/// Relative excess mass of a body of the second build.
const SECOND_BUILD: f64 = 0.03;

/// Relative mass error of a wrong payload.
const WRONG_PAYLOAD: f64 = 0.20;

/// Settings of a fleet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fleet {
    /// Number of days, with one run per robot and day.
    pub days: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Fraction of the robots with each fault.
    pub share: f64,
    /// Relative growth of viscous friction.
    pub friction_drift: f64,
    /// Relative growth of a first moment.
    pub moment_drift: f64,
}

/// Fault of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// Nothing.
    None,
    /// Viscous friction of a joint grows, over a third of the days.
    Friction,
    /// A first moment of a link grows, over a third of the days.
    Moment,
    /// The platform has another mass from the first day on.
    Payload,
    /// An encoder is stuck from a day on.
    Encoder,
}

impl Fault {
    /// All faults.
    pub const ALL: [Self; 5] = [
        Self::None,
        Self::Friction,
        Self::Moment,
        Self::Payload,
        Self::Encoder,
    ];

    /// Name of the fault.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Friction => "friction",
            Self::Moment => "moment",
            Self::Payload => "payload",
            Self::Encoder => "encoder",
        }
    }
}

/// A robot of a fleet.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Member {
    /// Number, from 0.
    pub number: usize,
    /// Build, `A` or `B`.
    pub build: char,
    /// Fault.
    pub fault: Fault,
    /// Column of the affected parameter, or number of the actuator with the affected encoder.
    pub place: usize,
    /// First day of the fault, from 0.
    pub begin: usize,
    /// Parameters on the first day, without daily friction changes and the fault.
    pub parameters: Vec<f64>,
    /// Columns of friction parameters.
    friction: Vec<usize>,
}

impl Fleet {
    /// A robot of the fleet, around `nominal` parameters.
    #[must_use]
    pub fn member(&self, number: usize, info: &Info<'_>, nominal: &[f64]) -> Member {
        let mut random = self.random(number, 0);
        let build = if number.is_multiple_of(2) { 'A' } else { 'B' };
        let (parameters, friction) = spread(info, nominal, build, &mut random);
        let kinds = &Fault::ALL[1..];
        let drawn = random.random::<f64>() / self.share.max(f64::MIN_POSITIVE);
        let fault = kinds.get(drawn.min(1e9) as usize).copied();
        let drawn = random.random::<f64>();
        let (fault, place) = match fault {
            Some(fault) => concerned(fault, info, nominal, drawn),
            None => (Fault::None, 0),
        };
        Member {
            number,
            build,
            fault,
            place,
            begin: match fault {
                Fault::Payload => 0,
                _ => self.days / 3,
            },
            parameters,
            friction,
        }
    }

    /// Relative change of the affected parameter on a day.
    #[must_use]
    pub fn size(&self, member: &Member, day: usize) -> f64 {
        let whole = match member.fault {
            Fault::Friction => self.friction_drift,
            Fault::Moment => self.moment_drift,
            Fault::Payload => return WRONG_PAYLOAD,
            Fault::Encoder | Fault::None => return 0.0,
        };
        let ramp = (self.days / 3).max(1);
        let days = day.saturating_sub(member.begin).min(ramp);
        whole * days as f64 / ramp as f64
    }

    /// Parameters of a robot on a day.
    #[must_use]
    pub fn on(&self, member: &Member, day: usize) -> Vec<f64> {
        let mut random = self.random(member.number, 1 + day);
        let mut own = member.parameters.clone();
        for &column in &member.friction {
            own[column] *= (FRICTION_SPREAD[1] * normal(&mut random)).exp();
        }
        if let Some(value) = own.get_mut(member.place) {
            *value *= 1.0 + self.size(member, day);
        }
        own
    }

    /// Noise seed of a robot on a day.
    #[must_use]
    pub fn noise(&self, member: &Member, day: usize) -> u64 {
        self.random(member.number, (1 << 20) + day).random()
    }

    /// Applies a stuck encoder: the actuator keeps its first position.
    pub fn spoil(&self, member: &Member, day: usize, record: &mut Record) {
        if member.fault != Fault::Encoder || day < member.begin {
            return;
        }
        let count = record.actuators.len();
        let first = record.positions.get(member.place).copied();
        let own = record.positions.iter_mut().skip(member.place);
        own.step_by(count.max(1))
            .for_each(|value| *value = first.unwrap_or(*value));
    }

    fn random(&self, number: usize, stream: usize) -> Pcg64 {
        let stream = (number as u128) << 32 | stream as u128;
        Pcg64::new(u128::from(self.seed), stream)
    }
}

/// Parameters of a robot around nominal ones, and the columns of friction.
fn spread(
    info: &Info<'_>,
    nominal: &[f64],
    build: char,
    random: &mut Pcg64,
) -> (Vec<f64>, Vec<usize>) {
    let all = || info.parameters.iter().chain(info.payload_parameters);
    let last = all().filter_map(|own| match own.body {
        Body::Leg { leg: 0, index, .. } => Some(index),
        _ => None,
    });
    let last = last.max();
    // Mass factor of each body, in order of appearance.
    let mut bodies: Vec<(Body, f64)> = Vec::new();
    let mut parameters = nominal.to_vec();
    let mut friction = Vec::new();
    for (column, (own, value)) in all().zip(&mut parameters).enumerate() {
        if own.symbol.is_inertial() {
            if !bodies.iter().any(|(body, _)| *body == own.body) {
                let heavier =
                    matches!(own.body, Body::Leg { leg: 0, index, .. } if Some(index) == last);
                let more = if heavier && build == 'B' {
                    SECOND_BUILD
                } else {
                    0.0
                };
                bodies.push((own.body, 1.0 + more + MASS_SPREAD * normal(random)));
            }
            let factor = bodies.iter().find(|(body, _)| *body == own.body);
            *value *= factor.map_or(1.0, |(_, factor)| *factor);
        } else if matches!(own.symbol, P::Fv | P::Fs) {
            *value *= (FRICTION_SPREAD[0] * normal(random)).exp();
            friction.push(column);
        }
    }
    (parameters, friction)
}

/// Column or actuator that a fault affects, chosen by a number from 0 to 1.
///
/// The fault becomes `None` if the robot has no such parameter.
fn concerned(fault: Fault, info: &Info<'_>, nominal: &[f64], drawn: f64) -> (Fault, usize) {
    let of = |wanted: &dyn Fn(P, &Body) -> bool| -> Vec<usize> {
        let all = info.parameters.iter().chain(info.payload_parameters);
        let own = all.zip(nominal).enumerate();
        own.filter(|(_, (own, value))| wanted(own.symbol, &own.body) && **value != 0.0)
            .map(|(column, _)| column)
            .collect()
    };
    let any = |columns: Vec<usize>| {
        columns
            .get((drawn * columns.len() as f64) as usize)
            .copied()
    };
    let place = match fault {
        Fault::None => None,
        Fault::Encoder => Some((drawn * info.sizes.actuators as f64) as usize),
        Fault::Friction => any(of(&|symbol, _| symbol == P::Fv)),
        // The largest first moment, that of a body of some size.
        Fault::Moment => largest(
            &of(&|symbol, _| matches!(symbol, P::Mx | P::My | P::Mz)),
            nominal,
        ),
        Fault::Payload => any(of(&|symbol, body| {
            symbol == P::M && *body == Body::Platform
        })),
    };
    place.map_or((Fault::None, 0), |place| (fault, place))
}

fn normal(random: &mut Pcg64) -> f64 {
    StandardNormal.sample(random)
}

fn largest(columns: &[usize], nominal: &[f64]) -> Option<usize> {
    let size = |column: &&usize| nominal[**column].abs();
    let best = columns.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
    best.copied()
}
