//! Sets `cfg(vectors)`, for sines and cosines in vector registers, and `cfg(dispatch)`, for
//! detection of the vector width at run time.
//!
//! No attribute of the language gives the optimisation level, and the best choice differs by a
//! factor of fifty. This crate's functions of many angles are compiled with the crate that calls
//! them. So a build counts as optimised for speed only if its profile is, not only this package.

use std::env::var;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(vectors, dispatch)");
    let is = |name: &str, values: &[&str]| var(name).is_ok_and(|x| values.contains(&x.as_str()));
    let feature =
        |name: &str| var("CARGO_CFG_TARGET_FEATURE").is_ok_and(|x| x.split(',').any(|f| f == name));
    let registers = is("CARGO_CFG_TARGET_ARCH", &["x86_64", "aarch64"])
        || feature("sse2")
        || feature("simd128");
    if registers && is("OPT_LEVEL", &["2", "3"]) && is("PROFILE", &["release"]) {
        println!("cargo::rustc-cfg=vectors");
        let is_wanted = var("CARGO_FEATURE_DISPATCH").is_ok();
        if is_wanted && is("CARGO_CFG_TARGET_ARCH", &["x86_64"]) && !feature("avx2") {
            println!("cargo::rustc-cfg=dispatch");
        }
    }
}
