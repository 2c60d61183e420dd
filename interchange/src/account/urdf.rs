//! Table of URDF: urdfdom, loop notations, and the extensions of Gazebo, ROS 2 control and Drake.

use super::table::{
    Rule, Table, Treatment, USUAL_GRAVITY, rejected, reported, rule, unless, whole,
};
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
    rule(
        "",
        "robot",
        Honoured,
        &[("name", Honoured), ("version", SIMULATION)],
    ),
    whole("robot", "material", APPEARANCE),
    rule(
        "robot",
        "link",
        Honoured,
        &[("name", Honoured), ("type", APPEARANCE)],
    ),
    whole("link", "visual visual_material", APPEARANCE),
    whole(
        "link",
        "collision collision_checking self_collision_checking contact",
        CONTACT,
    ),
    whole("link", "inertial", Honoured),
    rule("inertial", "mass", Honoured, &[("value", Honoured)]),
    rule(
        "inertial",
        "inertia",
        Honoured,
        &[("ixx ixy ixz iyy iyz izz", Honoured)],
    ),
    rule(
        "inertial joint predecessor successor link1 link2",
        "origin",
        Honoured,
        &[POSE],
    ),
    rule("robot", "joint", Honoured, &[("name type", Honoured)]),
    rule(
        "joint constraint",
        "parent child",
        Honoured,
        &[("link", Honoured)],
    ),
    rule(
        "joint loop constraint loop_joint",
        "axis",
        Honoured,
        &[("xyz", Honoured)],
    ),
    rule(
        "joint",
        "dynamics",
        Honoured,
        &[
            ("damping friction", Honoured),
            (
                "spring_stiffness spring_reference stiffness",
                unless("0", "the spring is missing from the model"),
            ),
        ],
    ),
    rule(
        "joint",
        "limit",
        Honoured,
        &[
            ("lower upper velocity", Honoured),
            ("effort acceleration jerk deceleration", CONTROL),
        ],
    ),
    rule(
        "joint",
        "mimic",
        Honoured,
        &[("joint multiplier offset", Honoured)],
    ),
    whole("joint", "safety_controller calibration", CONTROL),
    // Extension of onshape-to-robot.
    rule(
        "joint",
        "joint_properties",
        Container,
        &[(
            "friction damping armature stiffness",
            unless("0", "missing from the model: write it in <dynamics>"),
        )],
    ),
    whole("robot", "sensor", Irrelevant("sensors")),
    // Loop closures.
    rule("robot", "loop", Honoured, &[("name type", Honoured)]),
    rule(
        "loop coupling",
        "predecessor successor",
        Honoured,
        &[("link", Honoured), POSE],
    ),
    rule("robot", "constraint", Honoured, &[("name type", Honoured)]),
    rule(
        "constraint",
        "parent_origin child_origin",
        Honoured,
        &[POSE],
    ),
    rule(
        "constraint loop loop_joint",
        "parent_axis child_axis",
        Honoured,
        &[("xyz", Honoured)],
    ),
    rule("robot", "loop_joint", Honoured, &[("name type", Honoured)]),
    rule(
        "loop_joint",
        "link1 link2",
        Honoured,
        &[("link", Honoured), POSE],
    ),
    rule("robot", "coupling", Honoured, &[("name", CONTROL)]),
    rule("coupling", "ratio", Honoured, &[("value", Honoured)]),
    // ROS transmissions, also inside `<ros2_control>`.
    rule(
        "robot",
        "transmission",
        Honoured,
        &[("name", CONTROL), ("type", Honoured)],
    ),
    rule(
        "ros2_control",
        "transmission",
        Honoured,
        &[("name", CONTROL)],
    ),
    whole("transmission", "type plugin", Honoured),
    rule(
        "transmission",
        "joint",
        Honoured,
        &[("name role", Honoured)],
    ),
    rule(
        "transmission",
        "actuator",
        Honoured,
        &[("name role", Honoured)],
    ),
    whole(
        "transmission joint actuator",
        "mechanicalReduction mechanical_reduction",
        Honoured,
    ),
    whole(
        "transmission joint actuator",
        "hardwareInterface motorTorqueConstant encoder_resolution controller_gains",
        CONTROL,
    ),
    whole("joint actuator", "role", Honoured),
    whole("transmission joint", "offset", CONTROL),
    // PR2 transmissions.
    whole(
        "transmission",
        "leftActuator rightActuator flexJoint rollJoint gap_joint compensator simulated_actuated_joint \
                   use_simulated_gripper_joint",
        rejected(
            "transmissions that couple several joints are not supported",
            COUPLED_MOTORS,
        ),
    ),
    rule(
        "actuator",
        "rotor_inertia gear_ratio",
        Honoured,
        &[("value", Honoured)],
    ),
    rule(
        "robot",
        "ros2_control",
        Honoured,
        &[("name type rw_rate is_async", CONTROL)],
    ),
    whole("ros2_control", "hardware gpio sensor", CONTROL),
    whole(
        "ros2_control",
        "joint",
        reported(
            "not read: motors are those of <transmission>, of a YAML file next to the URDF, or of `--actuated`",
        ),
    ),
    rule("robot", "gazebo", Honoured, &[("reference", SIMULATION)]),
    // Joints of <gazebo> are in SDFormat and close loops.
    rule("gazebo", "joint", Honoured, &[("name type", Honoured)]),
    whole("gazebo/joint", "parent child", Honoured),
    rule(
        "gazebo/joint",
        "pose",
        Honoured,
        &[(
            "relative_to frame degrees rotation_format",
            rejected(
                "only poses relative to the child link, with roll, pitch and yaw in rad, are supported",
                "write the pose in the frame of the child link",
            ),
        )],
    ),
    whole("gazebo/joint", "axis", Honoured),
    rule(
        "joint/axis",
        "xyz",
        Honoured,
        &[(
            "expressed_in",
            rejected(
                "only axes in the frame of the joint are supported",
                "write the axis in the frame of the joint",
            ),
        )],
    ),
    whole(
        "joint/axis",
        "use_parent_model_frame",
        Treatment::Rejected {
            neutral: "false False 0",
            reason: "only axes in the frame of the joint are supported",
            help: "write the axis in the frame of the joint",
        },
    ),
    whole(
        "joint/axis",
        "limit initial_position",
        Irrelevant("limits and settings of a joint that closes a loop"),
    ),
    whole("joint/axis", "dynamics", Container),
    whole(
        "axis/dynamics",
        "damping friction spring_stiffness",
        unless(
            "0",
            "torques of joints that close a loop are missing from the model",
        ),
    ),
    whole("axis/dynamics", "spring_reference", SIMULATION),
    whole("gazebo/joint", "physics sensor", SIMULATION),
    whole(
        "gazebo",
        "link model include",
        rejected(
            "bodies of <gazebo> are not read from URDF",
            "convert the file by `gz sdf -p FILE` and import the SDFormat",
        ),
    ),
    whole(
        "gazebo",
        "plugin",
        reported("plugins are not read, nor forces that they exert"),
    ),
    whole(
        "gazebo",
        "springStiffness springReference",
        unless("0", "the spring is missing from the model"),
    ),
    whole(
        "gazebo",
        "turnGravityOff",
        unless("false False 0", "gravity acts on the link in the model"),
    ),
    whole(
        "gazebo",
        "gravity",
        unless("true True 1", "gravity acts on the link in the model"),
    ),
    whole(
        "gazebo",
        "kinematic static",
        unless("false False 0", "the robot moves in the model"),
    ),
    whole(
        "gazebo",
        "pose",
        unless(
            "0",
            "the base link is at the origin of the world in the model",
        ),
    ),
    whole("gazebo", "velocity_decay", Container),
    whole(
        "velocity_decay",
        "linear angular",
        unless("0", "the damping of the body is missing from the model"),
    ),
    whole(
        "gazebo",
        "dampingFactor",
        unless("0", "the damping of the body is missing from the model"),
    ),
    whole("gazebo", "material visual sensor light", APPEARANCE),
    whole(
        "gazebo",
        "mu1 mu2 mu kp kd fdir1 minDepth maxVel maxContacts selfCollide self_collide collision surface \
                   laserRetro disable_fixed_joint_lumping",
        CONTACT,
    ),
    whole(
        "gazebo",
        "preserveFixedJoint disableFixedJointLumping implicitSpringDamper provideFeedback \
                   provide_feedback stopCfm stopErp stopKp stopKd fudgeFactor cfmDamping initial_joint_position \
                   enable_wind allow_auto_disable canonicalBody ignition gz",
        SIMULATION,
    ),
    whole("robot", "ball_constraint", Honoured),
    rule(
        "ball_constraint",
        "ball_constraint_body_A ball_constraint_body_B",
        Honoured,
        &[("name", Honoured)],
    ),
    rule(
        "ball_constraint",
        "ball_constraint_p_AP ball_constraint_p_BQ",
        Honoured,
        &[("value", Honoured)],
    ),
    whole(
        "robot",
        "linear_bushing_rpy",
        rejected(
            "bushings close loops by springs and dampers, which is not supported",
            "replace the bushing by a joint: <loop> of type spherical, revolute or fixed",
        ),
    ),
    whole(
        "robot",
        "distance_constraint tendon_constraint coupler_constraint weld_constraint",
        rejected(
            "constraints of this kind are not supported",
            "write the loop as <loop> of type spherical, revolute or fixed, and couplings as <mimic>",
        ),
    ),
    whole("robot", "collision_filter_group", CONTACT),
    whole(
        "joint",
        "screw_thread_pitch",
        reported("screws are not read from URDF"),
    ),
    whole("robot", "mujoco", Container),
    rule(
        "mujoco",
        "compiler",
        Container,
        &[
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
    ),
    rule(
        "mujoco",
        "option",
        Container,
        &[
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
    ),
    rule(
        "option",
        "flag",
        Container,
        &[
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
    ),
    whole("mujoco", "size", SIMULATION),
];
