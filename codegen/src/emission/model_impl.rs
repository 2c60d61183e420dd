//! The generated `impl overact::Model`, which hands blocks of samples to the generated functions.

use super::function::is_fallible;
use crate::derivation::{Columns, Family, MotionInput};
use crate::model::RobotModel;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// The `Model` functions and the families behind them.
const FUNCTIONS: [(&str, Family); 15] = [
    ("Joints", Family::Joints),
    ("ActuatorPositions", Family::ActuatorPositions),
    ("InverseJacobian", Family::InverseJacobian),
    ("JointVelocities", Family::JointVelocities),
    ("JointAccelerations", Family::JointAccelerations),
    ("TwistFromActuators", Family::TwistFromActuators),
    (
        "AccelerationFromActuators",
        Family::AccelerationFromActuators,
    ),
    ("IdmRedPlatform", Family::IdmRedPlatform(Columns::Standard)),
    ("IdmRedPayload", Family::IdmRedPayload),
    ("ProjectPlatform", Family::ProjectPlatform),
    ("InverseDynamics", Family::InverseDynamics),
    ("MassMatrix", Family::MassMatrix),
    ("Bias", Family::Bias),
    ("ProjectTorques", Family::ProjectTorques),
    ("NullSpace", Family::NullSpace),
];

/// `impl overact::Model for NAME` and `pose_from_actuators`.
#[must_use]
pub fn item(model: &RobotModel, name: &Ident) -> TokenStream {
    let arms = FUNCTIONS
        .iter()
        .filter_map(|(label, family)| arm(model, label, *family));
    let mechanism = &model.mechanism;
    let payload = Literal::usize_unsuffixed(model.selection.payload.len());
    let standard = Literal::usize_unsuffixed(model.selection.standard.len());
    let displace = mechanism
        .platform
        .as_ref()
        .is_some_and(|p| p.motion.has_quaternion())
        .then(|| {
            quote! {
                fn displace(&self, pose: &mut [::core::primitive::f64], step: &[::core::primitive::f64]) {
                    ::overact::forward::displace_quaternion(pose, step);
                }
            }
        });
    quote! {
        impl ::overact::Model for #name {
            fn info(&self) -> ::overact::Info<'_> {
                ::overact::Info {
                    name: Self::NAME,
                    sizes: ::overact::Sizes {
                        pose: Self::POSE,
                        dof: Self::DOF,
                        actuators: Self::ACTUATORS,
                        joints: Self::JOINTS,
                        parameters: #standard,
                        payload_parameters: #payload,
                    },
                    legs: &Self::LEGS,
                    actuators: &Self::ACTUATOR_NAMES,
                    actuated_joints: &Self::ACTUATED_JOINTS,
                    actuator_is_revolute: &Self::ACTUATOR_IS_REVOLUTE,
                    coordinates: &Self::COORDINATES,
                    parameters: &Self::PARAMETERS,
                    payload_parameters: &Self::PAYLOAD_PARAMETERS,
                    home_pose: &Self::HOME_POSE,
                    home_joints: &Self::HOME_JOINTS,
                    kept_actuators: &Self::KEPT_ACTUATORS,
                }
            }

            fn evaluate(
                &self,
                function: ::overact::Function,
                inputs: &[&[::core::primitive::f64]],
                output: &mut [::core::primitive::f64],
            ) -> ::core::result::Result<(), ::overact::SampleError> {
                match function {
                    #(#arms)*
                    other => ::core::result::Result::Err(::overact::SampleError {
                        sample: 0,
                        error: ::overact::Error::NotOffered { function: other.name() },
                    }),
                }
            }

            fn pose_from_actuators(
                &self,
                actuators: &[::core::primitive::f64],
                pose: &mut [::core::primitive::f64],
            ) -> ::core::result::Result<(), ::overact::Error> {
                let found = Self::pose_from_actuators(
                    ::overact::block::array(actuators)?,
                    ::overact::block::array(pose)?,
                )?;
                pose.copy_from_slice(&found);
                ::core::result::Result::Ok(())
            }

            #displace
        }
    }
}

fn arm(model: &RobotModel, label: &str, family: Family) -> Option<TokenStream> {
    let function = model.plain(family)?;
    let (label, name) = (format_ident!("{label}"), format_ident!("{}", function.name));
    let size = Literal::usize_unsuffixed(function.program.entries.len());
    let given = function.program.inputs.iter();
    let given = given.filter(|a| !(model.finds_joints(function) && a.name == "joints"));
    let arguments: Vec<Ident> = given.map(|a| format_ident!("{}", a.name)).collect();
    let map = format_ident!("map{}", arguments.len());
    let call = if is_fallible(model, function) {
        quote!(Self::#name)
    } else {
        quote!(|#(#arguments),*| ::core::result::Result::Ok(Self::#name(#(#arguments),*)))
    };
    Some(quote! {
        ::overact::Function::#label => ::overact::block::#map(#size, inputs, output, #call),
    })
}

/// Forward kinematics as an associated function.
#[must_use]
pub fn pose_from_actuators(model: &RobotModel) -> TokenStream {
    let doc = " Forward kinematics: the pose that fits all actuators best in the sense of least squares, found from the pose `start`, whose assembly mode it keeps.";
    if model.is_tree() {
        return quote! {
            #[doc = #doc]
            #[doc = ""]
            #[doc = " # Errors"]
            #[doc = " None for a robot without a loop, whose pose is its joint positions."]
            pub fn pose_from_actuators(
                actuators: &[::core::primitive::f64; Self::ACTUATORS],
                _start: &[::core::primitive::f64; Self::POSE],
            ) -> ::core::result::Result<[::core::primitive::f64; Self::POSE], ::overact::Error> {
                ::core::result::Result::Ok(*actuators)
            }
        };
    }
    let quaternion = model
        .mechanism
        .platform
        .as_ref()
        .is_some_and(|p| p.motion.has_quaternion());
    let displace = if quaternion {
        quote!(displace_quaternion)
    } else {
        quote!(displace)
    };
    let fallible = |family: Family| model.plain(family).is_some_and(|f| is_fallible(model, f));
    let unwrap = |fallible: bool| fallible.then(|| quote!(?));
    let position = unwrap(fallible(Family::ActuatorPositions));
    let jacobian = unwrap(fallible(Family::InverseJacobian));
    let iterate = quote! {
        ::overact::forward::gauss_newton(
            ::overact::forward::Measured {
                positions: actuators,
                is_revolute: &Self::ACTUATOR_IS_REVOLUTE,
            },
            &mut pose,
            ::overact::forward::Workspace {
                actuators: &mut [0.0; Self::ACTUATORS],
                inverse_jacobian: &mut [0.0; Self::ACTUATORS * Self::DOF],
                normal: &mut [0.0; Self::DOF * Self::DOF],
                step: &mut [0.0; Self::DOF],
            },
            |pose, positions, jacobian| {
                let pose = ::overact::block::array(pose)?;
                positions.copy_from_slice(&Self::actuator_positions(pose)#position);
                jacobian.copy_from_slice(Self::inverse_jacobian(pose)#jacobian.as_flattened());
                ::core::result::Result::Ok(())
            },
            ::overact::forward::#displace,
        )
    };
    let is_redundant = model.mechanism.actuated().len() > model.mechanism.dof();
    let (way, body) = match model.function(Family::PoseInClosedForm, MotionInput::Actuators) {
        Some(_) if is_redundant => (
            " Where the iteration fails from there, it starts again from `pose_in_closed_form`.",
            quote! {
                let from = |mut pose: [::core::primitive::f64; Self::POSE]| { #iterate.map(|()| pose) };
                from(*start).or_else(|error| match Self::pose_in_closed_form(actuators) {
                    ::core::result::Result::Ok(pose) => from(pose),
                    ::core::result::Result::Err(_) => ::core::result::Result::Err(error),
                })
            },
        ),
        Some(_) => (
            " It is `pose_in_closed_form` where that has a value.",
            quote! {
                if let ::core::result::Result::Ok(pose) = Self::pose_in_closed_form(actuators) {
                    return ::core::result::Result::Ok(pose);
                }
                let mut pose = *start;
                #iterate.map(|()| pose)
            },
        ),
        None => (
            "",
            quote! {
                let mut pose = *start;
                #iterate.map(|()| pose)
            },
        ),
    };
    let doc = format!("{doc}{way}");
    quote! {
        #[doc = #doc]
        #[doc = ""]
        #[doc = " # Errors"]
        #[doc = " No convergence, or a singular or unreachable configuration on the way."]
        pub fn pose_from_actuators(
            actuators: &[::core::primitive::f64; Self::ACTUATORS],
            start: &[::core::primitive::f64; Self::POSE],
        ) -> ::core::result::Result<[::core::primitive::f64; Self::POSE], ::overact::Error> {
            #body
        }
    }
}
