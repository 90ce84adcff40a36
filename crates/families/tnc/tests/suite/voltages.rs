//! Output S for lasers and water jets: M200 to M204 with MP3011 = 3 [000:9841-9909].

use crate::stand::*;
use crate::support::Rig;
use bahn_tnc::RunState;

/// Voltage of output S.
fn volts(rig: &Rig) -> f64 {
    rig.machine.spindle().unwrap().volts
}

/// The manual's characteristics 1 and 2 [000:9876-9890]; the axes begin at X50.
fn laser(blocks: &str) -> Rig {
    let table = [
        (0, 0.0),
        (25, 0.0),
        (500, 4.5),
        (1000, 9.999),
        (0, 0.0),
        (10_000, 9.999),
    ];
    let mut build = bench(ACKNOWLEDGE).mp("3010=0").mp("3011=3");
    for (index, (velocity, volts)) in table.into_iter().enumerate() {
        build = build
            .mp(&format!("3013.{index}={velocity}"))
            .mp(&format!("3014.{index}={volts}"));
    }
    ready(build.program("1.H", blocks))
}

/// Runs until X is beyond a place.
fn until_x(rig: &mut Rig, x: f64) {
    rig.until(5.0, "the place", |rig| nominal(rig, 'X') >= x);
    rig.cycle();
}

fn is(rig: &Rig, expected: f64, tolerance: f64) {
    let volts = volts(rig);
    assert!((volts - expected).abs() <= tolerance, "{volts} V, not {expected}");
}

/// One block after the other at 50 mm/s: what is seen a cycle later is 0.15 mm further.
#[test]
fn m200_to_m204() {
    let mut rig = laser(
        "L X+60 R0 F3000\nL X+70 M200 V2.5\nL X+90 M201 V7.5\nL X+100\nL X+110 F750 M202 FNR.1\n\
         L X+120 F3000\nL X+130 M202 FNR.2\nL X+150 M203 V8 TIME0.2\nL X+180 M204 V1 TIME0.1",
    );
    is(&rig, 0.0, 0.0);
    rig.start();
    until_x(&mut rig, 58.0);
    is(&rig, 0.0, 0.0);
    until_x(&mut rig, 61.0);
    is(&rig, 2.5, 1e-9);
    // Half the way from X70 to X90: half the way from 2.5 to 7.5 V, 0.25 V a millimetre.
    until_x(&mut rig, 80.0);
    is(&rig, 5.0, 0.25 * 0.4);
    until_x(&mut rig, 95.0);
    is(&rig, 7.5, 1e-9);
    // 750 mm/min: 4.5 + 5.499 * 250 / 500.
    until_x(&mut rig, 105.0);
    is(&rig, 7.2495, 1e-6);
    // Beyond the last point its voltage.
    until_x(&mut rig, 117.0);
    is(&rig, 9.999, 1e-9);
    // 3000 of 10 000 mm/min.
    until_x(&mut rig, 127.0);
    is(&rig, 2.9997, 1e-6);
    // 0.1 s after X130: half the way to 8 V; 5 V in 0.2 s are 0.075 V a cycle, and two of them have passed.
    until_x(&mut rig, 135.0);
    is(&rig, 0.5 * (2.9997 + 8.0), 0.16);
    until_x(&mut rig, 145.0);
    is(&rig, 8.0, 1e-9);
    until_x(&mut rig, 152.0);
    is(&rig, 1.0, 1e-9);
    until_x(&mut rig, 156.0);
    is(&rig, 0.0, 0.0);
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
}

/// NC stop: the voltage by the way stands, that by the velocity follows it down; EMERGENCY STOP takes it away.
#[test]
fn stops() {
    let mut rig = laser("L X+150 R0 F3000 M201 V9");
    rig.start();
    until_x(&mut rig, 100.0);
    rig.event("key NC_STOP tap");
    rig.until(2.0, "it stands", |rig| {
        rig.control.snapshot().run == RunState::Interrupted
    });
    rig.seconds(0.5);
    let stands = 9.0 * (nominal(&rig, 'X') - 50.0) / 100.0;
    is(&rig, stands, 1e-5);
    rig.event("emergency press");
    rig.seconds(0.1);
    is(&rig, 0.0, 0.0);

    let mut rig = laser("L X+150 R0 F3000 M202 FNR.2");
    rig.start();
    until_x(&mut rig, 100.0);
    is(&rig, 2.9997, 1e-6);
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    is(&rig, 0.0, 1e-9);
}

/// Without MP3011 = 3 the functions are not there; a characteristic that MP3013 does not have and a voltage beyond
/// the range are wrong entries.
#[test]
fn wrong_entries() {
    for (blocks, message) in [
        ("L X+60 R0 F3000 M202 FNR.3", "ENTRY VALUE INCORRECT"),
        ("L X+60 R0 F3000 M200 V10", "ENTRY VALUE INCORRECT"),
        ("L X+60 R0 F3000 M203 V1", "ENTRY VALUE INCORRECT"),
        ("L X+60 R0 F3000 M204 V1 TIME2", "ENTRY VALUE INCORRECT"),
    ] {
        let mut rig = laser(blocks);
        rig.start();
        rig.seconds(1.0);
        let messages = rig.messages();
        assert!(
            messages.iter().any(|text| text.contains(message)),
            "{blocks}: {messages:?}"
        );
        near(nominal(&rig, 'X'), 50.0);
    }
    let mut rig = ready(
        bench(ACKNOWLEDGE)
            .mp("3010=0")
            .program("1.H", "L X+60 R0 F3000 M200 V1"),
    );
    rig.start();
    rig.seconds(1.0);
    assert!(!rig.messages().is_empty(), "M200 without MP3011 = 3");
    is(&rig, 0.0, 0.0);
}

/// MP3011 = 2: module 9130 gives the voltage of output S, mV [000:16037-16061]. With another use of the output nothing comes
/// out, and M3171 tells the PLC.
#[test]
fn module_9130() {
    let plc = format!("{ACKNOWLEDGE}{}", call(&["K+0", "K-2500"], 9130, &[]));
    let plc = format!("{plc}       L     M3171\n       = M900\n");
    for (mp3011, expected, error) in [
        ("3011=2", -2.5, false),
        ("3011=1", 0.0, true),
        ("3011=3", 0.0, true),
    ] {
        let mut rig = ready(bench(&plc).mp("3010=0").mp(mp3011));
        rig.seconds(0.1);
        is(&rig, expected, 1e-9);
        assert_eq!(rig.bit("M900"), error, "{mp3011}");
    }
}
