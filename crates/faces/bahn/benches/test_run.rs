//! How fast a test run without graphics is: reading, interpreting and look-ahead planning together.
#![allow(clippy::panic, reason = "a wrong program would measure nothing")]

use std::fmt::Write;
use std::sync::Arc;

use bahn_interpreter::{Interpreter, NoPrograms, Settings};
use bahn_motion::{AuxiliaryTimes, Limits, PlannedStep, Planner};
use bahn_path::{LiveData, PerAxis};
use bahn_program::Program;
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

const BLOCKS: u64 = 1_000_000;

/// Blocks along a wave, `step` mm apart, as a CAM system writes them.
fn wave(compensation: &str, step: f64) -> Vec<u8> {
    let mut text = String::from("BEGIN PGM WAVE MM\nTOOL DEF 1 L+0 R+0.5\nTOOL CALL 1 Z S1000\n");
    let _ = writeln!(text, "L X-10 Y+0 Z+0 R0 FMAX\nL X+0 Y+0 {compensation} F2000");
    for i in 0..BLOCKS {
        let x = i as f64 * step;
        let y = 5.0 * (x * 0.05).sin();
        let z = 2.0 * (x * 0.02).cos();
        let _ = match compensation {
            "R0" => writeln!(text, "L X{x:+.3} Y{y:+.3} Z{z:+.3}"),
            _ => writeln!(text, "L X{x:+.3} Y{y:+.3}"),
        };
    }
    text.push_str("END PGM WAVE MM\n");
    text.into_bytes()
}

/// Runs a program from its bytes to its machining time, s.
fn run(bytes: &[u8]) -> f64 {
    let program = Arc::new(Program::from_bytes("BENCH.H", bytes.to_vec()));
    let limits = Limits {
        max_feed_mm_min: PerAxis::splat(15_000.0),
        acceleration_m_s2: PerAxis::splat(1.0),
        radial_acceleration_m_s2: 0.5,
        corner_angle_deg: 10.0,
        servo_lag: false,
        cycle_s: 0.003,
        servo_window_s: bahn_motion::SERVO_WINDOW_S,
        spindle: Default::default(),
        feed_override_percent: 100.0,
        rapid_override_percent: 100.0,
    };
    let source = Interpreter::new(program, Settings::default(), Arc::new(NoPrograms));
    let mut planner = Planner::new(source, &limits, &AuxiliaryTimes::default());
    let mut time_s = 0.0;
    loop {
        match planner.next() {
            PlannedStep::Element(planned) => time_s += black_box(&planned).duration_s(),
            PlannedStep::Barrier(_) => planner.resume(LiveData::default()),
            PlannedStep::Error(error) => panic!("the benchmark's program is wrong: {error:?}"),
            PlannedStep::End | PlannedStep::Starved => return time_s,
        }
    }
}

/// Target: 2,000,000 blocks/s.
#[divan::bench(sample_count = 7, sample_size = 1)]
fn short_lines(bencher: Bencher) {
    let bytes = wave("R0", 0.02);
    bencher.counter(ItemsCount::new(BLOCKS)).bench(|| run(&bytes));
}

/// Target: 1,000,000 blocks/s.
#[divan::bench(sample_count = 7, sample_size = 1)]
fn compensated_lines(bencher: Bencher) {
    let bytes = wave("RL", 0.1);
    bencher.counter(ItemsCount::new(BLOCKS)).bench(|| run(&bytes));
}

/// Target: 10,000,000 blocks/s.
#[divan::bench(sample_count = 7, sample_size = 1)]
fn calculation_loop(bencher: Bencher) {
    const ROUNDS: u64 = 1_000_000;
    let text = format!(
        "BEGIN PGM LOOP MM\nFN0: Q1 = +0\nLBL 1\nFN1: Q1 = +Q1 + +1\nFN3: Q2 = +Q1 * +2\n\
         FN12: IF +Q1 LT +{ROUNDS} GOTO LBL 1\nEND PGM LOOP MM\n"
    );
    bencher
        .counter(ItemsCount::new(4 * ROUNDS))
        .bench(|| run(text.as_bytes()));
}
