//! Quasi-velocities of a leg: absolute rates along runs of parallel axes.
//!
//! If consecutive revolute axes are parallel, the bodies rotate with the sum of the joint rates, in
//! which closure and dynamics are simplest. So joint j of a leg has the quasi-velocity u_j = q̇_j +
//! s u_i. Here i is the preceding revolute joint of its run of parallel axes, and s = ±1 the
//! relative direction of the axes. A prismatic joint has u_j = q̇_j. Every joint rate, also of
//! coupled joints, is a linear form of the u with constant coefficients. If a joint is coupled to a
//! later one, as an ankle to the toe, every u is a joint rate: a sum along the run would contain
//! itself.

use crate::cas::{Angle, Arena, Expr, Number, Ratio};
use crate::mechanism::{Joint, JointKind, Leg};

/// A linear form Σ coefficient × u_i.
#[derive(Debug, Clone, Default)]
pub struct Form(Vec<(usize, Number)>);

impl Form {
    fn unit(index: usize) -> Self {
        Self(vec![(index, Number::ONE)])
    }

    fn add(&mut self, other: &Self, factor: Number) {
        for (index, coefficient) in &other.0 {
            let part = *coefficient * factor;
            match self.0.iter_mut().find(|(i, _)| i == index) {
                Some((_, own)) => *own = *own + part,
                None => self.0.push((*index, part)),
            }
        }
        self.0.retain(|(_, c)| !c.is_zero());
        self.0.sort_by_key(|(i, _)| *i);
    }

    /// The coefficient of u_i.
    #[must_use]
    pub fn coefficient(&self, index: usize) -> Number {
        self.0
            .iter()
            .find(|(i, _)| *i == index)
            .map_or(Number::ZERO, |(_, c)| *c)
    }

    /// Value of the form for given u.
    #[must_use]
    pub fn value<'a>(&self, arena: &'a Arena, u: &[Expr<'a>]) -> Expr<'a> {
        self.0
            .iter()
            .fold(arena.zero(), |sum, (i, c)| sum + u[*i] * *c)
    }

    /// The form applied to rows: Σ coefficient × row_i.
    #[must_use]
    pub fn row<'a>(&self, arena: &'a Arena, rows: &[Vec<Expr<'a>>]) -> Vec<Expr<'a>> {
        let width = rows.first().map_or(0, Vec::len);
        (0..width)
            .map(|c| {
                self.0
                    .iter()
                    .fold(arena.zero(), |sum, (i, k)| sum + rows[*i][c] * *k)
            })
            .collect()
    }
}

/// Joint rates of a leg as forms of its quasi-velocities.
#[derive(Debug, Clone)]
pub struct Rates {
    /// q̇ of every joint of the leg (fixed joints: empty).
    pub joint: Vec<Form>,
    /// Angular rate of each joint's body about its z axis, as far as its run of parallel axes
    /// causes it.
    pub turning: Vec<Form>,
    /// For each joint that continues such a run, the sign of its axis relative to the antecedent's.
    pub run: Vec<Option<Ratio>>,
}

impl Rates {
    /// Whether a joint's rate is a quasi-velocity that alone moves the bodies after it.
    ///
    /// It is not within a parallel run or with coupled joints.
    #[must_use]
    pub(crate) fn is_alone(&self, joint: usize) -> bool {
        let Some(&own) = self.own(&[joint]).first() else {
            return false;
        };
        let others = self.joint.iter().enumerate().filter(|(j, _)| *j != joint);
        others
            .clone()
            .all(|(_, form)| form.coefficient(own).is_zero())
    }

    /// The quasi-velocities that are rates of the given joints.
    #[must_use]
    pub fn own(&self, joints: &[usize]) -> Vec<usize> {
        let own = |j: &usize| match self.joint[*j].0.as_slice() {
            [(index, factor)] if *factor == Number::ONE => Some(*index),
            _ => None,
        };
        joints.iter().filter_map(own).collect()
    }

    /// The forms of a leg. If `absolute` is false every u is a joint rate.
    #[must_use]
    pub fn new(leg: &Leg, absolute: bool) -> Self {
        let independent: Vec<usize> = leg.independent().collect();
        let own_rate = |joint: usize| {
            let own = independent.iter().position(|i| *i == joint);
            own.map_or_else(Form::default, Form::unit)
        };
        let follows_later =
            |(index, j): (usize, &Joint)| j.variable.iter().any(|(of, _)| *of > index);
        let absolute = absolute && !leg.joints.iter().enumerate().any(follows_later);
        let mut joint: Vec<Form> = Vec::new();
        let mut turning: Vec<Form> = Vec::new();
        let mut run = Vec::new();
        for (index, j) in leg.joints.iter().enumerate() {
            let previous = previous_in_run(leg, index).filter(|_| absolute);
            run.push(previous.map(|(_, sign)| sign));
            let before = previous.map(|(at, sign)| (turning[at].clone(), sign));
            let mut rate = Form::default();
            if j.is_independent(index) {
                rate = own_rate(index);
                if let (Some((before, sign)), JointKind::Revolute) = (&before, j.kind) {
                    rate.add(before, -Number::ratio(*sign));
                }
            } else {
                for (of, factor) in &j.variable {
                    let form = joint.get(*of).cloned().unwrap_or_else(|| own_rate(*of));
                    rate.add(&form, Number::ratio(*factor));
                }
            }
            let mut turn = Form::default();
            if let Some((before, sign)) = &before {
                turn.add(before, Number::ratio(*sign));
            }
            if j.kind == JointKind::Revolute {
                turn.add(&rate, Number::ONE);
            }
            joint.push(rate);
            turning.push(turn);
        }
        Self {
            joint,
            turning,
            run,
        }
    }
}

/// The antecedent joint, if its z axis is parallel to this joint's, and the relative sign.
fn previous_in_run(leg: &Leg, index: usize) -> Option<(usize, Ratio)> {
    let antecedent = leg.joints[index].antecedent?;
    parallel(leg.joints[index].alpha).map(|sign| (antecedent, sign))
}

/// 1 or -1 if a rotation about x by this angle keeps the z axis parallel to itself.
#[must_use]
pub fn parallel(alpha: Angle) -> Option<Ratio> {
    let (cosine, sine) = alpha.cosine_and_sine();
    if !sine.is_zero() {
        return None;
    }
    Some(if cosine.value() > 0.0 {
        Ratio::ONE
    } else {
        Ratio::integer(-1)
    })
}
