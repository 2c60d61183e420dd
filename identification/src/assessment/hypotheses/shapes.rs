//! Shapes of torques and forces that a model may lack.

/// Dependence of a missing torque on the motion of its actuator or coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    /// 1: an offset of the torque, or friction that differs by direction.
    Constant,
    /// The velocity.
    Velocity,
    /// The sign of the velocity.
    Sign,
    /// The magnitude of the velocity: viscous friction that differs by direction.
    Speed,
    /// The signed square of the velocity: drag.
    Drag,
    /// The sign of the velocity, fading away from standstill: Stribeck friction, as in the key
    /// `stribeck` of a joint.
    Stribeck,
    /// Magnitude of the torque with the sign of the velocity: load-dependent friction.
    Load,
    /// The magnitude of the torque: a gain that differs by the torque's sign.
    Magnitude,
    /// The acceleration.
    Acceleration,
    /// The position: a spring.
    Position,
    /// The position with the sign of the velocity: position-dependent friction.
    PositionSign,
    /// The cosine of the position.
    Cosine,
    /// The sine of the position.
    Sine,
    /// The time since the start of the run: a drift.
    Time,
    /// The time with the sign of the velocity: friction that drifts.
    TimeSign,
    /// The torque times the time since the start of the run: a gain that drifts.
    GainTime,
    /// The signed square of the torque: a torque constant that saturates.
    Saturation,
    /// Waves over the range of the position, [`WAVES`] columns: cogging, or an error of a gear.
    Waves,
    /// The torque times these waves: ripple of the torque constant.
    LoadWaves,
}

/// Number of cosines over the range of a position, of 1/2, 1, 3/2 … periods.
pub(super) const WAVES: usize = 16;

/// Shapes of an actuator with one column each.
pub(super) const SHAPES: [Shape; 17] = [
    Shape::Constant,
    Shape::Velocity,
    Shape::Sign,
    Shape::Speed,
    Shape::Drag,
    Shape::Stribeck,
    Shape::Load,
    Shape::Magnitude,
    Shape::Acceleration,
    Shape::Position,
    Shape::PositionSign,
    Shape::Cosine,
    Shape::Sine,
    Shape::Time,
    Shape::TimeSign,
    Shape::GainTime,
    Shape::Saturation,
];

/// Motion of an actuator or a coordinate at one time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct ActuatorState {
    pub(super) position: f64,
    pub(super) velocity: f64,
    /// Sign of the velocity, as the dry friction columns define it around reversals.
    pub(super) sign: f64,
    pub(super) acceleration: f64,
    /// Torque or force, without the residual.
    pub(super) torque: f64,
    pub(super) time: f64,
}

/// Position range and largest speed of an actuator.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct PositionRange {
    /// Smallest and largest position (m, rad).
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// Largest speed (m/s, rad/s).
    pub(crate) speed: f64,
}

/// Fraction of the largest speed at which Stribeck friction has fallen to a half.
const STRIBECK: f64 = 0.1;

impl PositionRange {
    /// The union of two ranges.
    pub(crate) fn united(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            speed: self.speed.max(other.speed),
        }
    }

    /// The waves at a position.
    pub(super) fn waves(self, position: f64) -> [f64; WAVES] {
        let range = self.high - self.low;
        let place = if range > 0.0 {
            ((position - self.low) / range).clamp(0.0, 1.0)
        } else {
            0.0
        };
        std::array::from_fn(|k| (std::f64::consts::PI * (k + 1) as f64 * place).cos())
    }
}

/// Largest magnitude of a sum of waves over the range of the position.
///
/// `sizes` are the sizes of some waves by place.
pub(crate) fn wave_amplitude(sizes: &[(usize, f64)]) -> f64 {
    // The shortest period has eight of these positions.
    const POSITIONS: usize = 4 * WAVES;
    let range = PositionRange {
        low: 0.0,
        high: 1.0,
        speed: 0.0,
    };
    let sum = |position: usize| {
        let waves = range.waves(position as f64 / POSITIONS as f64);
        let parts = sizes.iter().map(|(place, size)| size * waves[*place]);
        parts.sum::<f64>().abs()
    };
    (0..=POSITIONS).map(sum).fold(0.0, f64::max)
}

impl Shape {
    /// Keys of a joint with which the model has such a torque; empty if there are none.
    pub(crate) const fn keys(self) -> &'static str {
        match self {
            Self::Velocity => " (`fv` in a joint's `parameters`)",
            Self::Sign => " (`fs` in a joint's `parameters`)",
            Self::Speed => " (\"friction by direction\" in a joint's `parameters`)",
            Self::Drag => " (`fq` in a joint's `parameters`)",
            Self::Acceleration => " (`ia` in a joint's `parameters`)",
            Self::Stribeck => " (`stribeck` of a joint)",
            Self::Position => " (`spring` of a joint)",
            Self::Load => " (`friction_load` of a joint, or `gear_friction`)",
            _ => "",
        }
    }

    /// Name in a JSON document.
    pub(crate) const fn key(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Velocity => "velocity",
            Self::Sign => "sign",
            Self::Speed => "speed",
            Self::Drag => "drag",
            Self::Stribeck => "stribeck",
            Self::Load => "load",
            Self::Magnitude => "magnitude",
            Self::Acceleration => "acceleration",
            Self::Position => "position",
            Self::PositionSign => "position-sign",
            Self::Cosine => "cosine",
            Self::Sine => "sine",
            Self::Time => "time",
            Self::TimeSign => "time-sign",
            Self::GainTime => "gain-time",
            Self::Saturation => "saturation",
            Self::Waves => "waves",
            Self::LoadWaves => "load-waves",
        }
    }

    /// Whether it is a sum of waves over the position.
    pub(crate) const fn is_waves(self) -> bool {
        matches!(self, Self::Waves | Self::LoadWaves)
    }

    /// Name in a sentence.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::Constant => "a constant, as an offset or friction that differs by direction",
            Self::Velocity => "the velocity, as viscous friction",
            Self::Sign => "the sign of the velocity, as dry friction",
            Self::Speed => {
                "the magnitude of the velocity, as viscous friction that differs by direction"
            }
            Self::Drag => "the square of the velocity, as drag",
            Self::Stribeck => {
                "the sign of the velocity near standstill, where friction rises or falls"
            }
            Self::Load => {
                "the magnitude of the torque and the sign of the velocity, as friction that grows with the load"
            }
            Self::Magnitude => "the magnitude of the torque, as a gain that differs by its sign",
            Self::Acceleration => "the acceleration, as inertia",
            Self::Position => "the position, as a spring",
            Self::PositionSign => {
                "the position and the sign of the velocity, as friction that differs by place"
            }
            Self::Cosine => "the cosine of the position, as gravity",
            Self::Sine => "the sine of the position, as gravity",
            Self::Time => "time, as a drift",
            Self::TimeSign => "time and the sign of the velocity, as friction that changes",
            Self::GainTime => "time and the torque, as a gain that drifts",
            Self::Saturation => {
                "the square of the torque with its sign, as a torque constant that saturates"
            }
            Self::Waves => "the position in waves, as cogging or an error of a gear",
            Self::LoadWaves => {
                "the torque in waves of the position, as ripple that grows with the load"
            }
        }
    }

    /// Unit of the size, for a torque (revolute actuator) or a force.
    pub(crate) const fn unit(self, revolute: bool) -> &'static str {
        match (self, revolute) {
            (Self::Constant | Self::Sign | Self::Stribeck | Self::Waves, false) => "N",
            (
                Self::Constant
                | Self::Sign
                | Self::Stribeck
                | Self::Waves
                | Self::Cosine
                | Self::Sine,
                _,
            ) => "N m",
            (Self::Velocity | Self::Speed, true) => "N m s/rad",
            (Self::Velocity | Self::Speed, false) => "N s/m",
            (Self::Drag, true) => "N m s^2/rad^2",
            (Self::Drag, false) => "N s^2/m^2",
            (Self::Acceleration, true) => "kg m^2",
            (Self::Acceleration, false) => "kg",
            (Self::Position | Self::PositionSign, true) => "N m/rad",
            (Self::Position | Self::PositionSign, false) => "N/m",
            (Self::Time | Self::TimeSign, true) => "N m/s",
            (Self::Time | Self::TimeSign, false) => "N/s",
            (Self::GainTime, _) => "1/s",
            (Self::Saturation, true) => "1/(N m)",
            (Self::Saturation, false) => "1/N",
            (Self::Load | Self::Magnitude | Self::LoadWaves, _) => "",
        }
    }

    /// Velocity at which Stribeck friction is a half, for the largest `speed` (m/s, rad/s).
    pub(crate) const fn fading(speed: f64) -> f64 {
        STRIBECK * speed
    }

    /// Value at a motion. Waves have no single value: they are added after decimation.
    pub(super) fn value(self, motion: ActuatorState, position_range: PositionRange) -> f64 {
        let ActuatorState {
            position,
            velocity,
            sign,
            acceleration,
            torque,
            time,
        } = motion;
        match self {
            Self::Constant => 1.0,
            Self::Velocity => velocity,
            Self::Sign => sign,
            Self::Speed => velocity.abs(),
            Self::Drag => velocity * velocity.abs(),
            Self::Stribeck if position_range.speed > 0.0 => {
                let relative = velocity / Self::fading(position_range.speed);
                sign / (1.0 + relative * relative)
            }
            Self::Load => sign * torque.abs(),
            Self::Magnitude => torque.abs(),
            Self::Acceleration => acceleration,
            Self::Position => position,
            Self::PositionSign => position * sign,
            Self::Cosine => position.cos(),
            Self::Sine => position.sin(),
            Self::Time => time,
            Self::TimeSign => time * sign,
            Self::GainTime => time * torque,
            Self::Saturation => torque * torque.abs(),
            Self::Stribeck | Self::Waves | Self::LoadWaves => 0.0,
        }
    }
}
