//! Axis IV of a TNC 155 in the place of an internal axis: M2590 and M2591 [001:2456-2467].

use crate::support::bench::close;
use crate::support::knee::*;
use crate::support::*;
use bahn_tnc::Mode;

/// A fourth linear axis U like the others, with its cam at E3.
const FOURTH: &str = r#"
[axis.U]
output = "4"
speed = 6000
volts = 9
time_constant_ms = 2
travel = [0, 200]
start = 50
reference_cam = { range = [140, 200], input = "I3" }
[axis.U.encoder]
input = "X4"
period_um = 20
mark = 150
"#;

/// Inputs I30 and I31 are the two markers.
const ASSIGNS: &str = "
       L     I30
       = M2590
       L     I31
       = M2591
";

/// Referenced, with I30 and I31 closed, and a program that moves an internal axis by 10 mm and axis IV by 5 mm.
fn ready(instructions: &str, internal: char) -> Rig {
    let program = format!("L I{internal}-10 R0 F3000\nL IU-5 F3000");
    let build = knee(instructions).with(FOURTH).program("1", &program);
    let mut rig = build.mps("72=0 90=3 3=6000 44=300 45=-300 46=300 47=-300").rig();
    for input in ["I30", "I31"] {
        rig.input(input, true);
    }
    rig.command("ce");
    rig.until(10.0, "the reference run is asked for", |rig| {
        rig.control.snapshot().mode == Mode::Reference
    });
    rig.scan();
    reference(&mut rig);
    rig
}

/// How far the tables of an internal axis and of axis IV go in the program, mm.
fn ways(rig: &mut Rig, internal: char) -> [f64; 2] {
    let from = [internal, 'U'].map(|axis| rig.table(axis));
    rig.run("1", 20.0);
    rig.settle();
    assert_eq!(rig.messages(), [""; 0]);
    let to = [internal, 'U'].map(|axis| rig.table(axis));
    [to[0] - from[0], to[1] - from[1]]
}

/// M2590 and M2591: 00 is X, 01 Y, 10 Z. What is programmed as that axis moves the table of axis IV by its 10 mm, and U the other one by 5 mm. With 11,
/// before and after, each axis is itself.
#[test]
fn axis_iv_takes_the_place_of_an_internal_axis() {
    for (m2590, m2591, internal) in [(false, false, 'X'), (false, true, 'Y'), (true, false, 'Z')] {
        let mut rig = ready(ASSIGNS, internal);
        for (markers, expected) in [
            ([true, true], [-10.0, -5.0]),
            ([m2590, m2591], [-5.0, -10.0]),
            ([true, true], [-10.0, -5.0]),
        ] {
            for (input, on) in ["I30", "I31"].into_iter().zip(markers) {
                rig.input(input, on);
            }
            rig.seconds(0.1);
            let moved = ways(&mut rig, internal);
            for (moved, expected) in moved.into_iter().zip(expected) {
                close(moved, expected, 0.02);
            }
        }
    }
}

/// A program that names neither marker leaves all axes what they are, though both are 0.
#[test]
fn a_program_without_the_markers_assigns_nothing() {
    let mut rig = ready("", 'X');
    let [x, u] = ways(&mut rig, 'X');
    close(x, -10.0, 0.02);
    close(u, -5.0, 0.02);
}

/// The markers change in the midst of a program: it goes on with the axes that it has, and the next one finds the others.
#[test]
fn the_axes_change_between_programs() {
    let mut rig = ready(ASSIGNS, 'X');
    let from = ['X', 'U'].map(|axis| rig.table(axis));
    rig.command("mode full");
    rig.command("select 1");
    rig.start();
    rig.until(2.0, "X moves", |rig| rig.table('X') < from[0] - 2.0);
    rig.input("I30", false);
    rig.input("I31", false);
    rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
    rig.settle();
    let to = ['X', 'U'].map(|axis| rig.table(axis));
    close(to[0] - from[0], -10.0, 0.02);
    close(to[1] - from[1], -5.0, 0.02);
    let [x, u] = ways(&mut rig, 'X');
    close(x, -5.0, 0.02);
    close(u, -10.0, 0.02);
}
