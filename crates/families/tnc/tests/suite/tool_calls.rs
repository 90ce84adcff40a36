//! TOOL CALL and TOOL DEF through the kernel [000:9194-9410].

use crate::stand::*;
use crate::support::*;
use bahn_path::ToolShape;
use bahn_tnc::Tool;

fn build(parameters: &[&str], plc: &str, program: &str) -> Rig {
    let mut build = bench(plc).program("1.H", program);
    for parameter in parameters {
        build = build.mp(parameter);
    }
    let tool = |length, pocket, special| Tool {
        shape: ToolShape {
            length,
            radius: 5.0,
            corner_radius: 0.0,
            ..ToolShape::default()
        },
        pocket,
        special,
        ..Tool::default()
    };
    build.tools = Some(
        [
            (1, tool(70.0, Some(11), false)),
            (2, tool(95.0, Some(12), false)),
            (3, tool(85.0, None, false)),
            (4, tool(60.0, Some(14), true)),
        ]
        .into(),
    );
    ready(build)
}

/// MP7480: what goes out for a TOOL CALL of another tool, and for the same one again; for TOOL DEF likewise.
/// Without the acknowledgements M2483 and M2484 the program would not end.
#[test]
fn outputs_of_mp7480() {
    let program = "TOOL CALL 1 Z S0\nTOOL CALL 2 Z S0\nTOOL CALL 2 Z S0\nTOOL DEF 1\nTOOL DEF 1";
    let codes = |call: u8, definition: u8| {
        let parameters = [format!("7480.0={call}"), format!("7480.1={definition}")];
        let parameters: Vec<&str> = parameters.iter().map(String::as_str).collect();
        let mut rig = build(&parameters, ACKNOWLEDGE, program);
        rig.start();
        let mut codes = Vec::new();
        let mut before = [false; 2];
        for _ in 0..500 {
            rig.cycle();
            let now = ["M2046", "M2047"].map(|name| rig.bit(name));
            for (name, (now, before)) in ["C", "D"].iter().zip(now.iter().zip(before)) {
                if *now && !before {
                    codes.push(format!("{name} {} {}", rig.number("W262"), rig.number("W264")));
                }
            }
            before = now;
        }
        assert!(rig.control.snapshot().ended);
        codes.join(", ")
    };
    assert_eq!(codes(0, 0), "");
    assert_eq!(codes(1, 1), "C 1 0, C 2 0, D 1 0");
    assert_eq!(codes(2, 2), "C 1 0, C 2 0, C 2 0, D 1 0, D 1 0");
    // Variable coding: tool 1 has taken pocket 12 of tool 2.
    assert_eq!(codes(3, 3), "C 11 1, C 12 2, D 12 1");
    assert_eq!(codes(4, 4), "C 11 1, C 12 2, C 11 2, D 12 1, D 12 1");
    assert_eq!(codes(5, 3), "C 11 1, C 12 2, D 11 1");
    assert_eq!(codes(6, 4), "C 11 1, C 12 2, C 12 2, D 11 1, D 11 1");
}

/// From the magazine to a tool by hand: both pairs with an acknowledgement each, M2093 with the first, and the
/// axes wait for both.
#[test]
fn two_strobes() {
    let plc = ACKNOWLEDGE.replace(
        "       L     M2046\n       = M2483\n",
        "       L     M2046\n       A     I20\n       = M2483\n",
    );
    let mut rig = build(
        &["7480.0=3"],
        &plc,
        "TOOL CALL 1 Z S0\nTOOL CALL 3 Z S0\nL X+60 R0 F6000",
    );
    rig.event("key A press");
    rig.start();
    rig.until(2.0, "tool 1", |rig| rig.number("W262") == 11);
    rig.until(2.0, "tool 1 is in", |rig| rig.control.snapshot().tool == 1);
    let names = "W262 W264 M2093 M2046 M2483";
    let order = edges(&mut rig, names, 0.5);
    assert_eq!(
        order.trim_start_matches("M2046- M2483- "),
        // The first pair leaves W262 = 11 as it is.
        "W264=0 M2093+ M2046+ M2483+ M2046- M2483- W262=255 W264=3 M2093- M2046+ M2483+ M2046- M2483-"
    );
    assert!(rig.bit("M2402") && !rig.bit("M2401"));
    assert_eq!(rig.control.snapshot().tool, 3);
    near(display(&rig, 'X'), 60.0);
}

/// T0: M2400 until another tool is called.
#[test]
fn tool_zero() {
    let mut rig = build(
        &["7480.0=3"],
        ACKNOWLEDGE,
        "TOOL CALL 1 Z S0\nTOOL CALL 0 Z S0\nM8\nTOOL CALL 4 Z S0",
    );
    rig.start();
    assert_eq!(
        edges(&mut rig, "M2400 M2403 W262", 1.0),
        "W262=11 M2400+ M2400- M2403+ W262=14"
    );
}

/// The tip of a longer tool stands lower: the display of Z changes with the call, no axis moves; the next
/// block drives the tip to its place. M2717 makes the geometry of the tool in W264 active [000:9217-9219].
#[test]
fn length_of_the_tool() {
    let plc = format!(
        "{ACKNOWLEDGE}       L     I20\n       AN    M0\n       = M1\n       L     I20\n       = M0\n       L     M1\n       IFT\n         L     K+1\n         = W264\n       ENDI\n       L     M1\n       S     M2717"
    );
    let mut rig = build(&["7480.0=1"], &plc, "TOOL CALL 2 Z S0\nM7\nL Z+10 R0 F6000");
    let z = rig.machine_position('Z');
    rig.command("mode single");
    rig.start();
    rig.seconds(0.5);
    near(display(&rig, 'Z'), 50.0 - 95.0);
    near(rig.machine_position('Z'), z);
    rig.command("mode full");
    rig.start();
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    near(rig.machine_position('Z'), z - 40.0 + 95.0);
    rig.event("key A press");
    rig.seconds(0.2);
    assert_eq!(rig.control.snapshot().tool, 1);
    near(display(&rig, 'Z'), 10.0 + 95.0 - 70.0);
}

/// M2100 to M2103 say which axis is the tool axis [000:3410-3416].
#[test]
fn markers_of_the_tool_axis() {
    let markers = ["M2100", "M2101", "M2102", "M2103"];
    for (axis, place) in [("Y", 1), ("Z", 2), ("X", 0)] {
        let mut rig = build(&[], ACKNOWLEDGE, &format!("TOOL CALL 1 {axis} S0"));
        rig.start();
        rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
        rig.cycle();
        let set: Vec<usize> = (0..4).filter(|at| rig.bit(markers[*at])).collect();
        assert_eq!(set, [place], "{axis}");
    }
}
