//! How fast blocks run: interpretation with reading, without planning.

use std::fmt::Write;
use std::sync::Arc;

use bahn_interpreter::{Interpreter, NoPrograms, Settings};
use bahn_path::{ElementSource, LiveData, Step};
use bahn_program::Program;
use divan::Bencher;
use divan::counter::ItemsCount;

fn main() {
    divan::main();
}

const BLOCKS: u64 = 1_000_000;

/// Short straight lines along a wave, as a CAM system writes them.
fn lines(compensation: &str) -> Arc<Program> {
    let mut text = String::from("BEGIN PGM LINES MM\nTOOL DEF 1 L+0 R+0.5\nTOOL CALL 1 Z S1000\n");
    text.push_str("L X-10 Y+0 Z+0 R0 FMAX\n");
    let _ = writeln!(text, "L X+0 Y+0 {compensation} F2000");
    for i in 0..BLOCKS {
        let x = i as f64 * 0.1;
        let y = 5.0 * (x * 0.05).sin();
        let z = 2.0 * (x * 0.02).cos();
        let _ = if compensation == "R0" {
            writeln!(text, "L X{x:+.3} Y{y:+.3} Z{z:+.3}")
        } else {
            writeln!(text, "L X{x:+.3} Y{y:+.3}")
        };
    }
    text.push_str("END PGM LINES MM\n");
    Arc::new(Program::from_bytes("LINES.H", text.into_bytes()))
}

fn run(program: &Arc<Program>) -> u64 {
    let settings = Settings {
        max_blocks_without_motion: u64::MAX,
        ..Settings::default()
    };
    let mut run = Interpreter::new(program.clone(), settings, Arc::new(NoPrograms));
    loop {
        match run.next() {
            Step::Element(element) => {
                divan::black_box(&element);
            }
            Step::Barrier(_) => run.resume(LiveData::default()),
            Step::Error(error) => {
                eprintln!("{error:?}");
                break;
            }
            _ => break,
        }
    }
    run.blocks_executed()
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn uncompensated_lines(bencher: Bencher) {
    let program = lines("R0");
    bencher.counter(ItemsCount::new(BLOCKS)).bench(|| run(&program));
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn compensated_lines(bencher: Bencher) {
    let program = lines("RL");
    bencher.counter(ItemsCount::new(BLOCKS)).bench(|| run(&program));
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn calculation_loop(bencher: Bencher) {
    let text = "BEGIN PGM LOOP MM\nFN0: Q1 = +0\nLBL 1\nFN1: Q1 = +Q1 + +1\nFN3: Q2 = +Q1 * +2\n\
                FN12: IF +Q1 LT +1000000 GOTO LBL 1\nEND PGM LOOP MM\n";
    let program = Arc::new(Program::from_bytes("LOOP.H", text.into()));
    bencher
        .counter(ItemsCount::new(4 * BLOCKS))
        .bench(|| run(&program));
}
