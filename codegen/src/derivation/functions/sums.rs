//! Functions of given parameters as sums over the legs, and their outputs from the sums alone.
//!
//! The mass matrix M, the bias h and Γ¹ are linear in the parameters, so they are sums of the parts
//! of each leg's bodies and of the platform. So is JᵀJ with J = J_p^inv, in which each leg has the
//! rows of its own actuators. Solving with these sums needs no single leg. The torques of a leg are
//! its rows of J times the solution x = (JᵀJ)⁻¹ Γ¹. With Jᵀ (q - q(x)) instead of Γ¹, the solution
//! is a step of forward kinematics. A small square J is solved by cofactors, from the rows of all
//! legs. So the function is written for one leg only, and used for all legs that differ from it by
//! numbers only.

use super::actuators::{ActuatorSystem, COFACTORS};
use super::{Derived, derive_with, with_divisors};
use crate::cas::{Arena, Expr, InputElement};
use crate::derivation::context::{DerivationContext, Owner, column};
use crate::derivation::derivation_error::DerivationError;
use crate::derivation::dynamics::actuated_joint_forces::ActuatedJointForces;
use crate::derivation::function_form::FunctionForm;
use crate::derivation::guard::{Guard, GuardKind};
use crate::derivation::linear_algebra::elimination::{Rows, inverse};
use crate::derivation::linear_algebra::linear::{Factored, apply, dot, transposed};
use crate::derivation::selection::Selection;
use crate::mechanism::Mechanism;
use overact_core::{ActuatorGroup, Columns, Function};

/// The name of the array of the sums.
pub(crate) const SUMS: &str = "sums";

/// The name of the array of the legs' rows.
pub(crate) const ROWS: &str = "rows";

/// Contributions of one leg and the platform to the sums of a function.
#[derive(Debug)]
pub(crate) struct Addends<'a> {
    /// The entries: contributions of the first leg and of the platform to each sum, and the rows.
    pub(crate) derived: Derived<'a>,
    /// Number of sums.
    pub(crate) count: usize,
    /// Number of rows of the first leg, one per actuator: of J, and the force on the actuator
    /// itself.
    pub(crate) rows: usize,
    /// Whether the rows are solved by cofactors.
    pub(crate) by_cofactors: bool,
}

/// Contributions to a function, by origin.
#[derive(Default)]
struct Parts<'a> {
    of_leg: Vec<Expr<'a>>,
    of_all: Vec<Expr<'a>>,
    rows: Vec<Expr<'a>>,
    by_cofactors: bool,
}

/// Contributions of one leg and the platform to a function of given parameters.
///
/// `None` if the function is not a sum.
///
/// # Errors
/// See [`DerivationError`].
pub(crate) fn derive_addends<'a>(
    arena: &'a Arena,
    mechanism: &'a Mechanism,
    selection: &Selection,
    form: FunctionForm,
) -> Result<Option<Addends<'a>>, DerivationError> {
    let mut shape = None;
    let derived = derive_with(arena, mechanism, selection, form, |context| {
        let Some(parts) = context.addends(form.function) else {
            return Ok(Vec::new());
        };
        let rows = parts.rows.len() / (mechanism.dof() + 1);
        shape = Some((parts.of_leg.len(), rows, parts.by_cofactors));
        Ok(column([parts.of_leg, parts.of_all, parts.rows].concat()))
    })?;
    let Some((count, rows, by_cofactors)) = shape else {
        return Ok(None);
    };
    Ok(Some(Addends {
        derived: with_divisors(arena, mechanism, derived)?,
        count,
        rows,
        by_cofactors,
    }))
}

/// Output of a function from its sums, or the factor of its rows.
///
/// The caller, who knows the sums at home, sets the magnitudes of the divisors there.
pub(crate) fn derive_of_sums(arena: &Arena, function: Function, dof: usize) -> Derived<'_> {
    let sum = |index| arena.input(SUMS, index);
    let upper = dof * (dof + 1) / 2;
    let vector = |first: usize| (first..first + dof).map(sum).collect::<Vec<Expr<'_>>>();
    let symmetric = || symmetric(dof, &sum);
    let kind = match function {
        Function::InverseDynamics(_) | Function::PoseStep => GuardKind::Platform {
            home: 1.0,
            actuators: ActuatorGroup::All,
        },
        _ => GuardKind::Mass,
    };
    let (rows, count, pivots) = match function {
        Function::MassMatrix(_) => (symmetric(), upper, Vec::new()),
        Function::InverseDynamics(_) | Function::ForwardDynamics(_) | Function::PoseStep => {
            let factored = Factored::of(symmetric());
            let solved = factored.solve(&vector(upper));
            (column(solved), upper + dof, factored.pivots)
        }
        _ => (column(vector(0)), dof, Vec::new()),
    };
    of_inputs(vec![(SUMS, count)], rows, &pivots, kind)
}

/// Layout of the numbers that legs of one shape contribute to the actuators' system.
///
/// Each actuator of a leg has a row of J and the force on the actuator itself.
pub(crate) struct LegRowLayout<'l> {
    /// Degrees of freedom: the columns of J.
    pub(crate) dof: usize,
    /// Number of legs.
    pub(crate) legs: usize,
    /// For each number of a leg, row by row, whether it may differ from zero.
    pub(crate) is_present: &'l [bool],
}

impl LegRowLayout<'_> {
    /// Length of a row.
    const fn width(&self) -> usize {
        self.dof + 1
    }

    /// Index of a number of a leg among the present ones of all legs; `None` if it is zero.
    fn place(&self, leg: usize, number: usize) -> Option<usize> {
        let before = self.is_present[..number].iter();
        let before = before.filter(|is_present| **is_present).count();
        self.is_present[number].then_some(before * self.legs + leg)
    }

    /// Count of the present numbers of all legs.
    fn count(&self) -> usize {
        let present = self.is_present.iter();
        present.filter(|is_present| **is_present).count() * self.legs
    }
}

/// Torques τ = τ_own + J⁻ᵀ F of a small square J, from the legs' rows of J and τ_own.
///
/// `None` if J is not solved by cofactors.
pub(crate) fn derive_of_rows<'a>(
    arena: &'a Arena,
    layout: &LegRowLayout<'_>,
    home: &dyn Fn(InputElement) -> Option<f64>,
) -> Option<Derived<'a>> {
    let (dof, width) = (layout.dof, layout.width());
    let number = |leg: usize, at: usize| match layout.place(leg, at) {
        Some(place) => arena.input(ROWS, place),
        None => arena.zero(),
    };
    let row = |leg: usize, row: usize| -> Vec<Expr<'a>> {
        let numbers = row * width..(row + 1) * width;
        numbers.map(|at| number(leg, at)).collect()
    };
    let rows_of_leg = layout.is_present.len() / width;
    let rows = (0..layout.legs).flat_map(|leg| (0..rows_of_leg).map(move |k| (leg, k)));
    let rows: Rows<'a> = rows.map(|(leg, k)| row(leg, k)).collect();
    let jacobian: Rows<'a> = rows.iter().map(|row| row[..dof].to_vec()).collect();
    let known = |symbol| home(arena.input_element(symbol)?);
    let at_home = |value: Expr<'a>| value.evaluate(&|symbol| known(symbol).unwrap_or(0.1));
    let inverse = inverse(&jacobian, &at_home).filter(|i| i.largest_block <= COFACTORS)?;
    let pivots = inverse.determinants.clone();
    let forces: Vec<Expr<'a>> = (0..dof).map(|index| arena.input(SUMS, index)).collect();
    let torques = ActuatorSystem::Square(inverse).torques(&forces);
    let torques = torques.iter().zip(&rows).map(|(t, row)| row[dof] + *t);
    let kind = GuardKind::Platform {
        home: 1.0,
        actuators: ActuatorGroup::All,
    };
    let inputs = vec![(SUMS, dof), (ROWS, layout.count())];
    Some(of_inputs(inputs, column(torques.collect()), &pivots, kind))
}

/// A function with guarded pivots.
fn of_inputs<'a>(
    inputs: Vec<(&'static str, usize)>,
    rows: Rows<'a>,
    pivots: &[Expr<'a>],
    kind: GuardKind,
) -> Derived<'a> {
    let guards = pivots.iter().map(|pivot| Guard {
        value: pivot.factor_and_base().1,
        kind,
        leg: String::new(),
    });
    let guards: Vec<Guard<'_>> = guards.collect();
    Derived {
        inputs,
        shape: (rows.len(), rows.first().map_or(0, Vec::len)),
        entries: rows.concat(),
        divisors: guards.clone(),
        guards,
    }
}

/// A symmetric matrix from its upper triangle, row by row.
fn symmetric<'a>(size: usize, entry: &dyn Fn(usize) -> Expr<'a>) -> Rows<'a> {
    let at = |i: usize, j: usize| {
        let (i, j) = (i.min(j), i.max(j));
        entry(i * size - i * (i + 1) / 2 + j)
    };
    let row = |i| (0..size).map(|j| at(i, j)).collect();
    (0..size).map(row).collect()
}

/// The upper triangle of a symmetric matrix, row by row.
fn upper<'a>(matrix: &Rows<'a>) -> Vec<Expr<'a>> {
    let rows = matrix.iter().enumerate();
    rows.flat_map(|(i, row)| row[i..].to_vec()).collect()
}

impl<'a> DerivationContext<'a, '_> {
    /// Contributions of the first leg and of the platform to each sum, and the first leg's rows.
    fn addends(&mut self, function: Function) -> Option<Parts<'a>> {
        let n = self.robot.mechanism.actuator_count();
        let mut parts = Parts::default();
        for owner in [Owner::Leg(0), Owner::Platform] {
            self.owner = owner;
            let added = match function {
                Function::MassMatrix(of) => upper(&self.mass_matrix(of)),
                Function::Bias(of) => self.own_bias(of),
                Function::ForwardDynamics(of) => self.own_forward(of, n),
                Function::InverseDynamics(of) => self.own_inverse(of, &mut parts),
                Function::PoseStep if n != self.robot.mechanism.dof() => self.own_step(),
                _ => return None,
            };
            match owner {
                Owner::Leg(_) => parts.of_leg = added,
                _ => parts.of_all = added,
            }
        }
        let is_whole = !parts.of_leg.is_empty() && parts.of_leg.len() == parts.of_all.len();
        is_whole.then_some(parts)
    }

    /// The owner's rows of J.
    fn own_jacobian(&self) -> Rows<'a> {
        let Owner::Leg(leg) = self.owner else {
            return Vec::new();
        };
        let mechanism = self.robot.mechanism;
        let joints = mechanism.joints();
        let rows = self.robot.inverse_jacobian().into_iter();
        let rows = rows.zip(mechanism.actuated());
        let own = rows.filter(|(_, joint)| joints[*joint].leg == leg);
        own.map(|(row, _)| row).collect()
    }

    /// Contribution of the owner to JᵀJ.
    fn own_normal(&self) -> Rows<'a> {
        let rows = self.own_jacobian();
        if rows.is_empty() {
            return vec![self.zeros(); self.robot.mechanism.dof()];
        }
        let columns = transposed(&rows);
        let row = |a: &Vec<Expr<'a>>| columns.iter().map(|b| dot(a, b)).collect();
        columns.iter().map(row).collect()
    }

    /// Contributions of the owner to JᵀJ and to Jᵀ (q - q(x)).
    fn own_step(&mut self) -> Vec<Expr<'a>> {
        let differences = self.differences();
        let rows = self.own_jacobian();
        let moved = if rows.is_empty() {
            self.zeros()
        } else {
            apply(&transposed(&rows), &differences[..rows.len()])
        };
        [upper(&self.own_normal()), moved].concat()
    }

    /// Contribution of the owner to h.
    fn own_bias(&mut self, of: Columns) -> Vec<Expr<'a>> {
        let (twist, still) = (self.twist(), self.zeros());
        self.projected_dynamics(of, &twist, &still)
    }

    /// Contribution of the owner to Jᵀ τ.
    fn moving(&mut self, n: usize) -> Vec<Expr<'a>> {
        let rows = self.own_jacobian();
        if rows.is_empty() {
            return self.zeros();
        }
        let torques = self.input("torques", n);
        apply(&transposed(&rows), &torques[..rows.len()])
    }

    /// Contributions of the owner to M and to Jᵀ τ - h.
    fn own_forward(&mut self, of: Columns, n: usize) -> Vec<Expr<'a>> {
        let _ = (self.twist(), self.input("torques", n));
        let mut all = upper(&self.mass_matrix(of));
        let bias = self.own_bias(of);
        let moving = self.moving(n);
        all.extend(moving.iter().zip(&bias).map(|(force, bias)| *force - *bias));
        all
    }

    /// Contributions of the owner to Γ¹ and, unless J is solved by cofactors, to JᵀJ.
    ///
    /// A leg's rows of J, with the forces on the actuators themselves, go to `parts`.
    fn own_inverse(&mut self, of: Columns, parts: &mut Parts<'a>) -> Vec<Expr<'a>> {
        let (twist, acceleration) = (self.twist(), self.acceleration());
        let mut own = ActuatedJointForces::of(&self.robot);
        let forces = self.dynamics_of(of, &twist, &acceleration, &mut own);
        let rows = self.own_jacobian();
        parts.by_cofactors = self.by_cofactors(&self.robot.inverse_jacobian()).is_some();
        if !rows.is_empty() {
            let direct = own.with(vec![self.robot.arena.zero(); rows.len()]);
            let row = |(row, own): (&Vec<Expr<'a>>, &Expr<'a>)| [&row[..], &[*own]].concat();
            parts.rows = rows.iter().zip(&direct).flat_map(row).collect();
        }
        if parts.by_cofactors {
            forces
        } else {
            [upper(&self.own_normal()), forces].concat()
        }
    }
}
