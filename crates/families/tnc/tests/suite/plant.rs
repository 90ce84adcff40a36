//! The seam to the machine: another plant than the simulated one, and what a drive says of itself.

use crate::stand::*;
use bahn_machine::Machine;
use bahn_servo::{Commands, IdealAxes, Measured, Plant, Step};
use bahn_tnc::{Control, Mode};

/// Counting steps of a millimetre: 1024 in 20 µm.
const STEPS_MM: f64 = 51_200.0;
const NC_START: usize = 10;
const NC_STOP: usize = 11;
const RADIUS: f64 = 20.0;
const PROGRAM: &str = "L X+60 Y+50 R0 F6000\nCC X+60 Y+70\nC X+60 Y+50 DR+ F3000\nL X+50 Y+90 Z+40 F9000";

fn cycle(control: &mut Control, plant: &mut IdealAxes) {
    control.prepare();
    control.cycle(plant);
}

fn until(
    control: &mut Control,
    plant: &mut IdealAxes,
    what: &str,
    mut so: impl FnMut(&Control, &IdealAxes) -> bool,
) {
    let end = control.time_us() + 60_000_000;
    while !so(control, plant) {
        let shown = control.snapshot();
        assert!(control.time_us() < end, "{what}: {shown:?}");
        assert!(
            shown.messages.iter().all(|shown| !shown.flashing),
            "{what}: {shown:?}"
        );
        cycle(control, plant);
    }
}

fn tap_start(control: &mut Control, plant: &mut IdealAxes) {
    for pressed in [true, false] {
        plant.inputs[NC_START] = pressed;
        for _ in 0..50 {
            cycle(control, plant);
        }
    }
}

/// A control that knows nothing of the simulated machine: reference run, lines and a full circle on axes that stand
/// where they are told to. Each contour cycle ends on the path but for half a counting step on each axis and the
/// rounding of positions, well within a micrometre.
#[test]
fn a_program_on_ideal_axes() {
    let (setup, _) = bench(ACKNOWLEDGE).program("1.H", PROGRAM).setup();
    let (mut control, mut plant) = (Control::new(setup), IdealAxes::default());
    plant.inputs[NC_STOP] = true;
    // 2 mm ahead, as on the bench.
    for mark in plant.marks.iter_mut().take(3) {
        *mark = Some((2.0 * STEPS_MM) as i64);
    }
    until(
        &mut control,
        &mut plant,
        "reference run asked for",
        |control, _| control.snapshot().mode == Mode::Reference,
    );
    tap_start(&mut control, &mut plant);
    until(&mut control, &mut plant, "marks passed", |control, _| {
        control.snapshot().mode == Mode::Manual
    });
    for _ in 0..100 {
        cycle(&mut control, &mut plant);
    }
    let at_datum = [0, 1, 2].map(|axis| plant.count(axis));
    for command in [
        "datum X 50",
        "datum Y 50",
        "datum Z 50",
        "mode full",
        "select 1.H",
    ] {
        assert!(control.command(command.parse().unwrap()), "{command}");
    }
    tap_start(&mut control, &mut plant);
    let place = |plant: &IdealAxes| {
        [0, 1, 2].map(|axis| 50.0 + (plant.count(axis) - at_datum[axis]) as f64 / STEPS_MM)
    };
    let (mut worst, mut seen) = (0.0f64, 0);
    until(&mut control, &mut plant, "the end", |control, plant| {
        let shown = control.snapshot();
        if shown.block.is_some_and(|block| block.block == 3) {
            let [x, y, _] = place(plant);
            worst = worst.max(((x - 60.0).hypot(y - 70.0) - RADIUS).abs());
            seen += 1;
        }
        shown.ended
    });
    // 2 pi 20 mm at 3000 mm/min are 2.5 s, of 3 ms each.
    assert!(seen > 800, "{seen} cycles on the circle");
    assert!(worst < 1e-3, "{worst}");
    for (is, wanted) in place(&plant).into_iter().zip([50.0, 90.0, 40.0]) {
        assert!((is - wanted).abs() < 1e-3, "{is} {wanted}");
    }
}

/// A machine whose drive of X says a fault.
struct Failing<'a> {
    machine: &'a mut Machine,
    word: u16,
}

impl Plant for Failing<'_> {
    fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured) {
        self.machine.exchange(step, commands, measured);
        measured.drives[0].fault = self.word;
    }
}

/// It is a gross error: the machine is switched off, and CE does not help.
#[test]
fn the_fault_word_of_a_drive_stops_the_machine() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+400 R0 F3000");
    rig.start();
    rig.seconds(1.0);
    let mut closed_with = |word| {
        let machine = &mut rig.machine;
        rig.control.prepare();
        rig.control.cycle(&mut Failing { machine, word });
        rig.seconds(0.1);
        rig.control.snapshot().axes.iter().all(|axis| axis.closed)
    };
    assert!(closed_with(0));
    assert!(!closed_with(0x7500));
    assert_eq!(rig.messages(), ["GROSS POSITIONING ERROR X C"]);
    assert!(!rig.control.command("ce".parse().unwrap()));
}
