//! Physical dimensions and the names of units.

use crate::expressions::scalar::Scalar;
use overact_core::StandardParameter;
use overact_exact::{Angle, Number, Ratio};

/// Exponents of metre, kilogram, second, ampere and radian.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Dimension([i8; 5]);

const BASE: [&str; 5] = ["m", "kg", "s", "A", "rad"];

impl Dimension {
    pub(crate) const NONE: Self = Self([0, 0, 0, 0, 0]);
    pub(crate) const LENGTH: Self = Self([1, 0, 0, 0, 0]);
    pub(crate) const MASS: Self = Self([0, 1, 0, 0, 0]);
    pub(crate) const TIME: Self = Self([0, 0, 1, 0, 0]);
    pub(crate) const CURRENT: Self = Self([0, 0, 0, 1, 0]);
    pub(crate) const ANGLE: Self = Self([0, 0, 0, 0, 1]);
    pub(crate) const FREQUENCY: Self = Self([0, 0, -1, 0, 0]);
    pub(crate) const SPEED: Self = Self([1, 0, -1, 0, 0]);
    pub(crate) const ANGULAR_SPEED: Self = Self([0, 0, -1, 0, 1]);
    pub(crate) const ACCELERATION: Self = Self([1, 0, -2, 0, 0]);
    pub(crate) const ANGULAR_ACCELERATION: Self = Self([0, 0, -2, 0, 1]);
    pub(crate) const FORCE: Self = Self([1, 1, -2, 0, 0]);
    pub(crate) const TORQUE: Self = Self([2, 1, -2, 0, 0]);
    pub(crate) const PRESSURE: Self = Self([-1, 1, -2, 0, 0]);
    pub(crate) const POWER: Self = Self([2, 1, -3, 0, 0]);
    pub(crate) const VOLTAGE: Self = Self([2, 1, -3, -1, 0]);
    pub(crate) const INERTIA: Self = Self([2, 1, 0, 0, 0]);
    pub(crate) const FIRST_MOMENT: Self = Self([1, 1, 0, 0, 0]);
    pub(crate) const LINEAR_VISCOSITY: Self = Self([0, 1, -1, 0, 0]);
    pub(crate) const ANGULAR_VISCOSITY: Self = Self([2, 1, -1, 0, -1]);
    pub(crate) const LINEAR_STIFFNESS: Self = Self([0, 1, -2, 0, 0]);
    pub(crate) const ANGULAR_STIFFNESS: Self = Self([2, 1, -2, 0, -1]);
    const LINEAR_DRAG: Self = Self([-1, 1, 0, 0, 0]);
    const ANGULAR_DRAG: Self = Self([2, 1, 0, 0, -2]);

    /// Names of dimensions with their article, and units.
    const NAMES: [(Self, &'static str, &'static str); 22] = [
        (Self::LENGTH, "a length", "m"),
        (Self::MASS, "a mass", "kg"),
        (Self::TIME, "a time", "s"),
        (Self::CURRENT, "a current", "A"),
        (Self::ANGLE, "an angle", "rad"),
        (Self::FREQUENCY, "a frequency", "Hz"),
        (Self::SPEED, "a speed", "m/s"),
        (Self::ANGULAR_SPEED, "an angular speed", "rad/s"),
        (Self::ACCELERATION, "an acceleration", "m/s^2"),
        (
            Self::ANGULAR_ACCELERATION,
            "an angular acceleration",
            "rad/s^2",
        ),
        (Self::FORCE, "a force", "N"),
        (Self::TORQUE, "a torque", "N m"),
        (Self::POWER, "a power", "W"),
        (Self::VOLTAGE, "a voltage", "V"),
        (Self::INERTIA, "a moment of inertia", "kg m^2"),
        (Self::FIRST_MOMENT, "a first moment of mass", "kg m"),
        (Self::LINEAR_VISCOSITY, "a viscous friction", "N s/m"),
        (Self::ANGULAR_VISCOSITY, "a viscous friction", "N m s/rad"),
        (Self::LINEAR_STIFFNESS, "a stiffness", "N/m"),
        (Self::ANGULAR_STIFFNESS, "a stiffness", "N m/rad"),
        (Self::LINEAR_DRAG, "a quadratic friction", "N s^2/m^2"),
        (Self::ANGULAR_DRAG, "a quadratic friction", "N m s^2/rad^2"),
    ];

    /// Dimension of a product; `None` on overflow of an exponent.
    pub(crate) fn times(self, other: Self) -> Option<Self> {
        let mut sum = [0; 5];
        for ((out, a), b) in sum.iter_mut().zip(self.0).zip(other.0) {
            *out = a.checked_add(b)?;
        }
        Some(Self(sum))
    }

    /// Dimension of a power; `None` on overflow.
    pub(crate) fn power(self, exponent: i8) -> Option<Self> {
        let mut product = [0; 5];
        for (out, a) in product.iter_mut().zip(self.0) {
            *out = a.checked_mul(exponent)?;
        }
        Some(Self(product))
    }

    /// Dimension of a square root; `None` for fractional exponents.
    pub(crate) fn root(self) -> Option<Self> {
        self.0
            .iter()
            .all(|e| e % 2 == 0)
            .then(|| Self(self.0.map(|e| e / 2)))
    }

    /// Whether a quantity of this dimension is accepted for an `expected` dimension.
    ///
    /// A plain number is always accepted. The radian counts only in dimensions without mass: a
    /// torque per angular speed is N m s or N m s/rad.
    pub(crate) fn fits(self, expected: Self) -> bool {
        let [m, kg, s, a, _] = expected.0;
        let without_angle = [m, kg, s, a] == [self.0[0], self.0[1], self.0[2], self.0[3]];
        self == Self::NONE || self == expected || (kg != 0 && without_angle)
    }

    /// Dimension of a standard parameter of a joint or body; `slides` for a prismatic joint.
    pub(crate) fn of_parameter(parameter: StandardParameter, slides: bool) -> Self {
        let own = parameter.unit(slides);
        let found = Self::NAMES.iter().find(|(.., unit)| *unit == own);
        found.map_or(Self::NONE, |(dimension, ..)| *dimension)
    }

    fn known(self) -> Option<(&'static str, &'static str)> {
        Self::NAMES
            .iter()
            .find(|(d, ..)| *d == self)
            .map(|(_, name, unit)| (*name, *unit))
    }

    /// The SI unit; empty for a plain number.
    pub(crate) fn unit(self) -> String {
        if let Some((_, unit)) = self.known() {
            return unit.to_owned();
        }
        let factor = |(name, exponent): (&&str, i8)| match exponent {
            0 => None,
            1 => Some((*name).to_owned()),
            _ => Some(format!("{name}^{exponent}")),
        };
        BASE.iter()
            .zip(self.0)
            .filter_map(factor)
            .collect::<Vec<_>>()
            .join(" ")
    }

    /// "a length (m)".
    pub(crate) fn describe(self) -> String {
        match self.known() {
            Some((name, unit)) => format!("{name} ({unit})"),
            None if self == Self::NONE => "a plain number".to_owned(),
            None => format!("a quantity in {}", self.unit()),
        }
    }

    /// "a length".
    pub(crate) fn name(self) -> String {
        self.known()
            .map_or_else(|| self.describe(), |(name, _)| name.to_owned())
    }
}

/// Names of all units.
pub(crate) const UNITS: [&str; 28] = [
    "m", "mm", "cm", "um", "km", "deg", "rad", "mrad", "kg", "g", "s", "ms", "us", "Hz", "kHz",
    "N", "mN", "kN", "Nm", "mNm", "J", "W", "kW", "V", "mV", "A", "mA", "rpm",
];

/// A unit's value in SI and its dimension.
pub(crate) fn unit(name: &str) -> Option<(Scalar, Dimension)> {
    let (numerator, denominator, dimension) = match name {
        "deg" => {
            let degree = Scalar::angle(Angle::half_turns(Ratio::new(1, 180)?));
            return Some((degree, Dimension::ANGLE));
        }
        "rpm" => {
            let speed = Scalar::angle(Angle::half_turns(Ratio::new(1, 30)?));
            return Some((speed, Dimension::ANGULAR_SPEED));
        }
        "m" => (1, 1, Dimension::LENGTH),
        "mm" => (1, 1_000, Dimension::LENGTH),
        "cm" => (1, 100, Dimension::LENGTH),
        "um" => (1, 1_000_000, Dimension::LENGTH),
        "km" => (1_000, 1, Dimension::LENGTH),
        "rad" => (1, 1, Dimension::ANGLE),
        "mrad" => (1, 1_000, Dimension::ANGLE),
        "kg" => (1, 1, Dimension::MASS),
        "g" => (1, 1_000, Dimension::MASS),
        "s" => (1, 1, Dimension::TIME),
        "ms" => (1, 1_000, Dimension::TIME),
        "us" => (1, 1_000_000, Dimension::TIME),
        "Hz" => (1, 1, Dimension::FREQUENCY),
        "kHz" => (1_000, 1, Dimension::FREQUENCY),
        "N" => (1, 1, Dimension::FORCE),
        "mN" => (1, 1_000, Dimension::FORCE),
        "kN" => (1_000, 1, Dimension::FORCE),
        "Nm" | "J" => (1, 1, Dimension::TORQUE),
        "mNm" => (1, 1_000, Dimension::TORQUE),
        "W" => (1, 1, Dimension::POWER),
        "kW" => (1_000, 1, Dimension::POWER),
        "V" => (1, 1, Dimension::VOLTAGE),
        "mV" => (1, 1_000, Dimension::VOLTAGE),
        "A" => (1, 1, Dimension::CURRENT),
        "mA" => (1, 1_000, Dimension::CURRENT),
        _ => return None,
    };
    Some((
        Scalar::number(Number::ratio(Ratio::new(numerator, denominator)?)),
        dimension,
    ))
}
