//! Damaged inputs for every reader: `cargo run --release -- TARGET COUNT [SEED]`.
//!
//! A mutator with a seed makes inputs from a corpus: the shipped files, those under `corpus/`, and packets of a
//! simulated floor. A reader may refuse any input; it may not panic, and it may not take longer than [`SLOW`]. An
//! input that causes either is saved under `found/`, and the exit status is 1.

mod corpus;
mod mutate;
mod targets;

use std::panic::{self, AssertUnwindSafe};
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use targets::Target;

/// Greatest time for one input: unnoticeable for a user with a file of this size.
const SLOW: Duration = Duration::from_millis(500);

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let numbers = || arguments.iter().skip(1).map(|number| number.parse::<u64>());
    let parsed: Result<Vec<u64>, _> = numbers().collect();
    let (Some(name), Ok(numbers)) = (arguments.first(), parsed) else {
        eprintln!("usage: underfoot-fuzz TARGET COUNT [SEED], TARGET one of: {}", targets::NAMES.join(", "));
        return ExitCode::from(2);
    };
    let count = numbers.first().copied().unwrap_or(10_000);
    let seed = numbers.get(1).copied().unwrap_or(1);
    let Some(mut target) = Target::named(name) else {
        eprintln!("there is no target {name}: {}", targets::NAMES.join(", "));
        return ExitCode::from(2);
    };
    run(&mut target, count, seed)
}

fn run(target: &mut Target, count: u64, seed: u64) -> ExitCode {
    let corpus = corpus::of(target.name());
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let (begun, mut accepted, mut bytes, mut slowest) = (Instant::now(), 0_u64, 0_u64, Duration::ZERO);
    let mut input = Vec::new();
    for number in 0..count {
        mutate::make(&corpus, target.most_bytes(), &mut rng, &mut input);
        bytes += input.len() as u64;
        let mut took = Duration::MAX;
        let mut read = Ok(false);
        // A busy machine is slow once, a slow reader every time.
        for _ in 0..4 {
            let started = Instant::now();
            read = panic::catch_unwind(AssertUnwindSafe(|| target.read(&input)));
            took = took.min(started.elapsed());
            if took < SLOW || read.is_err() {
                break;
            }
        }
        slowest = slowest.max(took);
        match read {
            Ok(was_good) if took < SLOW => accepted += u64::from(was_good),
            Ok(_) => return keep(target.name(), seed, number, &input, &format!("took {took:?}")),
            Err(_) => return keep(target.name(), seed, number, &input, "panicked"),
        }
    }
    let seconds = begun.elapsed().as_secs_f64();
    println!(
        "{}: {count} inputs of {} bytes on average from {} of the corpus, seed {seed}: {accepted} accepted, the others \
         refused; {seconds:.0} s, the slowest {slowest:?}",
        target.name(),
        bytes / count.max(1),
        corpus.len(),
    );
    ExitCode::SUCCESS
}

fn keep(name: &str, seed: u64, number: u64, input: &[u8], what: &str) -> ExitCode {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("found");
    let path = folder.join(format!("{name}-{seed}-{number}"));
    let kept = std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(&path, input));
    eprintln!("{name}: input {number} of seed {seed} {what}; {} ({kept:?})", path.display());
    ExitCode::FAILURE
}
