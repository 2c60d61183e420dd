//! Joints of several axes: words for what is otherwise written axis by axis.
//!
//! | type | axes |
//! |---|---|
//! | `cylindrical` | a slide along z and a turn about it |
//! | `universal` | turns about z and about x |
//! | `spherical` | turns about z, x and y |
//! | `planar` | slides along x and y, a turn about z |
//!
//! The first axis is where the table puts it. From one axis to the next the frame is turned by γ = α = 90°, which
//! puts z where x was: three such steps lead back to where they started, and a spherical joint is far from the
//! positions at which its first and last axes are parallel. The bodies between the axes have no mass, and the last
//! axis, which moves the body behind the joint, has the joint's name: a universal joint `cross` has the axes
//! `cross_1` and `cross`.

use super::joint_shape::JointShape;
use super::model::{JointKind, Spanned};
use super::reader::Item;
use crate::diagnostic::Code;
use overact_core::StandardParameter;

/// A word for a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Word {
    /// A joint of one axis, or none.
    Simple(JointKind),
    Cylindrical,
    Universal,
    Spherical,
    Planar,
}

/// The words of `type`.
pub(super) const WORDS: [(&str, Word); 7] = [
    ("revolute", Word::Simple(JointKind::Revolute)),
    ("prismatic", Word::Simple(JointKind::Prismatic)),
    ("fixed", Word::Simple(JointKind::Fixed)),
    ("cylindrical", Word::Cylindrical),
    ("universal", Word::Universal),
    ("spherical", Word::Spherical),
    ("planar", Word::Planar),
];

/// An axis of a joint: what its name ends with if it is not the last, its kind, and whether the frame is turned before it.
#[derive(Debug, Clone, Copy)]
struct Axis(&'static str, JointKind, bool);

impl Word {
    /// The axes of a joint of several.
    const fn axes(self) -> &'static [Axis] {
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
        }
    }

    /// Kind of the joint that the table's own keys describe: the first axis.
    pub(super) fn first(self) -> JointKind {
        match self {
            Self::Simple(kind) => kind,
            other => other
                .axes()
                .first()
                .map_or(JointKind::Revolute, |axis| axis.1),
        }
    }

    /// Kind of the joint whose body the next one starts from.
    pub(super) fn last(self) -> JointKind {
        let last = self.axes().last();
        last.map_or_else(|| self.first(), |axis| axis.1)
    }

    /// How many joints it stands for.
    pub(super) fn count(self) -> usize {
        self.axes().len().max(1)
    }

    /// Reports what is said of a joint of several axes that only one of one axis can have.
    pub(super) fn check<'i, 'c: 'i, 't: 'c>(
        self,
        said: impl IntoIterator<Item = &'i Item<'c, 't>>,
    ) {
        if let Self::Simple(_) = self {
            return;
        }
        for item in said {
            let message = format!("`{}` is said of a joint of one axis", item.key.value);
            let help = "write the axes of this joint as joints of their own, of type \"revolute\" and \"prismatic\"";
            item.context
                .report(item.error(Code::CONTRADICTION, message).help(help));
        }
    }

    /// The joint as its axes. `first` is what its table says, with the parameters of the last body; `at` is the
    /// number of the first axis in the leg.
    pub(super) fn split<'c, 't>(
        self,
        first: JointShape<'c, 't>,
        at: usize,
    ) -> Vec<JointShape<'c, 't>> {
        let axes = self.axes();
        if axes.is_empty() {
            return vec![first];
        }
        let (name, span) = (first.name.clone(), first.span.clone());
        let (parameters, kind) = (first.parameters.clone(), first.kind.clone());
        let own = |axis: &Axis| match axis.0 {
            "" => name.clone(),
            ending => Spanned::new(format!("{}_{ending}", name.value), name.span.clone()),
        };
        // Between the axes there is friction, and nothing that has a mass.
        let between = |axis: &Axis| -> Vec<StandardParameter> {
            let of_joint = parameters.iter().copied().filter(|p| !p.is_inertial());
            match axis.1 {
                JointKind::Fixed => Vec::new(),
                _ => of_joint.collect(),
            }
        };
        let mut joints = vec![first];
        for (place, axis) in axes.iter().enumerate().skip(1) {
            joints.push(JointShape {
                name: own(axis),
                kind: Spanned::new(axis.1, kind.span.clone()),
                antecedent: (at + place).checked_sub(1),
                steps: [const { None }; 6],
                turned: axis.2,
                actuated: false,
                parameters: Vec::new(),
                spring: None,
                known: None,
                stribeck: None,
                load: None,
                span: span.clone(),
            });
        }
        let last = joints.len() - 1;
        for (place, (joint, axis)) in joints.iter_mut().zip(axes).enumerate() {
            joint.name = own(axis);
            joint.parameters = match place == last {
                true => parameters.clone(),
                false => between(axis),
            };
        }
        joints
    }
}
