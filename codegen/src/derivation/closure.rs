//! The closure of a leg and its reduced Jacobians, eqs. (9) to (13).
//!
//! The leg's end moves with Ṗ = Σ E_i u_i and turns with Σ W_i u_i, where u are the quasi-velocities of
//! [`rates`](super::rates). As many rows of (E, W) as there are u are inverted once per leg; row i of
//! the inverse is a wrench (f_i, n_i) at P that feels joint i alone:
//!
//! - u_i = f_i · Ṗ + n_i · ω, with the platform point's velocity and the platform's angular velocity;
//! - ∂u_i/∂v = (f_i, p × f_i + n_i) D, the reduced Jacobian (p from the platform's origin to P);
//! - u̇_i = f_i · (P̈ - b) + n_i · (ω̇ - β), with the bias accelerations b, β of the leg's end at u̇ = 0.
//!
//! No matrix of the size of the robot is formed, and nothing is divided but by the leg determinants.

use super::bias::BiasTerm;
use super::elimination::{Inverse, Rows, inverse};
use super::frames::{LegFrames, joint_columns};
use super::platform::{Directions, PlatformMotion, PlatformPose};
use super::rates::Rates;
use crate::cas::{Arena, Expr, Matrix3, Number, Vector3};
use crate::mechanism::Leg;
use crate::mechanism::numeric::best_conditioned;
use nalgebra::DMatrix;

/// A wrench as factor × (force, moment).
#[derive(Debug, Clone, Copy)]
pub struct Wrench<'a> {
    /// The factor with the reciprocal of the determinant.
    pub factor: Expr<'a>,
    /// Force.
    pub force: Vector3<'a>,
    /// Moment about P.
    pub moment: Vector3<'a>,
}

/// The closure of a leg: its Jacobian's inverse as wrenches.
#[derive(Debug, Clone)]
pub struct LegClosure<'a> {
    /// f_i of every u_i, in the base frame.
    pub forces: Vec<Vector3<'a>>,
    /// n_i of every u_i, in the base frame.
    pub moments: Vec<Vector3<'a>>,
    /// The same wrenches in the leg's axes, with the reciprocals of the determinants taken out.
    pub wrenches: Vec<Wrench<'a>>,
    /// The determinant that each row was divided by.
    pub determinants: Vec<Expr<'a>>,
    /// The determinant of the leg's Jacobian J_k.
    pub determinant: Expr<'a>,
    /// P in the platform frame.
    pub at: [Number; 3],
    /// From the platform's origin to P, in the base frame.
    pub arm: Vector3<'a>,
    /// The orientation of the leg's axes in the base frame.
    pub axes: Matrix3<'a>,
    /// Wrenches in the leg's axes that no joint feels: of the shared components that are more than the joints,
    /// where the platform moves aside.
    pub(super) blocked: Vec<Wrench<'a>>,
    /// In which directions the independent coordinates move what the leg ends on.
    directions: Directions<'a>,
}

impl<'a> Wrench<'a> {
    /// Its product with a motion, or with what is missed of a place.
    pub(super) fn along(&self, linear: Vector3<'a>, angular: Vector3<'a>) -> Expr<'a> {
        self.factor * (self.force.dot(linear) + self.moment.dot(angular))
    }
}

impl<'a> LegClosure<'a> {
    /// Derives the closure. `rows` are the independent rows of the six-vector; `home` evaluates an
    /// expression at the home configuration. `None` for a structurally singular leg. `over` are shared rows
    /// beside these that a platform which moves aside has to keep.
    #[must_use]
    pub fn new(
        arena: &'a Arena,
        leg: &Leg,
        frames: &LegFrames<'a>,
        rates: &Rates,
        platform: &PlatformPose<'a>,
        [rows, over]: [&[usize]; 2],
        home: &dyn Fn(Expr<'a>) -> f64,
    ) -> Option<Self> {
        let columns = end_columns(arena, leg, frames, rates);
        let matrix: Rows<'a> = rows
            .iter()
            .map(|&row| columns.iter().map(|c| c[row / 3].0[row % 3]).collect())
            .collect();
        let Inverse {
            scaled,
            determinants,
            determinant,
            ..
        } = inverse(&matrix, home)?;
        let wrench = |part: usize, entries: &Vec<Expr<'a>>| {
            let mut vector = Vector3::zero(arena);
            for (&row, &entry) in rows.iter().zip(entries) {
                if row / 3 == part {
                    vector.0[row % 3] = entry;
                }
            }
            vector
        };
        let at = leg.end.as_ref()?.point();
        let arm = platform.arm(at);
        let wrenches: Vec<Wrench<'a>> = scaled
            .iter()
            .map(|row| Wrench {
                factor: row.factor,
                force: wrench(0, &row.entries),
                moment: wrench(1, &row.entries),
            })
            .collect();
        let blocked = over
            .iter()
            .map(|&row| blocked(arena, row, &columns, &wrenches))
            .collect();
        let in_base = |vector: Vector3<'a>, factor| (frames.axes * vector).scaled(factor);
        Some(Self {
            forces: wrenches
                .iter()
                .map(|w| in_base(w.force, w.factor))
                .collect(),
            moments: wrenches
                .iter()
                .map(|w| in_base(w.moment, w.factor))
                .collect(),
            wrenches,
            blocked,
            determinants,
            determinant,
            at,
            arm,
            axes: frames.axes,
            directions: platform.directions().clone(),
        })
    }

    /// ∂u_i/∂v for all u, r numbers each.
    #[must_use]
    pub(crate) fn reduced_jacobian(&self) -> Rows<'a> {
        let row = |(force, moment): (&Vector3<'a>, &Vector3<'a>)| {
            self.directions.components(self.arm, [*force, *moment])
        };
        self.forces.iter().zip(&self.moments).map(row).collect()
    }

    /// Velocity of the leg's end and angular velocity, in the leg's axes, per coordinate of which it is told how they
    /// move what the leg ends on: velocity of its origin and angular velocity.
    fn ends(&self, partials: &[[Vector3<'a>; 2]]) -> Vec<[Vector3<'a>; 2]> {
        let end = |[velocity, turning]: &[Vector3<'a>; 2]| {
            let linear = *velocity + turning.cross(self.arm);
            [self.turned_in(linear), self.turned_in(*turning)]
        };
        partials.iter().map(end).collect()
    }

    /// The velocity of the leg's end per independent coordinate, or per coordinate of which it is told how they move what
    /// the leg ends on, in the axes in which that is seen.
    pub(super) fn end_velocities(
        &self,
        arena: &'a Arena,
        partials: Option<&[[Vector3<'a>; 2]]>,
    ) -> Vec<Vector3<'a>> {
        match partials {
            Some(partials) => {
                let moved =
                    |[velocity, turning]: &[Vector3<'a>; 2]| *velocity + turning.cross(self.arm);
                partials.iter().map(moved).collect()
            }
            None => {
                let columns = self.directions.columns(arena, self.arm).into_iter();
                columns.map(|[velocity, _]| velocity).collect()
            }
        }
    }

    /// The joints' rates per such coordinate: all rows share the velocities of the leg's end.
    #[must_use]
    pub(super) fn rows_on(&self, partials: &[[Vector3<'a>; 2]]) -> Rows<'a> {
        let ends = self.ends(partials);
        let row = |wrench: &Wrench<'a>| {
            let [force, moment] =
                [wrench.force, wrench.moment].map(|part| part.scaled(wrench.factor));
            let on =
                |[linear, angular]: &[Vector3<'a>; 2]| force.dot(*linear) + moment.dot(*angular);
            ends.iter().map(on).collect()
        };
        self.wrenches.iter().map(row).collect()
    }

    /// The forces s on the u on such coordinates, as one force at the leg's end.
    #[must_use]
    pub(super) fn project_on(
        &self,
        partials: &[[Vector3<'a>; 2]],
        forces: &[Expr<'a>],
    ) -> Vec<Expr<'a>> {
        let parts = self.wrenches.iter().zip(forces);
        let zero = Vector3::zero(self.determinant.arena());
        // The products of factors and forces are had for the rows anyway.
        let force = parts.fold(zero, |sum, (w, s)| {
            sum + w.force.scaled(w.factor).scaled(*s)
        });
        let ends = self.ends(partials).into_iter();
        ends.map(|[linear, _]| force.dot(linear)).collect()
    }

    /// ∂u_i/∂v times a factor that divisors of the row vanish in.
    #[must_use]
    pub(super) fn reduced_row(&self, rate: usize, factor: Expr<'a>) -> Vec<Expr<'a>> {
        let wrench = [self.forces[rate], self.moments[rate]].map(|part| part.scaled(factor));
        self.directions.components(self.arm, wrench)
    }

    /// Whether the forces s on the u are projected with fewer products as one force at the leg's end
    /// than row by row: not with a moment at the end, nor where few rows take part.
    #[must_use]
    pub(crate) fn is_shorter_at_end(&self, rows: &Rows<'a>, forces: &[Expr<'a>]) -> bool {
        let parts = || (0..forces.len()).filter(|&i| !forces[i].is_zero());
        if parts().any(|i| !self.moments[i].is_zero()) {
            return false;
        }
        let sum_of = |products: usize| (2 * products).saturating_sub(1);
        let width = rows.first().map_or(0, Vec::len);
        let by_rows = |c: usize| sum_of(parts().filter(|&i| !rows[i][c].is_zero()).count());
        let on_axis = |axis: usize| {
            parts()
                .filter(|&i| !self.forces[i].0[axis].is_zero())
                .count()
        };
        let arms = |axis: usize| {
            (1..3)
                .filter(|k| !self.arm.0[(axis + k) % 3].is_zero())
                .count()
        };
        let at_end: usize = (0..3).map(|a| sum_of(on_axis(a)) + sum_of(arms(a))).sum();
        at_end < (0..width).map(by_rows).sum()
    }

    /// (F, p × F) of the forces s on the u, F = Σ s_i f_i.
    #[must_use]
    pub(crate) fn project_at_end(&self, forces: &[Expr<'a>]) -> Vec<Expr<'a>> {
        let zero = Vector3::zero(self.determinant.arena());
        // Where the end moves along axes, its components are had for the rows of the reduced Jacobian anyway.
        let force = if matches!(self.directions, Directions::Axes(_)) || self.is_in_base() {
            let parts = self.forces.iter().zip(forces);
            parts.fold(zero, |sum, (f, s)| sum + f.scaled(*s))
        } else {
            let parts = self.wrenches.iter().zip(forces);
            let own = parts.fold(zero, |sum, (w, s)| sum + w.force.scaled(w.factor * *s));
            self.axes * own
        };
        self.directions.components(self.arm, [force, zero])
    }

    /// The rows A of what no joint feels, per component of the platform's velocity.
    #[must_use]
    pub(super) fn blocked_rows(&self) -> Rows<'a> {
        let row = |wrench: &Wrench<'a>| {
            let [force, moment] = [wrench.force, wrench.moment]
                .map(|vector| (self.axes * vector).scaled(wrench.factor));
            self.directions.components(self.arm, [force, moment])
        };
        self.blocked.iter().map(row).collect()
    }

    /// The acceleration of the leg's end along a wrench that no joint feels, less its bias.
    #[must_use]
    pub(super) fn blocked_acceleration(
        &self,
        arena: &'a Arena,
        at: usize,
        motion: &PlatformMotion<'a>,
        bias: &[BiasTerm<'a>],
    ) -> Expr<'a> {
        let linear = self.turned_in(motion.point_acceleration(self.at, self.arm));
        let angular = self.turned_in(motion.angular_acceleration);
        let (b, beta) = summed(arena, bias);
        self.blocked[at].along(linear - b, angular - beta)
    }

    /// The quasi-velocities u for a platform motion.
    #[must_use]
    pub fn velocities(&self, motion: &PlatformMotion<'a>) -> Vec<Expr<'a>> {
        let velocity = motion.point_velocity(self.arm);
        self.apply(
            self.turned_in(velocity),
            self.turned_in(motion.angular_velocity),
        )
    }

    /// The derivatives u̇ for a platform motion and the bias accelerations of the leg's end.
    ///
    /// Where the products of the wrenches with the links are known already (in a plane they are the
    /// links' lengths and cosines of joint angles), the bias is taken term by term and the determinant
    /// is divided out last; else the bias is added up as a vector first. `names` are those of the end's
    /// acceleration along each wrench, less the bias of constant product.
    #[must_use]
    pub fn accelerations(
        &self,
        arena: &'a Arena,
        motion: &PlatformMotion<'a>,
        bias: &[BiasTerm<'a>],
        names: &[String],
    ) -> Vec<Expr<'a>> {
        let linear = self.turned_in(motion.point_acceleration(self.at, self.arm));
        let angular = self.turned_in(motion.angular_acceleration);
        if let Some(products) = self.bias_products(arena, bias) {
            let wrenches = self.wrenches.iter().zip(products).zip(names);
            return wrenches
                .map(|((wrench, products), name)| {
                    let start = wrench.force.dot(linear) + wrench.moment.dot(angular);
                    let terms = bias.iter().zip(products);
                    let (constant, other): (Vec<_>, Vec<_>) =
                        terms.partition(|(_, product)| product.as_number().is_some());
                    let less = |sum: Expr<'a>, (term, product): (&BiasTerm<'a>, Expr<'a>)| {
                        sum - term.scalar * product
                    };
                    let along = constant.into_iter().fold(start, less).named(name);
                    wrench.factor * other.into_iter().fold(along, less)
                })
                .collect();
        }
        let (b, beta) = summed(arena, bias);
        self.apply(linear - b, angular - beta)
    }

    /// The products of all wrenches with all bias terms, if each is a constant or a known node.
    fn bias_products(&self, arena: &'a Arena, bias: &[BiasTerm<'a>]) -> Option<Rows<'a>> {
        let known = arena.len();
        let product = |wrench: &Wrench<'a>, term: &BiasTerm<'a>| {
            let product = wrench.force.dot(term.linear) + wrench.moment.dot(term.angular);
            let (_, base) = product.factor_and_base();
            let is_known = base.as_number().is_some() || base.handle().index() < known;
            is_known.then_some(product)
        };
        let row = |wrench| bias.iter().map(|term| product(wrench, term)).collect();
        self.wrenches.iter().map(row).collect()
    }

    /// Σ of the wrenches' products with a motion of the leg's end, all in the leg's axes.
    fn apply(&self, linear: Vector3<'a>, angular: Vector3<'a>) -> Vec<Expr<'a>> {
        let one = |wrench: &Wrench<'a>| {
            if self.is_in_base() {
                // Factor and force are multiplied anyway, for the reduced Jacobian.
                let (f, n) = (wrench.force, wrench.moment);
                let k = wrench.factor;
                return f.scaled(k).dot(linear) + n.scaled(k).dot(angular);
            }
            wrench.factor * (wrench.force.dot(linear) + wrench.moment.dot(angular))
        };
        self.wrenches.iter().map(one).collect()
    }

    fn is_in_base(&self) -> bool {
        self.axes == Matrix3::identity(self.determinant.arena())
    }

    fn turned_in(&self, vector: Vector3<'a>) -> Vector3<'a> {
        self.axes.transposed() * vector
    }
}

/// The bias acceleration as vectors.
fn summed<'a>(arena: &'a Arena, bias: &[BiasTerm<'a>]) -> (Vector3<'a>, Vector3<'a>) {
    let (mut b, mut beta) = (Vector3::zero(arena), Vector3::zero(arena));
    for term in bias {
        b = b + term.linear.scaled(term.scalar);
        beta = beta + term.angular.scaled(term.scalar);
    }
    (b, beta)
}

/// The wrench of a component of the end's motion less what joints give to it: no joint feels it.
fn blocked<'a>(
    arena: &'a Arena,
    row: usize,
    columns: &[[Vector3<'a>; 2]],
    wrenches: &[Wrench<'a>],
) -> Wrench<'a> {
    let mut parts = [Vector3::zero(arena); 2];
    parts[row / 3] = Vector3::unit(arena, row % 3);
    let [mut force, mut moment] = parts;
    for (column, wrench) in columns.iter().zip(wrenches) {
        let part = column[row / 3].0[row % 3] * wrench.factor;
        force = force - wrench.force.scaled(part);
        moment = moment - wrench.moment.scaled(part);
    }
    Wrench {
        factor: arena.one(),
        force,
        moment,
    }
}

/// Of the shared components of a leg's end in the leg's axes those that determine its joint rates best at home,
/// and the others.
pub(super) fn split_rows<'a>(
    arena: &'a Arena,
    leg: &Leg,
    frames: &LegFrames<'a>,
    rates: &Rates,
    home: &dyn Fn(Expr<'a>) -> f64,
) -> [Vec<usize>; 2] {
    let columns = end_columns(arena, leg, frames, rates);
    let shared = leg.shared_components();
    let at_home = DMatrix::from_fn(shared.len(), columns.len(), |row, column| {
        home(columns[column][shared[row] / 3].0[shared[row] % 3])
    });
    let chosen = best_conditioned(&at_home);
    let (own, over): (Vec<usize>, Vec<usize>) =
        (0..shared.len()).partition(|row| chosen.contains(row));
    [own, over].map(|rows| rows.into_iter().map(|row| shared[row]).collect())
}

/// E_i = ∂Ṗ/∂u_i and W_i = ∂ω/∂u_i of the leg's end.
fn end_columns<'a>(
    arena: &'a Arena,
    leg: &Leg,
    frames: &LegFrames<'a>,
    rates: &Rates,
) -> Vec<[Vector3<'a>; 2]> {
    let joint_columns = joint_columns(arena, leg, frames);
    let column = |i: usize| {
        let mut sum = [Vector3::zero(arena); 2];
        for (columns, form) in joint_columns.iter().zip(&rates.joint) {
            let factor = arena.number(form.coefficient(i));
            sum[0] = sum[0] + columns[0].scaled(factor);
            sum[1] = sum[1] + columns[1].scaled(factor);
        }
        sum
    };
    (0..leg.independent().count()).map(column).collect()
}
