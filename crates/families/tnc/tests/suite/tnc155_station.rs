//! Programming station, MP170 = 1 or 2 of a TNC 151/155: it requires no transducers or external circuitry [001:1637-1641].

use crate::support::bench::close;
use crate::support::knee::*;
use crate::support::*;
use bahn_tnc::Mode;

/// A control without a machine: no relay of the control voltage, no axis, buttons alone.
fn desktop(mp170: u8) -> Rig {
    let mut build = knee("").mps(&format!("170={mp170} 44=300 45=-300 46=300 47=-300"));
    if mp170 == 2 {
        // A PLC program that lets nothing move.
        build.plc = "       EM\n".to_owned();
    }
    let program = "TOOL CALL 0 Z S1000\nL X+40 Y+20 R0 F3000 M3\nL X+0 Y+10";
    let mut rig = build.program("1", program).rig();
    // Nothing is connected but the buttons.
    rig.event("voltage off");
    for axis in ['X', 'Y', 'Z'] {
        rig.event(&format!("fault encoder {axis} amplitude"));
    }
    rig.command("ce");
    rig.seconds(2.0);
    rig
}

#[test]
fn a_station_runs_programs_in_the_nominal_positions() {
    for mp170 in [1, 2] {
        let mut rig = desktop(mp170);
        assert_eq!(rig.messages(), [""; 0], "MP170 = {mp170}");
        assert_eq!(rig.control.mode(), Mode::Manual, "no mark is asked for");
        rig.command("mode full");
        rig.command("select 1");
        rig.start();
        let mut most = 0.0_f64;
        let end = rig.control.time_us() + 20_000_000;
        while !rig.control.has_ended() {
            assert!(rig.control.time_us() < end, "{:?}", rig.control.snapshot());
            rig.cycle();
            most = most.max(rig.machine_position('X'));
        }
        close(most, 40.0, 0.002);
        close(rig.machine_position('X'), 0.0, 0.002);
        close(rig.machine_position('Y'), 10.0, 0.002);
        assert_eq!(rig.table('X'), 50.0, "no machine moves");
        assert_eq!(rig.messages(), [""; 0], "MP170 = {mp170}");
    }
}

/// The direction buttons move the axes by hand.
#[test]
fn direction_buttons_move_the_axes() {
    for mp170 in [1, 2] {
        let mut rig = desktop(mp170);
        rig.event("key Y- press");
        rig.seconds(1.0);
        rig.event("key Y- release");
        rig.settle();
        assert!((-21.0..-15.0).contains(&rig.machine_position('Y')));
    }
}

/// MP170 = 0 without a machine: the control waits for the voltage.
#[test]
fn a_control_needs_its_machine() {
    let rig = desktop(0);
    let mut rig = rig;
    for axis in ['X', 'Y', 'Z'] {
        rig.event(&format!("repair {axis}"));
    }
    rig.seconds(10.0);
    assert!(!rig.control.loops_closed());
}
