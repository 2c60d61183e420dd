//! Mass, first moment and inertia of rigidly connected bodies about a frame's origin.

use super::body::{place, second_moment};
use crate::cas::{Arena, Expr, Matrix3, Vector3};
use crate::derivation::kinematics::spatial::{SpatialMotion, Wrench};
use crate::derivation::kinematics::turn::Turn;
use crate::derivation::names::{AXES, Names};
use crate::derivation::parameter::BodyParameter;
use overact_description::StandardParameter;

/// Inertia of a body or of rigidly connected bodies.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inertia<'a> {
    /// Mass.
    pub(crate) mass: Expr<'a>,
    /// First moment.
    pub(crate) first: Vector3<'a>,
    /// Inertia about the frame's origin, symmetric.
    pub(crate) second: Matrix3<'a>,
}

impl<'a> Inertia<'a> {
    /// Zero inertia.
    pub(crate) fn zero(arena: &'a Arena) -> Self {
        Self {
            mass: arena.zero(),
            first: Vector3::zero(arena),
            second: Matrix3([[arena.zero(); 3]; 3]),
        }
    }

    /// Inertia of a point mass at the origin.
    pub(crate) fn point(mass: Expr<'a>) -> Self {
        Self {
            mass,
            ..Self::zero(mass.arena())
        }
    }

    /// Inertia from the values of a body's inertial parameters; repeated parameters add up.
    pub(crate) fn of(
        arena: &'a Arena,
        values: &[(BodyParameter, Expr<'a>)],
        own: &dyn Fn(BodyParameter) -> Option<StandardParameter>,
    ) -> Self {
        let mut sum = Self::zero(arena);
        for (parameter, value) in values {
            let Some((i, j)) = own(*parameter).and_then(place) else {
                continue;
            };
            if (i, j) == (3, 3) {
                sum.mass = sum.mass + *value;
                continue;
            }
            if j == 3 {
                sum.first.0[i] = sum.first.0[i] + *value;
                continue;
            }
            sum.second.0[i][j] = sum.second.0[i][j] + *value;
            sum.second.0[j][i] = sum.second.0[i][j];
        }
        sum
    }

    /// The inertia in the antecedent's axes, about the same origin.
    pub(crate) fn turned_back(&self, turn: &Turn<'a>) -> Self {
        Self {
            mass: self.mass,
            first: turn.back(self.first),
            second: turn.back_symmetric(self.second),
        }
    }

    /// The inertia in other axes, about the same origin.
    pub(crate) fn rotated(&self, rotation: Matrix3<'a>) -> Self {
        let moved = rotation * self.second;
        let entry = |i: usize, j: usize| moved.row(i.min(j)).dot(rotation.row(i.max(j)));
        Self {
            mass: self.mass,
            first: rotation * self.first,
            second: Matrix3(std::array::from_fn(|i| {
                std::array::from_fn(|j| entry(i, j))
            })),
        }
    }

    /// Adds this inertia to `onto`, after a translation by `at` (parallel axis theorem).
    ///
    /// Both frames have parallel axes; the origin of this one is at `at` in that of `onto`.
    pub(crate) fn moved_onto(&self, onto: &Self, at: Vector3<'a>) -> Self {
        let arm = at.scaled(self.mass);
        let (before, after) = (self.first, self.first + arm);
        let mut second = onto.second;
        // Σ m ((r + l)² 1 - (r + l)(r + l)ᵀ) exceeds Σ m (r² 1 - r rᵀ) by products of h = Σ m r and
        // l; the diagonal has g_k l_k with g = 2 h + m l.
        let along: [Expr<'a>; 3] = std::array::from_fn(|k| (before.0[k] + after.0[k]) * at.0[k]);
        for i in 0..3 {
            for j in i..3 {
                let more = if i == j {
                    along[(i + 1) % 3] + along[(i + 2) % 3]
                } else {
                    -(after.0[i] * at.0[j] + before.0[j] * at.0[i])
                };
                second.0[i][j] = second.0[i][j] + self.second.0[i][j] + more;
                second.0[j][i] = second.0[i][j];
            }
        }
        Self {
            mass: onto.mass + self.mass,
            first: onto.first + arm + before,
            second,
        }
    }

    /// Splits off the inertia that is invariant under rotation about z; also returns the rest.
    ///
    /// The invariant part is that of a rod along z: the mass, the first moment along z, and equal
    /// moments of inertia about x and y.
    pub(crate) fn split_about_z(&self) -> [Self; 2] {
        let arena = self.mass.arena();
        let (mut rod, mut rest) = (Self::zero(arena), *self);
        let across = self.second.0[1][1];
        rod.mass = self.mass;
        rod.first.0[2] = self.first.z();
        rod.second.0[0][0] = across;
        rod.second.0[1][1] = across;
        rest.mass = arena.zero();
        rest.first.0[2] = arena.zero();
        rest.second.0[0][0] = self.second.0[0][0] - across;
        rest.second.0[1][1] = arena.zero();
        [rod, rest]
    }

    /// Splits off the inertia that is invariant under translation along z; also returns the rest.
    ///
    /// The invariant part is the second moments without mass and first moment.
    pub(crate) fn split_along_z(&self) -> [Self; 2] {
        let (mut kept, mut rest) = (Self::zero(self.mass.arena()), *self);
        kept.second = self.second;
        rest.second = Matrix3([[self.mass.arena().zero(); 3]; 3]);
        [kept, rest]
    }

    /// Moment I ω̇ + ω × I ω in the body's axes.
    pub(crate) fn turning_moment(&self, omega: Vector3<'a>, alpha: Vector3<'a>) -> Vector3<'a> {
        use StandardParameter as P;
        let arena = self.mass.arena();
        let s = &self.second.0;
        let diagonal = |i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            s[i][i] * alpha.0[i] + (s[k][k] - s[j][j]) * (omega.0[j] * omega.0[k])
        };
        let off_diagonal = [(P::Xy, s[0][1]), (P::Xz, s[0][2]), (P::Yz, s[1][2])];
        let start = Vector3(std::array::from_fn(diagonal));
        off_diagonal
            .into_iter()
            .fold(start, |sum, (symbol, value)| {
                sum + second_moment(arena, symbol, omega, alpha).scaled(value)
            })
    }

    /// Wrench about the origin that accelerates the body from rest.
    pub(crate) fn wrench(&self, acceleration: &SpatialMotion<'a>) -> Wrench<'a> {
        let SpatialMotion { linear, angular } = *acceleration;
        Wrench {
            force: linear.scaled(self.mass) + angular.cross(self.first),
            moment: self.second * angular + self.first.cross(linear),
        }
    }

    /// Names the components in generated code, such as `mass2_leg1` and `inertia2_xy_leg1`.
    pub(crate) fn name(&self, names: &mut Names<'a>, body: &str, place: &str) {
        let end = if place.is_empty() {
            String::new()
        } else {
            format!("_{place}")
        };
        names.one(self.mass, format!("mass{body}{end}"));
        names.vector(self.first, &format!("first{body}"), place);
        for (i, row) in AXES.iter().enumerate() {
            for (j, column) in AXES.iter().enumerate().skip(i) {
                let what = format!("inertia{body}_{row}{column}{end}");
                names.one(self.second.0[i][j], what);
            }
        }
    }
}
