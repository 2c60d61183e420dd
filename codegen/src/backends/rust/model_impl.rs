//! The generated `impl overact::Model`, which passes blocks of samples to the generated functions.

use super::{boundary, expression, function};
use crate::derivation::MotionInput;
use crate::model::RobotModel;
use overact_core::{FrameFunction, Function};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// `impl overact::Model for NAME` and `pose_from_actuators`.
#[must_use]
pub fn item(model: &RobotModel, name: &Ident) -> TokenStream {
    let arms = model.all_functions().filter_map(|f| arm(model, f));
    let mechanism = &model.mechanism;
    let payload = Literal::usize_unsuffixed(model.selection.payload.len());
    let standard = Literal::usize_unsuffixed(model.selection.standard.len());
    let base = Literal::usize_unsuffixed(model.selection.base.len());
    let way = match &mechanism.platform {
        _ if mechanism.has_dependent_coordinates() => Some(quote!(Self::displace)),
        Some(own) if own.motion.has_quaternion() => {
            Some(quote!(::overact::forward::displace_quaternion))
        }
        _ => None,
    };
    let displace = way.map(|way| {
        quote! {
            fn displace(&self, pose: &mut [::core::primitive::f64], step: &[::core::primitive::f64]) {
                #way(pose, step);
            }
        }
    });
    let names = mechanism.frames.iter().map(|frame| frame.name.as_str());
    let frames = (!mechanism.frames.is_empty()).then(|| {
        quote! {
            fn frames(&self) -> &[&'static ::core::primitive::str] {
                &[#(#names),*]
            }
        }
    });
    let pulls = mechanism.has_cables().then(|| {
        let pulls = mechanism.pulls();
        quote! {
            fn pulls(&self) -> &[::core::primitive::bool] {
                &[#(#pulls),*]
            }
        }
    });
    let terms = (!mechanism.motors.is_empty()).then(|| {
        quote! {
            fn actuator_terms(
                &self,
                actuator: ::core::primitive::usize,
            ) -> &[(::core::primitive::usize, ::core::primitive::f64)] {
                Self::ACTUATOR_TERMS.get(actuator).copied().unwrap_or_default()
            }
        }
    });
    quote! {
        impl #name {
            const SIZES: ::overact::Sizes = ::overact::Sizes {
                pose: Self::POSE,
                dof: Self::DOF,
                actuators: Self::ACTUATORS,
                joints: Self::JOINTS,
                parameters: #standard,
                base_parameters: #base,
                payload_parameters: #payload,
            };
        }

        impl ::overact::Model for #name {
            fn info(&self) -> ::overact::Info<'_> {
                ::overact::Info {
                    name: Self::NAME,
                    sizes: Self::SIZES,
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

            #frames

            #pulls
            #terms
        }
    }
}

/// The arm of a function that the robot has.
fn arm(model: &RobotModel, function: Function) -> Option<TokenStream> {
    let compiled = model.served(function)?;
    let rows = (0..function.inputs().len()).map(Literal::usize_unsuffixed);
    let rows = quote!(#(row.row(#rows)?,)*);
    let pattern = pattern(function);
    let of_samples = match function.columns() {
        Some(_) => {
            let name = expression::ident(&function::into(&compiled.name));
            quote!(fill(|row, output| Self::#name(#rows output)))
        }
        None => {
            let name = expression::ident(&compiled.name);
            quote!(each(|row| Self::#name(#rows)))
        }
    };
    Some(quote! {
        #pattern => ::overact::block::Block::new(function, &Self::SIZES, inputs, output)?
            .#of_samples,
    })
}

/// The function as a path of the runtime, in the format of its derived `Debug`.
fn pattern(function: Function) -> TokenStream {
    if let Function::Frame(FrameFunction { frame, quantity }) = function {
        let frame = Literal::usize_unsuffixed(frame);
        let quantity = format_ident!("{quantity:?}");
        return quote!(::overact::Function::Frame(::overact::FrameFunction {
            frame: #frame,
            quantity: ::overact::FrameQuantity::#quantity,
        }));
    }
    let path = |text: &str| {
        let name = format_ident!("{text}");
        quote!(::overact::Function::#name)
    };
    let variant = format!("{function:?}");
    match variant.split_once('(') {
        Some((variant, columns)) => {
            let variant = path(variant);
            let columns = format_ident!("{}", columns.trim_end_matches(')'));
            quote!(#variant(::overact::Columns::#columns))
        }
        None => path(&variant),
    }
}

/// Forward kinematics as an associated function.
#[must_use]
pub fn pose_from_actuators(model: &RobotModel) -> TokenStream {
    let doc = " Forward kinematics: the pose that fits all actuators best by least squares, iterated from the pose `start`.";
    let kind = expression::kind(model.float);
    let range = boundary::range(model.float, &["actuators", "start"]);
    if model.is_tree() {
        return quote! {
            #[doc = #doc]
            #[doc = ""]
            #[doc = " # Errors"]
            #[doc = " An input is infinite, NaN or too large. The pose of a robot without loops is its joint positions."]
            pub fn pose_from_actuators(
                actuators: &[#kind; Self::ACTUATORS],
                start: &[#kind; Self::POSE],
            ) -> ::core::result::Result<[#kind; Self::POSE], ::overact::Error> {
                #range
                ::core::result::Result::Ok(*actuators)
            }
        };
    }
    let quaternion = model
        .mechanism
        .platform
        .as_ref()
        .is_some_and(|p| p.motion.has_quaternion());
    let independent = model.mechanism.independent_coordinates();
    let displace = match (&independent, quaternion) {
        (Some(_), _) => quote!(Self::displace),
        (None, true) => quote!(::overact::forward::displace_quaternion),
        (None, false) => quote!(::overact::forward::displace),
    };
    let unit = quaternion
        .then(|| quote!(let start = &::overact::guard::unit_quaternion(start, "start")?;));
    let closed = independent.is_some().then(|| {
        quote! {
            let mut closed = *start;
            Self::displace(&mut closed, &[]);
            let start = &closed;
        }
    });
    // Positions and step in one function, if there is one; if it fails, the loop below may succeed.
    let at_once = model.function(Function::PoseStep, MotionInput::Pose).map(|_| {
        quote! {
            let mut stepped = pose;
            let find = |pose: &[#kind], step: &mut [#kind]| {
                ::overact::block::write(&Self::pose_step(::overact::block::array(pose)?, actuators)?, step);
                ::core::result::Result::Ok(())
            };
            if ::overact::forward::steps(&mut stepped, &mut [0.0; Self::DOF], find, #displace) {
                return ::core::result::Result::Ok(stepped);
            }
        }
    });
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
                ::overact::block::write(&Self::actuator_positions(pose)?, positions);
                ::overact::block::write(&Self::inverse_jacobian(pose)?, jacobian);
                ::core::result::Result::Ok(())
            },
            #displace,
        )
    };
    let is_redundant = model.mechanism.actuator_count() > model.mechanism.dof();
    let (way, body) = match model.function(Function::PoseInClosedForm, MotionInput::Actuators) {
        Some(_) if is_redundant => (
            " The iteration starts from `pose_in_closed_form` if that is within 0.01 (m, rad) of `start`, otherwise from `start`, whose assembly mode it keeps. If that fails, the result is in the assembly mode of the home configuration.",
            quote! {
                let closed = Self::pose_in_closed_form(actuators).ok();
                ::overact::forward::from_closed_form(closed, *start, |mut pose: [#kind; Self::POSE]| {
                    #at_once
                    #iterate.map(|()| pose)
                })
            },
        ),
        Some(_) => (
            " It equals `pose_in_closed_form` if that succeeds.",
            quote! {
                if let ::core::result::Result::Ok(pose) = Self::pose_in_closed_form(actuators) {
                    return ::core::result::Result::Ok(pose);
                }
                let mut pose = *start;
                #at_once
                #iterate.map(|()| pose)
            },
        ),
        None => (
            " It keeps the assembly mode of `start`.",
            quote! {
                let mut pose = *start;
                #at_once
                #iterate.map(|()| pose)
            },
        ),
    };
    let doc = format!("{doc}{way}");
    let displace = independent.map(|coordinates| {
        if model.mechanism.has_dependent_joints() {
            displace_joints(&coordinates, &kind)
        } else {
            self::displace(&coordinates, &kind)
        }
    });
    quote! {
        #displace

        #[doc = #doc]
        #[doc = ""]
        #[doc = " # Errors"]
        #[doc = " An input is infinite, NaN or too large, the iteration does not converge, or a configuration on the way is singular or out of reach."]
        pub fn pose_from_actuators(
            actuators: &[#kind; Self::ACTUATORS],
            start: &[#kind; Self::POSE],
        ) -> ::core::result::Result<[#kind; Self::POSE], ::overact::Error> {
            #range
            #unit
            #closed
            #body
        }
    }
}

/// The displacement of a platform with parasitic motion, as an associated function.
fn displace(independent: &[usize], kind: &TokenStream) -> TokenStream {
    let independent = independent.iter().map(|&at| Literal::usize_unsuffixed(at));
    quote! {
        #[doc = " Displaces a pose by a small `step` along its independent coordinates; Newton's method finds the others so that the legs close. If it fails, other functions reject the pose."]
        pub fn displace(pose: &mut [#kind], step: &[#kind]) {
            ::overact::parasitic_motion::displace(pose, step, &[#(#independent),*], |pose, errors, jacobian| {
                let pose = ::overact::block::array(pose)?;
                ::overact::block::write(&Self::blocked_error(pose)?, errors);
                ::overact::block::write(&Self::blocked_jacobian(pose)?, jacobian);
                ::core::result::Result::Ok(())
            });
        }
    }
}

/// The displacement of a skeleton with dependent joints, as an associated function.
fn displace_joints(independent: &[usize], kind: &TokenStream) -> TokenStream {
    let independent = independent.iter().map(|&at| Literal::usize_unsuffixed(at));
    quote! {
        #[doc = " Displaces the independent joints of a pose by `step`; Newton's method finds the others so that the chains close. If it fails, other functions reject the pose."]
        pub fn displace(pose: &mut [#kind], step: &[#kind]) {
            ::overact::dependent_joints::displace(
                pose,
                step,
                &[#(#independent),*],
                ::overact::dependent_joints::Workspace {
                    errors: &mut [0.0; Self::POSE - Self::DOF],
                    jacobian: &mut [0.0; (Self::POSE - Self::DOF) * Self::POSE],
                    square: &mut [0.0; (Self::POSE - Self::DOF) * (Self::POSE - Self::DOF)],
                },
                |pose, errors, jacobian| {
                    let pose = ::overact::block::array(pose)?;
                    ::overact::block::write(&Self::pose_error(pose)?, errors);
                    ::overact::block::write(&Self::pose_error_jacobian(pose)?, jacobian);
                    ::core::result::Result::Ok(())
                },
            );
        }
    }
}
