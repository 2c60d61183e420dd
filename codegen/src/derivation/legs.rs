//! The legs of a robot, derived one after the other: the joints from what a leg ends on, the axes in which the closure
//! is seen, and the closure itself.

use super::centres::centres;
use super::closure::{LegClosure, split_rows};
use super::frames::LegFrames;
use super::guard::{Guard, GuardKind};
use super::inverse_kinematics::{Task, solve_leg};
use super::leg::LegState;
use super::motion_input::MotionInput;
use super::orientation::{Orientation, Seat};
use super::path::{Known, Path, orientation, seats};
use super::platform::PlatformPose;
use super::rates::Rates;
use super::robot::{Robot, name_rows};
use super::selection::Formulation;
use super::underivable::Underivable;
use crate::cas::{Expr, Vector3};
use crate::mechanism::Leg;

impl<'a> Robot<'a> {
    /// Derives a leg and what it knows of the robot; those before it are derived.
    ///
    /// # Errors
    /// A leg whose joints do not follow from the pose by rule, or a structurally singular leg.
    pub(super) fn derive_leg(
        &mut self,
        index: usize,
        formulation: &Formulation,
    ) -> Result<(), Underivable> {
        let (arena, mechanism) = (self.arena, self.mechanism);
        let leg = &mechanism.legs[index];
        arena.enter(&leg.name);
        let first_joint = mechanism.leg_range(index).start;
        let platform = self.end_of(index);
        if let Some(platform) = &platform {
            self.solve_joints(index, platform)?;
        }
        let seat = self.seat_of(index, formulation);
        let platform = match &seat {
            Some(seat) => self.end_seen(index, &seat.axes),
            None => platform,
        };
        let seen = seat.as_ref();
        let frames = self.frames_of(index, seen, formulation)?;
        let rates = Rates::new(leg, platform.is_some());
        let (ground, lift) = self.levels(leg, &frames, seen, formulation);
        let centres = match formulation.meeting {
            true => centres(leg, &rates),
            false => Vec::new(),
        };
        let closure = match &platform {
            Some(platform) => Some(self.close(index, &frames, &rates, platform)?),
            None => None,
        };
        let mut rows = match &closure {
            Some(closure) => closure.reduced_jacobian(),
            None => self.identity_rows(mechanism.coordinate_range(index)),
        };
        if let Some(closure) = &closure {
            self.guard_leg(closure, &leg.name);
        }
        if !mechanism.is_parasitic() {
            name_rows(&rows, leg, &self.twist);
        }
        if let Some(carrier) = leg.base_body {
            rows.extend(self.legs[carrier.leg].rows.clone());
        }
        self.legs.push(LegState {
            first_joint,
            frames,
            rates,
            centres,
            platform,
            closure,
            ground,
            lift,
            rows,
        });
        arena.enter("");
        Ok(())
    }

    /// Finds the sines and cosines of a leg's joints from the pose of what it ends on, where the configuration is
    /// one.
    fn solve_joints(
        &mut self,
        index: usize,
        platform: &PlatformPose<'a>,
    ) -> Result<(), Underivable> {
        if self.configuration.from() == MotionInput::Joints {
            return Ok(());
        }
        let leg = &self.mechanism.legs[index].name;
        let unsolved = || Underivable::InverseKinematics { leg: leg.clone() };
        let task = Task::new(self.arena, self.mechanism, index, platform).ok_or_else(unsolved)?;
        let conditions = solve_leg(task, &mut self.configuration).ok_or_else(unsolved)?;
        let guards = conditions.into_iter().map(|reach| Guard {
            value: reach.radicand,
            kind: GuardKind::Reach(self.at_home(reach.radicand).abs()),
            leg: leg.clone(),
        });
        let guards: Vec<_> = guards.collect();
        self.guards.extend(guards);
        Ok(())
    }

    /// The frames of a leg in the axes of its closure; first those in which the closure is seen, where sums over
    /// divisors are looked for.
    fn frames_of(
        &self,
        index: usize,
        seen: Option<&Seat>,
        formulation: &Formulation,
    ) -> Result<LegFrames<'a>, Underivable> {
        let (arena, configuration) = (self.arena, &self.configuration);
        let leg = &self.mechanism.legs[index];
        let first_joint = self.mechanism.leg_range(index).start;
        if let Some(seat) = seen.filter(|_| formulation.over_divisors) {
            let _ = LegFrames::write_in_seat(arena, leg, first_joint, configuration, seat);
        }
        let station = formulation.stations.get(index).copied().unwrap_or_default();
        let frames = LegFrames::new(arena, leg, first_joint, configuration, station, seen);
        frames.ok_or_else(|| Underivable::InverseKinematics {
            leg: leg.name.clone(),
        })
    }

    /// The acceleration of the ground less gravity, of a leg that stands on it: in the axes in which the closure sees
    /// what the leg ends on and in those of the leg, where the end's is taken so; and in the first ones, where masses
    /// at the leg's end are counted there.
    fn levels(
        &self,
        leg: &Leg,
        frames: &LegFrames<'a>,
        seat: Option<&Seat>,
        formulation: &Formulation,
    ) -> (Option<[Vector3<'a>; 2]>, Option<Vector3<'a>>) {
        let gravity = Vector3::constant(self.arena, self.mechanism.gravity);
        if leg.base_body.is_some() {
            return (None, None);
        }
        let level = |axes: &Orientation| {
            let level = Orientation::default().relative(axes, self.arena, &self.configuration)?;
            Some(-(level * gravity))
        };
        let weighted = seat.filter(|_| formulation.weighted);
        let ground =
            weighted.and_then(|seat| Some([level(&seat.axes)?, level(&frames.orientation)?]));
        let lift = match seat {
            _ if !formulation.masses_at_ends => None,
            Some(seat) => level(&seat.axes),
            None => Some(-gravity),
        };
        (ground, lift)
    }

    /// The closure of a leg on what it ends on.
    fn close(
        &self,
        index: usize,
        frames: &LegFrames<'a>,
        rates: &Rates,
        platform: &PlatformPose<'a>,
    ) -> Result<LegClosure<'a>, Underivable> {
        let (arena, mechanism) = (self.arena, self.mechanism);
        let leg = &mechanism.legs[index];
        let home = |e: Expr<'a>| self.at_home(e);
        let [selected, over] = match mechanism.is_parasitic() {
            true => split_rows(arena, leg, frames, rates, &home),
            false => [mechanism.closure_rows(index), Vec::new()],
        };
        let rows = [&selected[..], &over[..]];
        let closure = LegClosure::new(arena, leg, frames, rates, platform, rows, &home);
        closure.ok_or_else(|| Underivable::SingularLeg {
            leg: leg.name.clone(),
        })
    }

    /// What a leg ends on: the platform, or a body as it is seen from the one that the leg starts from. `None` for a leg without an end.
    pub(super) fn end_of(&self, index: usize) -> Option<PlatformPose<'a>> {
        if let Some(platform) = &self.platform {
            return Some(platform.clone());
        }
        let from = self.mechanism.legs[index].base_body;
        let axes = orientation(self.mechanism, &self.configuration, from)?;
        self.end_seen(index, &axes)
    }

    /// The axes in which a chain's closure is seen, where they are chosen.
    fn seat_of(&self, index: usize, formulation: &Formulation) -> Option<Seat> {
        let seat = formulation.seats.get(index).copied().unwrap_or_default();
        if seat == 0 {
            return None;
        }
        let all = seats(self.mechanism, &self.configuration, index)?;
        Some(Seat {
            from: all.first()?.clone(),
            axes: all.get(seat)?.clone(),
        })
    }

    /// What a chain ends on, as it is seen from the body that it starts from, in given axes.
    fn end_seen(&self, index: usize, axes: &Orientation) -> Option<PlatformPose<'a>> {
        let leg = &self.mechanism.legs[index];
        leg.end.as_ref()?;
        let legs = self.legs.iter();
        let known = Known {
            arena: self.arena,
            mechanism: self.mechanism,
            configuration: &self.configuration,
            legs: legs
                .map(|own| (own.first_joint, &own.rates, &own.rows))
                .collect(),
        };
        let path = Path::new(&known, leg.base_body, leg.end_body?, axes)?;
        Some(PlatformPose::on_body(self.arena, path))
    }

    fn guard_leg(&mut self, closure: &LegClosure<'a>, leg: &str) {
        for determinant in &closure.determinants {
            let (_, base) = determinant.factor_and_base();
            let known = self.guards.iter().any(|g| g.value == base);
            if !known && base.as_number().is_none() {
                let kind = GuardKind::Leg(self.at_home(base).abs());
                self.guards.push(Guard {
                    value: base,
                    kind,
                    leg: leg.to_owned(),
                });
            }
        }
    }
}
