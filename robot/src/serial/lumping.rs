//! Inertial parameters of the skeleton's bodies that fit the robot's dynamics.
//!
//! The inertia matrix and the torque of gravity are linear in the parameters. They are fitted by
//! least squares over the states. Bodies are physically consistent: the pseudo-inertia of each is
//! L Lᵀ plus a small multiple of the unit matrix (Rucker, Wensing 2022). Rotor inertias on the joints
//! are squares. The unknowns are the entries of L and the roots, found by the method of Levenberg and
//! Marquardt.

use super::pseudo_inertia::{parameters, pseudo_inertia};
use super::states::State;
use super::tree::{INERTIAL, Tree};
use nalgebra::{DMatrix, DVector, Matrix4, SymmetricEigen, Vector3};

/// Weight of the distance from the bodies' own inertia, for parameters without effect.
const REGULARISATION: f64 = 1e-6;
/// Smallest eigenvalue of a pseudo-inertia, relative to the robot's mass.
const FLOOR: f64 = 1e-9;
/// Smallest eigenvalues of the starts of the search.
const START_FLOORS: [f64; 3] = [1e-3, 1e-2, 1e-1];
/// Smallest rotor inertia of a start, relative to the inertia of its coordinate.
const START_ROTOR: f64 = 1e-3;
/// Residual at which the bodies' own parameters are kept.
const EXACT: f64 = 1e-9;
/// Largest number of steps, and decrease of the cost that ends the search.
const STEPS: usize = 400;
const DECREASE: f64 = 1e-10;
/// States for each step of the orthogonal factorisation.
const BATCH: usize = 40;

/// Scales of the compared quantities.
#[derive(Debug, Clone)]
pub(super) struct Scales {
    /// Roots of the mean diagonal of the inertia matrix.
    pub(super) coordinates: Vec<f64>,
    /// Root mean squares of the scaled inertia matrix, gravity and velocity torques.
    pub(super) inertia: f64,
    pub(super) gravity: f64,
    pub(super) velocity: f64,
}

impl Scales {
    /// Scales of a set of states.
    pub(super) fn new(states: &[State]) -> Self {
        let count = states.len().max(1) as f64;
        let r = states.first().map_or(0, |state| state.twist.len());
        let mean = |at: usize| {
            states
                .iter()
                .map(|state| state.inertia[(at, at)])
                .sum::<f64>()
                / count
        };
        let roots = (0..r).map(|at| mean(at).max(f64::MIN_POSITIVE).sqrt());
        let mut scales = Self {
            coordinates: roots.collect(),
            inertia: 1.0,
            gravity: 1.0,
            velocity: 1.0,
        };
        let rms = |norm: &dyn Fn(&State) -> f64| {
            let squares = states.iter().map(|state| norm(state).powi(2));
            (squares.sum::<f64>() / count).sqrt()
        };
        let all = [
            rms(&|state| scales.matrix(&state.inertia)),
            rms(&|state| scales.vector(&state.gravity)),
            rms(&|state| scales.vector(&state.velocity)),
        ];
        [scales.inertia, scales.gravity, scales.velocity] = all;
        scales
    }

    /// Norm of a matrix with scaled coordinates.
    pub(super) fn matrix(&self, matrix: &DMatrix<f64>) -> f64 {
        let d = &self.coordinates;
        let entry = |i: usize, j: usize| matrix[(i, j)] / (d[i] * d[j]);
        let all = (0..d.len()).flat_map(|i| (0..d.len()).map(move |j| (i, j)));
        all.map(|(i, j)| entry(i, j).powi(2)).sum::<f64>().sqrt()
    }

    /// Norm of torques with scaled coordinates.
    pub(super) fn vector(&self, vector: &DVector<f64>) -> f64 {
        let pairs = vector.iter().zip(&self.coordinates);
        pairs.map(|(x, d)| (x / d).powi(2)).sum::<f64>().sqrt()
    }
}

/// A fit of the tree's parameters.
pub(super) struct Lumping<'a> {
    pub(super) tree: &'a Tree,
    pub(super) states: &'a [State],
    pub(super) gravity: Vector3<f64>,
    /// Rotor inertias on the joints, r, at the start of the fit; empty if the file has none.
    pub(super) armature: &'a [f64],
    /// Length of the robot, m.
    pub(super) length: f64,
    /// Inertia of the skeleton's own bodies, 10 B.
    pub(super) own: &'a [f64],
}

impl Lumping<'_> {
    /// Physically consistent parameters of the bodies, 10 B, then nonnegative rotor inertias.
    pub(super) fn fitted(&self) -> Vec<f64> {
        let scales = Scales::new(self.states);
        let units = self.units(&scales);
        let (factor, right) = self.factor(&scales, &units);
        let all = self.own.iter().chain(self.armature);
        let own: Vec<f64> = all.zip(&units).map(|(own, unit)| own / unit).collect();
        let (of_bodies, rotors) = own.split_at(self.own.len());
        let residual = |all: &[f64]| (&factor * DVector::from_column_slice(all) - &right).norm();
        let raised = |floor: f64| -> Vec<f64> {
            let bodies = of_bodies.chunks(INERTIAL);
            let bodies = bodies.flat_map(|body| raised(body, floor));
            bodies.chain(rotors.iter().copied()).collect()
        };
        let kept = raised(FLOOR);
        let found = if residual(&kept) < EXACT * (self.states.len() as f64).sqrt() {
            kept
        } else {
            // A body at the boundary may hold the search, so it starts from several.
            let starts = START_FLOORS.iter().flat_map(|floor| {
                let start = raised(*floor);
                let mut without_rotors = start.clone();
                without_rotors[of_bodies.len()..].fill(0.0);
                [start, without_rotors]
            });
            let found = starts.map(|start| search(&factor, &right, &start, of_bodies.len()));
            let best = found.min_by(|a, b| residual(a).total_cmp(&residual(b)));
            best.unwrap_or(kept)
        };
        // The search approaches a rotor without inertia, but never reaches it.
        let is_none = |at: usize, value: f64| at >= of_bodies.len() && value < FLOOR;
        let scaled = found.iter().zip(&units).enumerate();
        scaled
            .map(|(at, (value, unit))| {
                if is_none(at, *value) {
                    0.0
                } else {
                    value * unit
                }
            })
            .collect()
    }

    /// Units of the parameters: of a body as heavy and as long as the robot, and the inertias of the
    /// coordinates.
    fn units(&self, scales: &Scales) -> Vec<f64> {
        let length = self.length;
        let mut mass = f64::MIN_POSITIVE;
        for body in &self.tree.bodies {
            for (at, _) in &body.terms {
                let inertia = scales.coordinates[*at].powi(2);
                let own = if body.is_revolute {
                    inertia / (length * length)
                } else {
                    inertia
                };
                mass = mass.max(own);
            }
        }
        let one = |at: usize| match at {
            0..6 => mass * length * length,
            6..9 => mass * length,
            _ => mass,
        };
        let bodies = self.tree.bodies.iter();
        let bodies = bodies.flat_map(|_| (0..INERTIAL).map(one));
        let rotors = scales.coordinates.iter().zip(self.armature);
        bodies.chain(rotors.map(|(root, _)| root * root)).collect()
    }

    /// Triangular factor of the equations of all states, with its right side.
    fn factor(&self, scales: &Scales, units: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let columns = units.len();
        let r = scales.coordinates.len();
        let mut factor = DMatrix::zeros(0, columns + 1);
        for batch in self.states.chunks(BATCH) {
            let before = factor.nrows();
            let mut all = DMatrix::zeros(before + batch.len() * (r * r + r), columns + 1);
            all.rows_mut(0, before).copy_from(&factor);
            let mut row = before;
            for state in batch {
                row = self.equations(state, scales, units, &mut all, row);
            }
            factor = all.qr().r();
        }
        let right = factor.column(columns).into_owned();
        (factor.columns(0, columns).into_owned(), right)
    }

    /// Writes the equations of a state and returns the next row.
    fn equations(
        &self,
        state: &State,
        scales: &Scales,
        units: &[f64],
        all: &mut DMatrix<f64>,
        mut row: usize,
    ) -> usize {
        let d = &scales.coordinates;
        let (r, columns, of_bodies) = (d.len(), units.len(), self.own.len());
        let still = vec![0.0; r];
        let mut write =
            |weight: f64, source: &DMatrix<f64>, line: usize, rotor: Option<usize>, right: f64| {
                for (column, unit) in units.iter().enumerate() {
                    let entry = match column.checked_sub(of_bodies) {
                        None => source[(line, column)],
                        Some(at) => f64::from(u8::from(rotor == Some(at))),
                    };
                    all[(row, column)] = weight * entry * unit;
                }
                all[(row, columns)] = weight * right;
                row += 1;
            };
        for axis in 0..r {
            let mut unit = still.clone();
            unit[axis] = 1.0;
            let source = self
                .tree
                .columns(&state.pose, &still, &unit, &Vector3::zeros());
            for line in 0..r {
                let rotor = (line == axis).then_some(axis);
                let weight = 1.0 / (d[line] * d[axis] * scales.inertia);
                write(weight, &source, line, rotor, state.inertia[(line, axis)]);
            }
        }
        let source = self
            .tree
            .columns(&state.pose, &still, &still, &self.gravity);
        for (line, scale) in d.iter().enumerate() {
            let is_felt = scales.gravity > f64::MIN_POSITIVE;
            let weight = if is_felt {
                1.0 / (scale * scales.gravity)
            } else {
                0.0
            };
            write(weight, &source, line, None, state.gravity[line]);
        }
        row
    }
}

/// Parameters whose pseudo-inertia has no eigenvalue below a floor.
fn raised(body: &[f64], floor: f64) -> [f64; INERTIAL] {
    let eigen = SymmetricEigen::new(pseudo_inertia(body));
    if eigen.eigenvalues.min() >= floor {
        return std::array::from_fn(|at| body[at]);
    }
    let values = Matrix4::from_diagonal(&eigen.eigenvalues.map(|value| value.max(floor)));
    parameters(&(eigen.eigenvectors * values * eigen.eigenvectors.transpose()))
}

/// Entries of the lower triangle.
const TRIANGLE: [(usize, usize); INERTIAL] = [
    (0, 0),
    (1, 0),
    (1, 1),
    (2, 0),
    (2, 1),
    (2, 2),
    (3, 0),
    (3, 1),
    (3, 2),
    (3, 3),
];

/// L of the bodies, entry by entry, then roots of the rotor inertias.
fn roots(start: &[f64], of_bodies: usize) -> DVector<f64> {
    let (bodies, rotors) = start.split_at(of_bodies);
    let rotors = rotors.iter().map(|inertia| inertia.max(START_ROTOR).sqrt());
    let bodies = bodies.chunks(INERTIAL).flat_map(|body| {
        let rest = pseudo_inertia(body) - Matrix4::identity() * (0.5 * FLOOR);
        let lower = rest.cholesky().map_or(Matrix4::identity(), |own| own.l());
        TRIANGLE.map(|at| lower[at])
    });
    DVector::from_iterator(start.len(), bodies.chain(rotors))
}

/// Parameters of bodies and rotors, and their derivatives by their roots.
fn squares(roots: &DVector<f64>, of_bodies: usize) -> (DVector<f64>, DMatrix<f64>) {
    let size = roots.len();
    let (mut all, mut slopes) = (DVector::zeros(size), DMatrix::zeros(size, size));
    for at in of_bodies..size {
        all[at] = roots[at] * roots[at];
        slopes[(at, at)] = 2.0 * roots[at];
    }
    for start in (0..of_bodies).step_by(INERTIAL) {
        let mut lower = Matrix4::zeros();
        for (at, place) in TRIANGLE.iter().enumerate() {
            lower[*place] = roots[start + at];
        }
        let whole = lower * lower.transpose() + Matrix4::identity() * (0.5 * FLOOR);
        for (at, value) in parameters(&whole).into_iter().enumerate() {
            all[start + at] = value;
        }
        for (at, place) in TRIANGLE.iter().enumerate() {
            let mut unit = Matrix4::zeros();
            unit[*place] = 1.0;
            let product = unit * lower.transpose();
            let slope = parameters(&(product + product.transpose()));
            for (row, value) in slope.into_iter().enumerate() {
                slopes[(start + row, start + at)] = value;
            }
        }
    }
    (all, slopes)
}

/// Second derivatives of the cost by the roots, as far as the parameters are not linear in them.
///
/// `gradient` is that of half the cost by the parameters. Near the boundary of consistent
/// parameters, these terms alone limit the steps.
fn curvature(gradient: &DVector<f64>, of_bodies: usize) -> DMatrix<f64> {
    let size = gradient.len();
    let mut all = DMatrix::zeros(size, size);
    for at in of_bodies..size {
        all[(at, at)] = 2.0 * gradient[at];
    }
    let unit = |place: (usize, usize)| {
        let mut unit = Matrix4::zeros();
        unit[place] = 1.0;
        unit
    };
    for start in (0..of_bodies).step_by(INERTIAL) {
        let own = gradient.rows(start, INERTIAL);
        for (a, of_a) in TRIANGLE.iter().enumerate() {
            for (b, of_b) in TRIANGLE.iter().enumerate() {
                let product = unit(*of_a) * unit(*of_b).transpose();
                let second = parameters(&(product + product.transpose()));
                all[(start + a, start + b)] = own.iter().zip(second).map(|(g, s)| g * s).sum();
            }
        }
    }
    all
}

/// Consistent parameters of least squares, by Newton's method with the damping of Levenberg and
/// Marquardt.
///
/// The first `of_bodies` are those of bodies, the others rotor inertias.
fn search(
    factor: &DMatrix<f64>,
    right: &DVector<f64>,
    start: &[f64],
    of_bodies: usize,
) -> Vec<f64> {
    let anchor = DVector::from_column_slice(start);
    let information = factor.tr_mul(factor)
        + DMatrix::identity(start.len(), start.len()) * REGULARISATION.powi(2);
    let cost = |all: &DVector<f64>| {
        (factor * all - right).norm_squared() + (REGULARISATION * (all - &anchor)).norm_squared()
    };
    let mut unknown = roots(start, of_bodies);
    let (mut all, mut slopes) = squares(&unknown, of_bodies);
    let (mut best, mut damping) = (cost(&all), 1e-3);
    let mut quiet = 0;
    for _ in 0..STEPS {
        let gradient =
            factor.tr_mul(&(factor * &all - right)) + (&all - &anchor) * REGULARISATION.powi(2);
        let bends = curvature(&gradient, of_bodies);
        let gradient = slopes.tr_mul(&gradient);
        let normal = slopes.tr_mul(&(&information * &slopes));
        let largest = normal.diagonal().amax();
        let mut damped = &normal + &bends;
        for at in 0..damped.nrows() {
            let size = normal[(at, at)] + bends[(at, at)].abs();
            damped[(at, at)] += damping * size + 1e-14 * largest;
        }
        let step = damped.cholesky().map(|own| own.solve(&gradient));
        let moved = step.map(|step| &unknown - step);
        let tried = moved.map(|moved| (cost(&squares(&moved, of_bodies).0), moved));
        match tried.filter(|(found, _)| *found < best) {
            Some((found, moved)) => {
                quiet = if best - found < DECREASE * best {
                    quiet + 1
                } else {
                    0
                };
                (best, unknown) = (found, moved);
                (all, slopes) = squares(&unknown, of_bodies);
                damping = (damping / 4.0).max(1e-12);
            }
            None if damping > 1e12 => break,
            None => damping *= 6.0,
        }
        if quiet > 3 {
            break;
        }
    }
    all.as_slice().to_vec()
}

#[cfg(test)]
mod tests {
    use super::{parameters, pseudo_inertia, raised, roots, search, squares};
    use nalgebra::{DMatrix, DVector};

    const BODY: [f64; 10] = [0.4, 0.01, -0.02, 0.5, 0.03, 0.3, 0.1, -0.2, 0.05, 1.5];

    #[test]
    fn a_pseudo_inertia_gives_its_parameters() {
        let again = parameters(&pseudo_inertia(&BODY));
        assert!(BODY.iter().zip(again).all(|(a, b)| (a - b).abs() < 1e-15));
        assert_eq!(raised(&BODY, 1e-9), BODY);
        let (all, _) = squares(&roots(&BODY, 10), 10);
        assert!((all - DVector::from_column_slice(&BODY)).norm() < 1e-12);
    }

    #[test]
    fn slopes_are_derivatives() {
        let start = roots(&[&BODY[..], &[0.3]].concat(), 10);
        let (_, slopes) = squares(&start, 10);
        for at in 0..11 {
            let moved = |by: f64| {
                let mut moved = start.clone();
                moved[at] += by;
                squares(&moved, 10).0
            };
            let slope = (moved(1e-6) - moved(-1e-6)) / 2e-6;
            assert!((slope - slopes.column(at)).norm() < 1e-8);
        }
    }

    /// Equations of a body that is inside the cone, and of one whose mass would be negative.
    #[test]
    fn the_search_finds_the_best_consistent_body() {
        let factor = DMatrix::identity(10, 10);
        let start = [0.2, 0.0, 0.0, 0.2, 0.0, 0.2, 0.0, 0.0, 0.0, 1.0];
        let found = search(&factor, &DVector::from_column_slice(&BODY), &start, 10);
        let off = found.iter().zip(&BODY).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-8);
        let mut wrong = BODY;
        (wrong[9], wrong[6], wrong[7], wrong[8]) = (-0.5, 0.0, 0.0, 0.0);
        let found = search(&factor, &DVector::from_column_slice(&wrong), &start, 10);
        assert!(found[9] > 0.0 && found[9] < 1e-4, "{found:?}");
        assert!(pseudo_inertia(&found).symmetric_eigenvalues().min() > 0.0);
        assert!((found[0] - BODY[0]).abs() < 1e-5, "{found:?}");
    }
}
