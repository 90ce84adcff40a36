//! Lubrication, lag tracking, offset adjustment, changed machine parameters [000:3565-3620]
//! [000:3900-3929] [000:5002-5072].

use crate::support::bench::*;
use crate::support::*;

/// The manual's example: MP4060.0 = 1 (65.536 mm), MP4110.0 = 100. The way counts both directions; then
/// M2012 = 1, in the same PLC cycle T0 starts and M2548 = 1; the NC clears the sum; O24 is on for 100 PLC
/// cycles [000:3600-3620].
#[test]
fn lubrication() {
    let program = "
       L M2012
       = T0
       = M2548
       L T48
       = O24
";
    let mut rig = bench(program).mps("4060.0=1 4110.0=100").ready();
    // 52.8 mm in the reference run; 12.736 mm are left.
    rig.event("key X- press");
    rig.until(2.0, "the pulse", |rig| rig.bit("M2012"));
    close(rig.table('X'), 102.8 - 12.736, 0.5);
    assert!(rig.bit("M2548"), "in the same PLC cycle");
    rig.until(0.05, "O24", |rig| rig.bit("O24"));
    rig.event("key X- release");
    let mut cycles = 0;
    let begin = rig.control.time_us();
    while rig.bit("O24") {
        rig.cycle();
        cycles += 1;
        assert!(cycles < 10_000);
    }
    // 100 cycles of 20 ms, seen in contour cycles of 3 ms.
    close((rig.control.time_us() - begin) as f64 / 1000.0, 2000.0, 20.0);
    assert!(
        !rig.bit("M2012") && !rig.bit("M2548"),
        "the NC reset the pulse, the PLC its answer"
    );
    rig.event("key X+ press");
    rig.seconds(2.0);
    assert!(!rig.bit("M2012"), "counted anew: 40 mm since");
    rig.event("key X+ release");
    rig.event("key X- press");
    rig.until(2.0, "65.5 mm", |rig| rig.bit("M2012"));
}

/// MP4060 = 0: never.
#[test]
fn no_lubrication() {
    let mut rig = bench("").mps("4060.0=0").ready();
    rig.event("key RAPID press");
    rig.event("key X- press");
    rig.seconds(2.0);
    assert!(!rig.bit("M2012"));
}

/// Thermal: MP4210.44 = 0.0005 is D944 = 5; 20 degrees are 40 in W506 and make 200 tenths of a µm in W578. With MP4070 = 0.0005
/// the table of Y moves 20 µm within 40 PLC cycles; the display does not change [000:3900-3929].
#[test]
fn lag_tracking() {
    let program = "
       L D944
       X W506
       = W578
";
    let mut rig = bench(program).mps("4070=0.0005 4210.44=0.0005 4410=1").ready();
    rig.event("temperature 1 0");
    rig.seconds(2.0);
    let (stood, shown) = (rig.table('Y'), rig.axis('Y').actual);
    rig.event("temperature 1 20");
    rig.seconds(0.4 + 0.1);
    assert_eq!((rig.number("W506"), rig.number("W578")), (40, 200));
    let half = rig.table('Y') - stood;
    assert!(
        half.abs() > 0.008 && half.abs() < 0.014,
        "about half of it: {half}"
    );
    rig.seconds(0.6);
    close((rig.table('Y') - stood).abs(), 0.020, 0.0005);
    close(rig.axis('Y').actual, shown, 0.0005);
}

/// An offset of 5 mV in the amplifier holds the table 5 mV / 9 V · 6000 mm/min / kv away. Each MP1220 = 2 s
/// the NC takes 1 mV of it off, while all axes stand [000:5022-5037].
#[test]
fn cyclic_offset_adjustment() {
    let mut rig = bench("")
        .plant("[axis.X]", "[axis.X]\noffset_mv = 5")
        .mps("1220=2")
        .ready();
    rig.settle();
    let lag = |rig: &Rig| rig.axis('X').lag.abs();
    let begin = lag(&rig);
    close(begin, 5.0 / 9000.0 * 6000.0 / 2000.0, 0.001);
    rig.seconds(4.1);
    close(lag(&rig), begin * 3.0 / 5.0, 0.0005);
    // Not while an axis moves.
    rig.event("key Y- press");
    let before = lag(&rig);
    rig.seconds(4.5);
    close(lag(&rig), before, 0.0002);
    rig.event("key Y- release");
    rig.seconds(20.0);
    assert!(lag(&rig) < 0.0003, "{}", lag(&rig));
    let volts = rig.control.remember().offsets_volts[0];
    close(volts, -0.005, 0.0003);
}

/// Not while an axis is clamped, nor with MP1220 = 0.
#[test]
fn no_adjustment_of_clamped_axes() {
    for (mp1220, clamped) in [(2, true), (0, false)] {
        let mut rig = bench("       L I28\n       = M2545\n")
            .plant("[axis.X]", "[axis.X]\noffset_mv = 5")
            .mp(&format!("1220={mp1220}"))
            .ready();
        rig.input("I28", clamped);
        rig.settle();
        let before = rig.axis('X').lag.abs();
        rig.seconds(10.0);
        close(rig.axis('X').lag.abs(), before, 0.0002);
    }
}

/// Code 75 368 shows the offsets in units of 0.15 mV; ENT compensates them at once, NO ENT takes the
/// compensation off [000:5014-5020]. What was compensated survives power-off.
#[test]
fn offset_by_code_number() {
    let build = || bench("").plant("[axis.X]", "[axis.X]\noffset_mv = 5");
    let mut rig = build().ready();
    rig.settle();
    assert_eq!(rig.control.offsets_shown(), None);
    rig.command("code 75368");
    // 5 mV / 0.1526 mV = 32.8.
    let units = rig.control.offsets_shown().unwrap()[0].abs();
    assert!((32..=33).contains(&units), "{units}");
    rig.command("offset adjust");
    rig.settle();
    assert!(rig.axis('X').lag.abs() < 0.0002);
    assert!(
        !rig.control.command("offset adjust".parse().unwrap()),
        "the dialogue is closed"
    );
    let remembered = rig.control.remember();
    let mut build = build();
    build.remembered = remembered;
    let mut rig = build.ready();
    rig.settle();
    assert!(rig.axis('X').lag.abs() < 0.0002, "as before power-off");
    rig.command("code 75368");
    rig.command("offset off");
    rig.settle();
    close(rig.axis('X').lag.abs(), 5.0 / 3000.0, 0.0002);
}

/// Module 9031 changes a machine parameter while the machine runs, and it takes effect: manual feed MP1020.0
/// and the software limit MP910.0.
#[test]
fn changed_parameters_take_effect() {
    let program = "
       L I28
       AN M80
       IFT
       LN I28
       = M81
       ENDI
       L I28
       AN M80
       CMT 50
       L I28
       = M80
LBL 50
       SUBM 60
       = B200
       EM
LBL 60
       PS K+1020
       PS K+0
       PS K+600
       CM 9031
       PL B201
       PS K+910
       PS K+0
       PS K+1200000
       CM 9031
       PL B202
       EM
";
    let mut rig = bench(program).ready();
    rig.event("key X+ press");
    rig.seconds(0.3);
    close(rig.speed('X'), 1200.0, 5.0);
    rig.input("I28", true);
    rig.seconds(0.4);
    assert_eq!((rig.number("B201"), rig.number("B202")), (0, 0));
    close(rig.speed('X'), 600.0, 5.0);
    rig.seconds(3.0);
    close(rig.table('X'), 120.0, 0.005);
}

/// A machine parameter that the PLC may change while a program runs counts for the blocks that are not yet read: during
/// the strobe of M70 MP7246 disables the paraxial block after it.
#[test]
fn changed_parameters_reach_the_program() {
    let change = "
       L I28
       A M2045
       AN M80
       CMT 50
       L I28
       A M2045
       = M80
       L I28
       A M2045
       AN M83
       R M2482
       LN M2045
       R M83
LBL 50
       SUBM 60
       = B200
       EM
LBL 60
       PS K+7246
       PS K+0
       PS K+1
       CM 9031
       PL B201
       L M83
       ON M83
       S M83
       EM
";
    for changes in [false, true] {
        let mut rig = bench(change)
            .program("1.H", "L IX+1 R0 F600\nM70\nIX+1 R0")
            .ready();
        rig.command("mode full");
        rig.command("select 1.H");
        rig.input("I28", changes);
        rig.start();
        rig.seconds(2.0);
        assert_eq!((rig.number("B201"), rig.bit("M2045")), (0, false));
        assert_eq!(rig.control.has_ended(), !changes, "{:?}", rig.messages());
        assert_eq!(rig.messages().len(), usize::from(changes), "{:?}", rig.messages());
    }
}

/// Voltages come in steps of 100 mV, W496 ff. of the first extension and W464 ff. of the second, where MP4410
/// activates it [000:8449-8484].
#[test]
fn analogue_inputs_of_the_extensions() {
    let words = ["W496", "W498", "W500", "W502", "W464", "W466", "W468", "W470"];
    for (active, first) in [("%01", 0), ("%10", 4)] {
        let mut rig = bench("").mps(&format!("4410={active}")).ready();
        for input in 0..8 {
            rig.event(&format!("analogue {input} {}", f64::from(input) - 3.5));
        }
        rig.settle();
        for (at, word) in words.iter().enumerate() {
            let expected = if (first..first + 4).contains(&at) {
                (at as i32) * 10 - 35
            } else {
                0
            };
            assert_eq!(rig.number(word), expected, "{word} with MP4410 = {active}");
        }
    }
}
