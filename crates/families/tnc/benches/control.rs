//! The whole control in machine time: machines of `machines` with their PLC, axes and spindle, while a program
//! runs. Items are seconds of machine time: at 500 times real time there are 500 of them in a second.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a bench may fail")]

#[path = "../tests/support/mod.rs"]
mod support;

use bahn_parameters::ControlModel;
use bahn_path::ToolShape;
use bahn_tnc::Tool;
use divan::Bencher;
use divan::counter::ItemsCount;
use support::{Build, Rig};

fn main() {
    divan::main();
}

/// A zigzag of short lines in three axes that goes on for ever.
const ZIGZAG: &str = "TOOL CALL 1 Z S1000\nL X+200 Y+100 Z+200 R0 FMAX M3\nLBL 1\nL IX+5 IY+1 IZ+1 F3000\nL IX+5 IY+1 IZ-1\n\
                      L IX-10 IY-2\nCALL LBL 1 REP 65000";
/// Lines of 0.1 mm at 6 m/min: 1000 blocks a second.
const SHORT: &str = "TOOL CALL 1 Z S1000\nL X+200 Y+100 Z+200 R0 FMAX M3\nLBL 1\nL IX+0.1 IZ+0.01 F6000\nL IX+0.1 IZ-0.01\n\
                     CALL LBL 1 REP 200\nL IX-40 F6000\nLBL 2\nCALL LBL 1\nCALL LBL 2 REP 65000";

/// Tools that the magazine changes and the tool probe measures, and the rotary table with them.
const CHANGES: &str = "LBL 1\nTOOL CALL 2 Z S1000\nTCH PROBE 31.0 TOOL LENGTH\nTCH PROBE 31.1 CHECK: 1 Q5\n\
                       TCH PROBE 31.2 HEIGHT: +100\nTCH PROBE 31.3 PROBING THE TEETH: 0\n\
                       L X+200 Y+100 Z+200 R0 FMAX M3\nL IX+50 IY+10 IC+20 F3000\nL IX-50 IY-10 IC+20\n\
                       TOOL CALL 1 Z S1000\nL IX+50 IC-40 F3000 M3\nCALL LBL 1 REP 65000";

/// The mill with its magazine in use: changes, measuring, cutting and turning.
fn magazine() -> Rig {
    let tool = |pocket: u16, length: f64, radius: f64| Tool {
        shape: ToolShape {
            length,
            radius,
            ..ToolShape::default()
        },
        pocket: Some(pocket),
        ..Tool::default()
    };
    let build = Build::mill().mp("7261=12").mp("7480.0=3").mp("4310.0=3");
    let mut build = build.program("1.H", CHANGES);
    build.tools = Some([(1, tool(1, 70.0, 31.5)), (2, tool(2, 95.0, 10.0))].into());
    let mut rig = build.rig();
    rig.machine.load_magazine([(1, 1), (2, 2)].into_iter(), 0);
    rig.power_on();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(120.0, "the first tool is measured", |rig| rig.bit("M2390"));
    rig
}

/// Five axes of the gantry at once: the head swivels, M114 leads the tip, the slave follows the portal.
const SWIVELS: &str = "TOOL CALL 1 Z S1000\nL X+800 Y+400 Z+400 B+0 R0 FMAX M3\nLBL 1\nL IX+5 IY+1 IZ+1 IB+2 F3000 M114\n\
                       L IX+5 IY+1 IZ-1 IB-1\nL IX-10 IY-2 IB-1\nCALL LBL 1 REP 65000";

/// A machine that cuts.
fn cutting(build: Build, program: &str) -> Rig {
    let mut rig = build.program("1.H", program).rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    for _ in 0..60 {
        rig.seconds(0.2);
        if rig.bit("M60") {
            rig.event("key CONFIRM tap");
        }
    }
    rig.until(20.0, "it cuts", |rig| rig.control.snapshot().feed_mm_min > 100.0);
    rig
}

/// Machine time of an iteration, s: long enough for all that comes and goes, as a tool change.
const MINUTE_S: u32 = 60;

/// How many times real time each machine runs, control, PLC and simulated machine together: an item is a second of
/// machine time, so 500 items a second are 500 times real time.
#[divan::bench(args = [
    Case("mill", || cutting(mill(), ZIGZAG)),
    Case("mill with magazine and tool probe", magazine),
    Case("dig425, digital drives", || cutting(digital(), ZIGZAG)),
    Case("gantry, five axes", || cutting(gantry(), SWIVELS)),
], sample_count = 20)]
fn times_real_time(bencher: Bencher, case: Case) {
    let mut rig = (case.1)();
    let bencher = bencher.counter(ItemsCount::new(MINUTE_S));
    bencher.bench_local(|| rig.seconds(f64::from(MINUTE_S)));
    assert!(rig.messages().is_empty(), "{:?}", rig.messages());
}

/// Long lines, and lines so short that many blocks are read in a second.
#[divan::bench(args = [
    Case("mill, zigzag", || cutting(mill(), ZIGZAG)),
    Case("mill, short lines", || cutting(mill(), SHORT)),
    Case("digital drives, zigzag", || cutting(digital(), ZIGZAG)),
    Case("digital drives, short lines", || cutting(digital(), SHORT)),
], sample_count = 20)]
fn second_of_machining(bencher: Bencher, case: Case) {
    let mut rig = (case.1)();
    let bencher = bencher.counter(ItemsCount::new(1u32));
    bencher.bench_local(|| rig.seconds(1.0));
    assert!(rig.messages().is_empty(), "{:?}", rig.messages());
}

fn mill() -> Build {
    Build::mill()
}

fn gantry() -> Build {
    Build::of("gantry", ControlModel::Tnc415b)
}

fn digital() -> Build {
    Build::of("dig425", ControlModel::Tnc425)
}

/// A name and a machine that runs its program.
#[derive(Clone, Copy)]
struct Case(&'static str, fn() -> Rig);

impl std::fmt::Display for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.0)
    }
}
