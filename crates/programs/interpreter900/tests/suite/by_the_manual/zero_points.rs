//! Zero points, shifts, rotation, mirrors, tool length.

use bahn_path::Function;
use bahn_system900::Name;

use super::support::{ends, fault, reader, run};

/// Zero points from P20000 on: one area, one shift group, three axes, seven points. The sum of G54 begins at
/// 20000 + 1 * 3, its shift at 20000 + 7 * 3 + 3 [002:978-1022].
const POINTS: &str = "q170: 20000\nq171: 1\nq172: 1\nq173: 3\nq174: 0\n";

#[test]
fn a_zero_point_shifts_what_is_programmed() {
    let data = format!("{POINTS}P20003: 100\nP20004: 50\n");
    let program = "N10 G1 X1 F100\nN20 G54 X1 Y1\nN30 G153 X1\nN40 M30\n";
    assert_eq!(
        ends(&data, program),
        [[1.0, 0.0, 0.0], [101.0, 51.0, 0.0], [1.0, 51.0, 0.0]]
    );
}

/// P8830 chooses the one at the start [002:4315-4318].
#[test]
fn the_start_has_its_zero_point() {
    let data = format!("{POINTS}P20003: 100\nP8830: 54\n");
    assert_eq!(ends(&data, "N10 G1 X1 F100\nN20 M30\n"), [[101.0, 0.0, 0.0]]);
}

/// A write to the shift of G54, group 1, makes the sum anew.
#[test]
fn a_written_shift_counts_in_the_sum() {
    let data = format!("{POINTS}P20003: 100\n");
    let mut reader = reader(&data, "N10 G54 P20024:7.5\nN20 G1 X1 F100\nN30 M30\n");
    let ran = run(&mut reader);
    assert_eq!((ran.fault.clone(), ran.ends()), (None, vec![[8.5, 0.0, 0.0]]));
    let sum = reader.memory().unwrap().cell(Name::P(1, 20_003)).unwrap();
    assert_eq!(sum.number(), Some(7.5));
}

#[test]
fn a_zero_point_that_is_not_there_is_refused() {
    let said = fault(POINTS, "N10 G154 G1 X1 F100\nN20 M30\n");
    assert!(
        said.ends_with("G154: the channel has no such zero point, q174"),
        "{said}"
    );
}

/// G92 adds to the zero point; G44 adds P8000 ff.
#[test]
fn shifts_add_to_the_zero_point() {
    let data = format!("{POINTS}P20003: 100\nP8001: 3\n");
    let program = "N10 G54 G92 X20\nN20 G1 X1 Y1 F100\nN30 G44 X1 Y1\nN40 G43 X1 Y1\nN50 M30\n";
    assert_eq!(
        ends(&data, program),
        [[121.0, 1.0, 0.0], [121.0, 4.0, 0.0], [121.0, 1.0, 0.0]]
    );
}

/// X = U cos E - V sin E + U0, Y = U sin E + V cos E + V0 with E = 90 degrees: (10, 2) is at (-2 + 5, 10 + 6).
#[test]
fn a_rotation_turns_the_plane() {
    let program =
        "N10 G45 P160:5 P161:6 P163:90\nN20 G1 X10 Y2 F100\nN30 G91 X1\nN40 G90 G46 X10 Y2\nN50 M30\n";
    assert_eq!(
        ends("", program),
        [[3.0, 16.0, 0.0], [3.0, 17.0, 0.0], [10.0, 2.0, 0.0]]
    );
}

/// G61 mirrors the first axis: a circle to the left turns to the right.
#[test]
fn a_mirror_turns_circles_over() {
    let program = "N10 G61 G1 X10 F100\nN20 G3 X0 Y10 I-10\nN30 M30\n";
    let ran = run(&mut reader("", program));
    assert_eq!(ran.ends(), [[-10.0, 0.0, 0.0], [0.0, 10.0, 0.0]]);
    let bahn_path::Curve::Arc(arc) = ran.elements.last().unwrap().curve else {
        panic!("no arc")
    };
    assert!((arc.sweep_deg + 90.0).abs() < 1e-9, "{}", arc.sweep_deg);
}

/// Tool array from P21000 on with 20 values each; T 2 is the second record with length 80 + 0.5. With M16 the path behind the
/// block is computed with it, without a tool change it is not [002:1965-1967].
#[test]
fn the_length_of_the_tool_lies_along_the_normal() {
    let data = "q175: 21000\nq176: 2\nq178: 20\nP21000: 1\nP21020: 2\nP21031: 80\nP21033: 0.5\n";
    assert_eq!(
        ends(data, "N10 T2 M16\nN20 G1 Z1 F100\nN30 M30\n"),
        [[0.0, 0.0, 81.5]]
    );
    assert_eq!(ends(data, "N10 T2\nN20 G1 Z1 F100\nN30 M30\n"), [[0.0, 0.0, 1.0]]);
    assert_eq!(
        fault(data, "N10 T3 M16\nN20 M30\n"),
        "T3: no tool of the channel has this group, q175 to q178"
    );
}

/// P12157 is what the display of an axis leaves out: zero point, G92 and tool length [002:8346-8348]. It follows with the first
/// movement under it.
#[test]
fn the_display_leaves_the_shifts_out() {
    let data = format!("{POINTS}P20003: 100\nP20004: 50\n");
    let shifts = |program: &str| -> Vec<(u8, f64)> {
        let ran = run(&mut reader(&data, program));
        let all = ran.elements.iter().flat_map(|element| element.functions());
        let shifts = all.filter_map(|function| match function.function {
            Function::Shift { logical, by } => Some((logical, by)),
            _ => None,
        });
        shifts.collect()
    };
    assert_eq!(
        shifts("N10 G54\nN20 G0 X5\nN30 X6\nN40 M30\n"),
        [(1, 100.0), (2, 50.0)]
    );
    assert_eq!(shifts("N10 G0 X5\nN20 M30\n"), []);
    // 100 and the 20 of G92; G53 takes the zero point back, and nothing else.
    assert_eq!(
        shifts("N10 G54 G92 X20\nN20 G0 X5\nN30 G53 X5\nN40 M30\n"),
        [(1, 120.0), (2, 50.0), (1, 20.0), (2, 0.0)]
    );
}
