//! Transmissions in C99 and C++17.

use crate::online::CFile;

/// Header and source in C, and a header for C++, independent of the robot.
///
/// Numbers are `double`, or `float` with the macro `OVERACT_TRANSMISSION_SINGLE`. Results are those
/// of Rust. `overact generate --lang c --transmission` writes the files.
///
/// ```
/// use overact::transmission::C_FILES;
///
/// assert_eq!(C_FILES[0].name, "overact_transmission.h");
/// assert!(C_FILES[0].text.contains("overact_transmission_init("));
/// ```
pub const C_FILES: [CFile; 3] = [
    CFile {
        name: "overact_transmission.h",
        text: include_str!("../../c/overact_transmission.h"),
    },
    CFile {
        name: "overact_transmission.c",
        text: include_str!("../../c/overact_transmission.c"),
    },
    CFile {
        name: "overact_transmission.hpp",
        text: include_str!("../../c/overact_transmission.hpp"),
    },
];
