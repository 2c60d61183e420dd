//! Lengths of a mechanism that calibration may change.

use overact_codegen::mechanism::{End, JointKind, Leg, Mechanism, Number};
use overact_identification::{GeometryParameter, ParameterKind};

const AXES: [&str; 3] = ["x", "y", "z"];

/// A length of a leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Length {
    /// MDH b of a joint's step.
    B(usize),
    /// MDH d of a joint's step.
    D(usize),
    /// MDH r of a joint's step.
    R(usize),
    /// A coordinate of the leg's base point.
    Base(usize),
    /// A coordinate of the leg's attachment point on the platform.
    End(usize),
}

/// A length of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LegLength {
    /// Index of the leg.
    pub(crate) leg: usize,
    /// Kind of length.
    pub(crate) length: Length,
}

impl Length {
    /// Value in a leg, m.
    fn value(self, leg: &Leg) -> f64 {
        let coordinate = |at: [Number; 3], axis: usize| at[axis].value();
        match self {
            Self::B(joint) => leg.joints[joint].b.value(),
            Self::D(joint) => leg.joints[joint].d.value(),
            Self::R(joint) => leg.joints[joint].r.value(),
            Self::Base(axis) => coordinate(leg.base.at, axis),
            Self::End(axis) => leg
                .end
                .as_ref()
                .map_or(0.0, |end| coordinate(end.point(), axis)),
        }
    }

    /// Adds a change to the value in a leg, m.
    pub(crate) fn add(self, leg: &mut Leg, change: f64) {
        let number = match self {
            Self::B(joint) => &mut leg.joints[joint].b,
            Self::D(joint) => &mut leg.joints[joint].d,
            Self::R(joint) => &mut leg.joints[joint].r,
            Self::Base(axis) => &mut leg.base.at[axis],
            Self::End(axis) => match &mut leg.end {
                Some(End::Rigid(placement)) => &mut placement.at[axis],
                Some(End::Point { at, .. }) => &mut at[axis],
                None => return,
            },
        };
        // Keep the exact number of the description if nothing changes.
        if change != 0.0 {
            *number = Number::float(number.value() + change);
        }
    }

    const fn kind(self) -> ParameterKind {
        match self {
            Self::B(_) | Self::D(_) | Self::R(_) => ParameterKind::Length,
            Self::Base(_) => ParameterKind::BasePoint,
            Self::End(_) => ParameterKind::PlatformPoint,
        }
    }

    /// `d_2_leg1`, `base_x_leg1`, `end_y_leg1`.
    fn name(self, leg: &Leg) -> String {
        let step = |symbol: &str, joint: usize| {
            format!("{symbol}_{}_{}", leg.joints[joint].name, leg.name)
        };
        match self {
            Self::B(joint) => step("b", joint),
            Self::D(joint) => step("d", joint),
            Self::R(joint) => step("r", joint),
            Self::Base(axis) => format!("base_{}_{}", AXES[axis], leg.name),
            Self::End(axis) => format!("end_{}_{}", AXES[axis], leg.name),
        }
    }

    /// All lengths of a leg that may be calibrated.
    ///
    /// Zero lengths of its chain are zero by design, but base and attachment points may be off in
    /// any direction. The constant of a prismatic joint is its position offset.
    fn all(leg: &Leg) -> Vec<Self> {
        let mut all = Self::steps(leg);
        all.extend((0..AXES.len()).map(Self::Base));
        all.extend((0..AXES.len()).map(Self::End));
        all
    }

    /// The lengths of a leg's chain.
    fn steps(leg: &Leg) -> Vec<Self> {
        let mut all = Vec::new();
        for (index, joint) in leg.joints.iter().enumerate() {
            let slides = joint.kind == JointKind::Prismatic;
            let steps = [Self::B(index), Self::D(index), Self::R(index)];
            let steps = steps
                .into_iter()
                .filter(|step| !(slides && *step == Self::R(index)));
            all.extend(steps.filter(|step| step.value(leg) != 0.0));
        }
        all
    }
}

/// Lengths of a serial robot, with their names and values (m).
pub(crate) fn of_tree(mechanism: &Mechanism) -> Vec<(LegLength, String, f64)> {
    let legs = mechanism.legs.iter().enumerate();
    let each = legs.flat_map(|(leg, own)| {
        let of_leg = move |length: Length| {
            (
                LegLength { leg, length },
                length.name(own),
                length.value(own),
            )
        };
        Length::steps(own).into_iter().map(of_leg)
    });
    match mechanism.platform {
        Some(_) => Vec::new(),
        None => each.collect(),
    }
}

/// Lengths of a robot with a platform, and the parameters for calibration.
///
/// Empty for robots without a platform, whose legs close no loops.
pub(crate) fn lengths(mechanism: &Mechanism) -> (Vec<LegLength>, Vec<GeometryParameter>) {
    if mechanism.platform.is_none() {
        return (Vec::new(), Vec::new());
    }
    let legs = mechanism.legs.iter().enumerate();
    let each = legs.flat_map(|(leg, own)| {
        let of_leg = move |length: Length| {
            let parameter = GeometryParameter {
                name: length.name(own),
                kind: length.kind(),
                described: length.value(own),
            };
            (LegLength { leg, length }, parameter)
        };
        Length::all(own).into_iter().map(of_leg)
    });
    each.unzip()
}
