//! Legs in SIMD lanes give the results of straight code up to rounding, and report the same failing
//! leg.
//!
//! Vectors are used in optimised builds only, so an optimised program is built separately. The full
//! tier does this for the smallest vectors and for run-time detection, which takes a minute; the
//! nightly tier for AVX2 and AVX-512 as well.

use overact_codegen::{Effort, Request, backends::rust, compile_with};
use overact_tests::support::{Failure, description, repository};
use overact_tier::{is_full, is_night};
use std::fs;
use std::path::Path;
use std::process::Command;

/// A robot with equal legs.
struct Robot {
    stem: &'static str,
    /// Name of its type.
    name: &'static str,
    /// Whether many of the drawn states are out of reach.
    has_limited_reach: bool,
}

const fn robot(stem: &'static str, name: &'static str, has_limited_reach: bool) -> Robot {
    Robot {
        stem,
        name,
        has_limited_reach,
    }
}

/// Robots of the full tier: base columns that the last leg lacks, and (DualV) two working modes.
const FEW: [Robot; 3] = [
    robot("delta", "Delta", true),
    robot("dualv", "DualV", true),
    robot("spherical_4rrr", "Spherical4Rrr", false),
];

/// Further robots of the nightly tier. Straight code of the first two exceeds an instruction cache.
const MORE: [Robot; 4] = [
    robot("hexapod", "Hexapod", true),
    robot("octopod", "Octopod", true),
    robot("delta_4", "Delta4", true),
    robot("planar_4prr", "Planar4Prr", true),
];

const FUNCTIONS: [&str; 13] = [
    "idm_red_platform",
    "idm_red_platform_base",
    "idm_red_platform_from_joints",
    "idm_red_platform_base_from_joints",
    "inverse_dynamics",
    "inverse_dynamics_base",
    "mass_matrix",
    "mass_matrix_base",
    "bias",
    "bias_base",
    "forward_dynamics",
    "forward_dynamics_base",
    "pose_step",
];

#[test]
fn parallel_and_sequential_evaluation_give_equal_results() -> Result<(), Failure> {
    if !is_full() {
        return Ok(());
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("side_by_side");
    fs::create_dir_all(folder.join("src"))?;
    let runtime = repository("runtime");
    let manifest = format!(
        "[package]\nname = \"side_by_side\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[dependencies]\n\
         overact = {{ path = '{}', default-features = false, features = [\"std\"] }}\n\n\
         [features]\ndispatch = [\"overact/dispatch\"]\n\n[workspace]\n",
        runtime.display()
    );
    fs::write(folder.join("Cargo.toml"), manifest)?;
    let more = is_night().then_some(MORE).into_iter().flatten();
    let robots: Vec<Robot> = FEW.into_iter().chain(more).collect();
    fs::write(folder.join("src/main.rs"), program(&robots))?;
    for Robot { stem, .. } in &robots {
        for (side_by_side, name) in [(true, "lanes"), (false, "straight")] {
            let text = module(stem, side_by_side)?;
            assert_eq!(text.contains("simd::places"), side_by_side, "{stem}");
            fs::write(folder.join(format!("src/{stem}_{name}.rs")), text)?;
        }
    }
    run(&folder, "", &[])?;
    run(&folder, "", &["--features", "dispatch"])?;
    if !is_night() {
        return Ok(());
    }
    if cfg!(target_arch = "x86_64") && std::arch::is_x86_feature_detected!("avx2") {
        run(&folder, "-Ctarget-feature=+avx2", &[])?;
    }
    // Those AVX-512 extensions that such processors have in common; `wide` does not compile with a
    // subset.
    if has_v4() {
        run(&folder, "-Ctarget-cpu=x86-64-v4", &[])?;
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
    let choice = overact_codegen::Choice::new(FUNCTIONS);
    let choice = choice.map_err(|_| "a name is none of the functions'")?;
    let request = Request {
        functions: Some(&choice),
        side_by_side,
        ..Request::with_effort(Effort::None)
    };
    let compiled = compile_with(&source, &request).map_err(|e| e.render_plain(&source))?;
    Ok(rust::file(&compiled.model, &source.name))
}

fn run(folder: &Path, flags: &str, features: &[&str]) -> Result<(), Failure> {
    let run = Command::new(env!("CARGO"))
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .env("RUSTFLAGS", flags)
        .args(["run", "--release", "--offline", "--quiet"])
        .args(features)
        .output()?;
    let printed = String::from_utf8_lossy(&run.stdout).into_owned();
    let failed = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(
        run.status.success(),
        "{flags} {features:?}: {printed}\n{failed}"
    );
    assert!(printed.contains("agree"), "{printed}");
    Ok(())
}

/// The program that compares both modules of each robot.
fn program(robots: &[Robot]) -> String {
    let module = |Robot { stem, .. }: &Robot| format!("mod {stem}_lanes;\nmod {stem}_straight;\n");
    let comparison = |robot: &Robot| {
        let Robot {
            stem,
            name,
            has_limited_reach,
        } = robot;
        let least = if *has_limited_reach { 200 } else { 0 };
        format!(
            "    let failed = compare!({stem}_lanes, {stem}_straight, {name});\n    \
             assert!(failed >= {least}, \"{{failed}} states of {name} failed\");\n"
        )
    };
    let modules: String = robots.iter().map(module).collect();
    let comparisons: String = robots.iter().map(comparison).collect();
    format!(
        "{modules}{COMPARISON}\nfn main() {{\n{comparisons}    println!(\"agree in {{}} lanes\", \
         <overact::simd::Wide as overact::simd::Vector>::WIDTH);\n}}\n"
    )
}

/// Compares both modules of each robot at random states, some of which are unreachable.
const COMPARISON: &str = r#"
use overact::StandardParameter as Symbol;

struct Stream(u64);

impl Stream {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
    fn numbers<const N: usize>(&mut self, around: [f64; N], spread: f64) -> [f64; N] {
        around.map(|x| x + spread * self.number())
    }
    /// Of bodies that have a mass.
    fn parameter(&mut self, symbol: Symbol) -> f64 {
        let around = match symbol {
            Symbol::M | Symbol::Ia => 1.0,
            Symbol::Xx | Symbol::Yy | Symbol::Zz => 0.3,
            _ => 0.02,
        };
        around * (1.0 + 0.2 * self.number())
    }
}

type Outcome<const N: usize> = Result<[f64; N], overact::Error>;

/// How many outputs do not fail, how many do, and how far apart they may be: far from home some poses are near to
/// singular ones.
#[derive(Default)]
struct Seen([usize; 2], f64);

impl Seen {
    fn same<const N: usize>(&mut self, a: Outcome<N>, b: Outcome<N>) {
        self.rows(a.map(|a| [a]), b.map(|b| [b]));
    }
    fn rows<const N: usize, const R: usize>(
        &mut self,
        a: Result<[[f64; N]; R], overact::Error>,
        b: Result<[[f64; N]; R], overact::Error>,
    ) {
        match (a, b) {
            (Ok(a), Ok(b)) => {
                let (a, b) = (a.as_flattened(), b.as_flattened());
                let largest = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                let gap = a.iter().zip(b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs()));
                assert!(gap <= self.1 * largest, "{gap} of {largest}");
                self.0[0] += 1;
            }
            (Err(a), Err(b)) => {
                self.0[1] += 1;
                assert_eq!(a.to_string(), b.to_string());
            }
            (a, b) => panic!("{:?} {:?}", a.err(), b.err()),
        }
    }
}

macro_rules! compare {
    ($lanes:ident, $straight:ident, $robot:ident) => {{
        use $lanes::$robot as A;
        use $straight::$robot as B;
        let (mut stream, mut seen) = (Stream(7), Seen::default());
        let symbols = A::PARAMETERS.iter().chain(&A::PAYLOAD_PARAMETERS).map(|p| p.symbol);
        let parameters: Vec<f64> = symbols.map(|symbol| stream.parameter(symbol)).collect();
        let parameters = parameters.try_into().expect("as many");
        let of = |name| A::PARAMETERS.iter().find(|p| p.name == name).expect("one").symbol;
        let symbols = A::BASE_PARAMETERS.iter().map(|p| of(p.parameter));
        let symbols = symbols.chain(A::PAYLOAD_PARAMETERS.iter().map(|p| p.symbol));
        let base: Vec<f64> = symbols.map(|symbol| stream.parameter(symbol)).collect();
        let base = base.try_into().expect("as many");
        for turn in 0..2000 {
            let is_far = turn % 10 == 0;
            // The very home once, where what legs divide by may vanish.
            let spread = if turn == 1 { 0.0 } else if is_far { 1.0 } else { 0.05 };
            seen.1 = if is_far { 1e-6 } else { 1e-11 };
            let pose = stream.numbers(A::HOME_POSE, spread);
            let mut joints = stream.numbers(A::HOME_JOINTS, if turn == 1 { 0.0 } else { 0.1 });
            if is_far && A::DOF == 6 {
                // A leg of no length, whichever it is.
                let leg = turn / 10 % (joints.len() / 3);
                joints[3 * leg + 2] = 0.0;
            }
            let twist = stream.numbers([0.0; { A::DOF }], 1.0);
            let acceleration = stream.numbers([0.0; { A::DOF }], 10.0);
            let torques = stream.numbers([0.0; { A::ACTUATORS }], 10.0);
            let (p, q, t, a) = (&pose, &joints, &twist, &acceleration);
            if turn == 1 {
                assert!(A::idm_red_platform(p, t, a).is_ok() && A::bias(p, t, &parameters).is_ok(), "home");
            }
            seen.rows(A::idm_red_platform(p, t, a), B::idm_red_platform(p, t, a));
            seen.rows(A::idm_red_platform_base(p, t, a), B::idm_red_platform_base(p, t, a));
            seen.rows(
                A::idm_red_platform_from_joints(p, q, t, a),
                B::idm_red_platform_from_joints(p, q, t, a),
            );
            seen.rows(
                A::idm_red_platform_base_from_joints(p, q, t, a),
                B::idm_red_platform_base_from_joints(p, q, t, a),
            );
            seen.same(A::inverse_dynamics(p, t, a, &parameters), B::inverse_dynamics(p, t, a, &parameters));
            seen.same(A::inverse_dynamics_base(p, t, a, &base), B::inverse_dynamics_base(p, t, a, &base));
            seen.rows(A::mass_matrix(p, &parameters), B::mass_matrix(p, &parameters));
            seen.rows(A::mass_matrix_base(p, &base), B::mass_matrix_base(p, &base));
            seen.same(A::bias(p, t, &parameters), B::bias(p, t, &parameters));
            seen.same(A::bias_base(p, t, &base), B::bias_base(p, t, &base));
            seen.same(
                A::forward_dynamics(p, t, &torques, &parameters),
                B::forward_dynamics(p, t, &torques, &parameters),
            );
            seen.same(
                A::forward_dynamics_base(p, t, &torques, &base),
                B::forward_dynamics_base(p, t, &torques, &base),
            );
            seen.same(A::pose_step(p, &torques), B::pose_step(p, &torques));
        }
        let [agree, fail] = seen.0;
        println!("{} {agree} agree, {fail} fail", A::NAME);
        assert!(agree >= 10_000, "{agree} agree");
        fail
    }};
}
"#;
