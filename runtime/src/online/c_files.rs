//! The same estimators in C99.

/// A C file of online estimation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CFile {
    /// File name.
    pub name: &'static str,
    /// Contents.
    pub text: &'static str,
}

/// Header and sources of the estimators in C, independent of the robot.
///
/// Numbers are `double`, or `float` with the macro `OVERACT_ONLINE_SINGLE`. Results are those of
/// Rust. `overact generate --lang c --online` writes the files.
///
/// ```
/// use overact::online::C_FILES;
///
/// let names = C_FILES.map(|file| file.name);
/// assert_eq!(names[..2], ["overact_online.h", "overact_online.c"]);
/// assert!(C_FILES[0].text.contains("overact_online_update("));
/// ```
pub const C_FILES: [CFile; 4] = [
    CFile {
        name: "overact_online.h",
        text: include_str!("../../c/overact_online.h"),
    },
    CFile {
        name: "overact_online.c",
        text: include_str!("../../c/overact_online.c"),
    },
    CFile {
        name: "overact_online_signals.c",
        text: include_str!("../../c/overact_online_signals.c"),
    },
    CFile {
        name: "overact_online_payload.c",
        text: include_str!("../../c/overact_online_payload.c"),
    },
];
