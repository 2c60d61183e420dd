//! Table of SDFormat 1.4 to 1.12: elements and attributes of its specification.

use super::table::{Rule, Table, Treatment, rejected, reported, rule, unless, whole};
use Treatment::{Container, Honoured, Irrelevant, Opaque};

const APPEARANCE: Treatment = Irrelevant("appearance");
const CONTACT: Treatment = Irrelevant("contact and collision");
const SENSORS: Treatment = Irrelevant("sensors");
const SIMULATION: Treatment = Irrelevant("settings of the simulation");

const LIMITS: Treatment = Irrelevant("force limits and softness of limits");

pub(crate) const TABLE: Table = Table {
    rules: RULES,
    repeatable: "world physics model include frame link joint",
    texts: "gravity static pose uri name placement_frame mass ixx ixy ixz iyy iyz izz parent child gearbox_ratio \
            gearbox_reference_body thread_pitch screw_thread_pitch xyz use_parent_model_frame damping friction \
            spring_stiffness spring_reference lower upper velocity multiplier offset reference \
            rotor_inertia gear_ratio",
};

/// An element whose text is read.
const fn text(within: &'static str, elements: &'static str) -> Rule {
    whole(within, elements, Honoured)
}

const RULES: &[Rule] = &[
    rule("", "sdf gazebo", Honoured, &[("version", Honoured)]),
    rule("sdf gazebo", "world", Honoured, &[("name", SIMULATION)]),
    text("world link physics", "gravity"),
    // Has gravity up to SDFormat 1.5.
    rule(
        "world",
        "physics",
        Honoured,
        &[("name default type", SIMULATION)],
    ),
    whole("sdf gazebo", "physics", SIMULATION),
    whole(
        "physics",
        "max_step_size real_time_factor real_time_update_rate max_contacts update_rate dart simbody bullet ode",
        SIMULATION,
    ),
    whole("physics", "magnetic_field", SIMULATION),
    whole(
        "sdf gazebo world",
        "actor audio atmosphere gui light magnetic_field population road scene spherical_coordinates state",
        SIMULATION,
    ),
    whole(
        "world",
        "wind",
        Irrelevant("acts on links with `enable_wind`, which are reported"),
    ),
    whole(
        "world",
        "plugin",
        reported("plugins are not read, nor forces that they exert"),
    ),
    rule(
        "sdf gazebo world model",
        "model",
        Honoured,
        &[("name placement_frame canonical_link", Honoured)],
    ),
    text("model include", "static"),
    whole("model", "self_collide", CONTACT),
    whole("model", "allow_auto_disable gripper", SIMULATION),
    whole(
        "model link",
        "enable_wind",
        unless(
            "false False 0",
            "the force of the wind is missing from the model",
        ),
    ),
    rule(
        "model include",
        "plugin",
        Opaque,
        &[("name filename", Honoured)],
    ),
    rule(
        "sdf gazebo world model",
        "include",
        Honoured,
        &[("merge", Honoured)],
    ),
    text("include", "uri name placement_frame"),
    whole(
        "include",
        "params",
        rejected(
            "an <include> that changes what it includes is not supported",
            "expand the model with `gz sdf -p FILE`",
        ),
    ),
    rule(
        "model include link joint frame inertial",
        "pose",
        Honoured,
        &[("relative_to frame degrees rotation_format", Honoured)],
    ),
    rule(
        "world model",
        "frame",
        Honoured,
        &[("name attached_to", Honoured)],
    ),
    rule("model", "link", Honoured, &[("name", Honoured)]),
    rule("link", "inertial", Honoured, &[("auto", Honoured)]),
    text("inertial", "mass inertia"),
    text("inertia", "ixx ixy ixz iyy iyz izz"),
    whole(
        "inertial",
        "density auto_inertia_params",
        Irrelevant("inertias from shapes are not read, which is reported"),
    ),
    whole(
        "inertial",
        "fluid_added_mass",
        rejected(
            "the added mass of a fluid is not supported",
            "remove <fluid_added_mass> if the robot moves in air",
        ),
    ),
    whole(
        "link",
        "kinematic",
        unless(
            "false False 0",
            "the link moves with its joints in the model",
        ),
    ),
    whole("link", "velocity_decay", Container),
    whole(
        "velocity_decay",
        "linear angular",
        unless("0", "the damping of the link is missing from the model"),
    ),
    whole("link", "self_collide collision", CONTACT),
    whole(
        "link",
        "visual light projector particle_emitter material audio_sink audio_source",
        APPEARANCE,
    ),
    whole("link joint", "sensor", SENSORS),
    whole("link", "must_be_base_link battery", SIMULATION),
    rule("world model", "joint", Honoured, &[("name type", Honoured)]),
    text(
        "joint",
        "parent child gearbox_ratio gearbox_reference_body thread_pitch screw_thread_pitch axis axis2",
    ),
    whole("joint", "physics", SIMULATION),
    rule("axis axis2", "xyz", Honoured, &[("expressed_in", Honoured)]),
    text("axis axis2", "use_parent_model_frame dynamics limit"),
    whole(
        "axis axis2",
        "initial_position",
        Irrelevant("home is the configuration in which all joints are zero"),
    ),
    text(
        "dynamics",
        "damping friction spring_stiffness spring_reference",
    ),
    text("limit", "lower upper velocity"),
    whole("limit", "effort stiffness dissipation", LIMITS),
    // Factor and offset are attributes in `<drake:mimic>`.
    rule(
        "axis axis2",
        "mimic",
        Honoured,
        &[("joint axis multiplier offset", Honoured)],
    ),
    // Drake.
    text("joint", "rotor_inertia gear_ratio"),
    whole("joint", "controller_gains", SIMULATION),
    whole(
        "model world",
        "ball_constraint linear_bushing_rpy distance_constraint tendon_constraint coupler_constraint \
         weld_constraint",
        rejected(
            "constraints of Drake close loops, and are not read from SDFormat",
            "write the loop as a <joint> of type ball, revolute or fixed",
        ),
    ),
    whole("model world", "collision_filter_group", CONTACT),
    text("mimic", "multiplier offset reference"),
];
