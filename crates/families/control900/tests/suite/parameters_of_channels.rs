//! Parameters of channels, one after the other: what each does while the control runs [002:1695-5270].

use std::sync::Arc;

use bahn_interpreter900::Reader900;
use bahn_path::{Axis, Position};
use bahn_text::MemoryFiles;

use crate::support::list::{Line, Lines};
use crate::support::{Rig, axis};

fn x(to: f64) -> [Line; 1] {
    [Line::to(&[(Axis::X, to)], 6000.0)]
}

/// P8762 points into the table of P8763 ff., from 0 on; P8761 takes the next one and shows it in P8760 [002:4053-4076].
#[test]
fn steps_are_those_of_the_table() {
    let mut rig = Rig::on("");
    for (name, value) in [
        ("P8750", "2"),
        ("P8751", "1"),
        ("P8764", "5"),
        ("P8765", "2.5"),
        ("P8762", "1"),
    ] {
        rig.operator(name, value);
    }
    rig.operator("P8752", "1");
    rig.seconds(1.0);
    assert_eq!(rig.read("P12151"), 5.0);
    rig.operator("P8761", "1");
    assert_eq!(
        ["P8760", "P8761", "P8762"].map(|name| rig.read(name)),
        [2.5, 0.0, 2.0]
    );
    rig.operator("P8752", "1");
    rig.seconds(1.0);
    assert_eq!(rig.read("P12151"), 7.5);
}

/// P7000, P7064 and P7096 hold by logical axes what the axes show [002:1543-1563].
#[test]
fn positions_stand_by_logical_axes() {
    let mut rig = Rig::on("");
    rig.operator("P12153", "3");
    rig.operator("P12353", "4");
    rig.start(1, &[Line::to(&[(Axis::X, 40.0), (Axis::Y, 20.0)], 3000.0)]);
    rig.until(|rig| rig.exact("P12151") > 10.0);
    assert_eq!(["P7064", "P7065"].map(|name| rig.read(name)), [40.0, 20.0]);
    for (table, own) in [
        ("P7096", "P12156"),
        ("P7097", "P12356"),
        ("P7000", "P12153"),
        ("P7001", "P12353"),
    ] {
        assert_eq!(rig.read(table), rig.read(own), "{table}");
    }
    assert!((20.0..30.0).contains(&rig.read("P7096")));
    assert_eq!(rig.read("P7001"), 4.0);
}

/// P8865 names the override of the path: 7 is 50 %. P8936 is F, P8940 its G function [002:4690-4693] [002:4894-4913].
#[test]
fn the_path_has_its_override_and_shows_its_feed() {
    let mut rig = Rig::on("P8865: 7\n");
    rig.start(
        1,
        &[
            Line::to(&[(Axis::X, 60.0)], 3000.0),
            Line {
                to: vec![(Axis::X, 0.0)],
                ..Line::default()
            },
        ],
    );
    rig.until(|rig| rig.exact("P12151") > 20.0);
    assert_eq!(
        ["P8936", "P8938", "P8940"].map(|name| rig.read(name)),
        [3000.0, 1500.0, 1.0]
    );
    rig.until(|rig| rig.read("P8901") == 20.0);
    assert_eq!(rig.read("P8940"), 0.0);
}

/// P8711 to P8713 call the programs of P8822, P8824, P8826 with the blocks behind them [002:3875-3882] [002:4306-4314].
#[test]
fn every_emergency_program_has_its_call() {
    for which in 0..4u32 {
        let mut rig = Rig::on("");
        let away = [
            Line::to(&[(Axis::Y, 99.0)], 3000.0),
            Line::to(&[(Axis::Y, -15.0)], 3000.0),
        ];
        rig.control
            .set_emergency_program(1, which as u8 + 1, Some(Lines::boxed(&away)));
        rig.operator(&format!("P{}", 8820 + 2 * which), "99");
        rig.operator(&format!("P{}", 8821 + 2 * which), "20");
        rig.start(1, &x(300.0));
        rig.until(|rig| rig.read("P12151") > 50.0);
        let call = format!("P{}", 8710 + which);
        rig.plc(&call, "1");
        rig.until(|rig| rig.read("P8900") == 99.0);
        assert_eq!(rig.read(&call), 0.0);
        rig.until_end(1);
        assert_eq!(
            (rig.read("P8801").is_nan(), rig.read("P12351")),
            (true, -15.0),
            "{call}"
        );
    }
}

/// P8504 names the axis of a message [002:3372].
#[test]
fn a_message_has_its_axis() {
    let mut rig = Rig::on("");
    rig.plc("P8504", "2");
    rig.plc("P8503", "3498");
    let message = &rig.control.messages()[0];
    assert_eq!((message.number, message.axis), (3498, Some(2)));
}

/// P8046 copies the spindle tool, or that of the PLC, to that which the path is computed with; P8045:1 copies the latter to both
/// others; customer data and all [002:1741-1777].
#[test]
fn tools_are_copied_as_ordered() {
    let mut data = String::new();
    for at in 0..50 {
        data += &format!("P{}: {}\nP{}: {}\n", 8050 + at, 100 + at, 8100 + at, 200 + at);
    }
    let mut rig = Rig::on(&data);
    let block = |rig: &Rig, first: u32| {
        (0..50)
            .map(|at| rig.read(&format!("P{}", first + at)))
            .collect::<Vec<_>>()
    };
    let counted = |first: u32| (0..50).map(|at| f64::from(first + at)).collect::<Vec<_>>();
    rig.plc("P8046", "1");
    assert_eq!(block(&rig, 8150), counted(200));
    rig.plc("P8046", "2");
    assert_eq!(block(&rig, 8150), counted(100));
    rig.plc("P8046", "1");
    rig.plc("P8045", "1");
    assert_eq!(
        [8100, 8150].map(|first| block(&rig, first)),
        [counted(100), counted(100)]
    );
}

/// Runs a program of channel 1 with X, Y and Z, physical axis 5, and 2000 parameters from P20000 on.
fn ran(more: &str, text: &str) -> Rig {
    let space = "q103: 300\nq3: 40000\nq104: 30000\nq105: 2000\nq112: $0305005A\nP11051: $10050601\n";
    let mut rig = Rig::on(&(axis(5) + space + more));
    let beside = Arc::new(MemoryFiles::default());
    let program = Reader900::new("P1000.900", text.as_bytes(), 1, Position::ZERO, beside);
    rig.operator("P8800", "1000");
    rig.control.set_program(1, Some(Box::new(program)));
    rig.operator("P8683", "2");
    rig.seconds(0.05);
    rig.operator("P8682", "2");
    rig.until_end(1);
    assert_eq!(rig.control.messages(), []);
    rig
}

/// P8555 = 2: G54 of the second area, which begins behind 2 groups of 7 points with 3 axes: P20042 + 3 [002:978-1022].
#[test]
fn p8555_chooses_the_work_area() {
    let areas = "q170: 20000\nq171: 2\nq172: 1\nq173: 3\nq174: 0\nP20003: 50\nP20045: 100\n";
    for (chosen, x) in [("P8555: 1\n", 51.0), ("P8555: 2\n", 101.0)] {
        let rig = ran(&format!("{areas}{chosen}"), "N10 G54 G1 X1 F6000\nN20 M30\n");
        assert_eq!(rig.read("P12151"), x, "{chosen}");
    }
}

/// T2 M6: the record of the tool goes to P8050 and P8150 whole, to P8200 and, by the standard answer, to P8100 without the data of
/// the customer; the path has length and radius with their corrections [002:1806-1997].
#[test]
fn a_tool_goes_through_its_records() {
    let record = [
        2.0, 7.0, 3.0, 1.0, 4.0, 11.0, 12.0, 13.0, 0.0, 14.0, 5.0, 100.0, 0.5, 0.25, 3.0, 9.0, 8.0,
    ];
    let data: String = (20_120..)
        .zip(record)
        .map(|(number, value)| format!("P{number}: {value}\n"))
        .collect();
    let layout = "q175: 20100\nq176: 2\nq178: 20\n";
    let rig = ran(
        &format!("{layout}{data}"),
        "N10 T2 M6\nN20 G1 Z1 F6000\nN30 G41 X10\nN40 X50\nN50 M30\n",
    );
    assert_eq!(["P8048", "P8049"].map(|name| rig.read(name)), [2.0, 6.0]);
    let block = |first: u32, count: u32| {
        (first..first + count)
            .map(|at| rig.read(&format!("P{at}")))
            .collect::<Vec<_>>()
    };
    for first in [8050, 8150] {
        assert_eq!(block(first, 17), record, "P{first}");
    }
    for first in [8200, 8100] {
        assert_eq!(block(first, 15), record[..15], "P{first}");
    }
    assert_eq!(["P12551", "P12351"].map(|name| rig.read(name)), [101.25, 5.5]);
}

/// q150 and q151 are the letters of radius and angle: U10 V90 is Y 10 [002:883-884].
#[test]
fn polar_words_have_their_letters() {
    let rig = ran("q150: 85\nq151: 86\n", "N10 G10 G1 U10 V90 F6000\nN20 M30\n");
    assert_eq!(["P12151", "P12351"].map(|name| rig.read(name)), [0.0, 10.0]);
}

/// P8841 and P8842 are the planes of G118 and G119, q152 that of G17: here with Z alone as normal, in which a tool has its
/// length [002:891-908] [002:4354-4366].
#[test]
fn planes_are_those_of_their_parameters() {
    let tool = "q175: 20100\nq176: 2\nq178: 20\nP20120: 2\nP20131: 30\n";
    for (plane, word) in [
        ("P8841", "G118"),
        ("P8842", "G119"),
        ("q152", "G17"),
        ("q153", "G18"),
        ("q154", "G19"),
    ] {
        // Logical axes 3 and 1 in the plane, 2 is its normal.
        let program = format!("N10 {word}\nN20 T2 M16\nN30 G1 Y1 F6000\nN40 M30\n");
        let rig = ran(&format!("{tool}{plane}: $00020103\n"), &program);
        assert_eq!(rig.read("P12351"), 31.0, "{plane}");
    }
}

/// P8859 byte 1 bit 1: G45 turns the shift of G92, or does not. 90 degrees lead (11, 0) to (0, 11), and (1, 0) to (0, 1), to
/// which 10 are added [002:4665-4671].
#[test]
fn p8859_says_whether_g92_is_turned() {
    let text = "N10 G92 X10\nN20 G45 P160:0 P161:0 P163:90\nN30 G1 X1 Y0 F6000\nN40 M30\n";
    for (more, place) in [("", [0.0, 11.0]), ("P8859: $2\n", [10.0, 1.0])] {
        let rig = ran(more, text);
        assert_eq!(["P12151", "P12351"].map(|name| rig.read(name)), place, "{more}");
    }
}

/// P8860 byte 1 is the spindle whose turns G95 counts: 0.2 mm of 1000 rpm, or of 500 rpm [002:4672-4678].
#[test]
fn p8860_names_the_spindle_of_g95() {
    for (more, feed) in [("", 200.0), ("P8860: $2\n", 100.0)] {
        let rig = ran(more, "N10 S1000 S2:500\nN20 F0.2 G95 G1 X1\nN30 M30\n");
        assert_eq!(rig.read("P8936"), feed, "{more}");
    }
}
