//! Prefixes of names, and reserved names of C.
//!
//! All external names begin with the robot's name, because C has a single scope. Names of local
//! values come from the derivation and partly from the description: a joint `os` has the cosine
//! `cos`. Such reserved names are not used; the value gets its next name or a number.

use crate::float::Float;

/// The names of a robot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Naming {
    /// Prefix of functions and types, and the name of the files.
    pub prefix: String,
    /// The floating-point type, whose limits occur in C texts.
    pub float: Float,
}

/// Standard headers, and device names that cannot be file names on some systems.
const NO_FILES: &str = "\
    assert aux complex con ctype errno fenv float inttypes iso646 limits locale math nul prn \
    setjmp signal stdalign stdarg stdatomic stdbool stddef stdint stdio stdlib stdnoreturn \
    string tgmath threads time uchar wchar wctype";

/// Prefixes reserved for functions of the C library, including future ones (C99, 7.26).
const LIBRARY: [&str; 5] = ["is", "mem", "str", "to", "wcs"];

/// Keywords of C up to C23, and names that a compiler may define.
const WORDS: &str = "\
    alignas alignof asm auto bool break case char const constexpr continue default do double \
    else enum errno extern false far float for fortran goto huge i386 if inline int interrupt \
    linux long main near nullptr register restrict return short signed sizeof static \
    static_assert struct switch thread_local true typedef typeof typeof_unqual union unix \
    unsigned void volatile while";

/// Functions of `math.h`, including those of POSIX; each also with the suffixes `f` and `l`.
const MATH: &str = "\
    acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh drem erf erfc exp exp10 \
    exp2 expm1 fabs fdim finite floor fma fmax fmin fmod fpclassify frexp gamma hypot ilogb \
    isfinite isgreater isgreaterequal isinf isless islessequal islessgreater isnan isnormal \
    isunordered j0 j1 jn ldexp lgamma llrint llround log log10 log1p log2 logb lrint lround \
    modf nan nearbyint nextafter nexttoward pow pow10 remainder remquo rint round scalb \
    scalbln scalbn signbit signgam significand sin sincos sinh sqrt tan tanh tgamma trunc y0 \
    y1 yn";

/// Macros of `math.h`, and of headers that it may include.
const MACROS: &str = "\
    DOMAIN EDOM EOF ERANGE INFINITY MAXFLOAT NAN NULL OVERFLOW PLOSS SING TLOSS UNDERFLOW \
    X_TLOSS double_t float_t math_errhandling";

/// Prefixes of other macros of `math.h`.
const MACRO_FAMILIES: [&str; 7] = ["FLT_", "FP_", "HUGE", "MATH_", "M_", "DBL_", "SNAN"];

/// Names that the generated code uses itself.
const OWN: &str = "\
    error found_joints_error found_pose_error found_joints found_pose output system unit_pose";

impl Naming {
    /// The names of a robot called `name`.
    #[must_use]
    pub fn new(name: &str) -> Self {
        let snake = snake_case(name);
        let is_library = LIBRARY.iter().any(|begin| {
            let rest = snake.strip_prefix(begin);
            rest.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_lowercase()))
        });
        let prefix = if is_library || holds(NO_FILES, &snake) {
            format!("robot_{snake}")
        } else {
            snake
        };
        Self {
            prefix,
            float: Float::default(),
        }
    }

    /// The name of a function, a type or a table.
    #[must_use]
    pub fn name(&self, name: &str) -> String {
        format!("{}_{name}", self.prefix)
    }

    /// The name of a macro or an enumerator.
    #[must_use]
    pub fn constant(&self, name: &str) -> String {
        format!("{}_{name}", self.prefix).to_ascii_uppercase()
    }

    /// Replaces `rob_` and `ROB_` in a text by the robot's prefix, and `LIMIT_` with a name by that
    /// limit.
    ///
    /// The text must not contain names of a description, in which these letters may occur.
    #[must_use]
    pub fn apply(&self, text: &str) -> String {
        let upper = self.constant("");
        let mut text = text
            .replace("rob_", &format!("{}_", self.prefix))
            .replace("ROB_", &upper);
        let limits = self.float.limits();
        for (name, limit) in [
            ("LIMIT_CLOSED", limits.closed),
            ("LIMIT_FARTHEST", limits.farthest),
            ("LIMIT_JOINT_STEP", limits.joint_step),
            ("LIMIT_PARTITION", limits.partition),
            ("LIMIT_PIVOT", limits.pivot),
            ("LIMIT_QUATERNION", limits.quaternion),
            ("LIMIT_SINGULAR", limits.singular),
            ("LIMIT_STEP", limits.step),
            ("LIMIT_TENSION", limits.tension),
        ] {
            text = text.replace(name, &format!("{limit:e}"));
        }
        text
    }

    /// Whether a name is reserved and cannot be that of a value.
    #[must_use]
    pub fn is_reserved(&self, name: &str) -> bool {
        let stem = name.strip_suffix(['f', 'l']).unwrap_or(name);
        let is_math = holds(MATH, name) || holds(MATH, stem);
        let own = format!("{}_", self.prefix);
        is_math
            || holds(WORDS, name)
            || holds(MACROS, name)
            || holds(OWN, name)
            || name.starts_with('_')
            || MACRO_FAMILIES.iter().any(|begin| name.starts_with(begin))
            || name.to_ascii_lowercase().starts_with(&own)
    }
}

/// Whether a word is a keyword of C, or a compiler may define it.
#[must_use]
pub fn is_keyword(word: &str) -> bool {
    holds(WORDS, word)
}

/// Whether a word is in a list.
fn holds(list: &str, word: &str) -> bool {
    list.split_ascii_whitespace().any(|one| one == word)
}

/// Converts `FiveBar` to `five_bar` and `DualV` to `dualv`: a word starts with a capital before a
/// small letter.
fn snake_case(name: &str) -> String {
    let letters: Vec<char> = name.chars().collect();
    let mut out = String::new();
    for (at, c) in letters.iter().enumerate() {
        let before = at.checked_sub(1).map(|at| letters[at]);
        let after = letters.get(at + 1);
        let begins = c.is_ascii_uppercase()
            && before.is_some_and(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
            && after.is_some_and(char::is_ascii_lowercase);
        if begins {
            out.push('_');
        }
        out.push(c.to_ascii_lowercase());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::Naming;

    #[test]
    fn robot_names_become_snake_case_prefixes() {
        let prefix = |name: &str| Naming::new(name).prefix;
        assert_eq!(prefix("DualV"), "dualv");
        assert_eq!(prefix("FiveBar"), "five_bar");
        assert_eq!(prefix("Delta4"), "delta4");
        assert_eq!(prefix("Planar3Rrr"), "planar3_rrr");
        assert_eq!(prefix("RX90"), "rx90");
    }

    #[test]
    fn prefixes_avoid_c_library_names() {
        let prefix = |name: &str| Naming::new(name).prefix;
        assert_eq!(prefix("Math"), "robot_math");
        assert_eq!(prefix("Tool"), "robot_tool");
        assert_eq!(prefix("Stretcher"), "robot_stretcher");
        assert_eq!(prefix("T1"), "t1");
    }

    #[test]
    fn c_names_are_reserved() {
        let naming = Naming::new("DualV");
        for name in [
            "cos",
            "sinf",
            "case",
            "y1",
            "M_PI",
            "NAN",
            "dualv_joints",
            "output",
            "_a",
        ] {
            assert!(naming.is_reserved(name), "{name}");
        }
        for name in ["c1_leg1", "M", "half", "sine", "L_AB", "h"] {
            assert!(!naming.is_reserved(name), "{name}");
        }
    }
}
