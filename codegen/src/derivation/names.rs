//! Names of intermediate values, which make generated code follow the derivation.
//!
//! A name belongs to a value: every node of that value gets it, in whatever form the search writes
//! the value; the negative is called `minus_…`. Names do not change a program, since naming a value
//! does not make it needed. `naming` has the names of quantities that the derivation itself does
//! not use.

use crate::cas::{Expr, Vector3};
use crate::mechanism::{Leg, TwistCoordinate};

/// The coordinate axes in names.
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// Names to assign. Among equal or opposite values, the first that needs no `minus_` keeps its
/// name.
#[derive(Debug, Default)]
pub(super) struct Names<'a>(Vec<(Expr<'a>, String)>);

impl<'a> Names<'a> {
    pub(super) fn one(&mut self, value: Expr<'a>, name: impl Into<String>) {
        self.0.push((value, name.into()));
    }

    /// Adds `what_x_where`, `what_y_where`, `what_z_where`.
    pub(super) fn vector(&mut self, vector: Vector3<'a>, what: &str, place: &str) {
        for (component, axis) in vector.0.iter().zip(AXES) {
            self.one(*component, joined(&[what, axis, place]));
        }
    }

    /// Assigns all names.
    pub(super) fn give(self) {
        let (negative, positive): (Vec<_>, Vec<_>) = self
            .0
            .into_iter()
            .partition(|(value, _)| value.handle().is_negative());
        for (value, name) in positive.into_iter().chain(negative) {
            let _ = value.named(&name);
        }
    }
}

/// Joins the nonempty parts of a name by underscores.
pub(super) fn joined(parts: &[&str]) -> String {
    let parts: Vec<&str> = parts
        .iter()
        .copied()
        .filter(|part| !part.is_empty())
        .collect();
    parts.join("_")
}

/// Label of a twist coordinate: `vx` or `wz`.
pub(super) fn coordinate_label(coordinate: &TwistCoordinate) -> String {
    match coordinate {
        TwistCoordinate::Linear(axis) => format!("v{}", AXES[*axis]),
        TwistCoordinate::Angular(axis) => format!("w{}", AXES[*axis]),
    }
}

/// Whether accelerations are those of the robot, or the bias at zero independent accelerations.
///
/// Names of the latter contain `bias`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Accelerations {
    are_bias: bool,
}

impl Accelerations {
    /// The kind of a motion with these independent accelerations.
    pub(super) fn new(independent: &[Expr<'_>]) -> Self {
        Self {
            are_bias: independent.iter().all(|a| a.is_zero()),
        }
    }

    pub(super) fn name(self, what: &str) -> String {
        if self.are_bias {
            format!("bias_{what}")
        } else {
            what.to_owned()
        }
    }

    /// `what1_leg2` for every independent joint of a leg.
    pub(super) fn labels(self, leg: &Leg, what: &str) -> Vec<String> {
        let name = |joint: usize| {
            let what = format!("{}{}", self.name(what), leg.joints[joint].suffix());
            joined(&[&what, &leg.name])
        };
        leg.independent().map(name).collect()
    }
}

/// Names the entries of a matrix `what_row_column`.
pub(super) fn name_matrix<'a>(matrix: &[Vec<Expr<'a>>], what: &str) {
    let mut names = Names::default();
    for (i, row) in matrix.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            names.one(*entry, format!("{what}_{}_{}", i + 1, j + 1));
        }
    }
    names.give();
}
