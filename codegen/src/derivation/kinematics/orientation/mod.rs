//! Orientations as products of rotations about z and constant tilts.
//!
//! The orientation of one frame in another is multiplied out between the two alone, wherever the
//! legs start.

use super::configuration::Configuration;
use super::joint::joint_turn;
use super::quaternion::{ConstantQuaternion, Quaternion, half};
use super::rates::parallel;
use crate::cas::{Angle, Arena, CosineSine, Direction, Matrix3, Number, Ratio, Vector3};
use crate::derivation::motion_input::MotionInput;
use crate::mechanism::{Leg, Mechanism};

mod right;

/// A factor of an orientation.
#[derive(Debug, Clone, PartialEq)]
enum OrientationFactor {
    /// Rz(rz) Ry(ry) Rx(rx) of constant angles.
    Tilt([Angle; 3]),
    /// A turn about z, of all joints of a run of parallel axes.
    Turn(Direction),
}

/// A frame's orientation in the robot's base frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Orientation(Vec<OrientationFactor>);

impl Orientation {
    /// The orientations of all frames of a leg; `None` if a constant overflows.
    #[must_use]
    pub fn of_leg(
        leg: &Leg,
        first_joint: usize,
        configuration: &Configuration<'_>,
    ) -> Option<Vec<Self>> {
        let mut all: Vec<Self> = Vec::new();
        for (index, joint) in leg.joints.iter().enumerate() {
            let mut parts = match joint.antecedent {
                Some(a) => all[a].0.clone(),
                None => Self::fixed(leg.base.rotation).0,
            };
            let from = match parts.pop_if(|part| matches!(part, OrientationFactor::Turn(_))) {
                Some(OrientationFactor::Turn(turn)) => turn,
                _ => Direction::constant(Angle::ZERO),
            };
            let turned = from.plus(&Direction::constant(joint.gamma))?;
            let theta = joint_turn(leg, index, first_joint, configuration)?;
            let tilt = OrientationFactor::Tilt([joint.alpha, Angle::ZERO, Angle::ZERO]);
            match parallel(joint.alpha) {
                Some(sign) if sign == Ratio::ONE => {
                    parts.push(OrientationFactor::Turn(turned.plus(&theta)?))
                }
                Some(_) => {
                    parts.extend([
                        tilt,
                        OrientationFactor::Turn(turned.negative().plus(&theta)?),
                    ]);
                }
                None => parts.extend([
                    OrientationFactor::Turn(turned),
                    tilt,
                    OrientationFactor::Turn(theta),
                ]),
            }
            all.push(Self(parts));
        }
        Some(all)
    }

    /// Orientation of a frame that has the orientation `next` in this one; `None` on overflow of a
    /// constant.
    #[must_use]
    pub(crate) fn followed_by(&self, next: &Self) -> Option<Self> {
        let mut parts = self.0.clone();
        let mut rest = next.0.as_slice();
        if let (
            Some(OrientationFactor::Turn(last)),
            [OrientationFactor::Turn(first), others @ ..],
        ) = (parts.last_mut(), rest)
        {
            *last = last.plus(first)?;
            rest = others;
        }
        parts.extend_from_slice(rest);
        Some(Self(right::merged(&parts)?))
    }

    /// A constant orientation, such as that of a leg's base.
    #[must_use]
    pub fn fixed(rotation: [Angle; 3]) -> Self {
        let is_turned = rotation.iter().any(|angle| !angle.is_zero());
        Self(
            is_turned
                .then_some(OrientationFactor::Tilt(rotation))
                .into_iter()
                .collect(),
        )
    }

    /// All frames on the paths from the base to a leg's frames, the base frame first.
    #[must_use]
    pub(crate) fn intermediate_frames(frames: &[Self]) -> Vec<Self> {
        let mut frames_on_path: Vec<Self> = Vec::new();
        for frame in frames {
            for length in 0..=frame.0.len() {
                let prefix = Self(frame.0[..length].to_vec());
                if !frames_on_path.contains(&prefix) {
                    frames_on_path.push(prefix);
                }
            }
        }
        frames_on_path
    }

    /// Orientation of `self` in the frame `from`.
    ///
    /// `None` if the configuration does not determine a sine or cosine.
    #[must_use]
    pub fn relative<'a>(
        &self,
        from: &Self,
        arena: &'a Arena,
        configuration: &Configuration<'a>,
    ) -> Option<Matrix3<'a>> {
        let shared = self.0.iter().zip(&from.0).take_while(|(a, b)| a == b);
        let shared = shared.count();
        let (mut forth, mut back) = (&self.0[shared..], &from.0[shared..]);
        let mut middle = Matrix3::identity(arena);
        if let (
            [OrientationFactor::Turn(to), rest @ ..],
            [OrientationFactor::Turn(of), others @ ..],
        ) = (forth, back)
        {
            let turn = to.plus(&of.negative())?;
            middle = OrientationFactor::Turn(turn).matrix(arena, configuration)?;
            (forth, back) = (rest, others);
        }
        let product = |start: Matrix3<'a>, parts: &[OrientationFactor]| {
            parts.iter().try_fold(start, |product, part| {
                Some(product * part.matrix(arena, configuration)?)
            })
        };
        let back = product(Matrix3::identity(arena), back)?.transposed();
        product(back * middle, forth)
    }

    /// The orientation as a unit quaternion, from half angles.
    ///
    /// `None` if it contains a joint that is no input of the function.
    pub(crate) fn quaternion<'a>(
        &self,
        arena: &'a Arena,
        configuration: &Configuration<'a>,
    ) -> Option<Quaternion<'a>> {
        let mut factors = Vec::new();
        let mut scale = Number::ONE;
        for part in &self.0 {
            match part {
                OrientationFactor::Tilt(angles) => {
                    let constant = ConstantQuaternion::new(arena, *angles)?;
                    scale = scale * constant.factor;
                    factors.push(constant.quaternion);
                }
                OrientationFactor::Turn(turn) => {
                    let half = configuration.input_unit(&turn.times(half())?)?;
                    factors.push(Quaternion::about(2, half));
                }
            }
        }
        // The factor of all constants goes to a turn, which has two entries.
        let is_turn = |part: &OrientationFactor| matches!(part, OrientationFactor::Turn(_));
        let scaled = self.0.iter().position(is_turn).unwrap_or_default();
        if let Some(scaled) = factors.get_mut(scaled) {
            scaled.0 = scaled.0.map(|entry| entry * arena.number(scale));
        }
        let one = Quaternion::one(arena);
        Some(
            factors
                .iter()
                .fold(one, |product, factor| product.times(factor)),
        )
    }

    /// Σ R_i v_i over vectors v_i in axes of orientations R_i.
    ///
    /// Vectors with the same first factors of their orientations are summed before these rotate
    /// them. `None` if the configuration does not determine a sine or cosine.
    pub(crate) fn rotated_sum<'a>(
        terms: &[(Self, Vector3<'a>)],
        arena: &'a Arena,
        configuration: &Configuration<'a>,
    ) -> Option<Vector3<'a>> {
        let terms: Vec<(&[OrientationFactor], Vector3<'a>)> = terms
            .iter()
            .filter(|(_, vector)| !vector.is_zero())
            .map(|(orientation, vector)| (orientation.0.as_slice(), *vector))
            .collect();
        rotated(&terms, arena, configuration)
    }
}

/// Σ R_i v_i over vectors behind factors of orientations.
fn rotated<'a>(
    terms: &[(&[OrientationFactor], Vector3<'a>)],
    arena: &'a Arena,
    configuration: &Configuration<'a>,
) -> Option<Vector3<'a>> {
    let mut sum = Vector3::zero(arena);
    let mut firsts: Vec<&OrientationFactor> = Vec::new();
    for (factors, vector) in terms {
        match factors.first() {
            None => sum = sum + *vector,
            Some(first) if !firsts.contains(&first) => firsts.push(first),
            Some(_) => {}
        }
    }
    for first in firsts {
        let behind = terms.iter().filter_map(|(factors, vector)| {
            let (own, rest) = factors.split_first()?;
            (own == first).then_some((rest, *vector))
        });
        let behind = rotated(&behind.collect::<Vec<_>>(), arena, configuration)?;
        sum = sum + first.matrix(arena, configuration)? * behind;
    }
    Some(sum)
}

/// The axes in which a chain's closure expresses its end body, if not those of the body at its
/// start.
///
/// Orientations are in the robot's base frame.
#[derive(Debug)]
pub(crate) struct ObserverFrame {
    /// Orientation of the body that the chain starts from.
    pub(crate) from: Orientation,
    /// Orientation of the axes.
    pub(crate) axes: Orientation,
}

/// Indices of the frames in whose axes a leg's closure may be written.
///
/// It is the base alone if the closure uses only some components of a velocity and other axes would
/// mix them with the rest.
#[must_use]
pub(crate) fn closure_frame_choices(mechanism: &Mechanism, leg: usize) -> Vec<usize> {
    let arena = Arena::new();
    let configuration = Configuration::new(&arena, mechanism, MotionInput::Joints);
    let first_joint = mechanism.leg_range(leg).start;
    Orientation::of_leg(&mechanism.legs[leg], first_joint, &configuration)
        .map(|frames| Orientation::intermediate_frames(&frames))
        .filter(|axes| keep_rows(mechanism, leg, &arena, &configuration, axes))
        .map_or(vec![0], |axes| distinct(&axes, &arena, &configuration))
}

/// Index of the frame in whose axes the closure of a chain that blocks directions is written; `None`
/// for other legs.
///
/// It is that of the last body: in its axes, a rod blocks the direction along it in every
/// configuration.
pub(crate) fn blocking_frame(mechanism: &Mechanism, leg: usize) -> Option<usize> {
    let choices = mechanism
        .blocking
        .contains(&leg)
        .then(|| closure_frame_choices(mechanism, leg));
    choices?.last().copied()
}

/// Indices of axes that are not signed permutations of others, which cost the same.
pub(crate) fn distinct<'a>(
    axes: &[Orientation],
    arena: &'a Arena,
    configuration: &Configuration<'a>,
) -> Vec<usize> {
    let mut own: Vec<usize> = Vec::new();
    for (at, one) in axes.iter().enumerate() {
        let is_known = own.iter().any(|&other| {
            let turn = one.relative(&axes[other], arena, configuration);
            turn.is_some_and(|turn| turn.is_signed_permutation())
        });
        if !is_known {
            own.push(at);
        }
    }
    own
}

/// Whether a leg's closure uses all three components of each velocity or none, so that any axes
/// will do.
pub(crate) fn may_use_any_axes(mechanism: &Mechanism, leg: usize) -> bool {
    let rows = mechanism.closure_rows(leg);
    [0, 1].iter().all(|&part| {
        let count = rows.iter().filter(|&&row| row / 3 == part).count();
        count == 0 || count == 3
    })
}

/// Whether a leg's closure has the same components in all of some axes.
///
/// It does if it uses all three components of a velocity or none, or if the axes rotate about the
/// components left out. The components refer to the first axes.
pub(crate) fn keep_rows<'a>(
    mechanism: &Mechanism,
    leg: usize,
    arena: &'a Arena,
    configuration: &Configuration<'a>,
    axes: &[Orientation],
) -> bool {
    let rows = if mechanism.has_dependent_coordinates() {
        // The axes themselves decide which of the shared components determine the joints.
        mechanism.legs[leg].shared_components()
    } else {
        mechanism.closure_rows(leg)
    };
    let parts = [0, 1].map(|part| {
        let own = rows.iter().filter(|&&row| row / 3 == part);
        own.map(|row| row % 3).collect::<Vec<_>>()
    });
    let parts = || parts.iter().filter(|part| ![0, 3].contains(&part.len()));
    let Some(first) = axes.first().filter(|_| parts().next().is_some()) else {
        return true;
    };
    axes.iter().all(|other| {
        let turn = other.relative(first, arena, configuration);
        turn.is_some_and(|turn| parts().all(|part| turn.is_block_diagonal(part)))
    })
}

impl OrientationFactor {
    fn matrix<'a>(
        &self,
        arena: &'a Arena,
        configuration: &Configuration<'a>,
    ) -> Option<Matrix3<'a>> {
        match self {
            Self::Tilt(angles) => Some(constant_rotation(arena, *angles)),
            Self::Turn(turn) => {
                let CosineSine { cosine, sine } = configuration.unit(turn)?;
                Some(Matrix3::rotation(2, cosine, sine))
            }
        }
    }
}

/// Rz(rz) Ry(ry) Rx(rx) of constant angles.
#[must_use]
pub(crate) fn constant_rotation(arena: &Arena, rotation: [Angle; 3]) -> Matrix3<'_> {
    let about = |axis: usize| {
        let (cosine, sine) = rotation[axis].cosine_and_sine();
        Matrix3::rotation(axis, arena.number(cosine), arena.number(sine))
    };
    about(2) * about(1) * about(0)
}
