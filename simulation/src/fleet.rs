//! Many robots of one description over many days: no two are alike, some change, and some are not what their
//! papers say.
//!
//! A robot's bodies have masses of their own, with their moments and inertias in proportion, so that each stays
//! a body that can be; its friction is its own, and that of a day is not that of the day before. Of two builds,
//! taken in turn, the second has the last body of its first leg 3 % heavier. A given share of the robots suffers
//! from each [`Fault`]. All of it follows from the seed, the number of the robot and the day, whatever else is
//! simulated.

use overact::{Body, Info, StandardParameter as P};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use crate::run::Record;

/// Deviation of the masses of bodies, as a part of them.
const MASS_SPREAD: f64 = 0.02;

/// Deviation of the logarithm of friction from robot to robot, and from day to day.
const FRICTION_SPREAD: [f64; 2] = [0.15, 0.01];

/// By how much a body of the second build is heavier.
const SECOND_BUILD: f64 = 0.03;

/// By how much the mass of a platform is off that is not what the order says.
const WRONG_PAYLOAD: f64 = 0.20;

/// A fleet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fleet {
    /// Days, of which each robot makes a run.
    pub days: usize,
    /// Seed of everything.
    pub seed: u64,
    /// Part of the robots that suffer from each fault.
    pub share: f64,
    /// By how much viscous friction grows, as a part of it.
    pub friction_drift: f64,
    /// By how much a first moment of mass grows, as a part of it.
    pub moment_drift: f64,
}

/// What is wrong with a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// Nothing.
    None,
    /// Viscous friction of a joint grows, within a third of the days.
    Friction,
    /// A first moment of mass of a link grows, within a third of the days.
    Moment,
    /// The platform's mass is another one from the first day on.
    Payload,
    /// An encoder shows the same position from a day on.
    Encoder,
}

impl Fault {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::None,
        Self::Friction,
        Self::Moment,
        Self::Payload,
        Self::Encoder,
    ];

    /// A word for it.
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
    /// Its number, from 0.
    pub number: usize,
    /// Its build, `A` or `B`.
    pub build: char,
    /// What is wrong with it.
    pub fault: Fault,
    /// The column of the parameter that is concerned, or the number of the actuator whose encoder is.
    pub place: usize,
    /// The day from which on it is wrong, from 0.
    pub begin: usize,
    /// Its parameters on the first day, without friction's daily part and without the fault.
    pub parameters: Vec<f64>,
    /// Columns of friction.
    friction: Vec<usize>,
}

impl Fleet {
    /// A robot of the fleet, around `nominal` parameters.
    #[must_use]
    pub fn member(&self, number: usize, info: &Info<'_>, nominal: &[f64]) -> Member {
        let mut random = self.random(number, 0);
        let build = if number.is_multiple_of(2) { 'A' } else { 'B' };
        let (parameters, friction) = spread((info, nominal), build, &mut random);
        let kinds = &Fault::ALL[1..];
        let drawn = random.random::<f64>() / self.share.max(f64::MIN_POSITIVE);
        let fault = kinds.get(drawn.min(1e9) as usize).copied();
        let drawn = random.random::<f64>();
        let (fault, place) = match fault {
            Some(fault) => concerned(fault, (info, nominal), drawn),
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

    /// By how much the parameter that is concerned is larger on a day, as a part of it.
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

    /// The parameters of a robot on a day.
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

    /// The seed of the noise of a robot on a day.
    #[must_use]
    pub fn noise(&self, member: &Member, day: usize) -> u64 {
        self.random(member.number, (1 << 20) + day).random()
    }

    /// What a dead encoder makes of a record: of its actuator the first position.
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

/// Parameters of a robot of a build around nominal ones, and the columns of its friction.
fn spread(
    (info, nominal): (&Info<'_>, &[f64]),
    build: char,
    random: &mut Pcg64,
) -> (Vec<f64>, Vec<usize>) {
    let all = || info.parameters.iter().chain(info.payload_parameters);
    let last = all().filter_map(|own| match own.body {
        Body::Leg { leg: 0, index, .. } => Some(index),
        _ => None,
    });
    let last = last.max();
    // The factor of each body, in the order in which bodies come.
    let mut bodies: Vec<(Body, f64)> = Vec::new();
    let mut parameters = nominal.to_vec();
    let mut friction = Vec::new();
    for (column, (own, value)) in all().zip(&mut parameters).enumerate() {
        if own.symbol.is_inertial() {
            if !bodies.iter().any(|(body, _)| *body == own.body) {
                let heavier =
                    matches!(own.body, Body::Leg { leg: 0, index, .. } if Some(index) == last);
                let more = match heavier && build == 'B' {
                    true => SECOND_BUILD,
                    false => 0.0,
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

/// The column, or the actuator, that a fault concerns, by a number from 0 to 1; no fault where there is none.
fn concerned(fault: Fault, (info, nominal): (&Info<'_>, &[f64]), drawn: f64) -> (Fault, usize) {
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
        // The largest: what a body of some size has.
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
