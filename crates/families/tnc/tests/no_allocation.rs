//! A contour cycle allocates nothing: not while axes move, functions go to the PLC and blocks change.

mod support;

use bahn_servo::Plant;
use bahn_tnc::{Mode, RunState};
use support::*;

const PROGRAM: &str = "TOOL CALL 1 Z S1000\nL X+200 Y+100 Z+200 R0 FMAX M3\nL X+250 F2000 M8\nCC X+250 Y+150\nC X+250 Y+200 DR+\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 0.2\nL X+200 F4000 M9\nFN 19: PLC=+1/+2\nTOOL CALL S2000\nL Z+250 FMAX M5";

#[test]
fn cycles_allocate_nothing() {
    let mut rig = Build::mill()
        .program(
            "1.H",
            "TOOL CALL 1 Z S1000\nL X+200 Y+100 Z+200 R0 FMAX M3\nLBL 1\nL IX+10 F3000\nL IY+5 M8\nCC IX+0 IY+5\n\
             C IX+0 IY+10 DR+\nL IX-10 IY-15 M9\nCALL LBL 1 REP 30\nL Z+250 R0 FMAX M5",
        )
        .rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    // The first scans of the PLC take their memory.
    rig.seconds(1.0);
    let mut moved = 0;
    for _ in 0..8000 {
        rig.control.prepare();
        let allocated = allocation_counter::measure(|| rig.control.cycle(&mut rig.machine));
        assert_eq!(
            allocated.count_total,
            0,
            "{:?} {:?}",
            rig.messages(),
            rig.control.snapshot()
        );
        moved += usize::from(rig.control.snapshot().feed_mm_min > 0.0);
        let _ = rig.machine.control_ready();
    }
    assert!(moved > 1000, "{moved}");
}

/// With START, NC STOP, overrides and single block in between. Messages and what follows PLC positioning may
/// allocate; neither happens here.
#[test]
fn stops_overrides_and_the_end_allocate_nothing() {
    let mut rig = Build::mill().program("1.H", PROGRAM).rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    let mut cycles = 0u32;
    while !rig.control.snapshot().ended {
        cycles += 1;
        match cycles % 1000 {
            300 => rig.event("override feed 60"),
            500 => rig.event("key NC_STOP tap"),
            620 => rig.start(),
            700 => rig.event("override feed 120"),
            800 if rig.control.snapshot().run != RunState::Idle => rig.command("mode single"),
            900 => rig.command("mode full"),
            950 if rig.control.snapshot().run == RunState::BlockEnd => rig.start(),
            _ => {}
        }
        rig.control.prepare();
        let (control, machine) = (&mut rig.control, &mut rig.machine);
        let allocated = allocation_counter::measure(|| control.cycle(machine as &mut dyn Plant));
        assert_eq!(
            (allocated.count_total, allocated.count_current),
            (0, 0),
            "cycle {cycles}: {allocated:?} {:?}",
            rig.control.snapshot()
        );
        assert!(
            cycles < 100_000,
            "{:?} {:?}",
            rig.messages(),
            rig.control.snapshot()
        );
    }
    assert_eq!(rig.control.snapshot().mode, Mode::FullSequence);
    assert_eq!(rig.messages(), [""; 0]);
}
