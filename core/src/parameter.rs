//! The fourteen standard parameters of a body and its joint, and the stiffness of a joint's spring.

/// A standard parameter, eq. (2); the order is that of the paper's χ, which knows no springs.
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
    /// Inertia of rotor and gears on the joint's side, kg m² or kg.
    Ia,
    /// Viscous friction, N m s/rad or N s/m.
    Fv,
    /// Coulomb friction, N m or N.
    Fs,
    /// Constant offset of friction and drive, N m or N.
    Off,
    /// Coefficient of a joint's spring, N m/rad or N/m of a linear one.
    K,
}

impl StandardParameter {
    /// The fourteen of every joint and its body, in order.
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

    /// The ten of a rigid body.
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

    /// The four that act on the coordinate of a joint and not on its body.
    pub const DRIVE: [Self; 4] = [Self::Ia, Self::Fv, Self::Fs, Self::Off];

    /// The three of friction.
    pub const FRICTION: [Self; 3] = [Self::Fv, Self::Fs, Self::Off];

    /// Field-standard name, `zz` for instance.
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
        }
    }

    /// The parameter with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|p| p.name() == name)
    }

    /// Whether it belongs to the rigid body and not to the joint.
    #[must_use]
    pub const fn is_inertial(self) -> bool {
        !matches!(self, Self::Ia | Self::Fv | Self::Fs | Self::Off | Self::K)
    }

    /// Whether no body or joint has a negative one.
    #[must_use]
    pub const fn is_nonnegative(self) -> bool {
        matches!(
            self,
            Self::Xx | Self::Yy | Self::Zz | Self::M | Self::Ia | Self::Fv | Self::Fs
        )
    }

    /// SI unit; `slides` says whether the joint is prismatic.
    #[must_use]
    pub const fn unit(self, slides: bool) -> &'static str {
        match self {
            Self::Xx | Self::Xy | Self::Xz | Self::Yy | Self::Yz | Self::Zz => "kg m^2",
            Self::Mx | Self::My | Self::Mz => "kg m",
            Self::M => "kg",
            Self::Ia if slides => "kg",
            Self::Ia => "kg m^2",
            Self::Fv if slides => "N s/m",
            Self::Fv => "N m s/rad",
            Self::Fs | Self::Off if slides => "N",
            Self::Fs | Self::Off => "N m",
            Self::K if slides => "N/m",
            Self::K => "N m/rad",
        }
    }
}
