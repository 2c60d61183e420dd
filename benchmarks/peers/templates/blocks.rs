//! Times a generated function and block evaluation of its program, alternately.
//!
//! Prints the shortest times per sample in nanoseconds: function, contiguous blocks, rows.
use overact::{Columns, Function};
use overact_codegen::derivation::{MotionInput};
use overact_codegen::interpreter::{Evaluator, Number, Rows};
use overact_codegen::{Source, compile};
use overact_timed::{Output, @MODULE@};
use std::{env, error::Error, fs, hint::black_box, time::Instant};

/// One state: the function's inputs.
type State = (@TYPES@);

/// Samples per block, as in an identification.
const SAMPLES: usize = 512;

const LENGTHS: &[usize] = &[@LENGTHS@];

fn state(values: &[f64]) -> Result<State, Box<dyn Error>> {
    Ok((@READ@))
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().collect();
    let bytes = fs::read(&arguments[1])?;
    let values: Vec<f64> = bytes.as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
    let rows = || values.chunks(@TOTAL@).cycle().take(SAMPLES);
    let states = rows().map(state).collect::<Result<Vec<State>, _>>()?;
    let text = fs::read_to_string("@DESCRIPTION@")?;
    let model = compile(&Source::new("description", &text)).map_err(|error| format!("{error:?}"))?.model;
    let function = Function::IdmRedPlatform(Columns::@COLUMNS@);
    let program = &model.function(function, MotionInput::Joints).ok_or("no such function")?.program;
    let mut start = 0;
    let inputs: Vec<Vec<f64>> = LENGTHS
        .iter()
        .map(|length| {
            start += length;
            rows().flat_map(|row| row[start - length..start].to_vec()).collect()
        })
        .collect();
    let inputs: Vec<Rows<'_>> = inputs.iter().map(|values| Rows { values, shared: false }).collect();
    let mut output = vec![0.0; SAMPLES * program.entries.len()];
    let mut evaluator = Evaluator::new(program);
    let mut written = @WRITTEN@;
    // Blocks first: all must agree with the function.
    evaluator
        .evaluate(SAMPLES, &inputs, &mut output)
        .map_err(|failed| format!("{failed:?}"))?;
    for (s, row) in states.iter().zip(output.chunks(program.entries.len())) {
        let mut expected = @CALL@(@ARGUMENTS@).numbers()?;
        expected.extend(written.numbers()?);
        let scale = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        if expected.iter().zip(row).any(|(a, b)| (a - b).abs() > 1e-9 * scale) {
            return Err("blocks differ from the function".into());
        }
    }
    let mut best = [f64::INFINITY; 3];
    for _ in 0..arguments[2].parse()? {
        for (what, best) in best.iter_mut().enumerate() {
            let start = Instant::now();
            match what {
                0 => states.iter().for_each(|s| {
                    black_box(&@CALL@(@ARGUMENTS@));
                    black_box(&mut written);
                }),
                1 => {
                    let take = |number: Number<'_>| {
                        black_box(&number);
                    };
                    let _ = black_box(evaluator.evaluate_numbers(SAMPLES, &inputs, take));
                }
                _ => {
                    let _ = black_box(evaluator.evaluate(SAMPLES, &inputs, &mut output));
                }
            }
            *best = best.min(start.elapsed().as_secs_f64() * 1e9 / SAMPLES as f64);
        }
    }
    println!("{:.3} {:.3} {:.3}", best[0], best[1], best[2]);
    Ok(())
}
