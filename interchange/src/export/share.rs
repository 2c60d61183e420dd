//! Distributes the inertia of a rigid group over the bodies of the file.

use crate::{
    assembly::network::Network,
    model::{Inertia, Pose},
};
use nalgebra::{Matrix3, Point3, Vector3};

/// New inertia of a body, in the body's own frame.
pub(super) struct NewInertia {
    pub(super) body: usize,
    pub(super) inertia: Inertia,
}

/// Inertia from ten parameters about a frame; `None` if a zero mass has moments.
pub(super) fn inertia(parameters: [f64; 10], frame: &Pose) -> Option<Inertia> {
    let [xx, xy, xz, yy, yz, zz, mx, my, mz, mass] = parameters;
    let first = Vector3::new(mx, my, mz);
    let about = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    if mass == 0.0 {
        let own = Inertia {
            mass,
            centre: Point3::origin(),
            tensor: about,
        };
        return (first == Vector3::zeros()).then(|| own.transformed(frame));
    }
    let centre = Point3::from(first / mass);
    let tensor = about - point(mass, &centre.coords);
    Some(
        Inertia {
            mass,
            centre,
            tensor,
        }
        .transformed(frame),
    )
}

/// Distributes a group's inertia, in the world frame at home, over its bodies.
///
/// 1. The heaviest body takes the difference, and the others keep the file's inertia.
/// 2. If its inertia is then not physically consistent, all bodies are scaled.
/// 3. If that fails too, the heaviest body takes the whole inertia.
///
/// The flag reports case 3.
pub(super) fn among(
    network: &Network<'_>,
    group: usize,
    whole: &Inertia,
) -> (Vec<NewInertia>, bool) {
    let model = network.model;
    let own: Vec<(usize, Inertia)> = network.groups[group]
        .bodies
        .iter()
        .filter(|&&body| model.bodies[body].place.is_some())
        .filter_map(|&body| Some((body, model.bodies[body].inertia?)))
        .collect();
    let Some(&(main, _)) = own
        .iter()
        .max_by(|a, b| a.1.mass.total_cmp(&b.1.mass).then(b.0.cmp(&a.0)))
    else {
        return (Vec::new(), false);
    };
    let pose = |body: usize| network.states[0].poses[body];
    let total: f64 = own.iter().map(|(_, inertia)| inertia.mass).sum();
    let factors = [1.0, if total > 0.0 { whole.mass / total } else { 0.0 }, 0.0];
    for factor in factors {
        let scaled = |inertia: &Inertia| Inertia {
            mass: factor * inertia.mass,
            tensor: inertia.tensor * factor,
            ..*inertia
        };
        let others = own.iter().filter(|(body, _)| *body != main);
        let others: Vec<(usize, Inertia)> = others.map(|(body, i)| (*body, scaled(i))).collect();
        let rest = others.iter().fold(*whole, |rest, (body, inertia)| {
            rest.without(&inertia.transformed(&pose(*body)))
        });
        if factor == 0.0 || is_body(&rest) {
            let heaviest = (main, rest.transformed(&pose(main).inverse()));
            let all = std::iter::once(heaviest).chain(others.into_iter().filter(|_| factor != 1.0));
            let shares = all
                .map(|(body, inertia)| NewInertia { body, inertia })
                .collect();
            return (shares, factor == 0.0 && own.len() > 1);
        }
    }
    (Vec::new(), false)
}

/// Whether an inertia is physically consistent: positive mass and triangle inequality of the
/// moments.
pub(super) fn is_body(inertia: &Inertia) -> bool {
    let moments = inertia.tensor.symmetric_eigenvalues();
    let (sum, largest) = (moments.sum(), moments.max());
    inertia.mass > 0.0 && moments.min() >= -1e-9 * largest && 2.0 * largest <= sum * (1.0 + 1e-9)
}

/// Inertia of a point mass about the origin.
fn point(mass: f64, at: &Vector3<f64>) -> Matrix3<f64> {
    (Matrix3::identity() * at.norm_squared() - at * at.transpose()) * mass
}
