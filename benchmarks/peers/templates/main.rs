//! Calls a model for successive states; prints the shortest and the median time per call in nanoseconds.
use overact_timed::{Output, @MODULE@};
use std::{env, error::Error, fs, hint::black_box, time::Instant};

/// One state: the function's inputs.
type State = (@TYPES@);

fn state(values: &[f64]) -> Result<State, Box<dyn Error>> {
    Ok((@READ@))
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().collect();
    let bytes = fs::read(&arguments[1])?;
    let values: Vec<f64> = bytes.as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
    let states = values.chunks(@TOTAL@).map(state).collect::<Result<Vec<State>, _>>()?;
    let mut written = @WRITTEN@;
    let mut times = Vec::new();
    for _ in 0..arguments[2].parse()? {
        let start = Instant::now();
        for s in &states {
            // In place: a copy would be timed, too, and the peers' results are not copied.
            black_box(&@CALL@(@ARGUMENTS@));
            black_box(&mut written);
        }
        times.push(start.elapsed().as_secs_f64() * 1e9 / states.len() as f64);
    }
    if let Some(path) = arguments.get(3) {
        let mut bytes = Vec::new();
        for s in &states {
            let mut output = @CALL@(@ARGUMENTS@).numbers()?;
            output.extend(written.numbers()?);
            bytes.extend(output.iter().flat_map(|x| x.to_le_bytes()));
        }
        fs::write(path, bytes)?;
    }
    times.sort_by(f64::total_cmp);
    println!("{:.3} {:.3}", times[0], times[times.len() / 2]);
    Ok(())
}
