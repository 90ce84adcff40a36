//! A block that is refused is refused whole: tool, length and axis stay as they were, and what comes after it in the program is
//! not executed. The run goes on with that block again, or elsewhere, from where the axes are.

use crate::stand::*;
use crate::support::*;
use bahn_path::ToolShape;
use bahn_tnc::{RunState, Tool};

/// The bench with tools 1 and 2, 60 and 80 mm long, and a program in full sequence. Its spindle turns 9000 rpm in no gear.
fn bench_of(parameters: &[&str], blocks: &str) -> Rig {
    let tool = |number, length| {
        let shape = ToolShape {
            length,
            radius: 5.0,
            ..ToolShape::default()
        };
        let tool = Tool {
            shape,
            ..Tool::default()
        };
        (number, tool)
    };
    let parameters = parameters.iter().chain(&["7480.0=1", "7680=%0000110"]);
    let mut build = parameters.fold(bench(ACKNOWLEDGE), |build, parameter| build.mp(parameter));
    build.tools = Some([tool(1, 60.0), tool(2, 80.0)].into());
    ready(build.program("1.H", blocks))
}

/// The message that is shown, with its block.
fn shown(rig: &Rig) -> Vec<(String, Option<u32>)> {
    let messages = rig.control.snapshot().messages;
    let text = |shown: &bahn_tnc::Shown| rig.control.message_text(&shown.message).to_string();
    let of = |shown: &bahn_tnc::Shown| (text(shown), shown.block.map(|block| block.block));
    messages.iter().map(of).collect()
}

fn wrong_speed(block: u32) -> Vec<(String, Option<u32>)> {
    vec![("WRONG SPINDLE SPEED".to_owned(), Some(block))]
}

/// In full sequence, single block and MDI: tool 1 stays in the spindle with its 60 mm, Z is shown as before, and does not move. NC
/// start finds the same block. From block 3 on the program runs with tool 1: the tip goes to Z+10, the machine 60 mm higher.
#[test]
fn a_tool_call_with_a_wrong_speed_leaves_the_old_tool() {
    const BLOCKS: &str = "TOOL CALL 1 Z S500\nTOOL CALL 2 Z S9000\nL Z+10 R0 F6000";
    for mode in ["full", "single", "mdi"] {
        let mut rig = bench_of(&[], BLOCKS);
        let tip = display(&rig, 'Z') - 60.0;
        rig.command(&format!("mode {mode}"));
        if mode == "mdi" {
            rig.command("mdi TOOL CALL 1 Z S500");
            rig.start();
            rig.seconds(1.0);
            rig.command("mdi TOOL CALL 2 Z S9000");
        } else {
            rig.start();
            rig.seconds(1.0);
        }
        let z = rig.machine_position('Z');
        for _ in 0..2 {
            rig.start();
            rig.seconds(1.0);
            let block = if mode == "mdi" { 1 } else { 2 };
            assert_eq!(shown(&rig), wrong_speed(block), "{mode}");
            assert_eq!(rig.control.snapshot().tool, 1, "{mode}");
            near(rig.machine_position('Z'), z);
            near(display(&rig, 'Z'), tip);
            assert!(rig.bit("M2092"), "{mode}");
            rig.command("ce");
        }
        rig.command("mode full");
        rig.command("goto 3");
        rig.start();
        rig.until(10.0, "the end", |rig| rig.control.snapshot().ended);
        near(rig.machine_position('Z'), z + 10.0 - tip);
        assert_eq!(rig.control.snapshot().tool, 1, "{mode}");
    }
}

/// MP3030 = 1: the axes do not halt for a speed. One that is refused stops them on their ramp behind X+60, in block 3, which is not
/// finished: 50 mm/s need v²/2a = 1.25 mm with 1 m/s². NC start finds block 2 again; the axes halt for it as little as before, and
/// stand after two cycles of 3 ms: v = 3 mm/s, 0.009 mm.
#[test]
fn a_wrong_speed_that_no_axis_halts_for_stops_the_path() {
    let blocks = "L X+60 R0 F3000\nTOOL CALL S9000\nL X+90 F3000";
    let mut rig = bench_of(&["3030=1"], blocks);
    rig.start();
    rig.until(5.0, "it is said", |rig| !rig.messages().is_empty());
    assert_eq!(shown(&rig), wrong_speed(2));
    rig.seconds(1.0);
    let at = nominal(&rig, 'X');
    assert!((61.2..61.3).contains(&at), "{at}");
    assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
    for again in 1..=2 {
        rig.command("ce");
        rig.start();
        rig.seconds(1.0);
        assert_eq!(shown(&rig), wrong_speed(2));
        let further = nominal(&rig, 'X') - at;
        assert!((0.0..0.02 * f64::from(again)).contains(&further), "{further} mm");
    }
    rig.command("ce");
    rig.command("goto 3");
    rig.start();
    rig.until(10.0, "the end", |rig| rig.control.snapshot().ended);
    near(nominal(&rig, 'X'), 90.0);
}

/// A block scan passes the wrong call: it ends there, the tool stays, and nothing after the block is executed by NC start.
#[test]
fn a_block_scan_ends_at_a_wrong_speed() {
    let blocks = "TOOL CALL 1 Z S500\nTOOL CALL 2 Z S9000\nL Z+10 R0 F6000\nL X+80\nL X+90";
    let mut rig = bench_of(&[], blocks);
    let at = ['X', 'Z'].map(|axis| rig.machine_position(axis));
    let tip = display(&rig, 'Z') - 60.0;
    rig.command("restore-at 4");
    for _ in 0..2 {
        rig.seconds(1.0);
        assert_eq!(shown(&rig), wrong_speed(2));
        rig.command("ce");
        rig.start();
    }
    rig.seconds(1.0);
    assert_eq!(rig.control.snapshot().tool, 1);
    for (axis, at) in ['X', 'Z'].into_iter().zip(at) {
        near(rig.machine_position(axis), at);
    }
    near(display(&rig, 'Z'), tip);
}

/// What the program itself refuses takes nothing over either: a tool that is not defined, the shift of an axis beyond 99 999.9999 mm.
/// Tool 1 stays in force with its length, X and Z are shown as before, and NC start refuses the block again, for the same reason.
#[test]
fn a_missing_tool_and_a_wrong_datum_shift_change_nothing() {
    for (blocks, message) in [
        ("TOOL CALL 9 Z S500", "TOOL NOT DEFINED"),
        (
            "FN 0: Q1 = +99999\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 IZ+Q1\nCYCL DEF 7.2 IZ+Q1",
            "ENTRY VALUE INCORRECT",
        ),
    ] {
        let blocks = format!("TOOL CALL 1 Z S500\n{blocks}\nL X+0 Z+10 R0 F6000");
        let mut rig = bench_of(&[], &blocks);
        let [x, tip] = [display(&rig, 'X'), display(&rig, 'Z') - 60.0];
        let at = rig.machine_position('Z');
        for _ in 0..3 {
            rig.start();
            rig.seconds(1.0);
            let said = rig.messages();
            assert!(said.len() == 1 && said[0].starts_with(message), "{said:?}");
            assert_eq!(rig.control.snapshot().tool, 1);
            near(rig.machine_position('Z'), at);
            near(display(&rig, 'X'), x);
            near(display(&rig, 'Z'), tip);
            rig.command("ce");
        }
    }
}
