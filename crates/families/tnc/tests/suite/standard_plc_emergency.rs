//! EMERGENCY STOP within a code of the standard PLC program.

use crate::support::Rig;
use crate::terminals::terminals;

/// Waits until an M or S code has gone off again.
fn code_ends(rig: &mut Rig) {
    rig.until(20.0, "the code goes off", |rig| rig.contacts(7, 8) == "00000000");
}

/// EMERGENCY STOP while the code of M13 waits for E17 takes the spindle off. With 24 V again it stays off, although the code is still
/// on the lines, until the next M function that switches it on; E17 alone ends the code, since no voltage comes up [001:548-550].
#[test]
fn emergency_stop_in_a_code_leaves_the_spindle_off() {
    for (m, line) in [(3, "A15"), (4, "A16"), (13, "A15"), (14, "A16")] {
        let blocks = format!("TOOL CALL 0 Z S3000\nL M{m}\nL M0\nL M{m}\nL M0");
        let build = terminals().mp("78=3000").mp("168=0.1");
        let mut rig = build.program("1.H", &blocks).rig();
        rig.power_on();
        rig.command("mode full");
        rig.command("select 1.H");
        rig.start();
        rig.until(2.0, "the code", |rig| rig.bit(line));
        rig.contact("completed", false);
        rig.until(2.0, "the spindle turns", |rig| {
            rig.machine.spindle().unwrap().rpm.abs() > 100.0
        });
        rig.event("emergency press");
        rig.seconds(3.0);
        rig.event("emergency release");
        rig.seconds(3.0);
        let shown = rig.messages();
        assert!(
            !shown.iter().any(|text| text.starts_with("ERROR IN PLC-PROGRAM")),
            "M{m}: {shown:?}"
        );
        assert!(rig.bit(line), "M{m}: the code waits for E17");
        assert_eq!(rig.machine.spindle().unwrap().rpm, 0.0, "M{m}");
        rig.contact("completed", true);
        code_ends(&mut rig);
        rig.command("ce");
        rig.start();
        rig.seconds(2.0);
        assert_eq!(rig.machine.spindle().unwrap().rpm, 0.0, "M{m}: at M0");
        rig.start();
        rig.until(3.0, "the next code", |rig| rig.bit(line));
        code_ends(&mut rig);
        assert!(rig.machine.spindle().unwrap().rpm.abs() > 2900.0, "M{m}");
    }
}
