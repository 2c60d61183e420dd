//! Table of URDF: urdfdom, loop notations, and the extensions of Gazebo, ROS 2 control and Drake.

use super::table::{Rule, Table, Treatment, USUAL_GRAVITY, rejected, reported, unless};
use Treatment::{Container, Honoured, Irrelevant};

const APPEARANCE: Treatment = Irrelevant("appearance");
const CONTACT: Treatment = Irrelevant("contact and collision");
const CONTROL: Treatment = Irrelevant("control and interfaces of the drives");
const SIMULATION: Treatment = Irrelevant("settings of the simulation");

const COUPLED_MOTORS: &str = "remove the transmission and name the driven joints, `--actuated JOINT,JOINT`; then describe \
    the motors in the TOML, [[leg.NAME.motor]] with `turns`";

const POSE: (&str, Treatment) = ("xyz rpy quat_xyzw", Honoured);

pub(crate) const TABLE: Table = Table {
    rules: RULES,
    repeatable: "link joint loop constraint loop_joint coupling ball_constraint transmission ros2_control actuator \
                 mechanicalReduction mechanical_reduction gazebo",
    texts: "type plugin mechanicalReduction mechanical_reduction role parent child pose xyz",
};

const RULES: &[Rule] = &[
    Rule {
        within: "",
        elements: "robot",
        treatment: Honoured,
        attributes: &[("name", Honoured), ("version", SIMULATION)],
    },
    Rule {
        within: "robot",
        elements: "material",
        treatment: APPEARANCE,
        attributes: &[],
    },
    Rule {
        within: "robot",
        elements: "link",
        treatment: Honoured,
        attributes: &[("name", Honoured), ("type", APPEARANCE)],
    },
    Rule {
        within: "link",
        elements: "visual visual_material",
        treatment: APPEARANCE,
        attributes: &[],
    },
    Rule {
        within: "link",
        elements: "collision collision_checking self_collision_checking contact",
        treatment: CONTACT,
        attributes: &[],
    },
    Rule {
        within: "link",
        elements: "inertial",
        treatment: Honoured,
        attributes: &[],
    },
    Rule {
        within: "inertial",
        elements: "mass",
        treatment: Honoured,
        attributes: &[("value", Honoured)],
    },
    Rule {
        within: "inertial",
        elements: "inertia",
        treatment: Honoured,
        attributes: &[("ixx ixy ixz iyy iyz izz", Honoured)],
    },
    Rule {
        within: "inertial joint predecessor successor link1 link2",
        elements: "origin",
        treatment: Honoured,
        attributes: &[POSE],
    },
    Rule {
        within: "robot",
        elements: "joint",
        treatment: Honoured,
        attributes: &[("name type", Honoured)],
    },
    Rule {
        within: "joint constraint",
        elements: "parent child",
        treatment: Honoured,
        attributes: &[("link", Honoured)],
    },
    Rule {
        within: "joint loop constraint loop_joint",
        elements: "axis",
        treatment: Honoured,
        attributes: &[("xyz", Honoured)],
    },
    Rule {
        within: "joint",
        elements: "dynamics",
        treatment: Honoured,
        attributes: &[
            ("damping friction", Honoured),
            (
                "spring_stiffness spring_reference stiffness",
                unless("0", "the spring is missing from the model"),
            ),
        ],
    },
    Rule {
        within: "joint",
        elements: "limit",
        treatment: Honoured,
        attributes: &[
            ("lower upper velocity", Honoured),
            ("effort acceleration jerk deceleration", CONTROL),
        ],
    },
    Rule {
        within: "joint",
        elements: "mimic",
        treatment: Honoured,
        attributes: &[("joint multiplier offset", Honoured)],
    },
    Rule {
        within: "joint",
        elements: "safety_controller calibration",
        treatment: CONTROL,
        attributes: &[],
    },
    Rule {
        // Extension of onshape-to-robot.
        within: "joint",
        elements: "joint_properties",
        treatment: Container,
        attributes: &[(
            "friction damping armature stiffness",
            unless("0", "missing from the model: write it in <dynamics>"),
        )],
    },
    Rule {
        within: "robot",
        elements: "sensor",
        treatment: Irrelevant("sensors"),
        attributes: &[],
    },
    // Loop closures.
    Rule {
        within: "robot",
        elements: "loop",
        treatment: Honoured,
        attributes: &[("name type", Honoured)],
    },
    Rule {
        within: "loop coupling",
        elements: "predecessor successor",
        treatment: Honoured,
        attributes: &[("link", Honoured), POSE],
    },
    Rule {
        within: "robot",
        elements: "constraint",
        treatment: Honoured,
        attributes: &[("name type", Honoured)],
    },
    Rule {
        within: "constraint",
        elements: "parent_origin child_origin",
        treatment: Honoured,
        attributes: &[POSE],
    },
    Rule {
        within: "constraint loop loop_joint",
        elements: "parent_axis child_axis",
        treatment: Honoured,
        attributes: &[("xyz", Honoured)],
    },
    Rule {
        within: "robot",
        elements: "loop_joint",
        treatment: Honoured,
        attributes: &[("name type", Honoured)],
    },
    Rule {
        within: "loop_joint",
        elements: "link1 link2",
        treatment: Honoured,
        attributes: &[("link", Honoured), POSE],
    },
    Rule {
        within: "robot",
        elements: "coupling",
        treatment: Honoured,
        attributes: &[("name", CONTROL)],
    },
    Rule {
        within: "coupling",
        elements: "ratio",
        treatment: Honoured,
        attributes: &[("value", Honoured)],
    },
    // ROS transmissions, also inside `<ros2_control>`.
    Rule {
        within: "robot",
        elements: "transmission",
        treatment: Honoured,
        attributes: &[("name", CONTROL), ("type", Honoured)],
    },
    Rule {
        within: "ros2_control",
        elements: "transmission",
        treatment: Honoured,
        attributes: &[("name", CONTROL)],
    },
    Rule {
        within: "transmission",
        elements: "type plugin",
        treatment: Honoured,
        attributes: &[],
    },
    Rule {
        within: "transmission",
        elements: "joint",
        treatment: Honoured,
        attributes: &[("name role", Honoured)],
    },
    Rule {
        within: "transmission",
        elements: "actuator",
        treatment: Honoured,
        attributes: &[("name role", Honoured)],
    },
    Rule {
        within: "transmission joint actuator",
        elements: "mechanicalReduction mechanical_reduction",
        treatment: Honoured,
        attributes: &[],
    },
    Rule {
        within: "transmission joint actuator",
        elements: "hardwareInterface motorTorqueConstant encoder_resolution controller_gains",
        treatment: CONTROL,
        attributes: &[],
    },
    Rule {
        within: "joint actuator",
        elements: "role",
        treatment: Honoured,
        attributes: &[],
    },
    Rule {
        within: "transmission joint",
        elements: "offset",
        treatment: CONTROL,
        attributes: &[],
    },
    Rule {
        // PR2 transmissions.
        within: "transmission",
        elements: "leftActuator rightActuator flexJoint rollJoint gap_joint compensator simulated_actuated_joint \
                   use_simulated_gripper_joint",
        treatment: rejected(
            "transmissions that couple several joints are not supported",
            COUPLED_MOTORS,
        ),
        attributes: &[],
    },
    Rule {
        within: "actuator",
        elements: "rotor_inertia gear_ratio",
        treatment: Honoured,
        attributes: &[("value", Honoured)],
    },
    Rule {
        within: "robot",
        elements: "ros2_control",
        treatment: Honoured,
        attributes: &[("name type rw_rate is_async", CONTROL)],
    },
    Rule {
        within: "ros2_control",
        elements: "hardware gpio sensor",
        treatment: CONTROL,
        attributes: &[],
    },
    Rule {
        within: "ros2_control",
        elements: "joint",
        treatment: reported(
            "not read: motors are those of <transmission>, of a YAML file next to the URDF, or of `--actuated`",
        ),
        attributes: &[],
    },
    Rule {
        within: "robot",
        elements: "gazebo",
        treatment: Honoured,
        attributes: &[("reference", SIMULATION)],
    },
    // Joints of <gazebo> are in SDFormat and close loops.
    Rule {
        within: "gazebo",
        elements: "joint",
        treatment: Honoured,
        attributes: &[("name type", Honoured)],
    },
    Rule {
        within: "gazebo/joint",
        elements: "parent child",
        treatment: Honoured,
        attributes: &[],
    },
    Rule {
        within: "gazebo/joint",
        elements: "pose",
        treatment: Honoured,
        attributes: &[(
            "relative_to frame degrees rotation_format",
            rejected(
                "only poses relative to the child link, with roll, pitch and yaw in rad, are supported",
                "write the pose in the frame of the child link",
            ),
        )],
    },
    Rule {
        within: "gazebo/joint",
        elements: "axis",
        treatment: Honoured,
        attributes: &[],
    },
    Rule {
        within: "joint/axis",
        elements: "xyz",
        treatment: Honoured,
        attributes: &[(
            "expressed_in",
            rejected(
                "only axes in the frame of the joint are supported",
                "write the axis in the frame of the joint",
            ),
        )],
    },
    Rule {
        within: "joint/axis",
        elements: "use_parent_model_frame",
        treatment: Treatment::Rejected {
            neutral: "false False 0",
            reason: "only axes in the frame of the joint are supported",
            help: "write the axis in the frame of the joint",
        },
        attributes: &[],
    },
    Rule {
        within: "joint/axis",
        elements: "limit initial_position",
        treatment: Irrelevant("limits and settings of a joint that closes a loop"),
        attributes: &[],
    },
    Rule {
        within: "joint/axis",
        elements: "dynamics",
        treatment: Container,
        attributes: &[],
    },
    Rule {
        within: "axis/dynamics",
        elements: "damping friction spring_stiffness",
        treatment: unless(
            "0",
            "torques of joints that close a loop are missing from the model",
        ),
        attributes: &[],
    },
    Rule {
        within: "axis/dynamics",
        elements: "spring_reference",
        treatment: SIMULATION,
        attributes: &[],
    },
    Rule {
        within: "gazebo/joint",
        elements: "physics sensor",
        treatment: SIMULATION,
        attributes: &[],
    },
    Rule {
        within: "gazebo",
        elements: "link model include",
        treatment: rejected(
            "bodies of <gazebo> are not read from URDF",
            "convert the file by `gz sdf -p FILE` and import the SDFormat",
        ),
        attributes: &[],
    },
    Rule {
        within: "gazebo",
        elements: "plugin",
        treatment: reported("plugins are not read, nor forces that they exert"),
        attributes: &[],
    },
    Rule {
        within: "gazebo",
        elements: "springStiffness springReference",
        treatment: unless("0", "the spring is missing from the model"),
        attributes: &[],
    },
    Rule {
        within: "gazebo",
        elements: "turnGravityOff",
        treatment: unless("false False 0", "gravity acts on the link in the model"),
        attributes: &[],
    },
    Rule {
        within: "gazebo",
        elements: "gravity",
        treatment: unless("true True 1", "gravity acts on the link in the model"),
        attributes: &[],
    },
    Rule {
        within: "gazebo",
        elements: "kinematic static",
        treatment: unless("false False 0", "the robot moves in the model"),
        attributes: &[],
    },
    Rule {
        within: "gazebo",
        elements: "pose",
        treatment: unless(
            "0",
            "the base link is at the origin of the world in the model",
        ),
        attributes: &[],
    },
    Rule {
        within: "gazebo",
        elements: "velocity_decay",
        treatment: Container,
        attributes: &[],
    },
    Rule {
        within: "velocity_decay",
        elements: "linear angular",
        treatment: unless("0", "the damping of the body is missing from the model"),
        attributes: &[],
    },
    Rule {
        within: "gazebo",
        elements: "dampingFactor",
        treatment: unless("0", "the damping of the body is missing from the model"),
        attributes: &[],
    },
    Rule {
        within: "gazebo",
        elements: "material visual sensor light",
        treatment: APPEARANCE,
        attributes: &[],
    },
    Rule {
        within: "gazebo",
        elements: "mu1 mu2 mu kp kd fdir1 minDepth maxVel maxContacts selfCollide self_collide collision surface \
                   laserRetro disable_fixed_joint_lumping",
        treatment: CONTACT,
        attributes: &[],
    },
    Rule {
        within: "gazebo",
        elements: "preserveFixedJoint disableFixedJointLumping implicitSpringDamper provideFeedback \
                   provide_feedback stopCfm stopErp stopKp stopKd fudgeFactor cfmDamping initial_joint_position \
                   enable_wind allow_auto_disable canonicalBody ignition gz",
        treatment: SIMULATION,
        attributes: &[],
    },
    Rule {
        within: "robot",
        elements: "ball_constraint",
        treatment: Honoured,
        attributes: &[],
    },
    Rule {
        within: "ball_constraint",
        elements: "ball_constraint_body_A ball_constraint_body_B",
        treatment: Honoured,
        attributes: &[("name", Honoured)],
    },
    Rule {
        within: "ball_constraint",
        elements: "ball_constraint_p_AP ball_constraint_p_BQ",
        treatment: Honoured,
        attributes: &[("value", Honoured)],
    },
    Rule {
        within: "robot",
        elements: "linear_bushing_rpy",
        treatment: rejected(
            "bushings close loops by springs and dampers, which is not supported",
            "replace the bushing by a joint: <loop> of type spherical, revolute or fixed",
        ),
        attributes: &[],
    },
    Rule {
        within: "robot",
        elements: "distance_constraint tendon_constraint coupler_constraint weld_constraint",
        treatment: rejected(
            "constraints of this kind are not supported",
            "write the loop as <loop> of type spherical, revolute or fixed, and couplings as <mimic>",
        ),
        attributes: &[],
    },
    Rule {
        within: "robot",
        elements: "collision_filter_group",
        treatment: CONTACT,
        attributes: &[],
    },
    Rule {
        within: "joint",
        elements: "screw_thread_pitch",
        treatment: reported("screws are not read from URDF"),
        attributes: &[],
    },
    Rule {
        within: "robot",
        elements: "mujoco",
        treatment: Container,
        attributes: &[],
    },
    Rule {
        within: "mujoco",
        elements: "compiler",
        treatment: Container,
        attributes: &[
            (
                "alignfree angle assetdir autolimits conflict convexhull discardvisual eulerseq fitaabb fusestatic \
                 inertiagrouprange meshdir passthrough savecanonical savecompiled saveinertial strippath texturedir \
                 usethread",
                SIMULATION,
            ),
            (
                "inertiafromgeom",
                unless(
                    "auto false",
                    "masses and inertias of the model are those of <inertial>",
                ),
            ),
            (
                "balanceinertia",
                unless(
                    "false",
                    "masses and inertias of the model are those of the links",
                ),
            ),
            (
                "settotalmass boundmass boundinertia",
                unless(
                    "0 -1",
                    "masses and inertias of the model are those of the links",
                ),
            ),
        ],
    },
    Rule {
        within: "mujoco",
        elements: "option",
        treatment: Container,
        attributes: &[
            (
                "gravity",
                unless(USUAL_GRAVITY, "gravity is 9.81 m/s² against z in the model"),
            ),
            (
                "density viscosity",
                unless("0", "forces of a fluid are missing from the model"),
            ),
            (
                "actuatorgroupdisable apirate ccd_iterations ccd_tolerance collision cone impratio integrator \
                 iterations jacobian ls_iterations ls_tolerance magnetic mpr_iterations mpr_tolerance \
                 noslip_iterations noslip_tolerance o_friction o_margin o_solimp o_solref sdf_initpoints \
                 sdf_iterations sleep_tolerance solver timestep tolerance wind",
                SIMULATION,
            ),
        ],
    },
    Rule {
        within: "option",
        elements: "flag",
        treatment: Container,
        attributes: &[
            (
                "gravity",
                unless("enable", "gravity is 9.81 m/s² against z in the model"),
            ),
            (
                "constraint equality spring damper passive frictionloss",
                unless(
                    "enable",
                    "the flag of the simulation is not used: forces act in the model",
                ),
            ),
            (
                "actuation autoreset clampctrl contact diagexact energy eulerdamp filterparent fwdinv invdiscrete \
                 ipc island limit midphase multiccd nativeccd override refsafe sensor sleep speculative warmstart",
                SIMULATION,
            ),
        ],
    },
    Rule {
        within: "mujoco",
        elements: "size",
        treatment: SIMULATION,
        attributes: &[],
    },
];
