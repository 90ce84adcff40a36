//! Monitoring of the axes: which message, what the machine does, what clears it [000:5160-5318]
//! [000:3288-3328].

use crate::support::bench::*;
use crate::support::*;
use bahn_tnc::RunState;

/// A bench on which X is braked when its drive has no power: 1 m/s².
fn braked() -> Build {
    bench("").plant("[axis.X]", "[axis.X]\nbrake = 1")
}

/// X runs with manual feed or in rapid traverse when something fails; what is shown then, and whether it
/// flashes.
fn fails(build: Build, rapid: bool, fault: &str) -> (Rig, Vec<(String, bool)>) {
    let mut rig = build.ready();
    if rapid {
        rig.event("key RAPID press");
    }
    rig.event("key X- press");
    rig.seconds(0.3);
    rig.event(fault);
    rig.seconds(0.5);
    let shown = rig.control.snapshot().messages;
    let messages = shown
        .iter()
        .map(|shown| (rig.control.message_text(&shown.message), shown.flashing))
        .collect();
    (rig, messages)
}

/// Faults that flash switch the control voltage off; CE does nothing.
fn off_for_good(mut rig: Rig) {
    assert!(!rig.machine.control_voltage(), "X41/34 is off");
    assert!(!rig.control.snapshot().axes.iter().any(|axis| axis.closed));
    rig.control.command("ce".parse().unwrap());
    assert!(rig.control.snapshot().messages.iter().any(|shown| shown.flashing));
    rig.seconds(0.5);
    close(rig.speed('X'), 0.0, 1.0);
}

/// The drive is dead: the axis does not move as its voltage says, C [000:5266-5287].
#[test]
fn dead_drive() {
    let (rig, messages) = fails(braked(), false, "fault drive X dead");
    assert_eq!(messages[0], ("GROSS POSITIONING ERROR X C".to_owned(), true));
    off_for_good(rig);
}

/// Without movement monitoring (MP1140 = 10) the lag grows beyond MP1710 first: POSITIONING ERROR, the axis
/// is stopped; then beyond MP1720 if it is not.
#[test]
fn lag_of_a_dead_drive() {
    let (rig, messages) = fails(
        braked().mps("1140.0=10 1110.0=30 1720.0=20"),
        true,
        "fault drive X dead",
    );
    assert_eq!(messages[0], ("POSITIONING ERROR X".to_owned(), false));
    assert!(rig.axis('Y').closed);
}

/// With MP1720 close to MP1710 the ramp that follows crosses it: A, flashing [000:5200-5206].
#[test]
fn gross_lag() {
    let (rig, messages) = fails(
        braked().mps("1140.0=10 1110.0=30 1710.0=4 1720.0=4.2"),
        true,
        "fault drive X dead",
    );
    let gross = ("GROSS POSITIONING ERROR X A".to_owned(), true);
    assert!(messages.contains(&gross), "{messages:?}");
    off_for_good(rig);
}

/// A drive that runs away at standstill: D [000:5289-5300].
#[test]
fn runaway() {
    let mut rig = bench("").ready();
    rig.settle();
    rig.event("fault drive X runaway");
    rig.seconds(0.5);
    assert_eq!(rig.messages(), ["GROSS POSITIONING ERROR X D"]);
    off_for_good(rig);
}

/// A, B: amplitude and edges of the encoder, if MP31 and MP32 watch them [000:3288-3328].
#[test]
fn encoder_signals() {
    for (kind, letter) in [("amplitude", 'A'), ("edges", 'B')] {
        let (rig, messages) = fails(braked(), false, &format!("fault encoder X {kind}"));
        assert_eq!(
            messages,
            [(format!("MEASURING SYSTEM X DEFECTIVE {letter}"), true)]
        );
        off_for_good(rig);
    }
    // Not watched: the count stands still, and the axis is found not to move.
    let (_, messages) = fails(braked().mps("31=0 32=0"), false, "fault encoder X amplitude");
    assert_eq!(messages[0].0, "GROSS POSITIONING ERROR X C");
}

/// CE clears POSITIONING ERROR; the axis stays where it is and can be moved again [000:5194-5198].
#[test]
fn ce_clears_positioning_error() {
    let mut rig = braked().mps("1140.0=10 1110.0=30 1720.0=20").ready();
    rig.event("key RAPID press");
    rig.event("key X- press");
    rig.seconds(0.3);
    rig.event("fault drive X dead");
    rig.seconds(0.3);
    assert_eq!(rig.messages(), ["POSITIONING ERROR X"]);
    assert!(rig.bit("M2190") && !rig.bit("M2191"));
    rig.event("key X- release");
    rig.event("repair X");
    rig.seconds(0.2);
    rig.command("ce");
    rig.seconds(0.05);
    let stands = rig.table('X');
    rig.seconds(1.0);
    close(rig.table('X'), stands, 0.05);
    rig.event("key X+ press");
    rig.seconds(0.2);
    assert!(rig.speed('X') > 3000.0);
    assert_eq!(rig.messages(), [""; 0]);
}

/// In a program: machine stop; after CE and NC start the axis goes back to the path and on to the end.
#[test]
fn positioning_error_in_a_program() {
    let mut rig = braked()
        .mps("1140.0=10 1110.0=30 1410.0=2 1420.0=30 4220.0=2000 4220.1=2000 4220.2=2000")
        .program("1.H", "L X+150 Y+60 R0 F1000\nL X+20 Y+100")
        .ready();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(5.0, "the run begins", |rig| rig.table('X') > 120.0);
    rig.event("fault drive X dead");
    rig.seconds(0.4);
    assert_eq!(rig.messages(), ["POSITIONING ERROR X"]);
    assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
    close(rig.speed('Y'), 0.0, 1.0);
    rig.event("repair X");
    rig.start();
    rig.seconds(0.3);
    assert_eq!(rig.control.snapshot().run, RunState::Interrupted, "not before CE");
    rig.command("ce");
    rig.start();
    rig.until(30.0, "the end", |rig| rig.control.snapshot().ended);
    rig.settle();
    close(rig.table('X'), 20.0, 0.01);
    close(rig.table('Y'), 100.0, 0.01);
    assert_eq!(rig.messages(), [""; 0]);
}

/// M2688 = 1 suppresses the monitoring; so does the input MP4130 while W522 bit 0 is 1 [000:5162-5188].
#[test]
fn monitoring_can_be_suppressed() {
    let marker = "       L I30\n       = M2688\n";
    let input = "       L K+1\n       = W522\n";
    for (program, forced) in [(marker, true), (input, true), (marker, false), (input, false)] {
        let mut rig = bench(program).mps("4130=30 4131=1").ready();
        rig.input("I30", forced);
        rig.settle();
        rig.event("fault drive X dead");
        rig.event("force X 0.05");
        rig.seconds(1.0);
        let expected: &[&str] = if forced {
            &[]
        } else {
            &["GROSS POSITIONING ERROR X D"]
        };
        assert_eq!(rig.messages(), expected);
    }
}

/// Feed pre-control: an axis whose drive cannot follow needs more than 10 V, B [000:5258-5264].
#[test]
fn voltage_beyond_ten_volts() {
    let mut rig = braked()
        .mps("1140.0=10 1110.0=30 1410.0=30 1420.0=30 1050.0=9 1510.0=2")
        .program("1.H", "L X+20 R0 FMAX")
        .ready();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(5.0, "full speed", |rig| rig.speed('X') < -5000.0);
    rig.event("fault drive X dead");
    rig.seconds(0.3);
    assert_eq!(rig.messages()[0], "GROSS POSITIONING ERROR X B");
}

/// C: the distance-coded marks contradict the position (MP30) [000:3293].
#[test]
fn contradicting_marks() {
    let mut rig = bench("")
        .plant(
            "input = \"X1\"\nperiod_um = 20\nmark = 100",
            "input = \"X1\"\nperiod_um = 20\nmarks_coded = 20",
        )
        .mps("30=1 1350.0=3 960.0=0")
        .ready();
    rig.event("fault encoder X marks");
    rig.event("key X+ press");
    rig.until(8.0, "a wrong mark", |rig| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["MEASURING SYSTEM X DEFECTIVE C"]);
}

/// POSITIONING ERROR leaves a residual voltage; MP1150 later, here 1 s, it is 0 V and the actual position is
/// the nominal one [000:5240-5242].
#[test]
fn residual_voltage() {
    let mut rig = braked().mps("1140.0=10 1110.0=30 1720.0=20 1150=1").ready();
    rig.event("key RAPID press");
    rig.event("key X- press");
    rig.seconds(0.3);
    rig.event("fault drive X dead");
    rig.until(1.0, "the error", |rig| !rig.messages().is_empty());
    let volts = |rig: &Rig| rig.control.observe(&"X.volts".parse().unwrap());
    rig.seconds(0.9);
    assert!(volts(&rig) < -1.0, "{}", volts(&rig));
    rig.seconds(0.2);
    assert_eq!(volts(&rig), 0.0);
    assert_eq!(rig.messages(), ["POSITIONING ERROR X"]);
}
