//! Tool life [000:9160-9192]: what is counted, when, and what its end leads to.

use crate::support::{Build, Rig};
use bahn_plc::TableKind;
use bahn_tnc::{Remembered, ToolLife};

/// Element of the tool table: current tool life [000:15440].
const CURRENT_TIME: usize = 7;

/// The mill with lives of tool 2, which tool 3 replaces.
fn mill(life: ToolLife, blocks: &str) -> Build {
    let mut build = Build::mill().program("LIFE.H", blocks);
    if let Some(tool) = build.tools.as_mut().and_then(|tools| tools.get_mut(&2)) {
        tool.life = life;
    }
    build
}

fn life(time1_min: f64, time2_min: f64, current_min: f64, replacement: Option<u32>) -> ToolLife {
    ToolLife {
        time1_min,
        time2_min,
        current_min,
        replacement,
    }
}

/// Where the tool life counter of tool 2 stands, as it would be found after power-on.
fn counted(rig: &Rig) -> f64 {
    let written = rig.control.remember().written;
    let of_tool_2 = written
        .iter()
        .find(|row| (row.table, row.line, row.element) == (TableKind::Tool, 2, CURRENT_TIME));
    of_tool_2.map_or(0.0, |row| row.value)
}

fn on(build: Build) -> Rig {
    let mut rig = build.rig();
    rig.power_on();
    rig
}

fn start(rig: &mut Rig) {
    rig.command("mode full");
    rig.command("select LIFE.H");
    rig.start();
    confirm(rig);
}

/// The operator changes the tool.
fn confirm(rig: &mut Rig) {
    rig.until(60.0, "a tool is asked for", |rig| rig.bit("M2046"));
    rig.seconds(0.5);
    rig.event("key CONFIRM tap");
    rig.until(5.0, "the tool is changed", |rig| !rig.bit("M2046"));
    rig.seconds(0.05);
}

/// From TOOL CALL 2 to TOOL CALL 3: a dwell of 30 s with the spindle at rest, half a minute; then nothing more.
#[test]
fn from_tool_call_to_tool_call() {
    let dwell = "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 30";
    let blocks = format!("{dwell}\nTOOL CALL 2 Z S500\n{dwell}\nTOOL CALL 3 Z S500\n{dwell}");
    let mut rig = on(mill(ToolLife::default(), &blocks));
    rig.command("mode full");
    rig.command("select LIFE.H");
    rig.start();
    rig.seconds(28.0);
    assert_eq!(counted(&rig), 0.0, "no tool was called");
    confirm(&mut rig);
    rig.seconds(20.0);
    let midway = counted(&rig);
    // Counted in steps of 0.1 minutes; the spindle takes some seconds to come to its speed.
    assert!((0.2..0.4).contains(&midway), "{midway}");
    confirm(&mut rig);
    let end = counted(&rig);
    assert!((0.5..0.7).contains(&end), "{end}");
    rig.until(60.0, "the run ends", |rig| rig.control.snapshot().ended);
    assert_eq!(counted(&rig), end, "tool 3 worked");
}

/// NC stop does not stop the counter, INTERNAL STOP does [000:9181]; MDI does not count [000:9183].
#[test]
fn stops_and_manual_modes() {
    let blocks = "TOOL CALL 2 Z S500\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 300";
    let mut rig = on(mill(ToolLife::default(), blocks));
    start(&mut rig);
    rig.seconds(6.0);
    rig.event("key NC_STOP tap");
    let stopped = counted(&rig);
    rig.seconds(60.0);
    let after = counted(&rig);
    assert!((after - stopped - 1.0).abs() < 0.11, "{stopped} {after}");
    rig.command("stop");
    rig.seconds(1.0);
    let internal = counted(&rig);
    rig.seconds(60.0);
    assert_eq!(counted(&rig), internal, "INTERNAL STOP");
    rig.command("mode mdi");
    rig.command("mdi CYCL DEF 9.0 DWELL TIME\\nCYCL DEF 9.1 DWELL 60");
    rig.start();
    rig.seconds(50.0);
    assert_eq!(counted(&rig), internal, "MDI");
}

/// CUR.TIME 0.9 of TIME1 1.0: M2094 comes after 6 s and more, stays when the PLC resets it, and falls when another
/// tool is in the spindle [000:9173].
#[test]
fn time1_sets_m2094() {
    let blocks = "TOOL CALL 2 Z S500\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 40\nTOOL CALL 3 Z S500";
    let mut rig = on(mill(life(1.0, 0.0, 0.9, None), blocks));
    start(&mut rig);
    assert!(!rig.bit("M2094"));
    rig.until(14.0, "TIME1 is over", |rig| rig.bit("M2094"));
    assert!(counted(&rig) > 1.0);
    confirm(&mut rig);
    rig.seconds(0.1);
    assert!(!rig.bit("M2094"), "tool 3 is in the spindle");
}

/// CUR.TIME beyond TIME2: TOOL CALL 2 calls tool 3, and the PLC sees its number; M2404 tells a programmed call.
/// Without RT the message [000:9168-9172].
#[test]
fn time2_calls_the_replacement_tool() {
    let blocks = "TOOL CALL 2 Z S500\nL Z+100 R0 FMAX";
    let mut rig = on(mill(life(0.0, 20.0, 20.5, Some(3)), blocks));
    rig.command("mode full");
    rig.command("select LIFE.H");
    rig.start();
    rig.until(5.0, "the strobe", |rig| rig.bit("M2046"));
    assert_eq!((rig.number("W262"), rig.bit("M2404")), (3, false));
    confirm(&mut rig);
    rig.until(30.0, "the run ends", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.control.snapshot().tool, 3);
    let mut rig = on(mill(life(0.0, 20.0, 20.5, None), blocks));
    rig.command("mode full");
    rig.command("select LIFE.H");
    rig.start();
    rig.seconds(1.0);
    assert!(
        rig.messages()[0].starts_with("MAX. TOOL LIFE EXPIRED"),
        "{:?}",
        rig.messages()
    );
    // The operator enters zero [000:9185].
    rig.command("ce");
    rig.command("tool-life 2 0");
    rig.start();
    confirm(&mut rig);
    assert_eq!(rig.control.snapshot().tool, 2);
}

/// The life ends while the program runs: the next TOOL CALL 2 calls tool 3.
#[test]
fn a_life_that_ends_in_the_program() {
    let dwell = "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 20";
    let blocks =
        format!("TOOL CALL 2 Z S500\n{dwell}\nTOOL CALL 1 Z S500\nTOOL CALL 2 Z S500\nL Z+100 R0 FMAX");
    let mut rig = on(mill(life(0.0, 5.0, 4.9, Some(3)), &blocks));
    start(&mut rig);
    assert_eq!(rig.control.snapshot().tool, 2);
    confirm(&mut rig);
    assert_eq!(rig.control.snapshot().tool, 1);
    confirm(&mut rig);
    rig.until(30.0, "the run ends", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.control.snapshot().tool, 3);
}

/// What was counted is there after power-off; a tool table with another CUR.TIME counts.
#[test]
fn the_count_survives_power_off() {
    let blocks = "TOOL CALL 2 Z S500\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 30";
    let mut rig = on(mill(life(0.0, 9.0, 3.0, None), blocks));
    start(&mut rig);
    rig.until(60.0, "the run ends", |rig| rig.control.snapshot().ended);
    let before = counted(&rig);
    assert!((3.5..3.7).contains(&before), "{before}");
    let remembered: Remembered = rig.control.remember();
    let again = |current| {
        let mut build = mill(life(0.0, 9.0, current, None), blocks);
        build.remembered = remembered.clone();
        counted(&build.rig())
    };
    assert_eq!(again(3.0), before);
    assert_eq!(again(1.0), 0.0, "the table was changed");
}
