//! Rows of the operating modes: potentiometers, buttons, handwheel, probe, power-on.

use bahn_tnc::{HANDWHEEL_STEPS, Mode};

use crate::bench::{
    Probe, Row, Verdict, begin, bench, bench_with, both, duration, holds, less, pair, ready, same, signal,
    tables,
};
use crate::support::knee::asked;
use crate::terminals::terminals;
use crate::transfer::printed;

pub const ROWS: &[Row] = &[
    Row(66..=66, Probe::Acts(potentiometer)),
    Row(68..=68, Probe::Acts(latched_buttons)),
    Row(74..=74, Probe::Acts(overrides)),
    Row(92..=92, Probe::Acts(switch_on)),
    Row(167..=167, Probe::Acts(smallest_feed)),
    Row(170..=170, Probe::Acts(station)),
    Row(171..=171, Probe::Acts(handwheel)),
    Row(215..=216, Probe::Acts(probing)),
    Row(235..=235, Probe::Acts(probing)),
    Row(247..=247, Probe::Acts(hysteresis)),
    Row(251..=251, Probe::Acts(probing)),
];

/// The external potentiometer stands at 50 %: 0 neither, 1 by hand and in programs, 2 by hand [001:1403].
fn potentiometer(number: u16) -> Verdict {
    let seen = [0, 1, 2].map(|value: u8| {
        let mut rig = asked(bench(&format!("{number}={value}")));
        rig.event("analogue 0 6.6667");
        crate::support::knee::reference(&mut rig);
        rig.event("analogue 0 3.3333");
        rig.seconds(0.1);
        let by_hand = rig.control.feed_override_percent();
        rig.command("mode full");
        rig.seconds(0.1);
        [by_hand, rig.control.feed_override_percent()]
    });
    same(seen, [[100.0, 100.0], [50.0, 50.0], [50.0, 100.0]])
}

/// Start together with a direction button: with 1 the axis goes on [001:1026-1028].
fn latched_buttons(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| {
        let mut rig = terminals().mps(mps).rig();
        rig.power_on();
        rig.event("key X- press");
        rig.seconds(0.3);
        rig.event("key NC_START press");
        rig.seconds(0.2);
        rig.event("key NC_START release");
        rig.event("key X- release");
        rig.seconds(0.3);
        signal(&rig, "X.nominal-speed") != 0.0
    });
    same(seen, [false, true])
}

/// +1: the override acts with the rapid button in programs; +4: with the rapid button by hand; without +2 feeds, without +8
/// speeds go in steps of 2 % [001:3262-3265].
fn overrides(number: u16) -> Verdict {
    let in_program = |value: u8| {
        let list = format!("{number}={value}");
        let mut rig = terminals().mps(&list).program("1", "L IX+150 R0 F300").rig();
        rig.power_on();
        rig.event("override feed 50");
        begin(&mut rig);
        rig.event("key RAPID press");
        rig.seconds(0.8);
        signal(&rig, "path.speed").round()
    };
    same([0, 1].map(in_program), [10_000.0, 5_000.0])?;
    let by_hand = |value: u8| {
        let mut rig = ready(bench(&format!("{number}={value}")));
        rig.event("override feed 50");
        rig.event("key RAPID press");
        rig.event("key X- press");
        rig.seconds(0.3);
        signal(&rig, "X.nominal-speed").abs().round()
    };
    same([0, 4].map(by_hand), [6000.0, 3000.0])?;
    let percent = |value: u8| {
        let mut rig = ready(bench(&format!("{number}={value}")));
        rig.event("override feed 73");
        rig.event("override spindle 73");
        rig.seconds(0.1);
        let shown = rig.control.snapshot();
        [shown.feed_override_percent, shown.spindle_override_percent]
    };
    let [none, feed, speed] = [0, 2, 8].map(percent);
    let even = |percent: f64| percent % 2.0 == 0.0;
    holds(
        even(none[0])
            && even(none[1])
            && feed[0] == 73.0
            && even(feed[1])
            && even(speed[0])
            && speed[1] == 73.0,
        || format!("{none:?} {feed:?} {speed:?}"),
    )
}

/// Bit 0: programs are sent with a point, not a comma; +2: the dialogue is English; +4, +8: RAM, EPROM and checksum are not tested
/// [001:1923] [001:2302-2310] [001:2369-2371].
fn switch_on(number: u16) -> Verdict {
    let sent = [0, 1].map(|value: u8| {
        let bytes = printed(&format!("{number}={value}"));
        let text: String = bytes.into_iter().map(char::from).collect();
        (text.contains("X+1,5"), text.contains("X+1.5"))
    });
    same(sent, [(true, false), (false, true)])?;
    let english = [0, 2].map(|value: u8| asked(bench(&format!("{number}={value}"))).bit("M2041"));
    same(english, [false, true])?;
    for (bit, fault) in [(4, "fault memory"), (8, "fault memory eprom")] {
        let tested = [0, bit].map(|value: u8| {
            let mut rig = bench(&format!("{number}={value}")).rig();
            rig.seconds(0.1);
            rig.event(fault);
            rig.command("power off");
            rig.seconds(0.1);
            rig.command("power on");
            rig.seconds(0.1);
            rig.messages().iter().any(|text| text.contains("MEMORY TEST"))
        });
        same(tested, [true, false])?;
    }
    Ok(())
}

/// With 1 all axes jog with the smallest of MP4 to MP7, here 600 [001:1020-1024].
fn smallest_feed(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| {
        let mut rig = ready(bench("167=0 4=1200 5=600").mps(mps));
        rig.event("key X- press");
        rig.seconds(0.3);
        signal(&rig, "X.nominal-speed").abs()
    });
    pair(seen, [1200.0, 600.0], 1.0)
}

/// 0 waits for the control voltage; 1 and 2 need no machine, and run programs in the nominal positions; with 2 the PLC does not
/// run [001:1637-1641].
fn station(number: u16) -> Verdict {
    let seen = [0, 1, 2].map(|value: u8| {
        let build = bench_lamp(&format!("{number}={value}")).program("1", "L IX-2 R0 F3000");
        let mut rig = build.rig();
        rig.event("voltage off");
        rig.command("ce");
        rig.seconds(2.0);
        let manual = rig.control.mode() == Mode::Manual && rig.messages().is_empty();
        (manual, rig.bit("O20"), manual && duration(&mut rig) > 0.0)
    });
    same(
        seen,
        [(false, true, false), (true, true, true), (true, false, true)],
    )
}

/// A PLC program whose lamp O20 is always on.
fn bench_lamp(mps: &str) -> crate::support::Build {
    bench_with("       L     M2719\n       ON    M2719\n       = O20\n", mps)
}

/// How far a turn of each wheel brings the tables of the axes, after X and Y were chosen.
fn turned(mps: &str, steps: f64) -> [f64; 4] {
    let mut rig = ready(bench("171=0 247=0").mps(mps));
    rig.command("mode handwheel");
    rig.command("handwheel Y 4");
    rig.command("handwheel X 4");
    rig.seconds(0.1);
    let before = tables(&rig);
    rig.event(&format!("handwheel 1 {}", -steps));
    rig.event(&format!("handwheel 2 {}", -steps));
    rig.seconds(0.6);
    less(tables(&rig), before)
}

/// A program runs while M2502 is set and the stylus is pushed aside; whether it stops.
fn stops_for_stylus(mps: &str) -> bool {
    let probe = "\n[probe]\nlength = 100\nradius = 2\n";
    let build = bench_with("       L     M2719\n       S     M2502\n", mps).with(probe);
    let mut rig = ready(build.program("1", "L IX-20 R0 F600"));
    rig.event("probe insert");
    begin(&mut rig);
    rig.seconds(0.3);
    rig.event("probe push X 5");
    rig.seconds(0.3);
    signal(&rig, "path.speed") == 0.0
}

/// 1 is the HE 310, whose second wheel moves another axis [001:1073-1077]; factor 4 is 1.25 mm. 2 is the TS 110 with a cable,
/// whose deflection stops the machine while M2502 is set; a TS 510 is on standby then [001:2208-2221] [000:7652].
fn handwheel(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| turned(mps, HANDWHEEL_STEPS));
    let rounded = seen.map(|ways| ways.map(|way| (way * 100.0).round() / 100.0));
    same(rounded, [[-1.25, 0.0, 0.0, 0.0], [-1.25, -1.25, 0.0, 0.0]])?;
    let stops = [0, 2].map(|value: u8| stops_for_stylus(&format!("{number}={value}")));
    same(stops, [false, true])
}

/// Fewer increments than MP247 are a vibration [001:2223-2226]: a tenth of a turn of 1.25 mm.
fn hysteresis(number: u16) -> Verdict {
    let seen = both(number, "200", |mps| turned(mps, HANDWHEEL_STEPS / 10.0)[0]);
    pair(seen, [-0.125, 0.0], 0.003)
}

/// A probe stands 20 mm beside the side of a solid: MP251 up to MP235 before the point, then MP215; MP216 is as far as it seeks
/// [001:2234-2252]. Greatest speed, speed at the contact, way with the slower one, and a message.
fn probed(mps: &str) -> (f64, f64, f64, String) {
    let probe = "\n[probe]\nlength = 100\nradius = 2\n[[probe.solid]]\nmin = [155, 100, -100]\nmax = [200, 200, 200]\n";
    let blocks = "TCH PROBE 0.0 REF. PLANE Q5 X+\nTCH PROBE 0.1 X+2 Y+0 Z+0";
    let list = "44=50 46=50 48=50 215=600 251=2400 235=8 216=30";
    let build = bench(list)
        .mps(mps)
        .with(probe)
        .plant("start = 149", "start = 135");
    let mut rig = ready(
        build
            .plc_line("       L     M2503\n       R     M2503\n")
            .program("1", blocks),
    );
    rig.event("probe insert");
    let mut seen = (0.0_f64, 0.0, 0.0, String::new());
    begin(&mut rig);
    let end_us = rig.control.time_us() + 20_000_000;
    let cycle_min = f64::from(rig.control.cycle_us()) * 1e-6 / 60.0;
    while !rig.control.has_ended() && rig.messages().is_empty() && !rig.bit("M2025") {
        assert!(rig.control.time_us() < end_us, "{:?}", rig.control.snapshot());
        rig.cycle();
        let speed = signal(&rig, "X.nominal-speed").abs();
        seen.0 = seen.0.max(signal(&rig, "path.speed"));
        if speed > 0.0 {
            seen.1 = speed;
        }
        if (speed - 600.0).abs() < 1.0 {
            seen.2 += speed * cycle_min;
        }
    }
    seen.3 = rig.messages().join(" ");
    seen
}

fn probing(number: u16) -> Verdict {
    let value = match number {
        215 => "300",
        216 => "1",
        235 => "4",
        _ => "1800",
    };
    let [before, after] = both(number, value, probed);
    match number {
        215 => pair([before.1, after.1], [600.0, 300.0], 1.0),
        216 => same(
            [before.3.as_str(), after.3.as_str()],
            ["", "TOUCH POINT INACCESSIBLE program 1 block 2"],
        ),
        235 => pair([before.2, before.2 - after.2], [before.2, 4.0], 0.2),
        _ => pair([before.0, after.0], [2400.0, 1800.0], 1.0),
    }
}

impl crate::support::Build {
    /// Instructions before the end of the PLC program.
    fn plc_line(mut self, line: &str) -> crate::support::Build {
        self.plc = self.plc.replacen("\n       EM", &format!("\n{line}       EM"), 1);
        self
    }
}
