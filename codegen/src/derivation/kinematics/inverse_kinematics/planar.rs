//! Inverse kinematics of two links in a plane.
//!
//! The rule applies if the leg's joints are revolute about parallel axes and its end depends on two
//! of them. The end is A + l1 e(ψ1 + β1) + l2 e(ψ2 + β2) in the plane normal to the axes. With D
//! from A to the end, ρ² = D², a = (ρ² + l1² - l2²)/(2ρ²) and h² = l1²/ρ² - a², the elbow is A + a
//! D ± h D⊥. This takes one square root per leg, whose sign is the working mode of the home
//! configuration. The unit vectors of both links are then algebraic. A last joint that does not
//! move the end's position follows from the platform's orientation.

use super::super::configuration::Configuration;
use super::super::joint::joint_turn;
use super::super::orientation::constant_rotation;
use super::super::rates::parallel;
use super::{Reach, Task};
use crate::cas::{Angle, Arena, CosineSine, Direction, Expr, Matrix3, Number, Ratio, Vector3};
use crate::mechanism::{End, JointKind, Leg};

/// A link in the plane.
struct Link {
    length: Number,
    /// Angle of the line from the link's joint to the next.
    direction: Direction,
}

/// The two links between the leg's first joint and its end.
struct LinkPair {
    first: Link,
    second: Link,
}

/// Solves the leg's angles from the pose. `None` if the rule does not fit the leg.
pub(super) fn solve<'a>(
    task: Task<'a, '_>,
    configuration: &mut Configuration<'a>,
) -> Option<Vec<Reach<'a>>> {
    let Task {
        arena,
        leg,
        first_joint,
        ..
    } = task;
    let links = planar_links(leg, first_joint, configuration)?;
    let prefix = plane(arena, leg);
    let base = Vector3::constant(arena, leg.base.at);
    let first = constant_rotation(arena, leg.base.rotation) * first_origin(arena, leg);
    let distance = task.target - base - first;
    let in_plane = prefix.transposed() * distance;
    let reach = two_links(task, &links, in_plane, configuration)?;
    let last = leg.joints.len() - 1;
    if let Some(axes) = task.axes {
        // The last frame has the platform's orientation, so its turn is known.
        let turn = total_turn(leg, last, first_joint, configuration)?;
        let relative = prefix.transposed() * axes;
        let turned = CosineSine {
            cosine: relative.0[0][0],
            sine: relative.0[1][0],
        };
        configuration.learn(turn, turned);
    }
    Some(vec![reach])
}

/// The two links of a leg, if the rule fits.
fn planar_links(
    leg: &Leg,
    first_joint: usize,
    configuration: &Configuration<'_>,
) -> Option<LinkPair> {
    let end = leg.end.as_ref()?;
    if end.shared_components().len() < 3 {
        return None;
    }
    let joints = &leg.joints;
    let moves = |i: usize| joints[i].kind == JointKind::Revolute && joints[i].is_independent(i);
    let chain = |i: usize| joints[i].antecedent == i.checked_sub(1);
    let plain = |i: usize| i == 0 || parallel(joints[i].alpha) == Some(Ratio::ONE);
    if joints.len() != 3 || !(0..3).all(|i| chain(i) && plain(i)) || !moves(0) || !moves(1) {
        return None;
    }
    let rigid = matches!(end, End::Rigid(_));
    let last_fits = if rigid {
        moves(2)
    } else {
        joints[2].kind == JointKind::Fixed || moves(2)
    };
    if !last_fits {
        return None;
    }
    let link = |i: usize| {
        let turn = total_turn(leg, i - 1, first_joint, configuration)?;
        let direction = turn.plus(&Direction::constant(joints[i].gamma))?;
        let positive = joints[i].d.value() > 0.0;
        positive.then_some(Link {
            length: joints[i].d,
            direction,
        })
    };
    Some(LinkPair {
        first: link(1)?,
        second: link(2)?,
    })
}

/// Sum of all turns about z up to joint `index`, relative to the plane's frame.
fn total_turn(
    leg: &Leg,
    index: usize,
    first_joint: usize,
    configuration: &Configuration<'_>,
) -> Option<Direction> {
    let mut sum = Direction::constant(Angle::ZERO);
    for i in 0..=index {
        if i > 0 || parallel(leg.joints[0].alpha) == Some(Ratio::ONE) {
            sum = sum.plus(&Direction::constant(leg.joints[i].gamma))?;
        }
        sum = sum.plus(&joint_turn(leg, i, first_joint, configuration)?)?;
    }
    Some(sum)
}

/// Orientation of the plane's frame in the base frame: the tilt of the first joint.
fn plane<'a>(arena: &'a Arena, leg: &Leg) -> Matrix3<'a> {
    let base = constant_rotation(arena, leg.base.rotation);
    let first = &leg.joints[0];
    if parallel(first.alpha) == Some(Ratio::ONE) {
        return base;
    }
    let about_z = constant_rotation(arena, [Angle::ZERO, Angle::ZERO, first.gamma]);
    let about_x = constant_rotation(arena, [first.alpha, Angle::ZERO, Angle::ZERO]);
    base * about_z * about_x
}

/// Origin of the first joint in the leg's base frame.
fn first_origin<'a>(arena: &'a Arena, leg: &Leg) -> Vector3<'a> {
    let joint = &leg.joints[0];
    let (cg, sg) = joint.gamma.cosine_and_sine();
    let (ca, sa) = joint.alpha.cosine_and_sine();
    let (d, r, one) = (joint.d, joint.r, Number::ONE);
    Vector3([
        arena.constant_sum([[d, cg, one], [sg, sa, r]]),
        arena.constant_sum([[d, sg, one], [-cg, sa, r]]),
        arena.constant_sum([[joint.b, one, one], [ca, r, one]]),
    ])
}

/// Unit vectors of both links from the end's position in the plane.
fn two_links<'a>(
    task: Task<'a, '_>,
    links: &LinkPair,
    end: Vector3<'a>,
    configuration: &mut Configuration<'a>,
) -> Option<Reach<'a>> {
    let arena = task.arena;
    let LinkPair { first, second } = links;
    let (l1, l2) = (first.length, second.length);
    let named = |value: Expr<'a>, what: &str| value.named(&format!("{what}_{}", task.leg.name));
    let (x, y) = (named(end.x(), "d_x"), named(end.y(), "d_y"));
    let square = named(x * x + y * y, "rho_squared");
    let reciprocal = square.reciprocal();
    // Expressions of lengths are numbers, unless the lengths are inputs.
    let (one, half) = (Number::ONE, Number::ratio(Ratio::new(1, 2)?));
    let over = |number: Number, divisor: Expr<'a>| match divisor.as_number() {
        Some(known) => arena.number(number / known),
        None => arena.number(number) / divisor,
    };
    // a = 1/2 + (l1² - l2²)/(2 ρ²), which is 1/2 for links of one length.
    let difference = arena.constant_sum([[l1, l1, half], [-l2, l2, half]]);
    let a = arena.number(half) + reciprocal * difference;
    let radicand = reciprocal * arena.constant_sum([[l1, l1, one]]) - a * a;
    let radicand = named(radicand, "h_squared");
    // The angle from the first link to the second at home determines the elbow's side.
    let bend = second.direction.plus(&first.direction.negative())?;
    let is_positive = task.turn_at_home(&bend).sin() > 0.0;
    let h = configuration.root(task.first_joint, task.home, radicand, is_positive);
    task.name_root(h, radicand, &format!("h_{}", task.leg.name));
    let (along, across) = ((x * a, y * a), (x * h, y * h));
    // The elbow is to the right of D if the second link bends to the left.
    let (e1x, e1y) = (along.0 + across.1, along.1 - across.0);
    let (e1x, e1y) = (named(e1x, "l1_x"), named(e1y, "l1_y"));
    let [inverse1, inverse2] = [l1, l2].map(|length| over(one, arena.number(length)));
    let unit = CosineSine {
        cosine: e1x * inverse1,
        sine: e1y * inverse1,
    };
    configuration.learn(first.direction.clone(), unit);
    let (e2x, e2y) = (named(x - e1x, "l2_x"), named(y - e1y, "l2_y"));
    let unit = CosineSine {
        cosine: e2x * inverse2,
        sine: e2y * inverse2,
    };
    configuration.learn(second.direction.clone(), unit);
    let product = arena.constant_sum([[l1, l2, one]]);
    let squares = arena.constant_sum([[l1, l1, one], [l2, l2, one]]);
    let cosine = (square - squares) * over(half, product);
    let sine = h * square * over(one, product);
    configuration.learn(bend, CosineSine { cosine, sine });
    Some(Reach { radicand })
}
