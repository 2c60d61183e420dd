//! Areas and inertias of hollow shapes with a thin wall, computed as in MuJoCo.

use nalgebra::Vector3;
use std::f64::consts::PI;

/// Exponent of Thomsen's approximation of the area of an ellipsoid.
const THOMSEN: f64 = 1.6075;
/// Wall of an ellipsoid, m: MuJoCo takes the difference of two solid ones.
const WALL: f64 = 1e-6;

/// Area and moments for unit mass of the surface of a shape.
pub(super) struct Shell {
    pub(super) area: f64,
    pub(super) moments: Vector3<f64>,
}

impl Shell {
    /// Sphere of a radius.
    pub(super) fn sphere(radius: f64) -> Self {
        let square = radius * radius;
        Self {
            area: 4.0 * PI * square,
            moments: Vector3::repeat(2.0 / 3.0 * square),
        }
    }

    /// Cylinder along z with both ends.
    pub(super) fn cylinder(radius: f64, height: f64) -> Self {
        let square = radius * radius;
        let (side, end) = (2.0 * PI * radius * height, PI * square);
        let area = side + 2.0 * end;
        let (side, ends) = (side / area, 2.0 * end / area);
        let across = side * (6.0 * square + height * height) / 12.0
            + ends * 0.25 * (square + height * height);
        let along = (side + 0.5 * ends) * square;
        Self {
            area,
            moments: Vector3::new(across, across, along),
        }
    }

    /// Cylinder along z with two half spheres.
    pub(super) fn capsule(radius: f64, height: f64) -> Self {
        let square = radius * radius;
        let (ball, side) = (4.0 * PI * square, 2.0 * PI * radius * height);
        let area = ball + side;
        let (ball, side) = (ball / area, side / area);
        // The centre of each half sphere is half a radius from the cylinder's end.
        let centre = 0.5 * (height + radius);
        let across = side * (6.0 * square + height * height) / 12.0
            + ball * (2.0 / 3.0 * square + centre * centre - 0.25 * square);
        let along = side * square + ball * 2.0 / 3.0 * square;
        Self {
            area,
            moments: Vector3::new(across, across, along),
        }
    }

    /// Box of half lengths.
    pub(super) fn cuboid(x: f64, y: f64, z: f64) -> Self {
        let faces = [y * z, x * z, x * y];
        let sum: f64 = faces.iter().sum();
        let half = Vector3::new(x, y, z);
        // Second moment of each coordinate: that of two faces across it, and of the four others.
        let second = |axis: usize| {
            let across = faces[axis] / sum;
            half[axis] * half[axis] * (across + (1.0 - across) / 3.0)
        };
        let [xx, yy, zz] = [0, 1, 2].map(second);
        Self {
            area: 8.0 * sum,
            moments: Vector3::new(yy + zz, xx + zz, xx + yy),
        }
    }

    /// Ellipsoid of half axes.
    pub(super) fn ellipsoid(x: f64, y: f64, z: f64) -> Self {
        let powers = [x * y, y * z, z * x].map(|own| own.powf(THOMSEN));
        let mean = powers.iter().sum::<f64>() / 3.0;
        let inner = Vector3::new(x, y, z);
        let outer = inner.add_scalar(WALL);
        let solid = |half: &Vector3<f64>| {
            let squares = half.component_mul(half);
            (
                half.product(),
                (Vector3::repeat(squares.sum()) - squares) / 5.0,
            )
        };
        let ((within, small), (whole, large)) = (solid(&inner), solid(&outer));
        Self {
            area: 4.0 * PI * mean.powf(1.0 / THOMSEN),
            moments: (large * whole - small * within) / (whole - within),
        }
    }
}
