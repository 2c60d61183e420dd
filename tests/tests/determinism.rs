//! The same description gives the same bytes, whatever was compiled before.

use overact_codegen::backends::rust;
use overact_tests::support::{Failure, description, model_of, repository};
use overact_tier::by_tier;
use std::fs;
use std::time::Instant;

#[test]
fn code_generation_is_deterministic() -> Result<(), Failure> {
    // The freshness of the checked-in modules shows the same for every robot.
    for stem in ["emps", by_tier(["five_bar", "planar_3prr"])] {
        let source = description(stem)?;
        let mut files = Vec::new();
        for _ in 0..2 {
            let start = Instant::now();
            let model = model_of(&source)?;
            let compiled = start.elapsed();
            files.push(rust::file(&model, &source.name));
            println!(
                "{}: compiled in {compiled:.0?}, with emission {:.0?}",
                source.name,
                start.elapsed()
            );
        }
        assert!(files[0] == files[1], "{} is not deterministic", source.name);
    }
    Ok(())
}

#[test]
fn parallel_threads_generate_the_same_bytes() -> Result<(), Failure> {
    let source = description(by_tier(["five_bar", "dualv"]))?;
    let one = || model_of(&source).map(|model| rust::file(&model, &source.name));
    let (a, b) = std::thread::scope(|scope| {
        let (a, b) = (scope.spawn(one), scope.spawn(one));
        (a.join(), b.join())
    });
    let failed = |_| Failure::from("a thread panicked");
    assert!(a.map_err(failed)?? == b.map_err(failed)??);
    Ok(())
}

#[test]
fn generated_text_contains_no_local_path() -> Result<(), Failure> {
    let here = repository("").canonicalize()?;
    let here = here.to_string_lossy();
    let source = description(by_tier(["emps", "five_bar"]))?;
    let file = rust::file(&model_of(&source)?, &source.name);
    assert!(!file.contains(&*here));
    for entry in fs::read_dir(repository("generated/src"))? {
        let path = entry?.path();
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let text = fs::read_to_string(path)?;
        assert!(!text.contains(&*here), "generated/src/{name} holds {here}");
    }
    Ok(())
}
