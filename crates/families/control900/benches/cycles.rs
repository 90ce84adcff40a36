//! How long an interpolation cycle of 4 ms takes: eight channels, each with four axes on a path.

#![allow(clippy::unwrap_used, reason = "a helper that panics fails its bench")]

#[path = "../tests/support/mod.rs"]
mod support;

use bahn_control900::StandardAnswers;
use bahn_path::Axis;
use support::list::Line;
use support::{Rig, axis};

/// Cycles of a second.
const CYCLES: usize = 250;

fn main() {
    divan::main();
}

/// Channels whose four axes go to and fro in short blocks.
fn cutting(channels: u32) -> Rig {
    let mut text = format!("q2: {channels}\nq3: 50000\n");
    for channel in 1..=channels {
        let first = 10_000 + 4000 * (channel - 1);
        text += &format!("q{}: {first}\nq{}: 100\n", 100 * channel + 2, 100 * channel + 3);
    }
    text += "q10: 99\n";
    for channel in 1..=channels {
        for (at, letter) in (0..).zip(["58", "59", "5A", "43"]) {
            let physical = 4 * (channel - 1) + at + 1;
            text += &format!("q{}: $00{physical:02X}00{letter}\n", 100 * channel + 10 + at);
        }
    }
    text += &(1..=4 * channels).map(axis).collect::<String>();
    let mut rig = Rig::of(&text, StandardAnswers::ALL);
    let place = |at: u32, axis: Axis, way: f64| (axis, f64::from(at % 7) * way);
    let lines: Vec<Line> = (0..20_000)
        .map(|at| {
            let to = [(Axis::X, 2.0), (Axis::Y, 1.0), (Axis::Z, 0.5), (Axis::C, 0.7)];
            let to: Vec<_> = to.map(|(axis, way)| place(at, axis, way)).to_vec();
            Line::to(&to, 3000.0)
        })
        .collect();
    for channel in 1..=channels {
        rig.start(channel as u8, &lines);
    }
    rig.seconds(1.0);
    rig
}

/// A second of the machine.
#[divan::bench(args = [1, 4, 8], sample_count = 10, sample_size = 1)]
fn second(bencher: divan::Bencher, channels: u32) {
    let mut rig = cutting(channels);
    bencher.bench_local(|| {
        for _ in 0..CYCLES {
            rig.cycle();
        }
    });
    let runs = (1..=channels).all(|channel| rig.read(&format!("{channel}:P8685")) == 2.0);
    assert!(runs, "{:?}", rig.control.messages());
}
