//! Closure of a leg and its reduced Jacobians, eqs. (9) to (13).
//!
//! The leg's end has the velocity Ṗ = Σ E_i u_i and the angular velocity Σ W_i u_i, where u are the
//! quasi-velocities of [`rates`](crate::derivation::kinematics::rates). As many rows of (E, W) as
//! there are u are inverted once per leg. Row i of the inverse is a wrench (f_i, n_i) at P that
//! does work on joint i alone:
//!
//! - u_i = f_i · Ṗ + n_i · ω, with the velocity of the platform point and the platform's angular
//!   velocity;
//! - ∂u_i/∂v = (f_i, p × f_i + n_i) D, the reduced Jacobian (p from the platform's origin to P);
//! - u̇_i = f_i · (P̈ - b) + n_i · (ω̇ - β), with the bias accelerations b, β of the leg's end at
//!   u̇ = 0.
//!
//! No matrix of the size of the robot is formed, and the only divisors are the leg determinants.

use super::bias::BiasTerm;
use super::cable::CableCourse;
use crate::cas::{Arena, Expr, Matrix3, Number, Vector3};
use crate::derivation::kinematics::frames::{LegFrames, joint_columns};
use crate::derivation::kinematics::platform::{Directions, PlatformMotion, PlatformPose};
use crate::derivation::kinematics::rates::Rates;
use crate::derivation::kinematics::spatial::{SpatialMotion, Wrench};
use crate::derivation::linear_algebra::elimination::{Inverse, Rows, inverse};
use crate::mechanism::Leg;
use crate::mechanism::numeric::best_conditioned;
use nalgebra::DMatrix;

/// A wrench as factor × (force, moment).
#[derive(Debug, Clone, Copy)]
pub struct FactoredWrench<'a> {
    /// The factor, which contains the reciprocal of the determinant.
    pub factor: Expr<'a>,
    /// Force, and moment about P.
    pub wrench: Wrench<'a>,
}

/// The rows of the six-vector of a leg's end (translation, rotation) that its closure uses.
pub(crate) struct ClosureRows {
    /// Independent rows, as many as the leg has quasi-velocities.
    pub(crate) independent: Vec<usize>,
    /// Further shared rows, which restrict a platform with parasitic motion.
    pub(crate) remaining: Vec<usize>,
}

/// Closure of a leg: the inverse of its Jacobian as wrenches.
#[derive(Debug, Clone)]
pub struct LegClosure<'a> {
    /// f_i of every u_i, in the base frame.
    pub forces: Vec<Vector3<'a>>,
    /// n_i of every u_i, in the base frame.
    pub moments: Vec<Vector3<'a>>,
    /// The same wrenches in the leg's axes, without the reciprocals of the determinants.
    pub wrenches: Vec<FactoredWrench<'a>>,
    /// The determinant by which each row was divided.
    pub determinants: Vec<Expr<'a>>,
    /// The determinant of the leg's Jacobian J_k.
    pub determinant: Expr<'a>,
    /// P in the platform frame.
    pub at: [Number; 3],
    /// Vector from the platform's origin to P, in the base frame.
    pub arm: Vector3<'a>,
    /// Orientation of the leg's axes in the base frame.
    pub axes: Matrix3<'a>,
    /// Wrenches in the leg's axes that do no work on any joint's motion: the constraints on a
    /// platform with parasitic motion.
    ///
    /// There is one for each shared row beyond those of the joints.
    pub(crate) blocked: Vec<FactoredWrench<'a>>,
    /// Directions in which the independent coordinates move the body at the leg's end.
    directions: Directions<'a>,
}

impl<'a> FactoredWrench<'a> {
    /// Product of the wrench with a motion or a small displacement.
    pub(crate) fn along(&self, motion: &SpatialMotion<'a>) -> Expr<'a> {
        self.factor * self.wrench.power(motion)
    }

    /// The wrench with its factor multiplied in.
    fn value(&self) -> Wrench<'a> {
        self.wrench.scaled(self.factor)
    }
}

impl<'a> LegClosure<'a> {
    /// Derives the closure. `home` evaluates an expression at the home configuration.
    ///
    /// `None` for a structurally singular leg.
    #[must_use]
    pub fn new(
        arena: &'a Arena,
        leg: &Leg,
        frames: &LegFrames<'a>,
        rates: &Rates,
        platform: &PlatformPose<'a>,
        rows: &ClosureRows,
        home: &dyn Fn(Expr<'a>) -> f64,
    ) -> Option<Self> {
        let columns = end_columns(arena, leg, frames, rates);
        let independent = &rows.independent;
        let matrix: Rows<'a> = independent
            .iter()
            .map(|&row| columns.iter().map(|c| c.component(row)).collect())
            .collect();
        let Inverse {
            scaled,
            determinants,
            determinant,
            ..
        } = inverse(&matrix, home)?;
        let part = |part: usize, entries: &Vec<Expr<'a>>| {
            let mut vector = Vector3::zero(arena);
            for (&row, &entry) in independent.iter().zip(entries) {
                if row / 3 == part {
                    vector.0[row % 3] = entry;
                }
            }
            vector
        };
        let at = leg.end.as_ref()?.point();
        let arm = platform.arm(at);
        let wrenches: Vec<FactoredWrench<'a>> = scaled
            .iter()
            .map(|row| FactoredWrench {
                factor: row.factor,
                wrench: Wrench {
                    force: part(0, &row.entries),
                    moment: part(1, &row.entries),
                },
            })
            .collect();
        let blocked = rows
            .remaining
            .iter()
            .map(|&row| blocked(arena, row, &columns, &wrenches))
            .collect();
        let in_base = |vector: Vector3<'a>, factor| (frames.axes * vector).scaled(factor);
        Some(Self {
            forces: wrenches
                .iter()
                .map(|w| in_base(w.wrench.force, w.factor))
                .collect(),
            moments: wrenches
                .iter()
                .map(|w| in_base(w.wrench.moment, w.factor))
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

    /// Closure of a cable, whose length is its only u: the wrench is the unit vector of the
    /// straight part, written as factor × force.
    pub(crate) fn of_cable(
        arena: &'a Arena,
        course: &CableCourse<'a>,
        at: [Number; 3],
        platform: &PlatformPose<'a>,
    ) -> Self {
        let zero = Vector3::zero(arena);
        let wrench = Wrench {
            force: course.along,
            moment: zero,
        };
        Self {
            forces: vec![course.along.scaled(course.factor)],
            moments: vec![zero],
            wrenches: vec![FactoredWrench {
                factor: course.factor,
                wrench,
            }],
            determinants: vec![course.divisor],
            determinant: course.divisor,
            at,
            arm: platform.arm(at),
            axes: Matrix3::identity(arena),
            blocked: Vec::new(),
            directions: platform.directions().clone(),
        }
    }

    /// Second derivative of a cable's length: e · P̈ plus the change of direction.
    pub(crate) fn cable_acceleration(
        &self,
        course: &CableCourse<'a>,
        motion: &PlatformMotion<'a>,
        rate: Expr<'a>,
        name: &str,
    ) -> Expr<'a> {
        let along = self.apply(&self.end_acceleration(motion));
        let along = along.into_iter().fold(rate.arena().zero(), |a, b| a + b);
        let along = along.named(name);
        along + course.turning(motion.point_velocity(self.arm), rate)
    }

    /// Transforms the motions of the body at the leg's end to those of other coordinates.
    pub(crate) fn project_directions(
        &mut self,
        project: &dyn Fn(&[SpatialMotion<'a>]) -> Vec<SpatialMotion<'a>>,
    ) {
        self.directions.project(project);
    }

    /// ∂u_i/∂v for all u, r numbers each.
    #[must_use]
    pub(crate) fn reduced_jacobian(&self) -> Rows<'a> {
        let row = |(&force, &moment)| {
            let wrench = Wrench { force, moment };
            self.directions.components(self.arm, wrench)
        };
        self.forces.iter().zip(&self.moments).map(row).collect()
    }

    /// Partial velocities of the leg's end in the leg's axes, from those of the end body's origin.
    fn ends(&self, partials: &[SpatialMotion<'a>]) -> Vec<SpatialMotion<'a>> {
        let end = |partial: &SpatialMotion<'a>| SpatialMotion {
            linear: self.turned_in(partial.linear_at(self.arm)),
            angular: self.turned_in(partial.angular),
        };
        partials.iter().map(end).collect()
    }

    /// Velocity of the leg's end per independent coordinate, in the observer's axes.
    ///
    /// With `partials`, per coordinate of these.
    pub(crate) fn end_velocities(
        &self,
        arena: &'a Arena,
        partials: Option<&[SpatialMotion<'a>]>,
    ) -> Vec<Vector3<'a>> {
        match partials {
            Some(partials) => {
                let moved = |partial: &SpatialMotion<'a>| partial.linear_at(self.arm);
                partials.iter().map(moved).collect()
            }
            None => {
                let columns = self.directions.columns(arena, self.arm).into_iter();
                columns.map(|column| column.linear).collect()
            }
        }
    }

    /// Joint rates per coordinate of `partials`. All rows share the velocities of the leg's end.
    #[must_use]
    pub(crate) fn rows_on(&self, partials: &[SpatialMotion<'a>]) -> Rows<'a> {
        let ends = self.ends(partials);
        let row = |wrench: &FactoredWrench<'a>| {
            let value = wrench.value();
            ends.iter().map(|end| value.power(end)).collect()
        };
        self.wrenches.iter().map(row).collect()
    }

    /// Generalised forces on the coordinates of `partials`: the forces s on the u as one force at
    /// the end.
    #[must_use]
    pub(crate) fn project_on(
        &self,
        partials: &[SpatialMotion<'a>],
        forces: &[Expr<'a>],
    ) -> Vec<Expr<'a>> {
        let parts = self.wrenches.iter().zip(forces);
        let zero = Vector3::zero(self.determinant.arena());
        // The rows need the products of factors and forces anyway.
        let force = parts.fold(zero, |sum, (w, s)| {
            sum + w.wrench.force.scaled(w.factor).scaled(*s)
        });
        let ends = self.ends(partials).into_iter();
        ends.map(|end| force.dot(end.linear)).collect()
    }

    /// ∂u_i/∂v times a factor that cancels divisors of the row.
    #[must_use]
    pub(crate) fn reduced_row(&self, rate: usize, factor: Expr<'a>) -> Vec<Expr<'a>> {
        let wrench = Wrench {
            force: self.forces[rate].scaled(factor),
            moment: self.moments[rate].scaled(factor),
        };
        self.directions.components(self.arm, wrench)
    }

    /// Whether projecting the forces s on the u as one force at the leg's end takes fewer products.
    ///
    /// It does not if the end has a moment, or if few rows take part.
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
        // If the end moves along axes, the rows of the reduced Jacobian need its components anyway.
        let force = if matches!(self.directions, Directions::Axes(_)) || self.is_in_base() {
            let parts = self.forces.iter().zip(forces);
            parts.fold(zero, |sum, (f, s)| sum + f.scaled(*s))
        } else {
            let parts = self.wrenches.iter().zip(forces);
            let own = parts.fold(zero, |sum, (w, s)| {
                sum + w.wrench.force.scaled(w.factor * *s)
            });
            self.axes * own
        };
        let wrench = Wrench {
            force,
            moment: zero,
        };
        self.directions.components(self.arm, wrench)
    }

    /// The rows A of the constraint wrenches, per component of the platform's velocity.
    #[must_use]
    pub(crate) fn blocked_rows(&self) -> Rows<'a> {
        let row = |wrench: &FactoredWrench<'a>| {
            let in_base = |vector: Vector3<'a>| (self.axes * vector).scaled(wrench.factor);
            let wrench = Wrench {
                force: in_base(wrench.wrench.force),
                moment: in_base(wrench.wrench.moment),
            };
            self.directions.components(self.arm, wrench)
        };
        self.blocked.iter().map(row).collect()
    }

    /// Acceleration of the leg's end along a constraint wrench, minus its bias.
    #[must_use]
    pub(crate) fn blocked_acceleration(
        &self,
        arena: &'a Arena,
        at: usize,
        motion: &PlatformMotion<'a>,
        bias: &[BiasTerm<'a>],
    ) -> Expr<'a> {
        let acceleration = self.end_acceleration(motion);
        let bias = summed(arena, bias);
        self.blocked[at].along(&acceleration.minus(&bias))
    }

    /// Quasi-velocities u for a platform motion.
    #[must_use]
    pub fn velocities(&self, motion: &PlatformMotion<'a>) -> Vec<Expr<'a>> {
        let velocity = motion.point_velocity(self.arm);
        self.apply(&SpatialMotion {
            linear: self.turned_in(velocity),
            angular: self.turned_in(motion.angular_velocity),
        })
    }

    /// Acceleration of the leg's end, in the leg's axes.
    fn end_acceleration(&self, motion: &PlatformMotion<'a>) -> SpatialMotion<'a> {
        SpatialMotion {
            linear: self.turned_in(motion.point_acceleration(self.at, self.arm)),
            angular: self.turned_in(motion.angular_acceleration),
        }
    }

    /// Derivatives u̇ for a platform motion and the bias accelerations of the leg's end.
    ///
    /// If the products of the wrenches with the links are known, the bias is computed term by term,
    /// and divided by the determinant last. In a plane they are link lengths and cosines of joint
    /// angles. Otherwise the bias is summed as a vector first. `names` are those of the end's
    /// acceleration along each wrench, minus the bias terms of constant product.
    #[must_use]
    pub fn accelerations(
        &self,
        arena: &'a Arena,
        motion: &PlatformMotion<'a>,
        bias: &[BiasTerm<'a>],
        names: &[String],
    ) -> Vec<Expr<'a>> {
        let acceleration = self.end_acceleration(motion);
        if let Some(products) = self.bias_products(arena, bias) {
            let wrenches = self.wrenches.iter().zip(products).zip(names);
            return wrenches
                .map(|((wrench, products), name)| {
                    let start = wrench.wrench.power(&acceleration);
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
        self.apply(&acceleration.minus(&summed(arena, bias)))
    }

    /// Products of all wrenches with all bias terms, if each is a constant or a known node.
    fn bias_products(&self, arena: &'a Arena, bias: &[BiasTerm<'a>]) -> Option<Rows<'a>> {
        let known = arena.len();
        let product = |wrench: &FactoredWrench<'a>, term: &BiasTerm<'a>| {
            let product = wrench.wrench.power(&term.acceleration);
            let (_, base) = product.factor_and_base();
            let is_known = base.as_number().is_some() || base.handle().index() < known;
            is_known.then_some(product)
        };
        let row = |wrench| bias.iter().map(|term| product(wrench, term)).collect();
        self.wrenches.iter().map(row).collect()
    }

    /// Products of the wrenches with a motion of the leg's end, all in the leg's axes.
    fn apply(&self, motion: &SpatialMotion<'a>) -> Vec<Expr<'a>> {
        let one = |wrench: &FactoredWrench<'a>| {
            if self.is_in_base() {
                // The reduced Jacobian needs the product of factor and force anyway.
                let (f, n) = (wrench.wrench.force, wrench.wrench.moment);
                let k = wrench.factor;
                return f.scaled(k).dot(motion.linear) + n.scaled(k).dot(motion.angular);
            }
            wrench.along(motion)
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

/// The bias acceleration as one sum.
fn summed<'a>(arena: &'a Arena, bias: &[BiasTerm<'a>]) -> SpatialMotion<'a> {
    let still = SpatialMotion::zero(arena);
    bias.iter().fold(still, |sum, term| {
        sum.plus_scaled(&term.acceleration, term.scalar)
    })
}

/// Wrench along a component of the end's motion, made reciprocal to all joints.
fn blocked<'a>(
    arena: &'a Arena,
    row: usize,
    columns: &[SpatialMotion<'a>],
    wrenches: &[FactoredWrench<'a>],
) -> FactoredWrench<'a> {
    let unit = |part: usize| {
        if row / 3 == part {
            Vector3::unit(arena, row % 3)
        } else {
            Vector3::zero(arena)
        }
    };
    let mut rest = Wrench {
        force: unit(0),
        moment: unit(1),
    };
    for (column, own) in columns.iter().zip(wrenches) {
        let part = column.component(row) * own.factor;
        rest.force = rest.force - own.wrench.force.scaled(part);
        rest.moment = rest.moment - own.wrench.moment.scaled(part);
    }
    FactoredWrench {
        factor: arena.one(),
        wrench: rest,
    }
}

/// Splits the shared rows of a leg's end, in the leg's axes.
///
/// The independent rows are those that best determine the joint rates at home.
pub(crate) fn split_rows<'a>(
    arena: &'a Arena,
    leg: &Leg,
    frames: &LegFrames<'a>,
    rates: &Rates,
    home: &dyn Fn(Expr<'a>) -> f64,
) -> ClosureRows {
    let columns = end_columns(arena, leg, frames, rates);
    let shared = leg.shared_components();
    let at_home = DMatrix::from_fn(shared.len(), columns.len(), |row, column| {
        home(columns[column].component(shared[row]))
    });
    let chosen = best_conditioned(&at_home);
    let (independent, remaining) =
        (0..shared.len()).partition::<Vec<_>, _>(|row| chosen.contains(row));
    let shared = |rows: Vec<usize>| rows.into_iter().map(|row| shared[row]).collect();
    ClosureRows {
        independent: shared(independent),
        remaining: shared(remaining),
    }
}

/// E_i = ∂Ṗ/∂u_i and W_i = ∂ω/∂u_i of the leg's end.
fn end_columns<'a>(
    arena: &'a Arena,
    leg: &Leg,
    frames: &LegFrames<'a>,
    rates: &Rates,
) -> Vec<SpatialMotion<'a>> {
    let joint_columns = joint_columns(arena, leg, frames);
    let column = |i: usize| {
        let still = SpatialMotion::zero(arena);
        let parts = joint_columns.iter().zip(&rates.joint);
        parts.fold(still, |sum, (column, form)| {
            sum.plus_scaled(column, arena.number(form.coefficient(i)))
        })
    };
    (0..leg.independent().count()).map(column).collect()
}
