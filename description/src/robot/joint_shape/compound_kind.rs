//! Joints of several axes: keywords for sequences of joints with one axis.
//!
//! | type | axes |
//! |---|---|
//! | `cylindrical` | a slide along z and a turn about it |
//! | `universal` | turns about z and about x |
//! | `spherical` | turns about z, x and y |
//! | `planar` | slides along x and y, a turn about z |
//! | `helical` | a slide along z, coupled to a turn about it |
//!
//! The first axis is at the place of the table. Between successive axes the frame rotates by
//! γ = α = 90°, which puts z where x was. Three such rotations are the identity, and a spherical
//! joint is far from positions with parallel first and last axes. The bodies between the axes have
//! no mass. The last axis, which moves the body of the joint, has the joint's name: a universal
//! joint `cross` has the axes `cross_1` and `cross`. A helical joint has one variable, that of its
//! turn, and all properties of a joint with one axis.

use crate::diagnostic::Code;
use crate::robot::model::JointKind;
use crate::toml_text::reader::Item;

/// A keyword of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CompoundJointKind {
    /// A joint of one axis or none.
    Simple(JointKind),
    Cylindrical,
    Universal,
    Spherical,
    Planar,
    Helical,
}

/// Values of `type`.
pub(crate) const WORDS: [(&str, CompoundJointKind); 8] = [
    ("revolute", CompoundJointKind::Simple(JointKind::Revolute)),
    ("prismatic", CompoundJointKind::Simple(JointKind::Prismatic)),
    ("fixed", CompoundJointKind::Simple(JointKind::Fixed)),
    ("cylindrical", CompoundJointKind::Cylindrical),
    ("universal", CompoundJointKind::Universal),
    ("spherical", CompoundJointKind::Spherical),
    ("planar", CompoundJointKind::Planar),
    ("helical", CompoundJointKind::Helical),
];

/// An axis of a joint: suffix of its name unless it is the last, its kind, and whether the frame
/// rotates before it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axis(
    pub(crate) &'static str,
    pub(crate) JointKind,
    pub(crate) bool,
);

impl CompoundJointKind {
    /// The axes of a joint with several.
    pub(crate) const fn axes(self) -> &'static [Axis] {
        use JointKind::{Fixed, Prismatic, Revolute};
        match self {
            Self::Simple(_) => &[],
            Self::Cylindrical => &[Axis("slide", Prismatic, false), Axis("", Revolute, false)],
            Self::Universal => &[Axis("1", Revolute, false), Axis("", Revolute, true)],
            Self::Spherical => &[
                Axis("1", Revolute, false),
                Axis("2", Revolute, true),
                Axis("", Revolute, true),
            ],
            Self::Planar => &[
                Axis("place", Fixed, false),
                Axis("x", Prismatic, true),
                Axis("y", Prismatic, true),
                Axis("", Revolute, true),
            ],
            Self::Helical => &[Axis("slide", Prismatic, false), Axis("", Revolute, false)],
        }
    }

    /// Kind of the joint described by the table's own keys: the first axis.
    pub(crate) fn first(self) -> JointKind {
        match self {
            Self::Simple(kind) => kind,
            other => other
                .axes()
                .first()
                .map_or(JointKind::Revolute, |axis| axis.1),
        }
    }

    /// Kind of the joint whose body carries the next one.
    pub(crate) fn last(self) -> JointKind {
        let last = self.axes().last();
        last.map_or_else(|| self.first(), |axis| axis.1)
    }

    /// Number of joints with one axis.
    pub(crate) fn count(self) -> usize {
        self.axes().len().max(1)
    }

    /// Reports keys of joints with one axis in a joint with several.
    pub(crate) fn check<'i, 'c: 'i, 't: 'c>(
        self,
        said: impl IntoIterator<Item = &'i Item<'c, 't>>,
    ) {
        if let Self::Simple(_) | Self::Helical = self {
            return;
        }
        for item in said {
            let message = format!("`{}` is for joints of one axis only", item.key.value);
            let help = "write the axes of this joint as separate joints, of type \"revolute\" and \"prismatic\"";
            item.context
                .report(item.error(Code::CONTRADICTION, message).help(help));
        }
    }

    /// Noun of the joint with its article.
    fn with_article(self) -> &'static str {
        match self {
            Self::Simple(JointKind::Revolute) => "a revolute joint",
            Self::Simple(JointKind::Prismatic) => "a prismatic joint",
            Self::Simple(JointKind::Fixed) => "a fixed joint",
            Self::Cylindrical => "a cylindrical joint",
            Self::Universal => "a universal joint",
            Self::Spherical => "a spherical joint",
            Self::Planar => "a planar joint",
            Self::Helical => "a helical joint",
        }
    }

    /// Where the variables of a joint may be used, for an error about one in another key.
    pub(crate) fn variables(self, name: &str) -> String {
        let own = self.with_article();
        let key = match self {
            Self::Simple(JointKind::Fixed) => {
                return format!(
                    "{own} has no variable: use type = \"revolute\" or \"prismatic\", or leave the variable out"
                );
            }
            Self::Simple(JointKind::Revolute) | Self::Helical => {
                return format!("the variable of {own} is the angle `q` in theta");
            }
            Self::Simple(JointKind::Prismatic) => {
                return format!("the variable of {own} is the length `q` in r");
            }
            Self::Cylindrical => Some("r"),
            Self::Universal | Self::Spherical => Some("theta"),
            Self::Planar => None,
        };
        let axes = self.axes().iter().filter_map(|axis| {
            let what = match axis.1 {
                JointKind::Revolute => "turn",
                JointKind::Prismatic => "slide",
                JointKind::Fixed => return None,
            };
            let called = match axis.0 {
                "" => name.to_owned(),
                ending => format!("{name}_{ending}"),
            };
            Some(format!("`{called}` ({what})"))
        });
        let axes: Vec<String> = axes.collect();
        let rest = match key {
            Some(key) => format!(
                "`{key}` may hold `q`, the variable of the first, and the other keys are constants that place it"
            ),
            None => "gamma, b, alpha, d, theta and r are constants that place them".to_owned(),
        };
        format!("{own} has the axes {}: {rest}", axes.join(", "))
    }
}
