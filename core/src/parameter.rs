//! Standard parameters of a body and its joint, and optional ones of a joint.
//!
//! The optional ones are the stiffness of a spring, friction that differs by direction, and
//! friction that increases towards standstill or with a load.

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

    /// The four parameters of friction that differs by direction; they replace [`Self::FRICTION`].
    pub const DIRECTED: [Self; 4] = [Self::FvPos, Self::FsPos, Self::FvNeg, Self::FsNeg];

    /// Standard name, such as `zz`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Xx => "xx",
            Self::Xy => "xy",
            Self::Xz => "xz",
            Self::Yy => "yy",
            Self::Yz => "yz",
            Self::Zz => "zz",
            Self::Mx => "mx",
            Self::My => "my",
            Self::Mz => "mz",
            Self::M => "m",
            Self::Ia => "ia",
            Self::Fv => "fv",
            Self::Fs => "fs",
            Self::Off => "off",
            Self::K => "k",
            Self::FvPos => "fv_pos",
            Self::FsPos => "fs_pos",
            Self::FvNeg => "fv_neg",
            Self::FsNeg => "fs_neg",
            Self::Fst => "fst",
            Self::Fl => "fl",
        }
    }

    /// The parameter of this name, among those that a description lists; others have keys of their
    /// own.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let mut listed = Self::ALL.into_iter().chain(Self::DIRECTED);
        listed.find(|p| p.name() == name)
    }

    /// Whether it is an inertial parameter of the body.
    #[must_use]
    pub const fn is_inertial(self) -> bool {
        matches!(
            self,
            Self::Xx
                | Self::Xy
                | Self::Xz
                | Self::Yy
                | Self::Yz
                | Self::Zz
                | Self::Mx
                | Self::My
                | Self::Mz
                | Self::M
        )
    }

    /// Whether it is friction that depends on the rate, so that its column changes when the rate
    /// reverses.
    #[must_use]
    pub const fn follows_rate(self) -> bool {
        self.is_viscous() || self.has_sign()
    }

    /// Whether it is viscous friction, proportional to the velocity.
    #[must_use]
    pub const fn is_viscous(self) -> bool {
        matches!(self, Self::Fv | Self::FvPos | Self::FvNeg)
    }

    /// Whether it is friction that jumps when the velocity changes sign.
    #[must_use]
    pub const fn has_sign(self) -> bool {
        matches!(
            self,
            Self::Fs | Self::FsPos | Self::FsNeg | Self::Fst | Self::Fl
        )
    }

    /// Whether physically consistent values are nonnegative.
    #[must_use]
    pub const fn is_nonnegative(self) -> bool {
        matches!(
            self,
            Self::Xx
                | Self::Yy
                | Self::Zz
                | Self::M
                | Self::Ia
                | Self::Fv
                | Self::Fs
                | Self::FvPos
                | Self::FvNeg
                | Self::Fst
                | Self::Fl
        )
    }

    /// SI unit; `slides` is true for a prismatic joint.
    #[must_use]
    pub const fn unit(self, slides: bool) -> &'static str {
        match self {
            Self::Xx | Self::Xy | Self::Xz | Self::Yy | Self::Yz | Self::Zz => "kg m^2",
            Self::Mx | Self::My | Self::Mz => "kg m",
            Self::M => "kg",
            Self::Ia if slides => "kg",
            Self::Ia => "kg m^2",
            Self::Fv | Self::FvPos | Self::FvNeg if slides => "N s/m",
            Self::Fv | Self::FvPos | Self::FvNeg => "N m s/rad",
            Self::Fs | Self::Off | Self::FsPos | Self::FsNeg | Self::Fst if slides => "N",
            Self::Fs | Self::Off | Self::FsPos | Self::FsNeg | Self::Fst => "N m",
            Self::Fl => "1",
            Self::K if slides => "N/m",
            Self::K => "N m/rad",
        }
    }
}
