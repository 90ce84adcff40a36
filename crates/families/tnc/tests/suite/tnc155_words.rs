//! Switch-on of a TNC 151/155: the words of its EMERGENCY STOP test [001:927-933], its memory test [001:2369-2371] and its
//! empty list [001:2483-2519].

use crate::support::bench::bench;
use crate::support::knee::*;
use crate::support::*;

/// Waiting for the voltage, ready, lost by an external cause: steady, and cleared with CE when it is back.
#[test]
fn the_switch_on_test_in_its_own_words() {
    let mut rig = knee("").rig();
    rig.event("voltage off");
    rig.command("ce");
    rig.until(3.0, "the control waits", |rig| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["RELAY EXT-DC VOLTAGE MISSING"]);
    rig.event("voltage on");
    rig.until(10.0, "it is ready", |rig| rig.control.loops_closed());
    assert_eq!(rig.messages(), [""; 0]);
    rig.event("emergency press");
    rig.seconds(1.0);
    assert_eq!(rig.messages(), ["EMERGENCY STOP"]);
    assert!(!rig.control.shown()[0].fault().row().flashes(), "steady");
    rig.event("emergency release");
    rig.seconds(0.5);
    rig.command("ce");
    rig.until(5.0, "the loops are closed again", |rig| {
        rig.control.loops_closed()
    });
    assert_eq!(rig.messages(), [""; 0]);
}

/// A relay that does not fall within 200 ms [001:929].
#[test]
fn a_relay_that_is_late() {
    let mut rig = knee("").rig();
    rig.event("fault relay welded");
    rig.command("ce");
    rig.until(5.0, "the test fails", |rig| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["EMERGENCY STOP DEFECTIVE"]);
}

/// RAM and checksum are tested at the next power-on, unless MP92 has +4 and +8; MP7690 of the later controls has bits 0
/// and 1 [001:3277-3281] [000:6976-6986].
#[test]
fn the_memory_is_tested_at_power_on() {
    let of_155 = |mp92: u8| knee("").mps(&format!("92={mp92}"));
    let of_415 = |mp7690: u8| bench("").mps(&format!("7690={mp7690}"));
    let (ram, checksum) = ("MEMORY TEST: RAM DEFECTIVE", "MEMORY TEST: CHECKSUM ERROR");
    for (build, fault, expected) in [
        (of_155(1), "memory", ram),
        (of_155(1), "memory eprom", checksum),
        (of_155(1 + 4), "memory", ""),
        (of_155(1 + 4), "memory eprom", checksum),
        (of_155(1 + 8), "memory eprom", ""),
        (of_415(0), "memory", ram),
        (of_415(1), "memory", ""),
        (of_415(2), "memory eprom", ""),
    ] {
        let mut rig = build.rig();
        rig.seconds(0.1);
        rig.event(&format!("fault {fault}"));
        rig.seconds(1.0);
        let said = |rig: &Rig| rig.messages().into_iter().find(|text| text.contains("MEMORY"));
        assert_eq!(said(&rig), None, "the control is on: it was tested");
        rig.command("power off");
        rig.seconds(0.1);
        rig.command("power on");
        rig.seconds(0.1);
        assert_eq!(said(&rig).unwrap_or_default(), expected, "{fault}");
        if !expected.is_empty() {
            assert!(
                !rig.control.command("ce".parse().unwrap()) || said(&rig).is_some(),
                "it flashes"
            );
        }
    }
}

/// Code number 531210: M1000 to M2000 and the machine parameters are erased; after CE the control asks for MP0.
#[test]
fn code_531210_erases_the_machine_parameters() {
    let mut rig = asked(knee("       L     I30\n       S     M1500\n       S     M900\n"));
    rig.input("I30", true);
    rig.scan();
    rig.input("I30", false);
    rig.scan();
    assert!(rig.bit("M1500") && rig.bit("M900"));
    rig.command("code 531210");
    rig.seconds(0.1);
    assert_eq!(rig.messages(), ["OPERATING PARAMTERS ERASED"]);
    let list = rig.control.first().edited_list().clone();
    assert_eq!(list.get(0, 0), Some(180.0), "the least of its range");
    assert!(!rig.bit("M1500"));
    rig.command("ce");
    assert_eq!(rig.messages(), ["MACHINE PARAMETER MP0 ?"]);
}
