//! Parasitic motion: the legs block directions A t = 0 of the platform, which change with its pose.
//! Chains with too few joints block rates of a skeleton in the same way.
//!
//! The independent components v of the velocity t then determine the others. With A split into the
//! columns A_i of independent and A_d of dependent components, t = D v: D is the identity on the
//! independent components and -A_d⁻¹ A_i on the dependent ones. Quantities per component of t, such
//! as rows of reduced Jacobians and forces, are projected on v by D.

use crate::cas::{Arena, Expr, Vector3};
use crate::derivation::kinematics::spatial::SpatialMotion;
use crate::derivation::linear_algebra::constant_columns::Solved;
use crate::derivation::linear_algebra::elimination::Rows;
use crate::derivation::linear_algebra::linear::{apply, transposed};

/// Number of components of a free body's velocity.
pub(crate) const SIX: usize = 6;

/// A row of A: a constraint that a leg imposes on the velocity of the platform or skeleton.
#[derive(Debug, Clone)]
pub(crate) struct BlockedRow<'a> {
    /// The leg.
    pub(crate) leg: usize,
    /// Index of the constraint among those of the leg.
    pub(crate) index: usize,
    /// The row, per component of t.
    pub(crate) entries: Vec<Expr<'a>>,
}

/// The components of a velocity of `count` components that are not independent.
pub(crate) fn dependent_components(count: usize, independent: &[usize]) -> Vec<usize> {
    (0..count).filter(|at| !independent.contains(at)).collect()
}

/// Velocity of a platform with parasitic motion, or of the joints of a skeleton, from its
/// independent coordinates.
#[derive(Debug)]
pub struct ParasiticMotion<'a> {
    /// Number of components of t.
    count: usize,
    /// The independent components of t.
    independent: Vec<usize>,
    /// The dependent components of t.
    pub(crate) dependent: Vec<usize>,
    /// The rows of A.
    pub(crate) rows: Vec<BlockedRow<'a>>,
    /// A, per component of t.
    pub(crate) matrix: Rows<'a>,
    /// A_d.
    pub(crate) solved: Solved<'a>,
    /// -A_d⁻¹ A_i.
    pub(crate) follow: Rows<'a>,
}

impl<'a> ParasiticMotion<'a> {
    /// Solves rows of A, as many as there are dependent components.
    ///
    /// `independent` are the independent ones of the `count` components of t; `home` evaluates an
    /// expression at the home configuration. `None` if the rows do not determine the dependent
    /// components.
    pub(crate) fn new(
        count: usize,
        independent: Vec<usize>,
        rows: Vec<BlockedRow<'a>>,
        home: &dyn Fn(Expr<'a>) -> f64,
    ) -> Option<Self> {
        let dependent = dependent_components(count, &independent);
        let matrix: Rows<'a> = rows.iter().map(|row| row.entries.clone()).collect();
        if rows.len() < dependent.len() {
            return None;
        }
        let part = |columns: &[usize]| -> Rows<'a> {
            let row = |row: &Vec<Expr<'a>>| columns.iter().map(|&c| row[c]).collect();
            matrix.iter().map(row).collect()
        };
        let (own, others) = (part(&independent), part(&dependent));
        let solved = Solved::new(&others, home)?;
        let column = |column: &Vec<Expr<'a>>| -> Vec<Expr<'a>> {
            let found = solved.solve(column).into_iter();
            found.map(|entry| -entry).collect()
        };
        let follow = transposed(&transposed(&own).iter().map(column).collect());
        Some(Self {
            count,
            independent,
            dependent,
            rows,
            matrix,
            solved,
            follow,
        })
    }

    /// t from the independent velocities.
    pub(crate) fn velocity(&self, twist: &[Expr<'a>]) -> Vec<Expr<'a>> {
        self.together(twist, &apply(&self.follow, twist))
    }

    /// Merges independent and dependent components.
    pub(crate) fn together(&self, own: &[Expr<'a>], others: &[Expr<'a>]) -> Vec<Expr<'a>> {
        let component = |at: usize| match self.independent.iter().position(|&own| own == at) {
            Some(place) => own[place],
            None => {
                let place = self.dependent.iter().position(|&own| own == at);
                others[place.unwrap_or_default()]
            }
        };
        (0..self.count).map(component).collect()
    }

    /// Dᵀ times all components: forces, or a row per component of t.
    pub(crate) fn on_independent(&self, all: &[Expr<'a>]) -> Vec<Expr<'a>> {
        let entry = |(column, &own): (usize, &usize)| {
            let others = self.dependent.iter().zip(&self.follow);
            others.fold(all[own], |sum, (&at, row)| sum + row[column] * all[at])
        };
        self.independent.iter().enumerate().map(entry).collect()
    }

    /// Motions per independent coordinate, from motions per component of t.
    pub(crate) fn motions(&self, all: &[SpatialMotion<'a>]) -> Vec<SpatialMotion<'a>> {
        let motion = |(column, &own): (usize, &usize)| {
            let others = self.dependent.iter().zip(&self.follow);
            others.fold(all[own], |sum, (&at, row)| {
                sum.plus_scaled(&all[at], row[column])
            })
        };
        self.independent.iter().enumerate().map(motion).collect()
    }

    /// Columns of D for a platform: velocity of its origin and angular velocity per independent rate.
    pub(crate) fn partials(&self, arena: &'a Arena) -> Vec<SpatialMotion<'a>> {
        let rows = self.platform_jacobian(arena);
        let part = |column: usize, first: usize| {
            Vector3(std::array::from_fn(|axis| rows[first + axis][column]))
        };
        let columns = 0..self.independent.len();
        let column = |c: usize| SpatialMotion {
            linear: part(c, 0),
            angular: part(c, 3),
        };
        columns.map(column).collect()
    }

    /// D, with a row per component of t.
    pub(crate) fn platform_jacobian(&self, arena: &'a Arena) -> Rows<'a> {
        let count = self.independent.len();
        let unit = |at: usize| (0..count).map(move |c| arena.integer(i64::from(c == at)));
        let row = |at: usize| match self.independent.iter().position(|&own| own == at) {
            Some(place) => unit(place).collect(),
            None => {
                let place = self.dependent.iter().position(|&own| own == at);
                self.follow[place.unwrap_or_default()].clone()
            }
        };
        (0..self.count).map(row).collect()
    }
}
