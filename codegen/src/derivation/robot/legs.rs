//! Derivation of a robot's legs, one after the other: joints from the end body, observer's axes,
//! closure.

use super::{Robot, name_rows};
use crate::cas::{Expr, Vector3};
use crate::derivation::closure::cable::cable_course;
use crate::derivation::closure::leg::{GroundAcceleration, LegGravity, LegState};
use crate::derivation::closure::leg_closure::{ClosureRows, LegClosure, split_rows};
use crate::derivation::derivation_error::DerivationError;
use crate::derivation::guard::{Guard, GuardKind};
use crate::derivation::kinematics::centres::centres;
use crate::derivation::kinematics::frames::LegFrames;
use crate::derivation::kinematics::inverse_kinematics::{Task, solve_leg};
use crate::derivation::kinematics::orientation::{ObserverFrame, Orientation, blocking_frame};
use crate::derivation::kinematics::path::{KnownMotion, Path, observer_frames, orientation};
use crate::derivation::kinematics::platform::PlatformPose;
use crate::derivation::kinematics::rates::Rates;
use crate::derivation::motion_input::MotionInput;
use crate::derivation::selection::Formulation;
use crate::mechanism::{Cable, Leg};

impl<'a> Robot<'a> {
    /// Derives a leg and its relation to the robot; earlier legs are already derived.
    ///
    /// # Errors
    /// A leg whose joints do not follow from the pose in closed form, or a structurally singular
    /// leg.
    pub(crate) fn derive_leg(
        &mut self,
        index: usize,
        formulation: &Formulation,
    ) -> Result<(), DerivationError> {
        let (arena, mechanism) = (self.arena, self.mechanism);
        let leg = &mechanism.legs[index];
        arena.enter(&leg.name);
        let first_joint = mechanism.leg_range(index).start;
        let platform = self.end_of(index);
        if let Some((cable, platform)) = leg.cable.as_ref().zip(platform.as_ref()) {
            return self.derive_cable(index, cable, platform);
        }
        if let Some(platform) = &platform {
            self.solve_joints(index, platform)?;
        }
        let observer = self.observer_frame_of(index, formulation);
        let platform = match &observer {
            Some(observer) => self.end_seen(index, &observer.axes),
            None => platform,
        };
        let observer = observer.as_ref();
        let frames = self.frames_of(index, observer, formulation)?;
        let rates = Rates::new(leg, platform.is_some());
        let gravity = self.gravity_of(leg, &frames, observer, formulation);
        let centres = if formulation.meeting {
            centres(leg, &rates)
        } else {
            Vec::new()
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
            cable: None,
            gravity,
            rows,
        });
        arena.enter("");
        Ok(())
    }

    /// Derives a cable from the pose of the platform; its length is not computed from joints.
    fn derive_cable(
        &mut self,
        index: usize,
        cable: &Cable,
        platform: &PlatformPose<'a>,
    ) -> Result<(), DerivationError> {
        let (arena, mechanism) = (self.arena, self.mechanism);
        let leg = &mechanism.legs[index];
        let first_joint = mechanism.leg_range(index).start;
        let unsolved = || DerivationError::SingularLeg {
            leg: leg.name.clone(),
        };
        let at = leg.end.as_ref().ok_or_else(unsolved)?.point();
        // Cables whose exit points have equal coordinates share them, taken from the platform first.
        let from_exit = platform.origin - Vector3::constant(arena, leg.base.at);
        let between = from_exit + platform.arm(at);
        let home = |value: Expr<'a>| mechanism.home.value(arena, value);
        let (course, guards) = cable_course(arena, leg, cable, between, &home);
        let guards = guards
            .into_iter()
            .filter(|guard| guard.value.as_number().is_none());
        self.guards.extend(guards);
        self.configuration
            .learn_position(first_joint, course.length);
        let closure = LegClosure::of_cable(arena, &course, at, platform);
        self.guard_leg(&closure, &leg.name);
        let rows = closure.reduced_jacobian();
        name_rows(&rows, leg, &self.twist);
        let frames = LegFrames::new(arena, leg, first_joint, &self.configuration, 0, None);
        self.legs.push(LegState {
            first_joint,
            frames: frames.ok_or_else(unsolved)?,
            rates: Rates::new(leg, true),
            centres: Vec::new(),
            platform: Some(platform.clone()),
            closure: Some(closure),
            cable: Some(course),
            gravity: LegGravity::default(),
            rows,
        });
        arena.enter("");
        Ok(())
    }

    /// Solves the sines and cosines of a leg's joints from the pose of its end body, if the pose is
    /// the input.
    fn solve_joints(
        &mut self,
        index: usize,
        platform: &PlatformPose<'a>,
    ) -> Result<(), DerivationError> {
        if self.configuration.from() == MotionInput::Joints {
            return Ok(());
        }
        let leg = &self.mechanism.legs[index].name;
        let unsolved = || DerivationError::InverseKinematics { leg: leg.clone() };
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

    /// Frames of a leg in the axes of its closure, derived in the observer's axes first if sums
    /// over divisors are searched.
    fn frames_of(
        &self,
        index: usize,
        observer: Option<&ObserverFrame>,
        formulation: &Formulation,
    ) -> Result<LegFrames<'a>, DerivationError> {
        let (arena, configuration) = (self.arena, &self.configuration);
        let leg = &self.mechanism.legs[index];
        let first_joint = self.mechanism.leg_range(index).start;
        if let Some(observer) = observer.filter(|_| formulation.over_divisors) {
            let _ = LegFrames::express_in_observer_frame(
                arena,
                leg,
                first_joint,
                configuration,
                observer,
            );
        }
        let chosen = formulation.closure_frames.get(index).copied();
        let closure_frame = blocking_frame(self.mechanism, index)
            .or(chosen)
            .unwrap_or_default();
        let frames = LegFrames::new(
            arena,
            leg,
            first_joint,
            configuration,
            closure_frame,
            observer,
        );
        frames.ok_or_else(|| DerivationError::InverseKinematics {
            leg: leg.name.clone(),
        })
    }

    /// Gravity as an acceleration of the ground, for a leg that starts from it.
    fn gravity_of(
        &self,
        leg: &Leg,
        frames: &LegFrames<'a>,
        observer: Option<&ObserverFrame>,
        formulation: &Formulation,
    ) -> LegGravity<'a> {
        if leg.base_body.is_some() {
            return LegGravity::default();
        }
        let gravity = Vector3::constant(self.arena, self.mechanism.gravity);
        let in_axes = |axes: &Orientation| {
            let turn = Orientation::default().relative(axes, self.arena, &self.configuration)?;
            Some(-(turn * gravity))
        };
        let observer_of_ground = observer.filter(|_| formulation.gravity_as_acceleration);
        let ground = observer_of_ground.and_then(|observer| {
            Some(GroundAcceleration {
                in_observer_axes: in_axes(&observer.axes)?,
                in_leg_axes: in_axes(&frames.orientation)?,
            })
        });
        let end_offset = match observer {
            _ if !formulation.masses_at_ends => None,
            Some(observer) => in_axes(&observer.axes),
            None => Some(-gravity),
        };
        LegGravity { ground, end_offset }
    }

    /// Closure of a leg on its end body.
    fn close(
        &self,
        index: usize,
        frames: &LegFrames<'a>,
        rates: &Rates,
        platform: &PlatformPose<'a>,
    ) -> Result<LegClosure<'a>, DerivationError> {
        let (arena, mechanism) = (self.arena, self.mechanism);
        let leg = &mechanism.legs[index];
        let home = |e: Expr<'a>| self.at_home(e);
        let rows = if mechanism.has_dependent_coordinates() {
            split_rows(arena, leg, frames, rates, &home)
        } else {
            ClosureRows {
                independent: mechanism.closure_rows(index),
                remaining: Vec::new(),
            }
        };
        let closure = LegClosure::new(arena, leg, frames, rates, platform, &rows, &home);
        closure.ok_or_else(|| DerivationError::SingularLeg {
            leg: leg.name.clone(),
        })
    }

    /// The leg's end body: the platform, or a body relative to the leg's start. `None` without an
    /// end.
    pub(crate) fn end_of(&self, index: usize) -> Option<PlatformPose<'a>> {
        if let Some(platform) = &self.platform {
            return Some(platform.clone());
        }
        let from = self.mechanism.legs[index].base_body;
        let axes = orientation(self.mechanism, &self.configuration, from)?;
        self.end_seen(index, &axes)
    }

    /// The chosen observer's axes of a chain's closure, if any.
    fn observer_frame_of(&self, index: usize, formulation: &Formulation) -> Option<ObserverFrame> {
        let observer_frame = formulation
            .observer_frames
            .get(index)
            .copied()
            .unwrap_or_default();
        if observer_frame == 0 || self.mechanism.blocking.contains(&index) {
            return None;
        }
        let all = observer_frames(self.mechanism, &self.configuration, index)?;
        Some(ObserverFrame {
            from: all.first()?.clone(),
            axes: all.get(observer_frame)?.clone(),
        })
    }

    /// End body of a chain in given axes, relative to the body at its start.
    fn end_seen(&self, index: usize, axes: &Orientation) -> Option<PlatformPose<'a>> {
        let leg = &self.mechanism.legs[index];
        leg.end.as_ref()?;
        let legs = self.legs.iter();
        let known = KnownMotion {
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
