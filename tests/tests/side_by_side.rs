//! Legs that run side by side give what straight code gives: the same numbers but for rounding, and of several legs
//! that fail the same one is told.
//!
//! Vectors are taken in optimised builds only, so a program of its own is built with optimisation, for the
//! processor's smallest vectors and for those of AVX and of AVX-512. Only the full tier does this: it takes a minute.

use overact_codegen::{Effort, Request, compile_with, emission};
use overact_tests::support::{Failure, description, repository};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Robots of equal legs whose straight code is longer than an instruction cache.
const ROBOTS: [&str; 2] = ["hexapod", "octopod"];

const FUNCTIONS: &str = "idm_red_platform,idm_red_platform_base,idm_red_platform_from_joints,idm_red_platform_base_from_joints";

#[test]
fn side_by_side_or_in_a_row_it_is_the_same() -> Result<(), Failure> {
    if !overact_tier::is_full() {
        return Ok(());
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("side_by_side");
    fs::create_dir_all(folder.join("src"))?;
    let runtime = repository("runtime");
    let manifest = format!(
        "[package]\nname = \"side_by_side\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[dependencies]\n\
         overact = {{ path = '{}', default-features = false, features = [\"std\"] }}\n\n[workspace]\n",
        runtime.display()
    );
    fs::write(folder.join("Cargo.toml"), manifest)?;
    fs::write(folder.join("src/main.rs"), PROGRAM)?;
    for stem in ROBOTS {
        for (side_by_side, name) in [(true, "lanes"), (false, "straight")] {
            let text = module(stem, side_by_side)?;
            assert_eq!(text.contains("lanes::places"), side_by_side, "{stem}");
            fs::write(folder.join(format!("src/{stem}_{name}.rs")), text)?;
        }
    }
    run(&folder, "")?;
    if cfg!(target_arch = "x86_64") && std::arch::is_x86_feature_detected!("avx2") {
        run(&folder, "-Ctarget-feature=+avx2")?;
    }
    // All of AVX-512 that such processors have in common: `wide` does not compile with a part of it.
    if has_v4() {
        run(&folder, "-Ctarget-cpu=x86-64-v4")?;
    }
    Ok(())
}

#[cfg(target_arch = "x86_64")]
fn has_v4() -> bool {
    use std::arch::is_x86_feature_detected as has;
    has!("avx512f") && has!("avx512bw") && has!("avx512cd") && has!("avx512dq") && has!("avx512vl")
}

#[cfg(not(target_arch = "x86_64"))]
const fn has_v4() -> bool {
    false
}

fn module(stem: &str, side_by_side: bool) -> Result<String, Failure> {
    let source = description(stem)?;
    let choice = overact_codegen::Choice::new(FUNCTIONS.split(','));
    let choice = choice.map_err(|_| "a name is none of the functions'")?;
    let request = Request {
        functions: Some(&choice),
        side_by_side,
        ..Request::with_effort(Effort::None)
    };
    let compiled = compile_with(&source, &request).map_err(|e| e.render_plain(&source))?;
    Ok(emission::file(&compiled.model, &source.name))
}

fn run(folder: &Path, flags: &str) -> Result<(), Failure> {
    let run = Command::new(env!("CARGO"))
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .env("RUSTFLAGS", flags)
        .args(["run", "--release", "--offline", "--quiet"])
        .output()?;
    let said = String::from_utf8_lossy(&run.stdout).into_owned();
    let failed = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(run.status.success(), "{flags}: {said}\n{failed}");
    assert!(said.contains("agree"), "{said}");
    Ok(())
}

/// Compares both modules of each robot at random states, a part of which is out of reach.
const PROGRAM: &str = r#"
mod hexapod_lanes;
mod hexapod_straight;
mod octopod_lanes;
mod octopod_straight;

struct Stream(u64);

impl Stream {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
    fn numbers<const N: usize>(&mut self, around: [f64; N], spread: f64) -> [f64; N] {
        around.map(|x| x + spread * self.number())
    }
}

macro_rules! compare {
    ($lanes:ident, $straight:ident, $robot:ident) => {{
        use $lanes::$robot as A;
        use $straight::$robot as B;
        let (mut stream, mut failed) = (Stream(7), 0);
        let mut same = |a: Result<Vec<f64>, overact::Error>, b: Result<Vec<f64>, overact::Error>| match (a, b) {
            (Ok(a), Ok(b)) => {
                let largest = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                let gap = a.iter().zip(&b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs()));
                assert!(a.len() == b.len() && gap <= 1e-11 * largest, "{gap} of {largest}");
            }
            (Err(a), Err(b)) => {
                failed += 1;
                assert_eq!(a.to_string(), b.to_string());
            }
            (a, b) => panic!("{a:?} {b:?}"),
        };
        for turn in 0..2000 {
            let spread = if turn % 10 == 0 { 1.0 } else { 0.1 };
            let pose = stream.numbers(A::HOME_POSE, spread);
            let mut joints = stream.numbers(A::HOME_JOINTS, 0.1);
            if turn % 10 == 0 {
                // A leg of no length, whichever it is.
                let leg = turn / 10 % (joints.len() / 3);
                joints[3 * leg + 2] = 0.0;
            }
            let (twist, acceleration) = (stream.numbers([0.0; 6], 1.0), stream.numbers([0.0; 6], 10.0));
            same(
                A::idm_red_platform(&pose, &twist, &acceleration).map(|m| m.concat()),
                B::idm_red_platform(&pose, &twist, &acceleration).map(|m| m.concat()),
            );
            same(
                A::idm_red_platform_base(&pose, &twist, &acceleration).map(|m| m.concat()),
                B::idm_red_platform_base(&pose, &twist, &acceleration).map(|m| m.concat()),
            );
            same(
                A::idm_red_platform_from_joints(&pose, &joints, &twist, &acceleration).map(|m| m.concat()),
                B::idm_red_platform_from_joints(&pose, &joints, &twist, &acceleration).map(|m| m.concat()),
            );
            same(
                A::idm_red_platform_base_from_joints(&pose, &joints, &twist, &acceleration).map(|m| m.concat()),
                B::idm_red_platform_base_from_joints(&pose, &joints, &twist, &acceleration).map(|m| m.concat()),
            );
        }
        assert!(failed >= 200, "{failed} states fail");
    }};
}

fn main() {
    compare!(hexapod_lanes, hexapod_straight, Hexapod);
    compare!(octopod_lanes, octopod_straight, Octopod);
    println!("agree in {} lanes", <overact::lanes::Many as overact::lanes::Vector>::WIDTH);
}
"#;
