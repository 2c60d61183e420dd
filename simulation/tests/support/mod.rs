//! Hand-written robots: a planar platform, and actuators with inertia and friction.
//!
//! All dynamics follow from Γ = Σ J_iᵀ (ia_i q̈_i + fv_i q̇_i + fs_i sign q̇_i) + platform, with q̇
//! = J v and q̈ = J a + c(x, v).
#![allow(
    dead_code,
    unreachable_pub,
    reason = "each test, inside and outside the crate, uses a part of the robots"
)]

pub mod mechanisms;

use mechanisms::Kinematics;
use overact::{
    Body, Columns, Error, Function, Info, Model, Parameter, SampleError, Sizes, StandardParameter,
    forward::solve_positive_definite, math::sign,
};

/// Largest n and r of these robots.
const MAX: usize = 4;

/// A robot defined by its kinematics.
pub struct Robot<K> {
    pub kinematics: K,
    sizes: Sizes,
    home_pose: Vec<f64>,
    parameters: Vec<Parameter>,
    payload: Vec<Parameter>,
    kept: Vec<usize>,
}

/// Parameter-independent part of the forces at a motion.
struct Moving {
    /// J_p^inv, n x r.
    jacobian: [f64; MAX * MAX],
    /// c(x, v) = dJ/dt v.
    convection: [f64; MAX],
    /// Sine and cosine of the platform's angle.
    turn: (f64, f64),
}

/// Columns: ia, fv, fs of each actuator, then the platform's; the payload's are like the
/// platform's.
impl<K: Kinematics> Robot<K> {
    pub fn new(kinematics: K) -> Self {
        let (n, r) = (kinematics.actuators().len(), kinematics.coordinates().len());
        let symbols: &[StandardParameter] = match r {
            3 => &[
                StandardParameter::M,
                StandardParameter::Mx,
                StandardParameter::My,
                StandardParameter::Zz,
            ],
            _ => &[StandardParameter::M],
        };
        let mut parameters = Vec::new();
        for leg in 0..n {
            for symbol in [
                StandardParameter::Ia,
                StandardParameter::Fv,
                StandardParameter::Fs,
            ] {
                let body = Body::Leg {
                    leg: leg as u16,
                    index: 0,
                    shape: 0,
                };
                parameters.push(parameter(
                    format!("{}_1_leg{}", symbol.name(), leg + 1),
                    symbol,
                    body,
                ));
            }
        }
        let of = |body: Body, name: &str| -> Vec<Parameter> {
            symbols
                .iter()
                .map(|s| parameter(format!("{}_{name}", s.name()), *s, body))
                .collect()
        };
        parameters.extend(of(Body::Platform, "platform"));
        let payload = of(Body::Payload, "payload");
        let home_pose = kinematics.home();
        let sizes = Sizes {
            pose: home_pose.len(),
            dof: r,
            actuators: n,
            joints: n,
            parameters: parameters.len(),
            base_parameters: 0,
            payload_parameters: payload.len(),
        };
        Self {
            kinematics,
            sizes,
            home_pose,
            parameters,
            payload,
            kept: (0..r).collect(),
        }
    }

    fn moving(&self, x: &[f64], v: &[f64]) -> Result<Moving, Error> {
        let mut moving = Moving {
            jacobian: [0.0; MAX * MAX],
            convection: [0.0; MAX],
            turn: x.get(2).map_or((0.0, 1.0), |phi| phi.sin_cos()),
        };
        let (jacobian, convection) = (&mut moving.jacobian, &mut moving.convection);
        self.kinematics.motion(x, v, jacobian, convection)?;
        Ok(moving)
    }

    /// Γ¹ of the motion (twist, acceleration) for parameters χ (own and payload's).
    fn force(&self, moving: &Moving, [v, a]: [&[f64]; 2], chi: &[f64], out: &mut [f64]) {
        let (n, r) = (self.sizes.actuators, self.sizes.dof);
        let own = self.sizes.parameters - self.sizes.payload_parameters;
        out.fill(0.0);
        for i in 0..n {
            // For a column of the regressor, all parameters but one are zero.
            if chi[3 * i..3 * i + 3] == [0.0; 3] {
                continue;
            }
            let row = &moving.jacobian[i * r..(i + 1) * r];
            let rate: f64 = row.iter().zip(v).map(|(j, v)| j * v).sum();
            let second: f64 =
                moving.convection[i] + row.iter().zip(a).map(|(j, a)| j * a).sum::<f64>();
            let torque = chi[3 * i] * second + chi[3 * i + 1] * rate + chi[3 * i + 2] * sign(rate);
            for (out, j) in out.iter_mut().zip(row) {
                *out += j * torque;
            }
        }
        let (platform, payload) = chi[own..].split_at(self.sizes.payload_parameters);
        if r < 3 {
            for (out, a) in out.iter_mut().zip(a) {
                *out += (platform[0] + payload[0]) * a;
            }
        } else {
            let sum = |k: usize| platform[k] + payload[k];
            let [m, mx, my, zz] = [sum(0), sum(1), sum(2), sum(3)];
            let (s, c) = moving.turn;
            let (w2, wd) = (v[2] * v[2], a[2]);
            out[0] += m * a[0] - mx * (wd * s + w2 * c) + my * (w2 * s - wd * c);
            out[1] += m * a[1] + mx * (wd * c - w2 * s) - my * (wd * s + w2 * c);
            out[2] += zz * wd + mx * (a[1] * c - a[0] * s) - my * (a[1] * s + a[0] * c);
        }
    }

    /// Least squares (JᵀJ)^-1 Jᵀ y.
    fn least_squares(&self, x: &[f64], y: &[f64], out: &mut [f64]) -> Result<(), Error> {
        let (n, r) = (self.sizes.actuators, self.sizes.dof);
        let mut j = [0.0; MAX * MAX];
        self.kinematics.jacobian(x, &mut j)?;
        for (k, out) in out.iter_mut().enumerate() {
            *out = (0..n).map(|i| j[i * r + k] * y[i]).sum();
        }
        solve_positive_definite(&mut self.normal(&j)[..r * r], out)
    }

    fn normal(&self, j: &[f64]) -> [f64; MAX * MAX] {
        let (n, r) = (self.sizes.actuators, self.sizes.dof);
        let mut normal = [0.0; MAX * MAX];
        for a in 0..r {
            for b in 0..r {
                normal[a * r + b] = (0..n).map(|i| j[i * r + a] * j[i * r + b]).sum();
            }
        }
        normal
    }

    /// Least-norm torques J (JᵀJ)^-1 Γ.
    fn least_norm(&self, x: &[f64], force: &mut [f64], out: &mut [f64]) -> Result<(), Error> {
        let r = self.sizes.dof;
        let mut j = [0.0; MAX * MAX];
        self.kinematics.jacobian(x, &mut j)?;
        solve_positive_definite(&mut self.normal(&j)[..r * r], force)?;
        for (i, out) in out.iter_mut().enumerate() {
            *out = (0..r).map(|k| j[i * r + k] * force[k]).sum();
        }
        Ok(())
    }

    fn sample(&self, function: Function, input: &[&[f64]], out: &mut [f64]) -> Result<(), Error> {
        let (n, r) = (self.sizes.actuators, self.sizes.dof);
        let (x, zero) = (input[0], [0.0; MAX]);
        let project = |torques: &[f64], out: &mut [f64]| {
            let mut j = [0.0; MAX * MAX];
            self.kinematics.jacobian(x, &mut j)?;
            for (k, out) in out.iter_mut().enumerate() {
                *out = (0..n).map(|i| j[i * r + k] * torques[i]).sum();
            }
            Ok(())
        };
        match function {
            Function::ActuatorPositions => self.kinematics.positions(x, out),
            Function::InverseJacobian => self.kinematics.jacobian(x, out),
            Function::TwistFromActuators => self.least_squares(x, input[1], out),
            Function::AccelerationFromActuators => {
                let mut rest = [0.0; MAX];
                self.kinematics.convection(x, input[1], &mut rest)?;
                for (rest, second) in rest.iter_mut().zip(input[2]) {
                    *rest = second - *rest;
                }
                self.least_squares(x, &rest, out)
            }
            Function::ProjectPlatform => project(input[1], out),
            Function::Bias(Columns::Standard) => {
                let moving = self.moving(x, input[1])?;
                self.force(&moving, [input[1], &zero[..r]], input[2], out);
                Ok(())
            }
            Function::ForwardDynamics(Columns::Standard) => {
                let mut mass = vec![0.0; r * r];
                let mut bias = vec![0.0; r];
                self.sample(
                    Function::MassMatrix(Columns::Standard),
                    &[x, input[3]],
                    &mut mass,
                )?;
                self.sample(
                    Function::Bias(Columns::Standard),
                    &[x, input[1], input[3]],
                    &mut bias,
                )?;
                project(input[2], out)?;
                for (force, bias) in out.iter_mut().zip(&bias) {
                    *force -= bias;
                }
                solve_positive_definite(&mut mass, out).map_err(|_| Error::MassMatrix)
            }
            Function::MassMatrix(Columns::Standard) => {
                let moving = self.moving(x, &zero[..r])?;
                columns(r, r, out, |k, column| {
                    let mut unit = [0.0; MAX];
                    unit[k] = 1.0;
                    self.force(&moving, [&zero[..r], &unit[..r]], input[1], column);
                });
                Ok(())
            }
            Function::IdmRedPlatform(Columns::Standard) | Function::IdmRedPayload => {
                let own = self.sizes.parameters;
                let (first, count) = match function {
                    Function::IdmRedPlatform(Columns::Standard) => (0, own),
                    _ => (own, self.sizes.payload_parameters),
                };
                let moving = self.moving(x, input[1])?;
                let mut chi = vec![0.0; own + self.sizes.payload_parameters];
                columns(r, count, out, |k, column| {
                    chi.fill(0.0);
                    chi[first + k] = 1.0;
                    self.force(&moving, [input[1], input[2]], &chi, column);
                });
                Ok(())
            }
            Function::InverseDynamics(Columns::Standard) => {
                let mut force = [0.0; MAX];
                let moving = self.moving(x, input[1])?;
                let motion = [input[1], input[2]];
                self.force(&moving, motion, input[3], &mut force[..r]);
                self.least_norm(x, &mut force[..r], out)
            }
            Function::ProjectTorques => {
                let mut force = [0.0; MAX];
                project(input[1], &mut force[..r])?;
                self.least_norm(x, &mut force[..r], out)
            }
            _ => Err(Error::NotOffered {
                function: function.name(),
            }),
        }
    }
}

/// Fills a row-major matrix column by column.
fn columns(
    rows: usize,
    columns: usize,
    out: &mut [f64],
    mut column: impl FnMut(usize, &mut [f64]),
) {
    let mut values = [0.0; MAX];
    for k in 0..columns {
        column(k, &mut values[..rows]);
        for row in 0..rows {
            out[row * columns + k] = values[row];
        }
    }
}

fn parameter(name: String, symbol: StandardParameter, body: Body) -> Parameter {
    Parameter {
        name: name.leak(),
        symbol,
        unit: "SI",
        body,
    }
}

impl<K: Kinematics> Model for Robot<K> {
    fn info(&self) -> Info<'_> {
        Info {
            name: "toy",
            sizes: self.sizes,
            legs: self.kinematics.actuators(),
            actuators: self.kinematics.actuators(),
            actuated_joints: &[0, 1, 2, 3][..self.sizes.actuators],
            actuator_is_revolute: &[K::REVOLUTE; MAX][..self.sizes.actuators],
            coordinates: self.kinematics.coordinates(),
            parameters: &self.parameters,
            payload_parameters: &self.payload,
            home_pose: &self.home_pose,
            home_joints: &[],
            kept_actuators: &self.kept,
        }
    }

    fn evaluate(
        &self,
        function: Function,
        inputs: &[&[f64]],
        output: &mut [f64],
    ) -> Result<(), SampleError> {
        let (rows, columns) = function.shape(&self.sizes);
        for (sample, out) in output.chunks_exact_mut(rows * columns).enumerate() {
            let mut row: [&[f64]; MAX] = [&[]; MAX];
            for (k, kind) in function.inputs().iter().enumerate() {
                let width = self.sizes.of(*kind);
                row[k] = match kind {
                    overact::Input::Parameters | overact::Input::BaseParameters => inputs[k],
                    _ => &inputs[k][sample * width..(sample + 1) * width],
                };
            }
            self.sample(function, &row, out)
                .map_err(|error| SampleError { sample, error })?;
        }
        Ok(())
    }

    fn pose_from_actuators(&self, _: &[f64], _: &mut [f64]) -> Result<(), Error> {
        Err(Error::NotOffered {
            function: "pose_from_actuators",
        })
    }

    fn displace(&self, pose: &mut [f64], step: &[f64]) {
        self.kinematics.displace(pose, step);
    }
}
