//! Table of .par files (OpenSYMORO): keys in capitals.

use super::table::{IDENTITY, Table, Treatment, rule, unless};
use Treatment::{Honoured, Irrelevant};

const BASE: &str = "the base is fixed at its position in the model";

pub(crate) const TABLE: Table = Table {
    rules: &[rule(
        "",
        "par",
        Honoured,
        &[
            (
                "NL NJ NF ANT SIGMA B D R GAMMA ALPHA MU THETA XX XY XZ YY YZ ZZ MX MY MZ M IA FV FS G \
                 IS_FLOATING IS_MOBILE",
                Honoured,
            ),
            (
                "TYPE",
                Irrelevant("structure, which follows from the frames"),
            ),
            (
                "QP QDP GAM",
                Irrelevant("names of velocities, accelerations and torques"),
            ),
            (
                "FX FY FZ CX CY CZ",
                unless("0", "the wrench on the body is missing from the model"),
            ),
            (
                "ETA K",
                unless("0", "elasticity of joints is missing from the model"),
            ),
            ("W0 WP0 V0 VP0", unless("0", BASE)),
            ("Z", unless(IDENTITY, BASE)),
        ],
    )],
    repeatable: "",
    texts: "",
};
