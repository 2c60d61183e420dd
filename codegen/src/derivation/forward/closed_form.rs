//! Forward kinematics in closed form, for poses that are determined by distances alone.
//!
//! Suppose that a leg's closure gives one equation in its actuators and the platform point X alone:
//! |X|² + h · X + f = 0. Then X lies on a sphere (a circle in a plane) about C = -h/2. If the last
//! links are a rod, C is the elbow. As many spheres as X has coordinates intersect in two points:
//!
//! - two circles, eqs. (55) to (57): with w = C1 - C0 and s = (ρ0² - ρ1² + w²)/2,
//!   X = C0 + (s w)/w² + t w⊥, t² = ρ0²/w² - (s/w²)²;
//! - three spheres: with u = C1 - C0, v = C2 - C0 and n = u × v,
//!   X = C0 + Y + t n, Y = (s1 v × n + s2 n × u)/n², t² = (ρ0² - Y²)/n².
//!
//! The sign of t is the assembly mode of the home configuration. A `point` or `translation`
//! platform takes one intersection. A `planar` one takes two, if two pairs of legs hold it at two
//! points.

use crate::cas::{
    Arena, CosineSine, Expr, Matrix3, Number, Ratio, Substitution, SymbolId, Vector3,
};
use crate::derivation::kinematics::configuration::{Configuration, Unknown};
use crate::derivation::kinematics::inverse_kinematics::{Reach, Task, advance, at_zero, equations};
use crate::derivation::kinematics::platform::PlatformPose;
use crate::derivation::motion_input::MotionInput;
use crate::mechanism::numeric::platform_frame;
use crate::mechanism::{End, JointKind, Mechanism, Motion, TwistCoordinate};

/// A pose from the actuators.
#[derive(Debug)]
pub struct ClosedForm<'a> {
    /// The pose's coordinates.
    pub pose: Vec<Expr<'a>>,
    /// Conditions for the spheres to intersect, with the name of a leg of the sphere.
    pub reach: Vec<(Reach<'a>, String)>,
}

/// |X|² + h · X + f = 0 for a platform point X, on its free axes.
#[derive(Debug, Clone)]
struct Sphere<'a> {
    leg: usize,
    center: Vector3<'a>,
    square_radius: Expr<'a>,
}

/// Smallest sine of the angle at which spheres intersect at home that determines the pose.
const REGULAR: f64 = 1e-3;

/// Input of the derivation.
#[derive(Clone, Copy)]
struct Work<'a> {
    arena: &'a Arena,
    mechanism: &'a Mechanism,
    /// Axes along which platform points move.
    free: [bool; 3],
    normal: Option<usize>,
}

/// The closed form, if the robot has one; motors may drive joints of several legs at once.
#[must_use]
pub(crate) fn closed_form<'a>(
    arena: &'a Arena,
    mechanism: &'a Mechanism,
) -> Option<ClosedForm<'a>> {
    if mechanism.has_cables() || !mechanism.motors.is_empty() {
        return None;
    }
    let motion = mechanism.platform.as_ref()?.motion;
    let mut free = [false; 3];
    for coordinate in motion.twist() {
        if let TwistCoordinate::Linear(axis) = coordinate {
            free[axis] = true;
        }
    }
    let work = Work {
        arena,
        mechanism,
        free,
        normal: free.iter().position(|is_free| !is_free),
    };
    match motion {
        Motion::Point { .. } | Motion::Translation => work.one_meeting(),
        Motion::Planar { .. } => work.two_meetings(),
        _ => None,
    }
}

impl<'a> Work<'a> {
    /// Coordinates of a platform point as unknowns: no joint is solved from an equation that
    /// contains them.
    fn unknown_point(self) -> Vector3<'a> {
        let coordinate = |axis: usize| {
            if self.free[axis] {
                self.arena.placeholder(&format!("unknown point[{axis}]"))
            } else {
                self.arena.zero()
            }
        };
        Vector3(std::array::from_fn(coordinate))
    }

    /// The spheres of `point`, which the legs impose; `arm` leads from it to the leg's end.
    fn spheres(
        self,
        legs: &[usize],
        arm: impl Fn(usize) -> Option<(Vector3<'a>, Option<Matrix3<'a>>)>,
    ) -> Vec<Sphere<'a>> {
        let point = self.unknown_point();
        let of_leg = |&leg: &usize| {
            let (arm, axes) = arm(leg)?;
            let task = Task {
                blocks: false,
                arena: self.arena,
                leg: &self.mechanism.legs[leg],
                first_joint: self.mechanism.leg_range(leg).start,
                home: &self.mechanism.home,
                target: point + arm,
                axes,
            };
            self.sphere(leg, task)
        };
        legs.iter().filter_map(of_leg).collect()
    }

    /// The sphere of one leg, after elimination of the joints that its actuators and the
    /// orientation determine.
    fn sphere(self, leg: usize, task: Task<'a, 'a>) -> Option<Sphere<'a>> {
        let mut configuration = self.measured(leg);
        loop {
            let scratch = configuration.with_unknowns();
            let equations = equations(task, &scratch)?.into_iter();
            let unknowns = scratch.unknowns();
            let mut without_turns = equations.map(|e| self.without_turns(e, &unknowns));
            let found = without_turns.find_map(|e| self.as_sphere(leg, e));
            if found.is_some() {
                return found;
            }
            advance(task, &mut configuration)?;
        }
    }

    /// A configuration in which the leg's actuators are known.
    fn measured(self, leg: usize) -> Configuration<'a> {
        let mut configuration = Configuration::new(self.arena, self.mechanism, MotionInput::Pose);
        let joints = self.mechanism.joints();
        for (k, &index) in self.mechanism.actuated().iter().enumerate() {
            if joints[index].leg != leg {
                continue;
            }
            if self.mechanism.joint(joints[index]).kind == JointKind::Prismatic {
                configuration.learn_position(index, self.arena.input("actuators", k));
            } else {
                let unit = self
                    .arena
                    .cosine_and_sine(&self.arena.input_angle("actuators", k));
                configuration.learn(configuration.joint_angle(index), unit);
            }
        }
        configuration
    }

    /// The equation without unknown turns on which it does not depend.
    ///
    /// An equation that contains only c² + s² of a turn has no derivative along the circle.
    fn without_turns(self, equation: Expr<'a>, unknowns: &[Unknown]) -> Expr<'a> {
        let turns = unknowns.iter().filter(|u| matches!(u, Unknown::Turn(_)));
        turns.fold(equation, |equation, turn| {
            let CosineSine { cosine, sine } = turn.unit(self.arena);
            let symbols: Vec<SymbolId> = [cosine, sine].iter().flat_map(|e| e.symbols()).collect();
            let [c, s] = symbols[..] else {
                return equation;
            };
            let along = equation.derivative(s) * cosine - equation.derivative(c) * sine;
            if !along.is_zero() {
                return equation;
            }
            let (one, zero) = (self.arena.one(), self.arena.zero());
            let at = Substitution::new(self.arena).value(c, one).value(s, zero);
            at.apply(equation)
        })
    }

    /// The equation as a sphere; `None` if it has another form.
    fn as_sphere(self, leg: usize, equation: Expr<'a>) -> Option<Sphere<'a>> {
        let arena = self.arena;
        let point = self.unknown_point();
        let coordinates: Vec<Expr<'a>> = point.0.into_iter().filter(|x| !x.is_zero()).collect();
        let symbols: Vec<SymbolId> = coordinates.iter().flat_map(|x| x.symbols()).collect();
        let is_own = |id: &SymbolId| symbols.contains(id) || !arena.is_placeholder(*id);
        if !equation.symbols().iter().all(is_own) {
            return None;
        }
        let zero = |e: Expr<'a>| at_zero(arena, e, &symbols);
        let slopes: Vec<Expr<'a>> = symbols.iter().map(|&s| equation.derivative(s)).collect();
        let curvature = zero(slopes.first()?.derivative(symbols[0])).as_number()?;
        if curvature.is_zero() {
            return None;
        }
        let (k, half) = (curvature * half(), half());
        let mut center = Vector3::zero(arena);
        let mut form = zero(equation);
        for (at, axis) in (0..3).filter(|&axis| self.free[axis]).enumerate() {
            let (x, slope) = (coordinates[at], zero(slopes[at]));
            center.0[axis] = slope * (-half / k);
            form = form + x * x * k + x * slope;
        }
        let square_radius = center.dot(center) - zero(equation) * (Number::ONE / k);
        (equation - form).is_zero().then_some(Sphere {
            leg,
            center,
            square_radius,
        })
    }

    /// Solves a point platform or a translation: X is the platform's origin.
    fn one_meeting(self) -> Option<ClosedForm<'a>> {
        let motion = self.mechanism.platform.as_ref()?.motion;
        let platform = PlatformPose::new(self.arena, motion, &[]);
        let legs: Vec<usize> = (0..self.mechanism.legs.len()).collect();
        let spheres = self.spheres(&legs, |leg| {
            match self.mechanism.legs[leg].end.as_ref()? {
                End::Rigid(at) => Some((platform.arm(at.at), Some(platform.orientation(at)))),
                End::Point { at, .. } => Some((platform.arm(*at), None)),
            }
        });
        let home = self.home_point([Number::ZERO; 3]);
        let meeting = self.best_meeting(&spheres, home)?;
        let axes = (0..3).map(|i| self.normal.map_or(i, |n| (n + 1 + i) % 3));
        let pose = axes.filter(|&a| self.free[a]).map(|a| meeting.point.0[a]);
        Some(self.result(pose.collect(), &[&meeting]))
    }

    /// Solves a planar platform that two pairs of legs hold at two points.
    fn two_meetings(self) -> Option<ClosedForm<'a>> {
        let normal = self.normal?;
        let mut points: Vec<([Number; 3], Vec<usize>)> = Vec::new();
        for leg in 0..self.mechanism.legs.len() {
            let own = self.end_point(leg)?;
            let same = |p: &[Number; 3]| (0..3).all(|i| i == normal || p[i] == own[i]);
            match points.iter_mut().find(|(p, _)| same(p)) {
                Some((_, legs)) => legs.push(leg),
                None => points.push((own, vec![leg])),
            }
        }
        let mut located = points.iter().filter_map(|(at, legs)| {
            let along_normal = |leg: usize| {
                let mut arm = [Number::ZERO; 3];
                arm[normal] = self.end_point(leg)?[normal];
                Some((Vector3::constant(self.arena, arm), None))
            };
            let spheres = self.spheres(legs, along_normal);
            Some(LocatedPoint {
                at: *at,
                meeting: self.best_meeting(&spheres, self.home_point(*at))?,
            })
        });
        let (first, second) = (located.next()?, located.next()?);
        let pose = self.pose_through(&first, &second, normal)?;
        Some(self.result(pose, &[&first.meeting, &second.meeting]))
    }

    /// The platform point that a leg ends at, in the platform frame.
    fn end_point(self, leg: usize) -> Option<[Number; 3]> {
        Some(self.mechanism.legs[leg].end.as_ref()?.point())
    }

    /// Position of a platform point at home.
    fn home_point(self, at: [Number; 3]) -> [f64; 3] {
        let Some(platform) = &self.mechanism.platform else {
            return [0.0; 3];
        };
        let frame = platform_frame(platform.motion, &self.mechanism.home.pose);
        let point = frame * nalgebra::Point3::from(at.map(Number::value));
        [point.x, point.y, point.z]
    }

    /// The intersection of as many spheres as coordinates that is farthest from singular at home.
    fn best_meeting(self, spheres: &[Sphere<'a>], home: [f64; 3]) -> Option<Meeting<'a>> {
        let count = self.free.iter().filter(|f| **f).count();
        let mut best: Option<(f64, Meeting<'a>)> = None;
        for chosen in combinations(spheres.len(), count) {
            let chosen: Vec<&Sphere<'a>> = chosen.iter().map(|&i| &spheres[i]).collect();
            let meeting = self.meeting(&chosen, home);
            let Some((quality, meeting)) = meeting.filter(|(quality, _)| *quality > REGULAR) else {
                continue;
            };
            // A later choice has to be clearly better, so that rounding does not decide.
            if best
                .as_ref()
                .is_none_or(|(b, _)| quality > b * (1.0 + 1e-6))
            {
                best = Some((quality, meeting));
            }
        }
        best.map(|(_, meeting)| meeting)
    }

    /// The intersection of spheres, and the sine of their angle at home.
    fn meeting(self, spheres: &[&Sphere<'a>], home: [f64; 3]) -> Option<(f64, Meeting<'a>)> {
        let first = *spheres.first()?;
        let arms = spheres[1..].iter().map(|s| {
            let arm = s.center - first.center;
            let half = half();
            (
                arm,
                (first.square_radius - s.square_radius + arm.dot(arm)) * half,
            )
        });
        let arms: Vec<(Vector3<'a>, Expr<'a>)> = arms.collect();
        // Y lies in the span of the arms; `normal` is perpendicular to it.
        let (normal, weighted, square) = match arms.as_slice() {
            [(w, s)] => {
                let normal = Vector3::unit(self.arena, self.normal?).cross(*w);
                (normal, w.scaled(*s), w.dot(*w))
            }
            [(u, s), (v, t)] => {
                let normal = u.cross(*v);
                let weighted = v.cross(normal).scaled(*s) + normal.cross(*u).scaled(*t);
                (normal, weighted, normal.dot(normal))
            }
            _ => return None,
        };
        let reciprocal = square.reciprocal();
        let foot = weighted.scaled(reciprocal);
        let radicand = (first.square_radius - foot.dot(foot)) * reciprocal;
        let value = |e: Expr<'a>| self.mechanism.home.value(self.arena, e);
        let at_home: f64 = (0..3)
            .map(|i| value(normal.0[i]) * (home[i] - value(first.center.0[i])))
            .sum();
        let radius = value(first.square_radius).sqrt();
        let quality = at_home.abs() / (value(square).sqrt() * radius);
        let root = radicand.sqrt();
        let signed = if at_home > 0.0 { root } else { -root };
        let meeting = Meeting {
            point: first.center + foot + normal.scaled(signed),
            radicand,
            legs: spheres.iter().map(|s| s.leg).collect(),
        };
        Some((quality, meeting))
    }

    /// The planar pose that maps two platform points to two positions.
    fn pose_through(
        self,
        first: &LocatedPoint<'a>,
        second: &LocatedPoint<'a>,
        normal: usize,
    ) -> Option<Vec<Expr<'a>>> {
        let (at1, p1) = (first.at, first.meeting.point);
        let (at2, p2) = (second.at, second.meeting.point);
        let arena = self.arena;
        let plane = [(normal + 1) % 3, (normal + 2) % 3];
        let local = plane.map(|i| arena.number(at2[i] - at1[i]));
        let base = plane.map(|i| p2.0[i] - p1.0[i]);
        let cosine = local[0] * base[0] + local[1] * base[1];
        let sine = local[0] * base[1] - local[1] * base[0];
        // Encoder noise changes the measured distance of the points; their midpoint is kept.
        let scale = (cosine * cosine + sine * sine).sqrt().reciprocal();
        let (cosine, sine) = (cosine * scale, sine * scale);
        let middle = plane.map(|i| (p1.0[i] + p2.0[i]) * half());
        let [x, y] = plane.map(|i| arena.number((at1[i] + at2[i]) * half()));
        let origin = [
            middle[0] - (cosine * x - sine * y),
            middle[1] - (sine * x + cosine * y),
        ];
        let home = *self.mechanism.home.pose.last()?;
        let angle = CosineSine { cosine, sine }.angle_near(arena, home);
        Some(vec![origin[0], origin[1], angle])
    }

    fn result(self, pose: Vec<Expr<'a>>, meetings: &[&Meeting<'a>]) -> ClosedForm<'a> {
        let leg_name = |meeting: &Meeting<'a>| self.mechanism.legs[meeting.legs[0]].name.clone();
        let reach = meetings.iter().map(|meeting| {
            let radicand = meeting.radicand;
            (Reach { radicand }, leg_name(meeting))
        });
        ClosedForm {
            pose,
            reach: reach.collect(),
        }
    }
}

/// Intersection of spheres.
struct Meeting<'a> {
    point: Vector3<'a>,
    radicand: Expr<'a>,
    legs: Vec<usize>,
}

/// A platform point whose position is known.
struct LocatedPoint<'a> {
    /// The point in the platform frame.
    at: [Number; 3],
    /// Its position: the intersection of spheres about the legs' joints.
    meeting: Meeting<'a>,
}

/// All subsets of `count` numbers below `all`, in lexicographic order.
fn combinations(all: usize, count: usize) -> Vec<Vec<usize>> {
    if count == 0 {
        return vec![Vec::new()];
    }
    let with_last = |last: usize| {
        let shorter = combinations(last, count - 1).into_iter();
        shorter.map(move |mut choice| {
            choice.push(last);
            choice
        })
    };
    let mut choices: Vec<Vec<usize>> = (count - 1..all).flat_map(with_last).collect();
    choices.sort();
    choices
}

fn half() -> Number {
    Number::ratio(Ratio::new(1, 2).unwrap_or(Ratio::ONE))
}
