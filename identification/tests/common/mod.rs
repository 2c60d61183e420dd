//! Small hand-written robots, and the location of reference data.
#![allow(dead_code, reason = "each test file uses its part")]

use std::path::PathBuf;

use overact::{
    Body, Columns, Error, Function, Info, Model, Parameter, SampleError, Sizes, StandardParameter,
};

/// A file of the reference data: in `OVERACT_SHARED`, or `shared` next to the repository.
///
/// `None`, with a message, if it does not exist.
pub(crate) fn shared(path: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("OVERACT_SHARED").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared"),
        PathBuf::from,
    );
    let file = folder.join(path);
    if file.exists() {
        Some(file)
    } else {
        eprintln!(
            "skipped: the reference data {path} are not here; set OVERACT_SHARED to their folder"
        );
        None
    }
}

/// A parameter of a leg's body.
pub(crate) const fn leg(
    name: &'static str,
    symbol: StandardParameter,
    unit: &'static str,
    leg: u16,
) -> Parameter {
    Parameter {
        name,
        symbol,
        unit,
        body: Body::Leg {
            leg,
            index: 0,
            shape: 0,
        },
    }
}

/// n motors in parallel on one mass on a line, with gear ratios q̇ = ratio · v.
///
/// For n = 2 this is the redundant robot of the paper's Fig. 1; for n = 1 a single prismatic drive.
pub(crate) struct Drives {
    pub(crate) ratios: &'static [f64],
    pub(crate) names: &'static [&'static str],
    pub(crate) parameters: &'static [Parameter],
    pub(crate) payload: &'static [Parameter],
    /// Largest reachable pose.
    pub(crate) reach: f64,
}

/// EMPS: one prismatic joint; mass and rotor inertia have equal columns.
pub(crate) const EMPS: Drives = Drives {
    ratios: &[1.0],
    names: &["1"],
    parameters: &[
        leg("m_1", StandardParameter::M, "kg", 0),
        leg("ia_1", StandardParameter::Ia, "kg", 0),
        leg("fv_1", StandardParameter::Fv, "N s/m", 0),
        leg("fs_1", StandardParameter::Fs, "N", 0),
        leg("off_1", StandardParameter::Off, "N", 0),
    ],
    payload: &[],
    reach: f64::INFINITY,
};

/// Two motors on one mass, of gear ratios 1 and -2, with friction at each motor.
pub(crate) const PAIR: Drives = Drives {
    ratios: &[1.0, -2.0],
    names: &["leg1", "leg2"],
    parameters: &[
        leg("ia_1_leg1", StandardParameter::Ia, "kg", 0),
        leg("fv_1_leg1", StandardParameter::Fv, "N s/m", 0),
        leg("fs_1_leg1", StandardParameter::Fs, "N", 0),
        leg("off_1_leg1", StandardParameter::Off, "N", 0),
        leg("ia_1_leg2", StandardParameter::Ia, "kg", 1),
        leg("fv_1_leg2", StandardParameter::Fv, "N s/m", 1),
        leg("fs_1_leg2", StandardParameter::Fs, "N", 1),
        leg("off_1_leg2", StandardParameter::Off, "N", 1),
        Parameter {
            name: "m_platform",
            symbol: StandardParameter::M,
            unit: "kg",
            body: Body::Platform,
        },
    ],
    payload: &[Parameter {
        name: "m_payload",
        symbol: StandardParameter::M,
        unit: "kg",
        body: Body::Payload,
    }],
    reach: 5.0,
};

impl Drives {
    /// Scalar column of a parameter, projected on the mass.
    fn column(&self, parameter: &Parameter, v: f64, a: f64) -> f64 {
        let ratio = match parameter.body {
            Body::Leg { leg, .. } => self.ratios[usize::from(leg)],
            _ => 1.0,
        };
        ratio
            * match parameter.symbol {
                StandardParameter::M | StandardParameter::Ia => ratio * a,
                StandardParameter::Fv => ratio * v,
                StandardParameter::Fs => overact::math::sign(ratio * v),
                StandardParameter::Off => 1.0,
                _ => 0.0,
            }
    }

    /// One sample of a function.
    fn sample(&self, function: Function, inputs: &[&[f64]], out: &mut [f64]) -> Result<(), Error> {
        let x = inputs[0][0];
        if x.abs() > self.reach {
            return Err(Error::OutOfReach { leg: "leg1" });
        }
        let square: f64 = self.ratios.iter().map(|g| g * g).sum();
        let dot =
            |values: &[f64]| -> f64 { self.ratios.iter().zip(values).map(|(g, q)| g * q).sum() };
        let spread = |value: f64, out: &mut [f64]| {
            out.iter_mut()
                .zip(self.ratios)
                .for_each(|(out, g)| *out = g * value);
        };
        match function {
            Function::Joints | Function::ActuatorPositions => spread(x, out),
            Function::InverseJacobian => spread(1.0, out),
            Function::JointVelocities => spread(inputs[1][0], out),
            Function::JointAccelerations => spread(inputs[2][0], out),
            Function::TwistFromActuators => out[0] = dot(inputs[1]) / square,
            Function::AccelerationFromActuators => out[0] = dot(inputs[2]) / square,
            Function::ProjectPlatform => out[0] = dot(inputs[1]),
            Function::IdmRedPlatform(Columns::Standard) | Function::IdmRedPayload => {
                let parameters = if function == Function::IdmRedPlatform(Columns::Standard) {
                    self.parameters
                } else {
                    self.payload
                };
                for (out, parameter) in out.iter_mut().zip(parameters) {
                    *out = self.column(parameter, inputs[1][0], inputs[2][0]);
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

    /// Γ¹ for parameter values, the robot's then the payload's.
    pub(crate) fn force(&self, values: &[f64], v: f64, a: f64) -> f64 {
        let parameters = self.parameters.iter().chain(self.payload);
        parameters
            .zip(values)
            .map(|(p, value)| value * self.column(p, v, a))
            .sum()
    }
}

impl Model for Drives {
    fn info(&self) -> Info<'_> {
        let n = self.ratios.len();
        Info {
            name: if n == 1 { "emps" } else { "pair" },
            sizes: Sizes {
                pose: 1,
                dof: 1,
                actuators: n,
                joints: n,
                parameters: self.parameters.len(),
                base_parameters: 0,
                payload_parameters: self.payload.len(),
            },
            legs: self.names,
            actuators: self.names,
            actuated_joints: &[0, 1][..n],
            actuator_is_revolute: &[false, false][..n],
            coordinates: &["x"],
            parameters: self.parameters,
            payload_parameters: self.payload,
            home_pose: &[0.0],
            home_joints: &[0.0, 0.0][..n],
            kept_actuators: &[0],
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
            self.sample(function, &row, out)
                .map_err(|error| SampleError { sample, error })?;
        }
        Ok(())
    }

    fn pose_from_actuators(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error> {
        let square: f64 = self.ratios.iter().map(|g| g * g).sum();
        let x = self
            .ratios
            .iter()
            .zip(actuators)
            .map(|(g, q)| g * q)
            .sum::<f64>()
            / square;
        if x.abs() > self.reach {
            return Err(Error::OutOfReach { leg: "leg1" });
        }
        pose[0] = x;
        Ok(())
    }
}
