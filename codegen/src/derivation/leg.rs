//! A leg in the base frame, its closure and its reduced Jacobians, eqs. (9) to (13).
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
use super::configuration::Configuration;
use super::elimination::{Inverse, Rows, inverse};
use super::orientation::Orientation;
use super::platform::{PlatformMotion, PlatformPose};
use super::rates::Rates;
use crate::cas::{Arena, Direction, Expr, Matrix3, Number, Vector3};
use crate::mechanism::{JointKind, Leg, TwistCoordinate};

/// Position and orientation of a joint's frame, written in the axes that were chosen for its leg.
#[derive(Debug, Clone)]
pub struct Frame<'a> {
    /// The frame's orientation.
    pub rotation: Matrix3<'a>,
    /// From the antecedent frame's origin to this one's.
    pub link: Vector3<'a>,
    /// Origin relative to the leg's base frame origin.
    pub origin: Vector3<'a>,
}

impl<'a> Frame<'a> {
    /// The direction of the joint's axis.
    #[must_use]
    pub fn axis(&self) -> Vector3<'a> {
        self.rotation.column(2)
    }
}

/// The frames of a leg.
///
/// All vectors are written in one set of axes: those of the base, or of a frame on the way along the
/// leg. In the axes of a joint near the middle most components of the leg's Jacobian are zero, and what
/// is left is triangular, at the price of turning the end's motion into them.
#[derive(Debug, Clone)]
pub struct LegFrames<'a> {
    /// One per joint.
    pub frames: Vec<Frame<'a>>,
    /// The orientation of the axes in the robot's base frame.
    pub axes: Matrix3<'a>,
}

impl<'a> LegFrames<'a> {
    /// Frames of all joints in the axes of the station of that number ([`Orientation::stations`]; 0
    /// is the base). `None` if there is no such station or a sine or cosine does not follow from the
    /// configuration.
    #[must_use]
    pub fn new(
        arena: &'a Arena,
        leg: &Leg,
        first_joint: usize,
        configuration: &Configuration<'a>,
        station: usize,
    ) -> Option<Self> {
        let orientations = Orientation::of_leg(leg, first_joint, configuration)?;
        let axes = Orientation::stations(&orientations).get(station)?.clone();
        let in_axes = |of: &Orientation| of.relative(&axes, arena, configuration);
        let base = in_axes(&Orientation::fixed(leg.base.rotation))?;
        let mut frames: Vec<Frame<'a>> = Vec::new();
        for (index, joint) in leg.joints.iter().enumerate() {
            // The joint's own sine and cosine come first: what turns out to be equal to them, a
            // determinant for instance, is then written as them.
            let theta = joint_turn(leg, index, first_joint, configuration)?;
            let _ = configuration.unit(&theta.plus(&Direction::constant(joint.gamma))?)?;
            let (from_rotation, from_origin) = match joint.antecedent {
                Some(a) => (frames[a].rotation, frames[a].origin),
                None => (base, Vector3::zero(arena)),
            };
            let rotation = in_axes(&orientations[index])?;
            let link = from_rotation * link_vector(arena, leg, index, first_joint, configuration)?;
            let origin = from_origin + link;
            frames.push(Frame {
                rotation,
                link,
                origin,
            });
        }
        let axes = axes.relative(&Orientation::default(), arena, configuration)?;
        Some(Self { frames, axes })
    }

    /// The vector from the origin of joint `index` to that of the last joint, along the links.
    #[must_use]
    pub fn to_end(&self, arena: &'a Arena, leg: &Leg, index: usize) -> Vector3<'a> {
        let mut sum = Vector3::zero(arena);
        let mut at = leg.joints.len() - 1;
        while at != index {
            sum = self.frames[at].link + sum;
            match leg.joints[at].antecedent {
                Some(a) => at = a,
                None => break,
            }
        }
        sum
    }
}

/// The turn θ of a joint about its z axis.
pub(super) fn joint_turn(
    leg: &Leg,
    index: usize,
    first_joint: usize,
    configuration: &Configuration<'_>,
) -> Option<Direction> {
    let joint = &leg.joints[index];
    let mut turn = Direction::constant(joint.theta);
    if joint.kind == JointKind::Revolute {
        for (of, factor) in &joint.variable {
            let at = first_joint + leg.independent().position(|i| i == *of)?;
            turn = turn.plus(&configuration.joint_angle(at).times(*factor)?)?;
        }
    }
    Some(turn)
}

/// The value of a joint's position, for prismatic joints.
pub(super) fn joint_slide<'a>(
    arena: &'a Arena,
    leg: &Leg,
    index: usize,
    first_joint: usize,
    configuration: &Configuration<'a>,
) -> Option<Expr<'a>> {
    let joint = &leg.joints[index];
    let mut slide = arena.number(joint.r);
    if joint.kind == JointKind::Prismatic {
        for (of, factor) in &joint.variable {
            let at = first_joint + leg.independent().position(|i| i == *of)?;
            slide = slide + configuration.joint_position(at)? * Number::ratio(*factor);
        }
    }
    Some(slide)
}

/// From the antecedent frame's origin to the joint frame's origin, in the antecedent frame:
/// Rot(z, γ) (d, 0, b) + r z_j.
pub(super) fn link_vector<'a>(
    arena: &'a Arena,
    leg: &Leg,
    index: usize,
    first_joint: usize,
    configuration: &Configuration<'a>,
) -> Option<Vector3<'a>> {
    let joint = &leg.joints[index];
    let (cg, sg) = joint.gamma.cosine_and_sine();
    let along = Vector3::constant(arena, [joint.d * cg, joint.d * sg, joint.b]);
    let axis = joint_axis(arena, leg, index);
    let slide = joint_slide(arena, leg, index, first_joint, configuration)?;
    Some(along + axis.scaled(slide))
}

/// The joint's z axis in the antecedent frame.
pub(super) fn joint_axis<'a>(arena: &'a Arena, leg: &Leg, index: usize) -> Vector3<'a> {
    let joint = &leg.joints[index];
    let (cg, sg) = joint.gamma.cosine_and_sine();
    let (ca, sa) = joint.alpha.cosine_and_sine();
    Vector3::constant(arena, [sg * sa, -(cg * sa), ca])
}

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
}

impl<'a> LegClosure<'a> {
    /// Derives the closure. `rows` are the independent rows of the six-vector; `home` evaluates an
    /// expression at the home configuration. `None` for a structurally singular leg.
    #[must_use]
    pub fn new(
        arena: &'a Arena,
        leg: &Leg,
        frames: &LegFrames<'a>,
        rates: &Rates,
        platform: &PlatformPose<'a>,
        rows: &[usize],
        home: &dyn Fn(Expr<'a>) -> f64,
    ) -> Option<Self> {
        let joint_columns = joint_columns(arena, leg, frames);
        let count = leg.independent().count();
        let column = |i: usize| {
            let mut sum = [Vector3::zero(arena); 2];
            for (columns, form) in joint_columns.iter().zip(&rates.joint) {
                let factor = arena.number(form.coefficient(i));
                sum[0] = sum[0] + columns[0].scaled(factor);
                sum[1] = sum[1] + columns[1].scaled(factor);
            }
            sum
        };
        let columns: Vec<[Vector3<'a>; 2]> = (0..count).map(column).collect();
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
            determinants,
            determinant,
            at,
            arm,
            axes: frames.axes,
        })
    }

    /// ∂u_i/∂v for all u, r numbers each.
    #[must_use]
    pub fn reduced_jacobian(&self, twist: &[TwistCoordinate]) -> Rows<'a> {
        let row =
            |(force, moment): (&Vector3<'a>, &Vector3<'a>)| self.on_twist(twist, *force, *moment);
        self.forces.iter().zip(&self.moments).map(row).collect()
    }

    /// Whether the forces s on the u are projected with fewer products as one force at the leg's end
    /// than row by row: not with a moment at the end, nor where few rows take part.
    #[must_use]
    pub fn is_shorter_at_end(&self, rows: &Rows<'a>, forces: &[Expr<'a>]) -> bool {
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
    pub fn project_at_end(&self, twist: &[TwistCoordinate], forces: &[Expr<'a>]) -> Vec<Expr<'a>> {
        let zero = Vector3::zero(self.determinant.arena());
        let parts = self.forces.iter().zip(forces);
        let force = parts.fold(zero, |sum, (f, s)| sum + f.scaled(*s));
        self.on_twist(twist, force, zero)
    }

    /// The components of a force and a moment at P on the twist coordinates.
    fn on_twist(
        &self,
        twist: &[TwistCoordinate],
        force: Vector3<'a>,
        moment: Vector3<'a>,
    ) -> Vec<Expr<'a>> {
        let turned = self.arm.cross(force) + moment;
        let entry = |c: &TwistCoordinate| match c {
            TwistCoordinate::Linear(axis) => force.0[*axis],
            TwistCoordinate::Angular(axis) => turned.0[*axis],
        };
        twist.iter().map(entry).collect()
    }

    /// A row of the six-vector (Ṗ, ω) of the platform point per twist coordinate.
    #[must_use]
    pub fn platform_row(
        &self,
        row: usize,
        twist: &[TwistCoordinate],
        arena: &'a Arena,
    ) -> Vec<Expr<'a>> {
        let entry = |c: &TwistCoordinate| {
            let unit = |axis: usize| Vector3::unit(arena, axis);
            let zero = Vector3::zero(arena);
            let (linear, angular) = match c {
                TwistCoordinate::Linear(axis) => (unit(*axis), zero),
                TwistCoordinate::Angular(axis) => (unit(*axis).cross(self.arm), unit(*axis)),
            };
            [linear, angular][row / 3].0[row % 3]
        };
        twist.iter().map(entry).collect()
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
        let (mut b, mut beta) = (Vector3::zero(arena), Vector3::zero(arena));
        for term in bias {
            b = b + term.linear.scaled(term.scalar);
            beta = beta + term.angular.scaled(term.scalar);
        }
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

/// ∂Ṗ/∂q̇ and ∂ω/∂q̇ of every joint on the path to the end.
fn joint_columns<'a>(arena: &'a Arena, leg: &Leg, frames: &LegFrames<'a>) -> Vec<[Vector3<'a>; 2]> {
    let zero = Vector3::zero(arena);
    let mut columns = vec![[zero; 2]; leg.joints.len()];
    for index in path_to_end(leg) {
        let axis = frames.frames[index].axis();
        columns[index] = match leg.joints[index].kind {
            JointKind::Revolute => [axis.cross(frames.to_end(arena, leg, index)), axis],
            JointKind::Prismatic => [axis, zero],
            JointKind::Fixed => [zero; 2],
        };
    }
    columns
}

/// ∂Ṗ/∂q̇ and ∂ω/∂q̇ of the independent joints, dependent ones added to those they follow.
pub(super) fn independent_columns<'a>(
    arena: &'a Arena,
    leg: &Leg,
    frames: &LegFrames<'a>,
) -> Vec<[Vector3<'a>; 2]> {
    let joint_columns = joint_columns(arena, leg, frames);
    leg.independent()
        .map(|own| {
            let mut sum = [Vector3::zero(arena); 2];
            for (joint, columns) in leg.joints.iter().zip(&joint_columns) {
                for (of, factor) in &joint.variable {
                    if *of == own {
                        let factor = arena.number(Number::ratio(*factor));
                        sum[0] = sum[0] + columns[0].scaled(factor);
                        sum[1] = sum[1] + columns[1].scaled(factor);
                    }
                }
            }
            sum
        })
        .collect()
}

/// The joints from the base to the end.
pub(super) fn path_to_end(leg: &Leg) -> Vec<usize> {
    let mut path = Vec::new();
    let mut at = leg.joints.len().checked_sub(1);
    while let Some(index) = at {
        path.push(index);
        at = leg.joints[index].antecedent;
    }
    path
}
