//! Standard parameters of a body and its joint, and optional ones of a joint.
//!
//! The optional ones are the stiffness of a spring, friction that differs by direction, friction
//! quadratic in the velocity, and friction that increases towards standstill or with a load.

/// A standard parameter, eq. (2); the order is that of the paper's χ, which ends with the offset.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum StandardParameter {
    /// Moment of inertia about x through the body frame's origin, kg m².
    Xx,
    /// Product of inertia, -∫ x y dm, kg m².
    Xy,
    /// Product of inertia, -∫ x z dm, kg m².
    Xz,
    /// Moment of inertia about y, kg m².
    Yy,
    /// Product of inertia, -∫ y z dm, kg m².
    Yz,
    /// Moment of inertia about z, kg m².
    Zz,
    /// First moment along x, kg m.
    Mx,
    /// First moment along y, kg m.
    My,
    /// First moment along z, kg m.
    Mz,
    /// Mass, kg.
    M,
    /// Inertia of rotor and gears, joint side, kg m² or kg.
    Ia,
    /// Viscous friction, N m s/rad or N s/m.
    Fv,
    /// Coulomb friction, N m or N.
    Fs,
    /// Constant offset of friction and drive, N m or N.
    Off,
    /// Coefficient of a joint's spring, N m/rad, or N/m for a linear one.
    K,
    /// Viscous friction at positive velocity, N m s/rad or N s/m.
    FvPos,
    /// Coulomb friction at positive velocity, N m or N.
    FsPos,
    /// Viscous friction at negative velocity, N m s/rad or N s/m.
    FvNeg,
    /// Coulomb friction at negative velocity, N m or N.
    FsNeg,
    /// Excess of static over Coulomb friction (Stribeck), N m or N.
    Fst,
    /// Ratio of dry friction to a known load; dimensionless for a load in N m or N.
    Fl,
    /// Friction quadratic in the velocity, N m s²/rad² or N s²/m².
    Fq,
}

/// The part of the model to which a parameter belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// The inertia of a body.
    Body,
    /// The inertia of a rotor with its gears.
    Rotor,
    /// A force against the motion of a joint.
    Friction {
        /// Exponent of the velocity: 0 for dry friction, 1 for viscous, 2 for quadratic friction.
        exponent: u8,
    },
    /// A constant force.
    Offset,
    /// The force of a spring.
    Spring,
}

/// All properties of a parameter.
struct Properties {
    name: &'static str,
    effect: Effect,
    /// Whether physically consistent values are nonnegative.
    is_nonnegative: bool,
    /// SI units for a joint that rotates, and for one that slides.
    units: [&'static str; 2],
}

const fn properties(
    name: &'static str,
    effect: Effect,
    is_nonnegative: bool,
    units: [&'static str; 2],
) -> Properties {
    Properties {
        name,
        effect,
        is_nonnegative,
        units,
    }
}

impl StandardParameter {
    /// The fourteen parameters of a joint and its body, in order.
    pub const ALL: [Self; 14] = [
        Self::Xx,
        Self::Xy,
        Self::Xz,
        Self::Yy,
        Self::Yz,
        Self::Zz,
        Self::Mx,
        Self::My,
        Self::Mz,
        Self::M,
        Self::Ia,
        Self::Fv,
        Self::Fs,
        Self::Off,
    ];

    /// The ten inertial parameters of a rigid body.
    pub const INERTIA: [Self; 10] = [
        Self::Xx,
        Self::Xy,
        Self::Xz,
        Self::Yy,
        Self::Yz,
        Self::Zz,
        Self::Mx,
        Self::My,
        Self::Mz,
        Self::M,
    ];

    /// The four parameters that act on a joint's coordinate and not on its body.
    pub const DRIVE: [Self; 4] = [Self::Ia, Self::Fv, Self::Fs, Self::Off];

    /// The three friction parameters.
    pub const FRICTION: [Self; 3] = [Self::Fv, Self::Fs, Self::Off];

    /// Listed parameters of a joint or motor that are not in [`Self::ALL`].
    pub const OPTIONAL: [Self; 5] = [Self::FvPos, Self::FsPos, Self::FvNeg, Self::FsNeg, Self::Fq];

    /// The four parameters of friction that differs by direction; they replace [`Self::FRICTION`].
    pub const DIRECTED: [Self; 4] = [Self::FvPos, Self::FsPos, Self::FvNeg, Self::FsNeg];

    const fn properties(self) -> Properties {
        use Effect::{Body, Offset, Rotor, Spring};
        const DRY: Effect = Effect::Friction { exponent: 0 };
        const VISCOUS: Effect = Effect::Friction { exponent: 1 };
        const QUADRATIC: Effect = Effect::Friction { exponent: 2 };
        const INERTIA: [&str; 2] = ["kg m^2"; 2];
        const MOMENT: [&str; 2] = ["kg m"; 2];
        const FORCE: [&str; 2] = ["N m", "N"];
        const PER_RATE: [&str; 2] = ["N m s/rad", "N s/m"];
        const PER_SQUARE: [&str; 2] = ["N m s^2/rad^2", "N s^2/m^2"];
        match self {
            Self::Xx => properties("xx", Body, true, INERTIA),
            Self::Xy => properties("xy", Body, false, INERTIA),
            Self::Xz => properties("xz", Body, false, INERTIA),
            Self::Yy => properties("yy", Body, true, INERTIA),
            Self::Yz => properties("yz", Body, false, INERTIA),
            Self::Zz => properties("zz", Body, true, INERTIA),
            Self::Mx => properties("mx", Body, false, MOMENT),
            Self::My => properties("my", Body, false, MOMENT),
            Self::Mz => properties("mz", Body, false, MOMENT),
            Self::M => properties("m", Body, true, ["kg"; 2]),
            Self::Ia => properties("ia", Rotor, true, ["kg m^2", "kg"]),
            Self::Fv => properties("fv", VISCOUS, true, PER_RATE),
            Self::Fs => properties("fs", DRY, true, FORCE),
            Self::Off => properties("off", Offset, false, FORCE),
            Self::K => properties("k", Spring, false, ["N m/rad", "N/m"]),
            Self::FvPos => properties("fv_pos", VISCOUS, true, PER_RATE),
            Self::FsPos => properties("fs_pos", DRY, false, FORCE),
            Self::FvNeg => properties("fv_neg", VISCOUS, true, PER_RATE),
            Self::FsNeg => properties("fs_neg", DRY, false, FORCE),
            Self::Fst => properties("fst", DRY, true, FORCE),
            Self::Fl => properties("fl", DRY, true, ["1"; 2]),
            Self::Fq => properties("fq", QUADRATIC, true, PER_SQUARE),
        }
    }

    /// Standard name, such as `zz`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.properties().name
    }

    /// The parameters that a description lists by name; others have keys of their own.
    pub fn listed() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().chain(Self::OPTIONAL)
    }

    /// The parameter of this name, among those that a description lists.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::listed().find(|p| p.name() == name)
    }

    /// The part of the model to which it belongs.
    #[must_use]
    pub const fn effect(self) -> Effect {
        self.properties().effect
    }

    /// Whether it is an inertial parameter of the body.
    #[must_use]
    pub const fn is_inertial(self) -> bool {
        matches!(self.effect(), Effect::Body)
    }

    /// Whether it is friction.
    #[must_use]
    pub const fn is_friction(self) -> bool {
        matches!(self.effect(), Effect::Friction { .. })
    }

    /// Whether it is friction that jumps when the velocity changes sign.
    #[must_use]
    pub const fn has_sign(self) -> bool {
        matches!(self.effect(), Effect::Friction { exponent: 0 })
    }

    /// Whether physically consistent values are nonnegative.
    #[must_use]
    pub const fn is_nonnegative(self) -> bool {
        self.properties().is_nonnegative
    }

    /// SI unit; `slides` is true for a prismatic joint.
    #[must_use]
    pub const fn unit(self, slides: bool) -> &'static str {
        let [rotating, sliding] = self.properties().units;
        if slides { sliding } else { rotating }
    }
}
