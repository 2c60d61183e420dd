//! Springs and dampers between two points on two bodies.
//!
//! With the points A and B, d = B - A, the length is l = |d| and ∂l/∂v = (d/l)ᵀ (∂V_B/∂v - ∂V_A/∂v).
//! A force f(l, l̇) that pulls the points together adds (∂l/∂v)ᵀ f to Γ¹. Two bodies of the tree are
//! seen from one of them along the path between them, which passes the fewest joints; the length and
//! its rate do not depend on the observer.

use super::formula::{Variable, expression};
use crate::cas::{Expr, Vector3};
use crate::derivation::bodies::motion::RobotMotion;
use crate::derivation::derivation_error::DerivationError;
use crate::derivation::guard::{Guard, GuardKind};
use crate::derivation::kinematics::path::{KnownMotion, Path, orientation};
use crate::derivation::linear_algebra::linear::{add_to, dot};
use crate::derivation::parameter::BodyParameter;
use crate::derivation::robot::Robot;
use crate::mechanism::{BodyIndex, Formula, PointSpring, SpringBody, SpringEnd};

/// A point as seen by an observer: its position, and its velocity per independent rate.
struct Point<'a> {
    position: Vector3<'a>,
    velocities: Vec<Vector3<'a>>,
}

/// Length of a spring, and its rate per independent rate.
struct Length<'a> {
    length: Expr<'a>,
    row: Vec<Expr<'a>>,
}

impl<'a> Robot<'a> {
    /// Column of a spring's coefficient in the platform projection, r numbers.
    pub(crate) fn point_spring_column(
        &self,
        motion: &RobotMotion<'a>,
        index: usize,
    ) -> Vec<Expr<'a>> {
        let spring = &self.mechanism.springs[index];
        let force = spring.force.as_ref().map(|force| &force.formula);
        self.along(spring, |length| self.force(length, motion, force?))
    }

    /// Γ¹ of all springs between points for given coefficients, with their known forces.
    pub(crate) fn point_spring_forces(
        &self,
        motion: &RobotMotion<'a>,
        values: &[(BodyParameter, Expr<'a>)],
    ) -> Vec<Expr<'a>> {
        let mut total = vec![self.arena.zero(); self.mechanism.dof()];
        for (index, spring) in self.mechanism.springs.iter().enumerate() {
            let own = BodyParameter::Spring(index);
            let value = values.iter().find(|(parameter, _)| *parameter == own);
            let forces = self.along(spring, |length| {
                let mut sum = self.arena.zero();
                if let Some((force, (_, value))) = spring.force.as_ref().zip(value) {
                    sum = self.force(length, motion, &force.formula)? * *value;
                }
                if let Some(known) = &spring.known {
                    sum = sum + self.force(length, motion, known)?;
                }
                Some(sum)
            });
            add_to(&mut total, forces);
        }
        total
    }

    /// Guards for forces of springs between points to have a value: radicands must not be negative.
    pub(crate) fn point_spring_guards(&self, motion: &RobotMotion<'a>) -> Vec<Guard<'a>> {
        let mut guards = Vec::new();
        if self.mechanism.springs.is_empty() {
            return guards;
        }
        for spring in &self.mechanism.springs {
            let leg = self.place(spring);
            self.arena.enter(leg);
            let force = spring.force.as_ref().map(|force| &force.formula);
            for formula in [force, spring.known.as_ref()].into_iter().flatten() {
                let Some(length) = self.length(spring) else {
                    continue;
                };
                let mut radicands = Vec::new();
                let stretch = self.stretch(&length, motion, formula);
                let _ = expression(self.arena, &stretch, formula, &mut radicands);
                guards.extend(radicands.into_iter().map(|value| Guard {
                    value,
                    kind: GuardKind::Reach(0.0),
                    leg: if leg.is_empty() {
                        self.mechanism.legs[0].name.clone()
                    } else {
                        leg.to_owned()
                    },
                }));
            }
        }
        self.arena.enter("");
        guards
    }

    /// Checks that the configuration determines the forces of all springs between points.
    ///
    /// # Errors
    /// A spring whose length does not follow from the configuration, or whose force has no value.
    pub(crate) fn check_point_springs(&self) -> Result<(), DerivationError> {
        for spring in &self.mechanism.springs {
            self.arena.enter(self.place(spring));
            let undetermined = || DerivationError::UndeterminedSpring {
                spring: spring.name.clone(),
            };
            let length = self.length(spring).ok_or_else(undetermined)?;
            let stretch = Stretch {
                length: length.length,
                rate: self.arena.zero(),
            };
            let force = spring.force.as_ref().map(|force| &force.formula);
            for formula in [force, spring.known.as_ref()].into_iter().flatten() {
                let force = expression(self.arena, &stretch, formula, &mut Vec::new());
                force.ok_or_else(undetermined)?;
            }
        }
        self.arena.enter("");
        Ok(())
    }

    /// (∂l/∂v)ᵀ times a force, which [`Self::check_point_springs`] has found to be determined.
    fn along(
        &self,
        spring: &PointSpring,
        force: impl Fn(&Length<'a>) -> Option<Expr<'a>>,
    ) -> Vec<Expr<'a>> {
        self.arena.enter(self.place(spring));
        let found = self.length(spring).and_then(|length| {
            let force = force(&length)?.named(&format!("force_{}", spring.name));
            let entries = length.row.iter().map(|entry| *entry * force);
            Some(entries.collect::<Vec<_>>())
        });
        self.arena.enter("");
        found.unwrap_or_else(|| vec![self.arena.zero(); self.mechanism.dof()])
    }

    /// A force at the length and its rate; `None` if an angle exceeds the range of numbers.
    fn force(
        &self,
        length: &Length<'a>,
        motion: &RobotMotion<'a>,
        formula: &Formula,
    ) -> Option<Expr<'a>> {
        let stretch = self.stretch(length, motion, formula);
        expression(self.arena, &stretch, formula, &mut Vec::new())
    }

    /// The length, and its rate if a formula contains it.
    fn stretch(
        &self,
        length: &Length<'a>,
        motion: &RobotMotion<'a>,
        formula: &Formula,
    ) -> Stretch<'a> {
        let rate = if formula.has_rate() {
            dot(&length.row, &motion.twist)
        } else {
            self.arena.zero()
        };
        Stretch {
            length: length.length,
            rate,
        }
    }

    /// The leg that errors of a spring name: that of one of its bodies, if any.
    fn place(&self, spring: &PointSpring) -> &str {
        let leg = spring.ends.iter().rev().find_map(|end| match end.body {
            SpringBody::Joint(body) => Some(self.mechanism.legs[body.leg].name.as_str()),
            SpringBody::Ground | SpringBody::Platform => None,
        });
        leg.unwrap_or("")
    }

    /// Length of a spring; `None` if the configuration does not determine it.
    fn length(&self, spring: &PointSpring) -> Option<Length<'a>> {
        let [from, to] = &spring.ends;
        let [from, to] = match (from.body, to.body) {
            (SpringBody::Platform, _) | (_, SpringBody::Platform) => {
                [self.seen_from_ground(from)?, self.seen_from_ground(to)?]
            }
            // A path leads to a body.
            (SpringBody::Joint(_), SpringBody::Ground) => [self.fixed(to), self.seen(None, from)?],
            (SpringBody::Joint(body), _) => match self.seen(Some(body), to) {
                Some(to) => [self.fixed(from), to],
                // A body of one chain does not determine those of another.
                None => [self.seen_from_ground(from)?, self.seen_from_ground(to)?],
            },
            (SpringBody::Ground, _) => [self.fixed(from), self.seen(None, to)?],
        };
        let between = to.position - from.position;
        let square = between.dot(between);
        let length = square.sqrt().named(&format!("l_{}", spring.name));
        let along = between.scaled(length.reciprocal());
        let rows = to.velocities.iter().zip(&from.velocities);
        let row = rows.map(|(to, from)| along.dot(*to - *from)).collect();
        Some(Length { length, row })
    }

    /// A point that rests for the observer on its body.
    fn fixed(&self, end: &SpringEnd) -> Point<'a> {
        Point {
            position: Vector3::constant(self.arena, end.at),
            velocities: vec![Vector3::zero(self.arena); self.mechanism.dof()],
        }
    }

    /// A point of any body as seen from the ground.
    fn seen_from_ground(&self, end: &SpringEnd) -> Option<Point<'a>> {
        match end.body {
            SpringBody::Ground => Some(self.fixed(end)),
            SpringBody::Platform => self.on_platform(end),
            SpringBody::Joint(_) => self.seen(None, end),
        }
    }

    /// A point of the platform.
    fn on_platform(&self, end: &SpringEnd) -> Option<Point<'a>> {
        let pose = self.platform.as_ref()?;
        let arm = pose.arm(end.at);
        let velocities = match &self.parasitic_motion {
            Some(parasitic) => {
                let partials = parasitic.partials(self.arena);
                partials.iter().map(|one| one.linear_at(arm)).collect()
            }
            None => {
                let columns = pose.directions().columns(self.arena, arm);
                columns.iter().map(|column| column.linear).collect()
            }
        };
        Some(Point {
            position: pose.origin + arm,
            velocities,
        })
    }

    /// A point of a leg's body as seen from another body, or from the ground, in its axes.
    fn seen(&self, from: Option<BodyIndex>, end: &SpringEnd) -> Option<Point<'a>> {
        let SpringBody::Joint(to) = end.body else {
            return None;
        };
        let legs = self.legs.iter();
        let known = KnownMotion {
            arena: self.arena,
            mechanism: self.mechanism,
            configuration: &self.configuration,
            legs: legs
                .map(|own| (own.first_joint, &own.rates, &own.rows))
                .collect(),
        };
        let axes = orientation(self.mechanism, &self.configuration, from)?;
        let path = Path::new(&known, from, to, &axes)?;
        let arm = path.rotation * Vector3::constant(self.arena, end.at);
        let columns = path.columns.iter();
        Some(Point {
            position: path.origin + arm,
            velocities: columns.map(|column| column.linear_at(arm)).collect(),
        })
    }
}

/// Length and rate of a spring as variables of a formula.
struct Stretch<'a> {
    length: Expr<'a>,
    rate: Expr<'a>,
}

impl<'a> Variable<'a> for Stretch<'a> {
    fn number(&self) -> Option<Expr<'a>> {
        Some(self.length)
    }

    fn rate(&self) -> Option<Expr<'a>> {
        Some(self.rate)
    }
}
