//! A point mass in a vertical plane with three telescopic legs: n = 3, r = 2.
//!
//! Its Jacobian depends on the pose.

use overact::{
    Body, Columns, Error, Function, Info, Model, Parameter, SampleError, Sizes, StandardParameter,
    forward::{Measured, Workspace, gauss_newton},
};

/// Anchors of the legs, m.
pub(crate) const ANCHORS: [[f64; 2]; 3] = [[-1.0, -0.6], [1.0, -0.5], [0.1, 1.2]];

const GRAVITY: f64 = 9.81;

const fn parameter(name: &'static str, symbol: StandardParameter, leg: u16) -> Parameter {
    let body = Body::Leg {
        leg,
        index: 0,
        shape: 0,
    };
    Parameter {
        name,
        symbol,
        unit: "",
        body,
    }
}

const PARAMETERS: [Parameter; 13] = [
    parameter("ia_1_leg1", StandardParameter::Ia, 0),
    parameter("fv_1_leg1", StandardParameter::Fv, 0),
    parameter("fs_1_leg1", StandardParameter::Fs, 0),
    parameter("off_1_leg1", StandardParameter::Off, 0),
    parameter("ia_1_leg2", StandardParameter::Ia, 1),
    parameter("fv_1_leg2", StandardParameter::Fv, 1),
    parameter("fs_1_leg2", StandardParameter::Fs, 1),
    parameter("off_1_leg2", StandardParameter::Off, 1),
    parameter("ia_1_leg3", StandardParameter::Ia, 2),
    parameter("fv_1_leg3", StandardParameter::Fv, 2),
    parameter("fs_1_leg3", StandardParameter::Fs, 2),
    parameter("off_1_leg3", StandardParameter::Off, 2),
    Parameter {
        name: "m_platform",
        symbol: StandardParameter::M,
        unit: "kg",
        body: Body::Platform,
    },
];

/// The robot.
pub(crate) struct Point;

/// A leg at a state: direction, length, velocity, acceleration.
pub(crate) struct Leg {
    pub(crate) u: [f64; 2],
    pub(crate) q: f64,
    pub(crate) velocity: f64,
    pub(crate) acceleration: f64,
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// State of one leg.
pub(crate) fn leg(index: usize, x: [f64; 2], v: [f64; 2], a: [f64; 2]) -> Leg {
    let d = [x[0] - ANCHORS[index][0], x[1] - ANCHORS[index][1]];
    let q = dot(d, d).sqrt();
    let u = [d[0] / q, d[1] / q];
    let velocity = dot(u, v);
    Leg {
        u,
        q,
        velocity,
        acceleration: dot(u, a) + (dot(v, v) - velocity * velocity) / q,
    }
}

/// Column of a parameter on the platform.
pub(crate) fn column(index: usize, x: [f64; 2], v: [f64; 2], a: [f64; 2]) -> [f64; 2] {
    if index == 12 {
        return [a[0], a[1] + GRAVITY];
    }
    let leg = leg(index / 4, x, v, a);
    let scalar = match index % 4 {
        0 => leg.acceleration,
        1 => leg.velocity,
        2 => overact::math::sign(leg.velocity),
        _ => 1.0,
    };
    leg.u.map(|u| u * scalar)
}

/// Least squares of three equations in two unknowns.
fn least_squares(rows: [[f64; 2]; 3], y: [f64; 3]) -> [f64; 2] {
    let sum = |f: &dyn Fn(usize) -> f64| (0..3).map(f).sum::<f64>();
    let [a, b, c] = [(0, 0), (0, 1), (1, 1)].map(|(i, j)| sum(&|k| rows[k][i] * rows[k][j]));
    let [d, e] = [0, 1].map(|i| sum(&|k| rows[k][i] * y[k]));
    let determinant = a * c - b * b;
    [(c * d - b * e) / determinant, (a * e - b * d) / determinant]
}

impl Point {
    fn sample(function: Function, inputs: &[&[f64]], out: &mut [f64]) -> Result<(), Error> {
        let pair = |k: usize| {
            inputs
                .get(k)
                .map_or([0.0; 2], |values| [values[0], values[1]])
        };
        let x = pair(0);
        let legs = |v, a| [0, 1, 2].map(|index| leg(index, x, v, a));
        let rows = legs([0.0; 2], [0.0; 2]).map(|leg| leg.u);
        match function {
            Function::Joints | Function::ActuatorPositions => {
                out.copy_from_slice(&legs([0.0; 2], [0.0; 2]).map(|leg| leg.q));
            }
            Function::InverseJacobian => out.copy_from_slice(rows.as_flattened()),
            Function::JointVelocities => {
                out.copy_from_slice(&legs(pair(1), pair(2)).map(|leg| leg.velocity));
            }
            Function::TwistFromActuators => {
                let y = [inputs[1][0], inputs[1][1], inputs[1][2]];
                out.copy_from_slice(&least_squares(rows, y));
            }
            Function::AccelerationFromActuators => {
                // q̈ = J v̇ + the acceleration at v̇ = 0.
                let rest = legs(pair(1), [0.0; 2]).map(|leg| leg.acceleration);
                let y = [0, 1, 2].map(|k| inputs[2][k] - rest[k]);
                out.copy_from_slice(&least_squares(rows, y));
            }
            Function::ProjectPlatform => {
                for (i, out) in out.iter_mut().enumerate() {
                    *out = (0..3).map(|k| rows[k][i] * inputs[1][k]).sum();
                }
            }
            Function::IdmRedPlatform(Columns::Standard) => {
                for index in 0..PARAMETERS.len() {
                    let [first, second] = column(index, x, pair(1), pair(2));
                    out[index] = first;
                    out[PARAMETERS.len() + index] = second;
                }
            }
            _ => {
                return Err(Error::NotOffered {
                    function: function.name(),
                });
            }
        }
        Ok(())
    }
}

impl Model for Point {
    fn info(&self) -> Info<'_> {
        Info {
            name: "point",
            sizes: Sizes {
                pose: 2,
                dof: 2,
                actuators: 3,
                joints: 3,
                parameters: PARAMETERS.len(),
                base_parameters: 0,
                payload_parameters: 0,
            },
            legs: &["leg1", "leg2", "leg3"],
            actuators: &["leg1", "leg2", "leg3"],
            actuated_joints: &[0, 1, 2],
            actuator_is_revolute: &[false; 3],
            coordinates: &["x", "y"],
            parameters: &PARAMETERS,
            payload_parameters: &[],
            home_pose: &[0.0, 0.1],
            home_joints: &[0.0; 3],
            kept_actuators: &[0, 2],
        }
    }

    fn evaluate(
        &self,
        function: Function,
        inputs: &[&[f64]],
        output: &mut [f64],
    ) -> Result<(), SampleError> {
        let sizes = self.info().sizes;
        let (rows, columns) = function.shape(&sizes);
        for (sample, out) in output.chunks_exact_mut(rows * columns).enumerate() {
            let row: Vec<&[f64]> = function
                .inputs()
                .iter()
                .zip(inputs)
                .map(|(input, values)| {
                    let width = sizes.of(*input);
                    &values[sample * width..(sample + 1) * width]
                })
                .collect();
            Self::sample(function, &row, out).map_err(|error| SampleError { sample, error })?;
        }
        Ok(())
    }

    fn pose_from_actuators(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error> {
        let mut found = pose.to_vec();
        gauss_newton(
            Measured {
                positions: actuators,
                is_revolute: &[false; 3],
            },
            &mut found,
            Workspace {
                actuators: &mut [0.0; 3],
                inverse_jacobian: &mut [0.0; 6],
                normal: &mut [0.0; 4],
                step: &mut [0.0; 2],
            },
            |pose, positions, jacobian| {
                Self::sample(Function::ActuatorPositions, &[pose], positions)?;
                Self::sample(Function::InverseJacobian, &[pose], jacobian)
            },
            |pose, step| pose.iter_mut().zip(step).for_each(|(x, s)| *x += s),
        )?;
        pose.copy_from_slice(&found);
        Ok(())
    }
}
