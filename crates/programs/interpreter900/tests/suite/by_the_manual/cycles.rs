//! Cycles by M functions and tool changes; drilling.

use bahn_path::{Curve, FeedRate};

use super::support::{ends, reader, run, with_cycles};

/// M234 calls Z234 at the end of its block, where P8250 ff. say so (byte 3 of P8308, 234 = 4 * 58 + 2) [002:5493-5501].
#[test]
fn a_cycle_runs_at_the_end_of_its_block() {
    let cycles = [("Z234.900", "N10 G91 G1 Y5 F100\nN20 G90\n")];
    let data = "q158: 1\nP8308: $00400000\n";
    let mut reader = with_cycles(data, "N10 G1 X1 F100 M234\nN20 Z1\nN30 M30\n", &cycles);
    let ran = run(&mut reader);
    assert_eq!(ran.fault, None);
    assert_eq!(ran.ends(), [[1.0, 0.0, 0.0], [1.0, 5.0, 0.0], [1.0, 5.0, 1.0]]);
    // The movement of the cycle is that of the block that has called it.
    let blocks: Vec<u32> = ran.elements.iter().map(|element| element.block.block).collect();
    assert_eq!(blocks, [1, 1, 2]);
}

/// A cycle that calls itself ends with a fault, and so does one that is not there.
#[test]
fn cycles_end() {
    let data = "q158: 1\nP8308: $00400000\n";
    let own = [("Z234.900", "N10 M234\n")];
    let ran = run(&mut with_cycles(data, "N10 M234\n", &own));
    let said = ran.fault.unwrap();
    assert_eq!(said, "more than 10 cycles within one another");
    let ran = run(&mut with_cycles(data, "N10 M234\n", &[]));
    let said = ran.fault.unwrap();
    assert!(said.contains("Z234.900"), "{said}");
}

/// M6 runs Z6 where that lies beside the program [002:1731-1735].
#[test]
fn a_tool_change_runs_its_cycle() {
    let data = "q175: 21000\nq176: 1\nq178: 20\nP21000: 1\nP21011: 40\n";
    let cycles = [("Z6.900", "N10 G153 G0 X-100\nN20 G53\n")];
    let ran = run(&mut with_cycles(
        data,
        "N10 T1 M6\nN20 G1 Z0 F100\nN30 M30\n",
        &cycles,
    ));
    assert_eq!(ran.fault, None);
    assert_eq!(ran.ends(), [[-100.0, 0.0, 0.0], [-100.0, 0.0, 40.0]]);
}

/// G81: rapidly to P34 = 2, with P32 = 150 to P33 = -10, back to 2 and to P35 = 20; modal by P8806 byte 3, so a second
/// place follows [002:4230-4236].
#[test]
fn g81_drills_at_each_place() {
    let data = "P32: 150\nP33: -10\nP34: 2\nP35: 20\nP8806: $00010000\n";
    let program = "N10 G0 Z20\nN20 G81 X5\nN30 X15\nN40 G80\nN50 X0\nN60 M30\n";
    let z = |x: f64| [2.0, -10.0, 2.0, 20.0].map(|z| [x, 0.0, z]);
    let mut wanted = vec![[0.0, 0.0, 20.0], [5.0, 0.0, 20.0]];
    wanted.extend(z(5.0));
    wanted.push([15.0, 0.0, 20.0]);
    wanted.extend(z(15.0));
    wanted.push([0.0, 0.0, 20.0]);
    assert_eq!(ends(data, program), wanted);
    let ran = run(&mut reader(data, program));
    let down = ran
        .elements
        .iter()
        .find(|one| one.end[bahn_path::Axis::Z] == -10.0 && one.curve != Curve::Hold);
    assert_eq!(down.unwrap().feed, FeedRate::Programmed(150.0));
}

/// G83 with three strokes from 0 to -9: (P33 - P34) / P36 = 3 each; out to P34 and back to 1 above the depth before.
#[test]
fn g83_drills_in_strokes() {
    let data = "P32: 150\nP33: -9\nP34: 0\nP35: 0\nP36: 3\n";
    let places: Vec<f64> = ends(data, "N10 G83 G1 F100 X5\nN20 M30\n")
        .iter()
        .map(|place| place[2])
        .collect();
    assert_eq!(places, [0.0, -3.0, 0.0, -2.0, -6.0, 0.0, -5.0, -9.0, 0.0]);
}
