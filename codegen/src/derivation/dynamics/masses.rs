//! Mass matrix of the whole robot from those of its legs and the platform's inertia.
//!
//! M = Σ Gᵀ M_leg G with the legs' reduced Jacobians G = ∂u/∂v; only the upper triangle is
//! computed. If a leg ends in a point and no joint moves its end's rotation, the rows of G are
//! forces f_i at that point. The leg is then a mass tensor Λ = Σ f_i M_ij f_jᵀ at the arm p, with
//! the blocks Λ, Λ [p]×ᵀ and [p]× Λ [p]×ᵀ.

use crate::cas::{Expr, Matrix3, Vector3};
use crate::derivation::bodies::inertia::Inertia;
use crate::derivation::bodies::platform_body::Mount;
use crate::derivation::closure::leg_closure::LegClosure;
use crate::derivation::linear_algebra::elimination::Rows;
use crate::derivation::linear_algebra::linear::{dot, transposed};
use crate::derivation::names::{Names, name_matrix};
use crate::derivation::parameter::BodyParameter;
use crate::derivation::robot::Robot;
use crate::mechanism::TwistCoordinate;

impl<'a> Robot<'a> {
    /// M for given parameters. `None` if the configuration does not determine a sine or cosine.
    pub(crate) fn masses(&self, values: &[(BodyParameter, Expr<'a>)]) -> Option<Rows<'a>> {
        // Platforms carry no legs.
        if self
            .mechanism
            .legs
            .iter()
            .any(|leg| leg.base_body.is_some())
        {
            return self.tree_masses(values);
        }
        let dof = self.mechanism.dof();
        let square = |size: usize| vec![vec![self.arena.zero(); size]; size];
        let mut sum = square(dof);
        // Quantities per component of the velocity of a platform with parasitic motion.
        let mut free = square(self.free.len());
        for (index, state) in self.legs.iter().enumerate() {
            let name = &self.mechanism.legs[index].name;
            self.arena.enter(name);
            let upper = self.leg_masses(index, values)?;
            if upper.is_empty() {
                continue;
            }
            let masses: Rows<'a> = (0..upper.len())
                .map(|i| {
                    let entry = |k: usize| upper[i.min(k)][i.max(k) - i.min(k)];
                    (0..upper.len()).map(entry).collect()
                })
                .collect();
            name_matrix(&masses, &format!("masses_{name}"));
            let at_end = state.closure.as_ref().filter(|c| c.feels_no_moment());
            match at_end.filter(|_| self.platform.is_some()) {
                Some(closure) => {
                    let tensor = closure.mass_at_end(&masses);
                    let entry = on_twist(&self.free, tensor, closure.arm);
                    if self.parasitic_motion.is_some() {
                        add(&mut free, &entry)
                    } else {
                        add(&mut sum, &entry)
                    }
                }
                None => {
                    let columns = transposed(&state.rows);
                    let moved: Rows<'a> = columns
                        .iter()
                        .map(|column| masses.iter().map(|row| dot(row, column)).collect())
                        .collect();
                    add(&mut sum, &|a, b| dot(&columns[a], &moved[b]));
                }
            }
        }
        self.arena.enter("platform");
        if let Some(entry) = self.platform_masses(values) {
            if self.parasitic_motion.is_some() {
                add(&mut free, &entry)
            } else {
                add(&mut sum, &entry)
            }
        }
        if let Some(parasitic) = &self.parasitic_motion {
            let size = free.len();
            let entry = |a: usize, b: usize| free[a.min(b)][a.max(b)];
            let rows = (0..size).map(|a| {
                let row: Vec<Expr<'a>> = (0..size).map(|b| entry(a, b)).collect();
                parasitic.on_independent(&row)
            });
            let columns = transposed(&rows.collect());
            let both: Rows<'a> = columns
                .iter()
                .map(|c| parasitic.on_independent(c))
                .collect();
            add(&mut sum, &|a, b| both[b][a]);
        }
        self.arena.enter("");
        let entry = |a: usize, b: usize| sum[a.min(b)][a.max(b)];
        let row = |a: usize| (0..dof).map(|b| entry(a, b)).collect();
        Some((0..dof).map(row).collect())
    }

    /// Mass matrix of all bodies that move with the platform.
    fn platform_masses(
        &self,
        values: &[(BodyParameter, Expr<'a>)],
    ) -> Option<impl Fn(usize, usize) -> Expr<'a> + '_> {
        let pose = self.platform.as_ref()?;
        let Inertia {
            mass,
            first,
            second,
        } = self.platform_inertia(values).rotated(pose.rotation);
        let zero = self.arena.zero();
        Some(
            move |a: usize, b: usize| match (self.free[a], self.free[b]) {
                (TwistCoordinate::Linear(i), TwistCoordinate::Linear(j)) if i == j => mass,
                (TwistCoordinate::Linear(_), TwistCoordinate::Linear(_)) => zero,
                (TwistCoordinate::Linear(i), TwistCoordinate::Angular(j)) => {
                    Vector3::unit(self.arena, j).cross(first).0[i]
                }
                (TwistCoordinate::Angular(i), TwistCoordinate::Linear(j)) => {
                    Vector3::unit(self.arena, i).cross(first).0[j]
                }
                (TwistCoordinate::Angular(i), TwistCoordinate::Angular(j)) => second.0[i][j],
            },
        )
    }

    /// Inertia of all bodies that move with the platform, in the platform's frame.
    pub(crate) fn platform_inertia(&self, values: &[(BodyParameter, Expr<'a>)]) -> Inertia<'a> {
        let mut whole = Inertia::of(self.arena, values, &|p| p.of_platform());
        for (index, leg) in self.mechanism.legs.iter().enumerate() {
            for (at, mount) in Mount::of_leg(self.arena, leg).iter().enumerate() {
                let Some(mount) = mount else { continue };
                let body = Inertia::of(self.arena, values, &|p| p.of_joint(index, at));
                whole = mount.on_platform(self.arena, &body, &whole);
            }
        }
        let mut names = Names::default();
        whole.name(&mut names, "", "platform");
        names.give();
        whole
    }
}

/// Adds to the upper triangle of a matrix.
fn add<'a>(sum: &mut Rows<'a>, part: &dyn Fn(usize, usize) -> Expr<'a>) {
    for (a, row) in sum.iter_mut().enumerate() {
        for (b, entry) in row.iter_mut().enumerate().skip(a) {
            *entry = *entry + part(a, b);
        }
    }
}

/// Entries on the twist coordinates of a mass tensor at an arm.
fn on_twist<'a>(
    twist: &[TwistCoordinate],
    tensor: Matrix3<'a>,
    arm: Vector3<'a>,
) -> impl Fn(usize, usize) -> Expr<'a> {
    // Row i of Λ [p]×ᵀ is p × Λ_i; column j of [p]× Λ [p]×ᵀ is p × (column j of Λ [p]×ᵀ).
    let mixed = Matrix3(std::array::from_fn(|i| arm.cross(tensor.row(i)).0));
    let turning = Matrix3(std::array::from_fn(|j| arm.cross(mixed.column(j)).0));
    move |a, b| match (twist[a], twist[b]) {
        (TwistCoordinate::Linear(i), TwistCoordinate::Linear(j)) => tensor.0[i][j],
        (TwistCoordinate::Linear(i), TwistCoordinate::Angular(j))
        | (TwistCoordinate::Angular(j), TwistCoordinate::Linear(i)) => mixed.0[i][j],
        (TwistCoordinate::Angular(i), TwistCoordinate::Angular(j)) => turning.0[i][j],
    }
}

impl<'a> LegClosure<'a> {
    /// Whether a moment at the leg's end loads no joint.
    pub(crate) fn feels_no_moment(&self) -> bool {
        self.moments.iter().all(|moment| moment.is_zero())
    }

    /// Σ f_i M_ij f_jᵀ.
    fn mass_at_end(&self, masses: &Rows<'a>) -> Matrix3<'a> {
        let axis = |c: usize| -> Vec<Expr<'a>> { self.forces.iter().map(|f| f.0[c]).collect() };
        let moved: Rows<'a> = (0..3)
            .map(|c| masses.iter().map(|row| dot(row, &axis(c))).collect())
            .collect();
        Matrix3(std::array::from_fn(|i| {
            std::array::from_fn(|j| dot(&axis(i.min(j)), &moved[i.max(j)]))
        }))
    }
}
