//! Eight channels with 32 axes under one clock and one PLC, on axes that stand where they are told to: what the control
//! alone takes. One iteration is a second of machine time: 50 times real time is 20 ms.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a bench may fail")]

#[path = "../tests/support/mod.rs"]
mod support;

use std::sync::Arc;

use bahn_parameters::PerPlcAxis;
use bahn_servo::IdealAxes;
use bahn_tnc::{
    AxisId, Cartesian, ChannelSetup, Command, Control, Mode, Remembered, RunState, SpindleWiring, Window,
};
use divan::Bencher;
use support::Shelf;

fn main() {
    divan::main();
}

/// A zigzag of short lines in four axes that goes on for ever.
const ZIGZAG: &str = "L X+100 Y+100 Z+100 R0 FMAX\nLBL 1\nL IX+5 IY+1 IZ+1 IA+1 R0 F3000\nL IX+5 IY+1 IZ-1 IA-1\n\
                      L IX-10 IY-2\nCALL LBL 1 REP 65000";

/// X, Y, Z and A, each with a mark 2 mm (2 degrees) ahead.
const FOUR_AXES: &str = "10=%01111 50=%01111 410.3=0 960.3=-100 910.0=1000 910.1=1000 910.2=1000 910.3=1000 \
                         920.0=-1000 920.1=-1000 920.2=-1000 920.3=-1000 3010=0 7300=0";
/// Counting steps of a millimetre: 1024 in 20 µm.
const STEPS_MM: f64 = 51_200.0;

/// Every channel sees the panel of the first one.
fn window() -> Window {
    let bit = |name: &str| name.parse().unwrap();
    Window::default()
        .markers(bit("M2448"), bit("M2448"), 32)
        .markers(bit("M2488"), bit("M2488"), 1)
        .markers(bit("M2556"), bit("M2556"), 4)
}

/// So many channels that cut, with four axes each.
fn cutting(channels: u8) -> (Control, IdealAxes) {
    let build = support::bench::bench("").mps(FOUR_AXES).program("1.H", ZIGZAG);
    let (setup, _) = build.setup();
    let channel = |number: u8| {
        let mut programs = Shelf::default();
        programs.0.insert(
            "1.H".to_owned(),
            format!("BEGIN PGM 1 MM\n{ZIGZAG}\nEND PGM 1 MM\n"),
        );
        let axis = |place| AxisId::new(5 + 4 * (number - 1) + place);
        ChannelSetup {
            parameters: setup.parameters.clone(),
            axes: PerPlcAxis([axis(1), axis(2), axis(3), axis(4), None]),
            connectors: 5 * number,
            spindle: SpindleWiring { output: 5, input: 5 },
            programs: Arc::new(programs),
            kinematics: Arc::new(Cartesian),
            window: window(),
            remembered: Remembered::default(),
        }
    };
    let others = (1..channels).map(channel).collect();
    let mut control = Control::with_channels(setup, others).unwrap();
    let mut plant = IdealAxes::default();
    plant.marks.fill(Some((2.0 * STEPS_MM) as i64));
    // Inputs of the panel that are 1 at rest.
    plant.inputs[147] = true;
    let all = 0..usize::from(channels);
    let mode_is = |mode| move |control: &Control, channel| control.snapshot_of(channel).unwrap().mode == mode;
    if !control.shown().is_empty() {
        assert!(control.command("ce".parse().unwrap()));
    }
    until(&mut control, &mut plant, all.clone(), mode_is(Mode::Reference));
    tap_start(&mut control, &mut plant);
    until(&mut control, &mut plant, all.clone(), mode_is(Mode::Manual));
    for channel in all.clone() {
        for command in ["mode full", "select 1.H"] {
            assert!(
                control.command_to(channel, command.parse::<Command>().unwrap()),
                "{command}"
            );
        }
    }
    tap_start(&mut control, &mut plant);
    until(&mut control, &mut plant, all, |control, channel| {
        let state = control.snapshot_of(channel).unwrap();
        state.run == RunState::Running && state.feed_mm_min > 1000.0
    });
    (control, plant)
}

fn cycle(control: &mut Control, plant: &mut IdealAxes) {
    control.prepare();
    control.cycle(plant);
}

fn until(
    control: &mut Control,
    plant: &mut IdealAxes,
    channels: std::ops::Range<usize>,
    so: impl Fn(&Control, usize) -> bool,
) {
    let end = control.time_us() + 60_000_000;
    while !channels.clone().all(|channel| so(control, channel)) {
        let shown: Vec<_> = channels
            .clone()
            .map(|channel| control.snapshot_of(channel).unwrap())
            .collect();
        assert!(control.time_us() < end, "{shown:?}");
        cycle(control, plant);
    }
}

fn tap_start(control: &mut Control, plant: &mut IdealAxes) {
    for pressed in [true, false] {
        plant.inputs[146] = pressed;
        for _ in 0..50 {
            cycle(control, plant);
        }
    }
}

#[divan::bench(args = [1, 2, 8], sample_count = 20)]
fn second_of_channels(bencher: Bencher, channels: u8) {
    let (mut control, mut plant) = cutting(channels);
    bencher.bench_local(|| {
        let end = control.time_us() + 1_000_000;
        while control.time_us() < end {
            cycle(&mut control, &mut plant);
        }
    });
}
