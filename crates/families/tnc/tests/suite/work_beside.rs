//! A contour that takes long to compute does not hold the machine: whoever drives it computes beside.

use crate::support::*;
use bahn_tnc::RunState;

/// A square of 20 mm to be cleared by cycle 6.
const PROGRAM: &str = "TOOL DEF 1 L+0 R+3
TOOL CALL 1 Z S1000
CYCL DEF 14.0 CONTOUR GEOMETRY
CYCL DEF 14.1 CONTOUR LABEL 1
CYCL DEF 6.0 ROUGH-OUT
CYCL DEF 6.1 SET UP -2 DEPTH -5
CYCL DEF 6.2 PECKG -5 F100 ALLOW +0
CYCL DEF 6.3 ANGLE +0 F500
L X+200 Y+120 R0 FMAX
CYCL CALL
L X+210 R0 FMAX M2
LBL 1
L X+190 Y+110 RL
L X+210
L Y+130
L X+190
L Y+110
LBL 0";

fn started(beside: bool) -> Rig {
    let mut build = Build::mill().program("1.H", PROGRAM);
    build.tools = None;
    let mut rig = build.rig();
    rig.power_on();
    if beside {
        rig.control.defer_work();
    }
    rig.control.keep_path(true);
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig
}

/// The ends of all elements that were read until the run has ended.
fn ends(rig: &mut Rig) -> Vec<[u64; 2]> {
    let mut ends = Vec::new();
    for _ in 0..200_000 {
        rig.cycle();
        if let Some(work) = rig.control.take_work() {
            rig.control.finish_work(work.compute());
        }
        let path = rig.control.take_path(0).into_iter();
        ends.extend(
            path.map(|element| {
                [bahn_path::Axis::X, bahn_path::Axis::Y].map(|axis| element.end[axis].to_bits())
            }),
        );
        if rig.control.has_ended() {
            return ends;
        }
    }
    panic!("it does not end: {:?}", rig.messages())
}

/// Computed beside, the path is the same, bit by bit.
#[test]
fn the_path_is_the_same() {
    let own = ends(&mut started(false));
    assert!(own.len() > 10, "{}", own.len());
    assert_eq!(ends(&mut started(true)), own);
}

/// While it is computed the cycles go on: the run waits, and the operator can break it off; what comes out then
/// has no effect, and the next start computes it anew.
#[test]
fn the_machine_goes_on_meanwhile() {
    let mut rig = started(true);
    let mut work = None;
    for _ in 0..100_000 {
        rig.cycle();
        work = rig.control.take_work();
        if work.is_some() {
            break;
        }
    }
    let work = work.expect("the contour is to be computed");
    rig.seconds(20.0);
    assert_eq!(rig.control.run_state(), RunState::Running);
    assert!(rig.control.stands() && rig.control.take_work().is_none());
    rig.event("key NC_STOP tap");
    rig.seconds(0.2);
    rig.command("stop");
    assert_eq!(rig.control.run_state(), RunState::Idle);
    rig.control.finish_work(work.compute());
    rig.start();
    let again = ends(&mut rig);
    assert!(again.len() > 10, "{}", again.len());
}
