//! MJCF: the elements and attributes of MuJoCo's XML reference, up to version 4.

use super::table::{Rule, Table, Treatment, rejected, reported, rule, unless, whole};
use Treatment::{Container, Honoured, Irrelevant};

const APPEARANCE: Treatment = Irrelevant("appearance");
const CONTACT: Treatment = Irrelevant("contact and collision");
const CONTROL: Treatment = Irrelevant("control law of the drive");
const LIMITS: Treatment = Irrelevant("force limits and softness of limits");
const NAMES: Treatment = Irrelevant("name, group or data of the user");
const SIMULATION: Treatment = Irrelevant("settings of the simulation");
const SOFTNESS: Treatment = Irrelevant("softness of the constraint");
const WRITING: Treatment = Irrelevant("files and how they are written");

const BODIES: &str = "worldbody body frame";
const BODIES_OR_DEFAULT: &str = "worldbody body frame default";

const POSE: (&str, Treatment) = ("pos quat axisangle xyaxes zaxis euler", Honoured);

const WRITE_OUT: &str = "expand the bodies: save the model as MJCF from MuJoCo";
const ON_A_JOINT: &str = "let it act on a joint, or remove the actuator";
const ENABLE: &str =
    "the flag of the simulation is not used: forces and constraints act in the model";

pub(crate) const TABLE: Table = Table {
    rules: RULES,
    // Sections may occur several times; later attributes override earlier ones.
    repeatable: "asset mesh include compiler option default worldbody body frame joint freejoint geom site equality actuator \
                 connect weld tendon spatial fixed flex flexvert flexstrain distance general motor position velocity intvelocity \
                 orientation pid damper cylinder muscle adhesion dcmotor plugin",
    texts: "",
};

const MESH: &[(&str, Treatment)] = &[
    (
        "name class file vertex face scale refpos refquat inertia builtin",
        Honoured,
    ),
    (
        "content_type maxhullvert normal texcoord smoothnormal material params",
        APPEARANCE,
    ),
];

const TENDON: &[(&str, Treatment)] = &[
    (
        "name class stiffness damping frictionloss armature springlength",
        Honoured,
    ),
    (
        "springyield",
        unless("0", "the softness of the spring is missing from the model"),
    ),
    (
        "actuatorfrclimited actuatorfrcrange limited margin range solimpfriction solimplimit \
         solreffriction solreflimit",
        LIMITS,
    ),
    ("group user", NAMES),
    ("material rgba width", APPEARANCE),
];

const ACTUATOR: &[(&str, Treatment)] = &[
    (
        "name class joint jointinparent tendon gear armature damping",
        Honoured,
    ),
    (
        "site refsite body slidersite cranksite",
        rejected(
            "actuators of sites and bodies are not supported",
            ON_A_JOINT,
        ),
    ),
    (
        "cogging lugre",
        reported("torques inside the drive are missing from the model"),
    ),
    (
        "actdim actearly actlimited actrange area bias biasprm biastype controller \
             cranklength ctrllimited ctrlrange dampratio delay diameter dynprm dyntype ffrange \
             force forcelimited forcerange fpmax fvmax gain gainprm gaintype group imax \
             inductance inheritrange input instance interp ki kp kv lengthrange lmax lmin \
             motorconst nominal nsample plugin posrange range resistance saturation scale \
             slewmax tausmooth thermal timeconst user velrange vmax",
        CONTROL,
    ),
];

const RULES: &[Rule] = &[
    rule("", "mujoco", Honoured, &[("model", Honoured)]),
    // Allowed in any element; replaced by the elements of the included file.
    rule("", "include", Honoured, &[("file", Honoured)]),
    rule(
        "mujoco",
        "compiler",
        Honoured,
        &[
            (
                "angle eulerseq coordinate autolimits inertiafromgeom inertiagrouprange \
                 settotalmass boundmass boundinertia balanceinertia fusestatic assetdir meshdir strippath",
                Honoured,
            ),
            (
                "alignfree texturedir discardvisual usethread conflict \
                 passthrough savecanonical savecompiled saveinertial fitaabb convexhull",
                WRITING,
            ),
            (
                "exactmeshinertia",
                reported("removed from MJCF: write inertia=\"exact\" at the <mesh>"),
            ),
        ],
    ),
    whole("compiler", "lengthrange", CONTROL),
    rule(
        "mujoco",
        "option",
        Honoured,
        &[
            ("gravity", Honoured),
            (
                "density",
                unless("0", "forces of a fluid are missing from the model"),
            ),
            (
                "viscosity",
                unless("0", "forces of a fluid are missing from the model"),
            ),
            (
                "wind",
                Irrelevant("acts with density and viscosity, which are reported"),
            ),
            ("magnetic", SIMULATION),
            (
                "actuatorgroupdisable apirate ccd_iterations ccd_tolerance collision cone impratio \
                 integrator iterations jacobian ls_iterations ls_tolerance mpr_iterations \
                 mpr_tolerance noslip_iterations noslip_tolerance o_friction o_margin o_solimp \
                 o_solref sdf_initpoints sdf_iterations sleep_tolerance solver timestep tolerance",
                SIMULATION,
            ),
        ],
    ),
    rule(
        "option",
        "flag",
        Honoured,
        &[
            ("gravity", Honoured),
            (
                "constraint equality spring damper passive frictionloss",
                unless("enable", ENABLE),
            ),
            (
                "actuation autoreset clampctrl contact diagexact energy eulerdamp filterparent \
                 fwdinv invdiscrete ipc island limit midphase multiccd nativeccd override refsafe \
                 sensor sleep speculative warmstart",
                SIMULATION,
            ),
        ],
    ),
    whole("mujoco", "size statistic custom", SIMULATION),
    whole("mujoco", "visual", APPEARANCE),
    whole("mujoco", "asset", Honoured),
    rule("asset default", "mesh", Honoured, MESH),
    whole("asset", "hfield skin texture material", APPEARANCE),
    whole(
        "asset",
        "model",
        Irrelevant("acts with `attach`, which is rejected"),
    ),
    whole("mujoco", "contact", CONTACT),
    whole("mujoco", "sensor", Irrelevant("sensors")),
    whole(
        "mujoco",
        "keyframe",
        Irrelevant("its positions are a start for the home of robots with loops"),
    ),
    whole(
        "mujoco",
        "extension",
        Irrelevant("plugins are reported where they act"),
    ),
    whole("mujoco", "tendon", Honoured),
    whole("mujoco", "deformable", Container),
    rule("tendon", "spatial fixed", Honoured, TENDON),
    rule("spatial", "site", Honoured, &[("site", Honoured)]),
    rule(
        "spatial",
        "geom pulley",
        Honoured,
        &[(
            "geom sidesite divisor",
            Irrelevant("a tendon with such a path is rejected if it exerts forces"),
        )],
    ),
    rule("fixed", "joint", Honoured, &[("joint coef", Honoured)]),
    whole(
        "deformable",
        "flex",
        rejected("deformable bodies are not supported", "remove it"),
    ),
    whole("deformable", "skin", APPEARANCE),
    rule(
        "mujoco default",
        "default",
        Honoured,
        &[("class", Honoured)],
    ),
    whole("default", "texture material camera light pair", APPEARANCE),
    rule("default", "tendon", Honoured, TENDON),
    rule(
        "default",
        "equality",
        Honoured,
        &[("active", Honoured), ("solimp solref", SOFTNESS)],
    ),
    rule(
        "mujoco",
        "worldbody",
        Honoured,
        &[
            ("childclass", Honoured),
            ("name pos quat axisangle xyaxes zaxis euler user", NAMES),
        ],
    ),
    rule(
        BODIES,
        "body",
        Honoured,
        &[
            ("name childclass", Honoured),
            POSE,
            ("gravcomp", Honoured),
            (
                "mocap",
                unless(
                    "false",
                    "the body is fixed here at its position in the file",
                ),
            ),
            ("fuse simple sleep user", SIMULATION),
        ],
    ),
    rule(
        BODIES,
        "frame",
        Honoured,
        &[("childclass", Honoured), POSE, ("name", NAMES)],
    ),
    rule(
        "body frame",
        "inertial",
        Honoured,
        &[POSE, ("mass diaginertia fullinertia", Honoured)],
    ),
    rule(
        "body frame default",
        "joint",
        Honoured,
        &[
            (
                "name class type pos axis range limited ref springref stiffness damping \
                 frictionloss armature springdamper",
                Honoured,
            ),
            (
                "springyield",
                unless("0", "the softness of the spring is missing from the model"),
            ),
            ("actuatorgravcomp", Honoured),
            (
                "actuatorfrclimited actuatorfrcrange margin solimpfriction solimplimit \
                 solreffriction solreflimit",
                LIMITS,
            ),
            ("group user", NAMES),
        ],
    ),
    rule(
        "body frame",
        "freejoint",
        Honoured,
        &[("name", Honoured), ("group align", NAMES)],
    ),
    rule(
        BODIES_OR_DEFAULT,
        "geom",
        Honoured,
        &[
            POSE,
            (
                "class type size fromto mass density group shellinertia mesh",
                Honoured,
            ),
            (
                "name user material rgba castshadow fitscale hfield",
                APPEARANCE,
            ),
            (
                "fluidcoef fluidshape",
                Irrelevant("acts with density and viscosity, which are reported"),
            ),
            (
                "adhesion conaffinity condim contype friction gap margin priority solimp solmix \
                 solref surfacevel",
                CONTACT,
            ),
        ],
    ),
    rule(
        BODIES_OR_DEFAULT,
        "site",
        Honoured,
        &[
            ("name class", Honoured),
            POSE,
            (
                "fromto",
                reported("the frame of the site is that of `pos` and its rotation"),
            ),
            ("group material mesh rgba size type user", APPEARANCE),
        ],
    ),
    whole(BODIES, "camera light", APPEARANCE),
    whole(
        "body frame geom mesh",
        "plugin",
        reported("forces and shapes of plugins are missing from the model"),
    ),
    whole(
        BODIES,
        "flexcomp composite",
        reported("the bodies that it represents are missing from the model"),
    ),
    whole(
        BODIES,
        "attach replicate",
        rejected("copies of bodies are not supported", WRITE_OUT),
    ),
    whole("mujoco", "equality actuator", Honoured),
    rule(
        "equality",
        "connect",
        Honoured,
        &[
            ("name class active body1 body2 site1 site2 anchor", Honoured),
            ("solref solimp", SOFTNESS),
        ],
    ),
    rule(
        "equality",
        "weld",
        Honoured,
        &[
            (
                "name class active body1 body2 site1 site2 anchor relpose torquescale",
                Honoured,
            ),
            ("solref solimp", SOFTNESS),
        ],
    ),
    rule(
        "equality",
        "joint",
        Honoured,
        &[
            ("name class active joint1 joint2 polycoef", Honoured),
            ("solref solimp", SOFTNESS),
        ],
    ),
    rule(
        "equality",
        "tendon",
        Honoured,
        &[
            ("class active tendon1 tendon2 polycoef", Honoured),
            ("name", NAMES),
            ("solref solimp", SOFTNESS),
        ],
    ),
    // Rejected by name if active.
    rule(
        "equality",
        "flex flexvert flexstrain distance",
        Honoured,
        &[
            ("class active", Honoured),
            (
                "name flex cell geom1 geom2 distance solref solimp",
                SOFTNESS,
            ),
        ],
    ),
    rule(
        "actuator default",
        "general motor position velocity intvelocity orientation pid damper cylinder muscle \
                   dcmotor plugin",
        Honoured,
        ACTUATOR,
    ),
    rule("default", "adhesion", Honoured, ACTUATOR),
    whole("actuator", "adhesion", CONTACT),
    whole("plugin", "config", CONTROL),
];
