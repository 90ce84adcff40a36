//! A contour cycle allocates nothing: not while axes move, functions go to the PLC and blocks change.

mod support;

use bahn_servo::Plant;
use support::*;

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
