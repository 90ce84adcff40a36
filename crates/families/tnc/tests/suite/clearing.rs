//! What is cancelled when a program is selected, and at its end: MP7300 [000:6589-6601].

use crate::stand::*;
use crate::support::*;
use bahn_path::ToolShape;
use bahn_tnc::Tool;

/// The display of Z at the start, and the tool.
const Z: f64 = 50.0;
const LENGTH: f64 = 70.0;
const RADIUS: f64 = 5.0;

/// A tool, then a shift by 10 mm that X+0 before it does not see yet.
const PROGRAM: &str = "TOOL CALL 1 Z S0\nL X+0 R0 F6000\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+10";

fn build(mp7300: u8) -> Rig {
    let mut build = bench(ACKNOWLEDGE)
        .program("1.H", PROGRAM)
        .program("2.H", "L X-20 Y+0 RL F6000\nL X+30")
        .program("3.H", "L X+0 R0 F6000")
        .mp(&format!("7300={mp7300}"))
        .mp("7480.0=1");
    let tool = Tool {
        shape: ToolShape {
            length: LENGTH,
            radius: RADIUS,
            ..ToolShape::default()
        },
        ..Tool::default()
    };
    build.tools = Some([(1, tool)].into());
    let mut rig = ready(build);
    run(&mut rig);
    rig
}

fn run(rig: &mut Rig) {
    rig.start();
    rig.seconds(0.2);
    rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
    rig.cycle();
    rig.cycle();
}

/// The shift stays in force after the end with an even value, and never after the selection of a program.
#[test]
fn transformations_stay_as_mp7300_says() {
    for value in 0..8u8 {
        let mut rig = build(value);
        run(&mut rig);
        near(display(&rig, 'X'), if value % 2 == 0 { 10.0 } else { 0.0 });
        rig.command("select 3.H");
        run(&mut rig);
        near(display(&rig, 'X'), 0.0);
    }
}

/// GOTO after the end of a program starts with the Q parameters that are left then: without those that MP7300
/// cancelled at the end, and with what the PLC has written since.
#[test]
fn goto_after_the_end_brings_nothing_back() {
    for (mp7300, x) in [(1, 0.0), (2, 20.0)] {
        let program = "FN 0: Q1 = +20\nL X+Q1 R0 F6000";
        let build = bench(ACKNOWLEDGE).program("1.H", program);
        let mut rig = ready(build.mp(&format!("7300={mp7300}")));
        run(&mut rig);
        near(display(&rig, 'X'), 20.0);
        rig.command("goto 2");
        run(&mut rig);
        near(display(&rig, 'X'), x);
    }
}

/// With 0 to 3 length and radius of the tool are cancelled; with odd values at the end already.
#[test]
fn tool_data_stay_as_mp7300_says() {
    for value in 0..8u8 {
        let mut rig = build(value);
        let stays = value > 3;
        let length = |stays| if stays { LENGTH } else { 0.0 };
        near(display(&rig, 'Z'), Z - length(stays || value % 2 == 0));
        rig.command("select 2.H");
        near(display(&rig, 'Z'), Z - length(stays));
        if stays {
            run(&mut rig);
            // Left of the contour along +X is +Y.
            near(display(&rig, 'Y'), RADIUS);
        } else {
            rig.start();
            rig.seconds(1.0);
            let shown = ["PROGRAM-START UNDEFINED program 2.H block 1: no tool is called before"];
            assert_eq!(rig.messages(), shown);
        }
        assert_eq!(rig.control.snapshot().tool, 1, "it is still in the spindle");
    }
}

/// A block of MDI is no program: its tool stays in force for the next one.
#[test]
fn a_block_of_mdi_ends_no_program() {
    let mut rig = build(1);
    near(display(&rig, 'Z'), Z);
    rig.command("mode mdi");
    rig.command("mdi TOOL CALL 1 Z S0");
    rig.start();
    rig.seconds(1.0);
    near(display(&rig, 'Z'), Z - LENGTH);
    rig.command("mdi L Z+0 R0 F6000");
    rig.start();
    rig.seconds(5.0);
    near(display(&rig, 'Z'), 0.0);
}
