//! M101: the automatic change to the replacement tool [000:9175-9177].

use crate::support::{Build, Rig};
use bahn_plc::TableKind;
use bahn_tnc::{RunState, Tool, ToolLife};

/// Element of the tool table: current tool life [000:15440].
const CURRENT_TIME: usize = 7;

/// A milling pass to and fro, 5 s each way, under M101, with tool 2 (L 95, R 10) whose life ends within the first 6 s
/// after its call.
const PASSES: &str = "L X+0 Y+0 Z+20 R0 FMAX M101\nL X+5 R0 F60\nL X+0\nL X+5\nL X+0";

/// The mill; the lives TIME1 and TIME2 of tool 2 end 0.1 minutes after its call. Tool 3 (L 85) is as large.
fn passes(blocks: &str, time: [f64; 2], replacement: Option<u32>) -> Build {
    let [time1_min, time2_min] = time;
    let build = Build::mill().program("LIFE.H", &format!("TOOL CALL 2 Z S500\n{blocks}"));
    let life = ToolLife {
        time1_min,
        time2_min,
        current_min: 4.9,
        replacement,
    };
    with_tool(with_tool(build, 2, |tool| tool.life = life), 3, |tool| {
        tool.shape.radius = 10.0
    })
}

fn with_tool(mut build: Build, number: u32, change: impl Fn(&mut Tool)) -> Build {
    for (_, tool) in build.tools.iter_mut().flatten().filter(|(of, _)| **of == number) {
        change(tool);
    }
    build
}

/// The life of tool 2 as it is kept.
fn counted(rig: &Rig) -> f64 {
    let written = rig.control.remember().written;
    let of_tool_2 = written
        .iter()
        .find(|row| (row.table, row.line, row.element) == (TableKind::Tool, 2, CURRENT_TIME));
    of_tool_2.map_or(0.0, |row| row.value)
}

/// Switched on, LIFE.H started, and tool 2 in the spindle.
fn started(build: Build) -> Rig {
    let mut rig = build.rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select LIFE.H");
    rig.start();
    confirm(&mut rig);
    rig
}

/// The operator changes the tool.
fn confirm(rig: &mut Rig) {
    rig.until(60.0, "a tool is asked for", |rig| rig.bit("M2046"));
    rig.seconds(0.5);
    rig.event("key CONFIRM tap");
    rig.until(5.0, "the tool is changed", |rig| !rig.bit("M2046"));
    rig.seconds(0.05);
}

/// The change to another tool has begun; the tool that is asked for.
fn change(rig: &mut Rig) -> i32 {
    rig.until(60.0, "the replacement tool is called", |rig| rig.bit("M2046"));
    assert!(rig.bit("M2404"));
    rig.number("W262")
}

fn to_the_end(rig: &mut Rig) {
    rig.until(300.0, "the run ends", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.messages(), [""; 0]);
}

/// Displayed X and Z, workpiece coordinates.
fn tip(rig: &Rig) -> [f64; 2] {
    let axes = rig.control.snapshot().axes;
    let at = |letter| {
        let axis = axes.iter().find(|axis| axis.letter == letter);
        axis.map_or(f64::NAN, |axis| axis.nominal)
    };
    [at('X'), at('Z')]
}

/// M101: TIME1 or TIME2 of tool 2 is over while it mills to and fro. At the end of that block M2046 comes with the
/// number of tool 3 and M2404; the axes stand. After the change the shorter tool comes down by 95 - 85 mm to where the
/// tip of tool 2 was, and only then the next block is milled. A programmed call resets M2404 [000:9175] [000:9297].
#[test]
fn m101_replaces_the_worn_tool() {
    for time in [[5.0, 0.0], [0.0, 5.0]] {
        let blocks = format!("{PASSES}\nTOOL CALL 1 Z S500");
        let mut rig = started(passes(&blocks, time, Some(3)));
        assert!(!rig.bit("M2404"), "the first call is programmed");
        assert_eq!(change(&mut rig), 3);
        assert!(counted(&rig) > 5.0);
        let [x, z] = tip(&rig);
        assert!(x == 0.0 || x == 5.0, "at the end of a block: {x}");
        // The length of the called tool counts: its tip is 10 mm higher, without a movement.
        assert_eq!((z, rig.control.snapshot().tool), (30.0, 2));
        rig.seconds(1.0);
        assert_eq!(tip(&rig), [x, 30.0], "the path waits");
        let before = rig.machine_position('Z');
        rig.event("key CONFIRM tap");
        rig.until(5.0, "the strobe falls", |rig| !rig.bit("M2046"));
        rig.until(0.1, "the tool is in the spindle", |rig| {
            rig.control.snapshot().tool == 3
        });
        rig.until(10.0, "the next block is milled", |rig| {
            (tip(rig)[0] - x).abs() > 0.01
        });
        assert!(
            (tip(&rig)[1] - 20.0).abs() < 1e-6,
            "at the depth of the old tool: {:?}",
            tip(&rig)
        );
        assert!(
            (before - rig.machine_position('Z') - 10.0).abs() < 0.01,
            "it has come down"
        );
        assert_eq!(rig.messages(), [""; 0]);
        let worn = counted(&rig);
        rig.until(60.0, "tool 1 is called", |rig| rig.bit("M2046"));
        assert!(!rig.bit("M2404"), "by the program");
        assert_eq!(counted(&rig), worn, "tool 3 works");
        confirm(&mut rig);
        rig.until(10.0, "the run ends", |rig| rig.control.snapshot().ended);
    }
    // Without M101, and after M102, the worn tool works on.
    for blocks in [PASSES.replace(" M101", ""), PASSES.replacen("F60", "F60 M102", 1)] {
        let mut rig = started(passes(&blocks, [5.0, 0.0], Some(3)));
        to_the_end(&mut rig);
        assert_eq!(rig.control.snapshot().tool, 2);
        assert!(counted(&rig) > 5.0);
    }
}

/// Without a replacement tool, or with tools that replace each other and are all worn, the run stops at the end of each
/// block with the message, until the life is reset.
#[test]
fn m101_stops_the_run_of_a_worn_tool_that_none_replaces() {
    let stopped = |rig: &Rig| rig.control.snapshot().run == RunState::BlockEnd;
    for replacement in [None, Some(2), Some(3), Some(9)] {
        let worn = ToolLife {
            time1_min: 1.0,
            time2_min: 0.0,
            current_min: 1.5,
            replacement: Some(2),
        };
        let build = passes(PASSES, [0.0, 5.0], replacement);
        let mut rig = started(with_tool(build, 3, |tool| tool.life = worn));
        rig.until(60.0, "the run stops", stopped);
        assert!(counted(&rig) > 5.0);
        let [x, _] = tip(&rig);
        assert!(x == 0.0 || x == 5.0, "at the end of a block: {x}");
        assert_eq!(rig.messages(), ["MAX. TOOL LIFE EXPIRED"]);
        rig.command("ce");
        rig.start();
        rig.until(10.0, "the run stops again", |rig| {
            stopped(rig) && !rig.messages().is_empty()
        });
        assert_eq!(tip(&rig)[0], 5.0 - x, "one block further");
        rig.command("ce");
        rig.command("tool-life 2 0");
        rig.start();
        rig.until(60.0, "the run ends", |rig| rig.control.snapshot().ended);
        assert_eq!(rig.messages(), [""; 0]);
    }
}

/// A replacement tool that is worn itself is replaced by its own one.
#[test]
fn a_worn_replacement_tool_is_passed_over() {
    let worn = ToolLife {
        time1_min: 1.0,
        time2_min: 0.0,
        current_min: 1.5,
        replacement: Some(1),
    };
    let build = with_tool(passes(PASSES, [5.0, 0.0], Some(3)), 3, |tool| tool.life = worn);
    let build = with_tool(build, 1, |tool| tool.shape.radius = 10.0);
    let mut rig = started(build);
    assert_eq!(change(&mut rig), 1);
}

/// A larger tool would cut into the part: TOOL RADIUS TOO LARGE, but for M107; M108 resets that [000:9177].
#[test]
fn a_larger_replacement_tool_is_refused() {
    let large = |blocks: &str| {
        let build = passes(blocks, [5.0, 0.0], Some(3));
        started(with_tool(build, 3, |tool| tool.shape.radius = 10.1))
    };
    let refused = |mut rig: Rig| {
        let stopped = |rig: &Rig| rig.control.snapshot().run == RunState::BlockEnd;
        rig.until(60.0, "the run stops", stopped);
        assert_eq!(rig.messages(), ["TOOL RADIUS TOO LARGE"]);
        assert_eq!(rig.control.snapshot().tool, 2);
    };
    refused(large(PASSES));
    assert_eq!(change(&mut large(&PASSES.replace("M101", "M101 M107"))), 3);
    refused(large(&PASSES.replace("M101", "M101 M107\nL Z+30 FMAX M108")));
}

/// The life ends on a contour under RL, 24 mm at 60 mm/min: the tool is replaced after its R0 block.
#[test]
fn a_contour_is_finished_with_its_tool() {
    let blocks = "L X+10 Y+0 Z+20 R0 FMAX M101\nL X+20 RL F600\nL X+26 F60\nL X+32\nL X+38\nL X+44\n\
                  L X+50 F600\nL X+60 R0\nL X+65\nL X+70";
    let mut rig = started(passes(blocks, [5.0, 0.0], Some(3)));
    rig.until(60.0, "the life is over", |rig| counted(rig) > 5.0);
    assert!(tip(&rig)[0] < 44.0, "on the contour");
    assert_eq!(change(&mut rig), 3);
    assert_eq!(
        tip(&rig)[0],
        65.0,
        "after the block that leads away from the contour"
    );
    confirm(&mut rig);
    to_the_end(&mut rig);
}

/// After a datum shift each movement is held back for a rounding that may come. The tool is replaced neither before a
/// rounding nor before a tangential arc, which go on from the movement before: X 20 lies at the datum.
#[test]
fn roundings_and_tangential_arcs_keep_their_beginning() {
    for feed in [40, 60, 80, 120] {
        let shift = "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+20";
        let corner = "L X+10 FMAX\nRND R2\nL Y+10\nCT X+0 Y+10\nL Y+0".replace("FMAX", &format!("F{feed}"));
        let blocks = format!("{shift}\nL X+0 Y+0 Z+20 R0 FMAX M101\n{corner}\n{corner}\n{corner}");
        let mut rig = started(passes(&blocks, [5.0, 0.0], Some(3)));
        assert_eq!(change(&mut rig), 3);
        let axes = rig.control.snapshot().axes;
        let [x, y] = [axes[0].nominal, axes[1].nominal];
        // After the rounding, the arc, and the last line.
        let ends = [[30.0, 2.0], [20.0, 10.0], [20.0, 0.0]];
        let near = |end: &[f64; 2]| (end[0] - x).hypot(end[1] - y) < 0.001;
        assert!(ends.iter().any(near), "F{feed}: {x} {y}");
        confirm(&mut rig);
        to_the_end(&mut rig);
    }
}

/// Functions for which the program waits are in each block: no block after it is known where one ends.
#[test]
fn blocks_with_functions_let_the_tool_be_replaced() {
    let blocks = PASSES
        .replacen("F60", "F60 M8", 1)
        .replace("\nL X+0\n", "\nL X+0 M9\n");
    let blocks = blocks.replace("L X+5\n", "L X+5 M8\n");
    let mut rig = started(passes(&blocks, [5.0, 0.0], Some(3)));
    assert_eq!(change(&mut rig), 3);
    let x = tip(&rig)[0];
    assert!(x == 0.0 || x == 5.0, "at the end of a block: {x}");
    confirm(&mut rig);
    to_the_end(&mut rig);
}

/// The block after the one in which the life ends calls tool 1: it is the only change, and none of M101. With a function
/// in the block the call is not read yet when it ends.
#[test]
fn a_worn_tool_is_changed_once_where_the_next_block_calls_one() {
    for function in ["", " M8"] {
        let blocks =
            format!("L X+0 Y+0 Z+20 R0 FMAX M101\nL X+8 R0 F60{function}\nTOOL CALL 1 Z S500\nL X+0 F600");
        let mut rig = started(passes(&blocks, [5.0, 0.0], Some(3)));
        rig.until(60.0, "a tool is asked for", |rig| rig.bit("M2046"));
        assert_eq!((rig.number("W262"), rig.bit("M2404")), (1, false), "`{function}`");
        confirm(&mut rig);
        to_the_end(&mut rig);
        assert_eq!(rig.control.tool(), 1);
    }
}

/// In single block the change and the way back are blocks; each takes its start.
#[test]
fn replaced_in_single_block() {
    let mut rig = started(passes(PASSES, [5.0, 0.0], Some(3)));
    rig.until(60.0, "the life is over", |rig| counted(rig) > 5.0);
    assert!(!rig.bit("M2046"), "in the midst of a block");
    rig.command("mode single");
    assert_eq!(change(&mut rig), 3);
    confirm(&mut rig);
    for z in [30.0, 20.0] {
        rig.until(5.0, "the block ends", |rig| {
            rig.control.snapshot().run == RunState::BlockEnd
        });
        assert_eq!(tip(&rig)[1], z);
        rig.start();
        rig.seconds(0.3);
    }
}

/// A change that is broken off by INTERNAL STOP did not happen: tool 2 is in the spindle, and the next start calls tool 3
/// again, at the latest after the block that it begins with. NC stop and EMERGENCY STOP only hold the path.
#[test]
fn a_change_that_is_broken_off() {
    let blocks = format!("{PASSES}\nL X+5\nL X+0");
    let mut rig = started(passes(&blocks, [5.0, 0.0], Some(3)));
    change(&mut rig);
    let [x, _] = tip(&rig);
    let z = rig.machine_position('Z');
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    assert!(rig.bit("M2046"), "the PLC goes on with the change");
    rig.command("stop");
    rig.seconds(0.5);
    assert!(!rig.bit("M2046"));
    assert_eq!((rig.control.snapshot().tool, tip(&rig)), (2, [x, 20.0]));
    rig.start();
    assert_eq!(change(&mut rig), 3);
    assert!(
        (rig.machine_position('Z') - z).abs() < 1e-6,
        "at the depth of tool 2"
    );
    // EMERGENCY STOP in the change: afterwards it is done and the path goes on.
    rig.event("emergency press");
    rig.seconds(0.5);
    assert_eq!(rig.control.snapshot().tool, 2);
    rig.event("emergency release");
    rig.seconds(0.5);
    while !rig.messages().is_empty() {
        rig.command("ce");
        rig.seconds(0.1);
    }
    rig.seconds(2.0);
    rig.start();
    rig.until(5.0, "it goes on", |rig| {
        rig.control.snapshot().run == RunState::Running
    });
    rig.until(60.0, "the PLC has changed it", |rig| {
        rig.control.snapshot().tool == 3
    });
    rig.until(30.0, "the tool comes down", |rig| {
        (tip(rig)[1] - 20.0).abs() < 1e-6
    });
    to_the_end(&mut rig);
}

/// INTERNAL STOP on the way back: the next start begins with that way, for the blocks after it count on the depth.
#[test]
fn the_way_back_is_made_up_for() {
    let mut rig = started(passes(PASSES, [5.0, 0.0], Some(3)));
    change(&mut rig);
    confirm(&mut rig);
    rig.until(5.0, "it comes down", |rig| tip(rig)[1] < 29.0);
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    let [x, z] = tip(&rig);
    assert!(z > 20.5, "on the way: {z}");
    rig.command("stop");
    rig.start();
    rig.until(10.0, "the next block", |rig| (tip(rig)[0] - x).abs() > 0.01);
    assert!((tip(&rig)[1] - 20.0).abs() < 1e-6);
    to_the_end(&mut rig);
    assert_eq!(rig.control.snapshot().tool, 3);
}

/// The change is kept before its strobe falls: who finds the state of any moment finds the tool that is in the spindle.
#[test]
fn the_change_is_kept_before_the_strobe_falls() {
    let mut rig = started(passes(PASSES, [5.0, 0.0], Some(3)));
    rig.control.keep_state(true);
    while !(rig.bit("M2046") && rig.bit("M2404")) {
        assert!(rig.control.time_us() < 200_000_000, "the tool is called");
        rig.control.stored();
        rig.cycle();
    }
    assert_eq!(rig.control.remember().tool, 2);
    rig.control.stored();
    rig.seconds(0.5);
    rig.event("key CONFIRM tap");
    rig.seconds(5.0);
    assert!(rig.bit("M2046"), "nothing was stored");
    assert_eq!(rig.control.remember().tool, 3);
    // Power fails here: tool 3 is in the spindle afterwards, and tool 2 as worn as it was.
    let mut again = passes(PASSES, [5.0, 0.0], Some(3));
    again.remembered = rig.control.remember();
    let again = again.rig();
    assert_eq!(again.control.snapshot().tool, 3);
    assert!(counted(&again) > 5.0);
    rig.control.stored();
    rig.seconds(0.1);
    assert!(!rig.bit("M2046"));
}

/// A block scan passes M101 without a change; the run after it replaces the worn tool.
#[test]
fn a_block_scan_passes_m101() {
    let build = passes(PASSES, [5.0, 0.0], Some(3)).mp("7680=%0000110");
    let build = with_tool(build, 2, |tool| tool.life.current_min = 6.0);
    let mut rig = build.rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select LIFE.H");
    rig.command("restore-at 4");
    confirm(&mut rig);
    assert_eq!((rig.control.snapshot().tool, rig.bit("M2404")), (2, false));
    rig.seconds(1.0);
    assert!(!rig.bit("M2046"));
    rig.command("restore-position");
    rig.seconds(0.1);
    rig.start();
    rig.until(30.0, "the contour", |rig| !rig.bit("M2019"));
    rig.seconds(0.3);
    rig.start();
    assert_eq!(change(&mut rig), 3);
    confirm(&mut rig);
    to_the_end(&mut rig);
}

/// The spindle of the mill turns again as before, and at its speed, before the program goes on.
#[test]
fn the_spindle_turns_again() {
    let mut rig = started(passes(&PASSES.replace("M101", "M3 M101"), [5.0, 0.0], Some(3)));
    rig.until(20.0, "the spindle turns", |rig| rig.bit("M2485"));
    change(&mut rig);
    rig.seconds(0.5);
    assert!(!rig.bit("M2485"), "not while the tool is changed");
    rig.event("key CONFIRM tap");
    rig.until(20.0, "the strobe falls", |rig| !rig.bit("M2046"));
    assert!(rig.bit("M2485") && rig.bit("I10"), "at its speed");
    to_the_end(&mut rig);
}
