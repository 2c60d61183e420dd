//! MJCF: the elements and attributes of MuJoCo's XML reference, up to version 4.

use super::table::{Rule, Table, Treatment, rejected, reported, unless};
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
    Rule {
        within: "",
        elements: "mujoco",
        treatment: Honoured,
        attributes: &[("model", Honoured)],
    },
    Rule {
        // Allowed in any element; replaced by the elements of the included file.
        within: "",
        elements: "include",
        treatment: Honoured,
        attributes: &[("file", Honoured)],
    },
    Rule {
        within: "mujoco",
        elements: "compiler",
        treatment: Honoured,
        attributes: &[
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
    },
    Rule {
        within: "compiler",
        elements: "lengthrange",
        treatment: CONTROL,
        attributes: &[],
    },
    Rule {
        within: "mujoco",
        elements: "option",
        treatment: Honoured,
        attributes: &[
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
    },
    Rule {
        within: "option",
        elements: "flag",
        treatment: Honoured,
        attributes: &[
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
    },
    Rule {
        within: "mujoco",
        elements: "size statistic custom",
        treatment: SIMULATION,
        attributes: &[],
    },
    Rule {
        within: "mujoco",
        elements: "visual",
        treatment: APPEARANCE,
        attributes: &[],
    },
    Rule {
        within: "mujoco",
        elements: "asset",
        treatment: Honoured,
        attributes: &[],
    },
    Rule {
        within: "asset default",
        elements: "mesh",
        treatment: Honoured,
        attributes: MESH,
    },
    Rule {
        within: "asset",
        elements: "hfield skin texture material",
        treatment: APPEARANCE,
        attributes: &[],
    },
    Rule {
        within: "asset",
        elements: "model",
        treatment: Irrelevant("acts with `attach`, which is rejected"),
        attributes: &[],
    },
    Rule {
        within: "mujoco",
        elements: "contact",
        treatment: CONTACT,
        attributes: &[],
    },
    Rule {
        within: "mujoco",
        elements: "sensor",
        treatment: Irrelevant("sensors"),
        attributes: &[],
    },
    Rule {
        within: "mujoco",
        elements: "keyframe",
        treatment: Irrelevant("its positions are a start for the home of robots with loops"),
        attributes: &[],
    },
    Rule {
        within: "mujoco",
        elements: "extension",
        treatment: Irrelevant("plugins are reported where they act"),
        attributes: &[],
    },
    Rule {
        within: "mujoco",
        elements: "tendon",
        treatment: Honoured,
        attributes: &[],
    },
    Rule {
        within: "mujoco",
        elements: "deformable",
        treatment: Container,
        attributes: &[],
    },
    Rule {
        within: "tendon",
        elements: "spatial fixed",
        treatment: Honoured,
        attributes: TENDON,
    },
    Rule {
        within: "spatial",
        elements: "site",
        treatment: Honoured,
        attributes: &[("site", Honoured)],
    },
    Rule {
        within: "spatial",
        elements: "geom pulley",
        treatment: Honoured,
        attributes: &[(
            "geom sidesite divisor",
            Irrelevant("a tendon with such a path is rejected if it exerts forces"),
        )],
    },
    Rule {
        within: "fixed",
        elements: "joint",
        treatment: Honoured,
        attributes: &[("joint coef", Honoured)],
    },
    Rule {
        within: "deformable",
        elements: "flex",
        treatment: rejected("deformable bodies are not supported", "remove it"),
        attributes: &[],
    },
    Rule {
        within: "deformable",
        elements: "skin",
        treatment: APPEARANCE,
        attributes: &[],
    },
    Rule {
        within: "mujoco default",
        elements: "default",
        treatment: Honoured,
        attributes: &[("class", Honoured)],
    },
    Rule {
        within: "default",
        elements: "texture material camera light pair",
        treatment: APPEARANCE,
        attributes: &[],
    },
    Rule {
        within: "default",
        elements: "tendon",
        treatment: Honoured,
        attributes: TENDON,
    },
    Rule {
        within: "default",
        elements: "equality",
        treatment: Honoured,
        attributes: &[("active", Honoured), ("solimp solref", SOFTNESS)],
    },
    Rule {
        within: "mujoco",
        elements: "worldbody",
        treatment: Honoured,
        attributes: &[
            ("childclass", Honoured),
            ("name pos quat axisangle xyaxes zaxis euler user", NAMES),
        ],
    },
    Rule {
        within: BODIES,
        elements: "body",
        treatment: Honoured,
        attributes: &[
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
    },
    Rule {
        within: BODIES,
        elements: "frame",
        treatment: Honoured,
        attributes: &[("childclass", Honoured), POSE, ("name", NAMES)],
    },
    Rule {
        within: "body frame",
        elements: "inertial",
        treatment: Honoured,
        attributes: &[POSE, ("mass diaginertia fullinertia", Honoured)],
    },
    Rule {
        within: "body frame default",
        elements: "joint",
        treatment: Honoured,
        attributes: &[
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
    },
    Rule {
        within: "body frame",
        elements: "freejoint",
        treatment: Honoured,
        attributes: &[("name", Honoured), ("group align", NAMES)],
    },
    Rule {
        within: BODIES_OR_DEFAULT,
        elements: "geom",
        treatment: Honoured,
        attributes: &[
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
    },
    Rule {
        within: BODIES_OR_DEFAULT,
        elements: "site",
        treatment: Honoured,
        attributes: &[
            ("name class", Honoured),
            POSE,
            (
                "fromto",
                reported("the frame of the site is that of `pos` and its rotation"),
            ),
            ("group material mesh rgba size type user", APPEARANCE),
        ],
    },
    Rule {
        within: BODIES,
        elements: "camera light",
        treatment: APPEARANCE,
        attributes: &[],
    },
    Rule {
        within: "body frame geom mesh",
        elements: "plugin",
        treatment: reported("forces and shapes of plugins are missing from the model"),
        attributes: &[],
    },
    Rule {
        within: BODIES,
        elements: "flexcomp composite",
        treatment: reported("the bodies that it represents are missing from the model"),
        attributes: &[],
    },
    Rule {
        within: BODIES,
        elements: "attach replicate",
        treatment: rejected("copies of bodies are not supported", WRITE_OUT),
        attributes: &[],
    },
    Rule {
        within: "mujoco",
        elements: "equality actuator",
        treatment: Honoured,
        attributes: &[],
    },
    Rule {
        within: "equality",
        elements: "connect",
        treatment: Honoured,
        attributes: &[
            ("name class active body1 body2 site1 site2 anchor", Honoured),
            ("solref solimp", SOFTNESS),
        ],
    },
    Rule {
        within: "equality",
        elements: "weld",
        treatment: Honoured,
        attributes: &[
            (
                "name class active body1 body2 site1 site2 anchor relpose",
                Honoured,
            ),
            ("torquescale solref solimp", SOFTNESS),
        ],
    },
    Rule {
        within: "equality",
        elements: "joint",
        treatment: Honoured,
        attributes: &[
            ("name class active joint1 joint2 polycoef", Honoured),
            ("solref solimp", SOFTNESS),
        ],
    },
    Rule {
        within: "equality",
        elements: "tendon",
        treatment: Honoured,
        attributes: &[
            ("class active tendon1 tendon2 polycoef", Honoured),
            ("name", NAMES),
            ("solref solimp", SOFTNESS),
        ],
    },
    Rule {
        // Rejected by name if active.
        within: "equality",
        elements: "flex flexvert flexstrain distance",
        treatment: Honoured,
        attributes: &[
            ("class active", Honoured),
            (
                "name flex cell geom1 geom2 distance solref solimp",
                SOFTNESS,
            ),
        ],
    },
    Rule {
        within: "actuator default",
        elements: "general motor position velocity intvelocity orientation pid damper cylinder muscle \
                   dcmotor plugin",
        treatment: Honoured,
        attributes: ACTUATOR,
    },
    Rule {
        within: "default",
        elements: "adhesion",
        treatment: Honoured,
        attributes: ACTUATOR,
    },
    Rule {
        within: "actuator",
        elements: "adhesion",
        treatment: CONTACT,
        attributes: &[],
    },
    Rule {
        within: "plugin",
        elements: "config",
        treatment: CONTROL,
        attributes: &[],
    },
];
