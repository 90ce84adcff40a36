//! The standard PLC program of the TNC 151 and 155 at the terminals: codes, strobes, decoded functions [001:458-900].

use crate::support::{Build, Rig};
use crate::terminals::terminals;
use bahn_tnc::RunState;

/// Codes on A7 to A14 and decoded lines A15 to A19 while a strobe is on, with the strobe lines A20 to A22.
type Seen = (String, String, String);

fn at_strobe(rig: &Rig) -> Seen {
    (rig.contacts(7, 8), rig.contacts(15, 5), rig.contacts(20, 3))
}

/// Runs a program to its end, goes on at each stop, and writes down what stands at the terminals when a strobe comes.
fn seen(build: Build, blocks: &str) -> Vec<Seen> {
    let mut rig = build.program("1.H", blocks).rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    let mut seen = Vec::new();
    let (mut before, mut stopped) = (false, false);
    let end_us = rig.control.time_us() + 200_000_000;
    while !rig.control.snapshot().ended {
        assert!(rig.control.time_us() < end_us, "{seen:?} {:?}", rig.messages());
        rig.cycle();
        let strobe = rig.contacts(20, 3);
        let on = strobe != "000";
        if on && !before {
            seen.push(at_strobe(&rig));
        }
        before = on;
        let stops = rig.control.snapshot().run == RunState::Stopped;
        if stops && !stopped {
            rig.start();
        }
        stopped = stops;
    }
    seen
}

/// Two decades 8-4-2-1, units first: M19 is 9 and 1, `1001 1000` [001:562-675].
fn decades(number: u8) -> String {
    let digit = |digit: u8| (0..4).map(move |place| if digit >> place & 1 == 1 { '1' } else { '0' });
    digit(number % 10).chain(digit(number / 10)).collect()
}

/// What is decoded beside a code: M03, M04, M05, M08, M09 at A15 to A19 [001:525-529] [001:690-700] [001:3131-3139].
fn decoded(m: u8) -> &'static str {
    match m {
        0 | 2 | 30 => "00101",
        3 => "10000",
        4 => "01000",
        5 | 6 | 19 => "00100",
        8 => "00010",
        9 => "00001",
        13 => "10010",
        14 => "01010",
        _ => "00000",
    }
}

/// All M functions: M00 to M88 go out in the code of their number, with the decoded lines of those that have some. M89 goes
/// out with MP214 = 0, M90 to M99 never [001:564-718]. M02 and M30 end a program.
#[test]
fn every_m_function() {
    let printed = |numbers: &[u8]| -> Vec<Seen> {
        let strobe = |m: &u8| (decades(*m), decoded(*m).to_owned(), "010".to_owned());
        numbers.iter().map(strobe).collect()
    };
    let inside: Vec<u8> = (0..90).filter(|m| !matches!(m, 2 | 30)).collect();
    let blocks = |numbers: &[u8]| -> String { numbers.iter().map(|m| format!("L M{m}\n")).collect() };
    let bench = || terminals().mp("214=0");
    assert_eq!(seen(bench(), &blocks(&inside)), printed(&inside));
    for end in [2, 30] {
        assert_eq!(seen(bench(), &blocks(&[end])), printed(&[end]));
    }
    let silent: Vec<u8> = [90, 92, 94, 97, 98].to_vec();
    assert_eq!(seen(bench(), &blocks(&silent)), printed(&[]));
}

/// All S codes: S00 is 0, S01 to S99 are the standard speeds of the series R20 from 0.112 to 9000 rpm
/// [001:763-872]. Each speed that a block can name goes out with the S strobe.
#[test]
fn every_s_code() {
    let series = [
        1.0, 1.12, 1.25, 1.4, 1.6, 1.8, 2.0, 2.24, 2.5, 2.8, 3.15, 3.55, 4.0, 4.5, 5.0, 5.6, 6.3, 7.1, 8.0,
        9.0,
    ];
    let speed = |code: u8| {
        let place = usize::from(code);
        series[place % 20] * 10f64.powi((place / 20) as i32 - 1)
    };
    let blocks: String = (1..100u8)
        .map(|code| format!("TOOL CALL 0 Z S{}\n", (speed(code) * 1000.0).round() / 1000.0))
        .collect();
    let printed: Vec<Seen> = (1..100u8)
        .map(|code| (decades(code), "00000".to_owned(), "100".to_owned()))
        .collect();
    assert_eq!(
        seen(terminals().mp("62=2").mp("63=1991").mp("61=0"), &blocks),
        printed
    );
}

/// Tool numbers in two decades with the T strobe; above 99 all eight lines. T and S of one TOOL CALL come one after the other
/// [001:732-746].
#[test]
fn tool_numbers() {
    let build = terminals().tools([7, 42, 99, 100, 254]).mp("61=1").mp("62=2");
    let found = seen(
        build,
        "TOOL CALL 7 Z S1000\nTOOL CALL 42 Z S1000\nTOOL CALL 99 Z S1000\nTOOL CALL 100 Z S1000\nTOOL CALL 254 Z S1000",
    );
    let codes: Vec<(String, String)> = found
        .into_iter()
        .map(|(code, _, strobe)| (code, strobe))
        .collect();
    let all = || "11111111".to_owned();
    let tools = [decades(7), decades(42), decades(99), all(), all()];
    let expected: Vec<(String, String)> = tools
        .into_iter()
        .flat_map(|code| [(code, "001".to_owned()), (decades(80), "100".to_owned())])
        .collect();
    assert_eq!(codes, expected, "S80 is 1000 rpm");
}

/// A scan, ms, and the contour cycle in which a change is seen.
const SCAN_MS: f64 = 20.0;
const CYCLE_MS: f64 = 6.0;

/// Times in ms from the code on: strobe on, strobe off, code off.
fn times(rig: &mut Rig, strobe: &str) -> [f64; 3] {
    let mut at = |what: &str, so: &dyn Fn(&Rig) -> bool| {
        rig.until(10.0, what, so);
        rig.control.time_us() as f64 * 1e-3
    };
    let code = at("the code", &|rig| rig.contacts(7, 8) != "00000000");
    let on = at("the strobe", &|rig| rig.bit(strobe));
    let off = at("the end of the strobe", &|rig| !rig.bit(strobe));
    let end = at("the end of the code", &|rig| rig.contacts(7, 8) == "00000000");
    [on - code, off - code, end - code]
}

/// MP120, MP121 and MP122 count from the code in units of 20 ms; each time may be late by two scans [001:544-552]
/// [001:1833].
#[test]
fn times_of_strobes() {
    for [on, off, test] in [[2, 7, 9], [0, 1, 2], [5, 20, 50]] {
        let mps = [(120, on), (121, off), (122, test)].map(|(number, value)| format!("{number}={value}"));
        let build = mps.iter().fold(terminals(), |build, mp| build.mp(mp));
        let mut rig = build
            .mp("61=1")
            .mp("62=2")
            .tools([7])
            .program("1.H", "L M7\nTOOL CALL 7 Z S1000")
            .rig();
        rig.power_on();
        rig.command("mode full");
        rig.command("select 1.H");
        rig.start();
        for strobe in ["A21", "A22", "A20"] {
            for (time, units) in times(&mut rig, strobe).into_iter().zip([on, off, test]) {
                let least = f64::from(units) * SCAN_MS;
                assert!(
                    (least - CYCLE_MS..=least + 2.0 * SCAN_MS + CYCLE_MS).contains(&time),
                    "{strobe}: {time} ms for {units} units"
                );
            }
        }
    }
}

/// With 0 V at E17 the code stays and the program waits without limit; 24 V ends both [001:548-550].
#[test]
fn e17_is_waited_for_without_limit() {
    let mut rig = terminals()
        .program("1.H", "L X+0 R0 F1000\nL M7\nL IX+5 F5000")
        .rig();
    rig.power_on();
    rig.command("datum X 0");
    rig.contact("completed", false);
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(2.0, "the code", |rig| rig.bit("A7"));
    rig.seconds(60.0);
    assert_eq!((rig.contacts(7, 8), rig.bit("A21")), (decades(7), false));
    assert_eq!(rig.control.snapshot().run, RunState::Running);
    rig.contact("completed", true);
    rig.until(0.1, "the code goes off", |rig| rig.contacts(7, 8) == "00000000");
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
}

/// Waits until an M or S code has gone off again.
fn code_ends(rig: &mut Rig) {
    rig.until(20.0, "the code goes off", |rig| rig.contacts(7, 8) == "00000000");
}

/// Starts a program in full sequence.
fn running(build: Build, blocks: &str) -> Rig {
    let mut rig = build.program("1.H", blocks).rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig
}

/// MP78 to MP85 with a speed of 500 rpm a gear: gear n goes out on line n alone, with the S strobe [001:879-886].
#[test]
fn one_of_eight_gears() {
    let gears = (0..8).map(|gear| format!("{}={}", 78 + gear, 500 * (gear + 1)));
    let build = gears.fold(terminals().mp("62=4").mp("61=0"), |build, mp| build.mp(&mp));
    let blocks: String = (1..9)
        .map(|gear| format!("TOOL CALL 0 Z S{}\n", 500 * gear))
        .collect();
    let line = |gear: usize| {
        (0..8)
            .map(|place| if place == gear { '1' } else { '0' })
            .collect()
    };
    let expected: Vec<Seen> = (0..8)
        .map(|gear| (line(gear), "00000".to_owned(), "100".to_owned()))
        .collect();
    assert_eq!(seen(build, &blocks), expected);
}

/// While E17 is waited for, output S has MP70 in turn with one sign for MP124 and with the other for MP125; each may be late
/// by two scans. With E17 the gear is there and the voltage gone [001:896].
#[test]
fn change_of_gear_swings_the_spindle() {
    let build = terminals()
        .mp("78=1000")
        .mp("79=2000")
        .mp("70=0.8")
        .mp("124=12")
        .mp("125=5")
        .mp("168=0");
    let mut rig = running(build, "TOOL CALL 0 Z S1500");
    rig.contact("completed", false);
    rig.until(2.0, "the gear", |rig| rig.bit("A8"));
    let volts = |rig: &Rig| rig.control.observe(&"output.S".parse().unwrap());
    // A whole number of steps of 12 bits, 10 V / 2048, is nearest to 0.8 V.
    let near = |found: f64, wanted: f64| (found - wanted).abs() < 10.0 / 2048.0;
    let mut changes = Vec::new();
    let mut before = 0.0;
    for _ in 0..400 {
        rig.cycle();
        let now = volts(&rig);
        if (now - before).abs() > 0.01 {
            changes.push((rig.control.time_us() as f64 * 1e-3, now));
        }
        before = now;
    }
    assert!(changes.len() > 6, "{changes:?}");
    for pair in changes.windows(2) {
        let [(from, sign), (to, other)] = pair else {
            continue;
        };
        assert!(near(sign.abs(), 0.8) && near(*other, -sign), "{changes:?}");
        let least = SCAN_MS * if *sign > 0.0 { 12.0 } else { 5.0 };
        let time = to - from;
        assert!(
            (least - CYCLE_MS..=least + 2.0 * SCAN_MS + CYCLE_MS).contains(&time),
            "{time} ms with {sign} V"
        );
    }
    rig.contact("completed", true);
    code_ends(&mut rig);
    rig.seconds(0.05);
    assert!(near(volts(&rig), 0.0));
    assert_eq!(rig.control.snapshot().spindle.gear, 2);
}

/// MP168 = 0.001 V/ms: 9 V at 3000 rpm take 9 s. E17 is looked at when the ramp is at its end, with M05 at once [001:894].
#[test]
fn the_ramp_of_m3_comes_before_e17() {
    for (m, line) in [(3, "A15"), (4, "A16"), (13, "A15"), (14, "A16")] {
        let build = terminals().mp("78=3000").mp("168=0.001");
        let mut rig = running(build, &format!("TOOL CALL 0 Z S3000\nL M{m}\nL M5"));
        rig.until(2.0, "M3", |rig| rig.bit(line));
        let from = rig.control.time_us();
        code_ends(&mut rig);
        let seconds = (rig.control.time_us() - from) as f64 * 1e-6;
        assert!((8.95..9.1).contains(&seconds), "M{m}: {seconds} s");
        rig.until(2.0, "M5", |rig| rig.bit("A17"));
        let from = rig.control.time_us();
        code_ends(&mut rig);
        let seconds = (rig.control.time_us() - from) as f64 * 1e-6;
        assert!((0.17..0.23).contains(&seconds), "M5: {seconds} s");
    }
}

/// MP78 to MP85 do not ascend: four gears of 1000 to 4000 rpm, whose comparator speeds are 900 to 3600 rpm. M2504 is 1 below
/// it, 0 above [001:1516-1536].
#[test]
fn m2504_compares_the_speed() {
    let speeds = [1000, 2000, 3000, 4000, 900, 1800, 2700, 3600];
    let list = || {
        (78..).zip(speeds).fold(terminals(), |build, (number, rpm)| {
            build.mp(&format!("{number}={rpm}"))
        })
    };
    for (rpm, below) in [
        (890, true),
        (910, false),
        (1790, true),
        (1810, false),
        (3610, false),
    ] {
        let mut rig = running(list().mp("168=0"), &format!("TOOL CALL 0 Z S{rpm}\nL M3"));
        assert!(rig.bit("M2504"), "it stands");
        rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
        rig.seconds(0.1);
        assert_eq!(rig.bit("M2504"), below, "S{rpm}");
    }
    let ascending = running(terminals().mp("78=1000"), "L M3");
    assert!(!ascending.bit("M2504"));
}

/// The spindle option of section 10: kv 1, window 20 increments, 100 rpm, mark at 45 degrees.
fn orienting() -> Build {
    let option = [
        "237=1", "238=1", "246=20", "248=100", "240=45", "78=3000", "156=200",
    ];
    option.into_iter().fold(terminals(), |build, mp| build.mp(mp))
}

/// The angle of the spindle, degrees.
fn angle(rig: &Rig) -> f64 {
    rig.control.snapshot().spindle.angle_deg.unwrap_or(f64::NAN)
}

/// M19 with MP158 + 4096: to the angle of the orientation cycle, to MP240 where there was none; + 8192: to MP156. The strobe
/// stays until the spindle is there, E17 is looked at after it, and M05 goes out with it [001:3117-3139]. M03, M05 let go.
#[test]
fn m19_orients() {
    let cycle = "CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 120\n";
    for (mp158, before, target) in [(4096, "", 45.0), (4096, cycle, 120.0), (8192, "", 200.0)] {
        for turning in ["", "TOOL CALL 0 Z S1000\nL M4\n"] {
            let build = orienting().mp(&format!("158={mp158}"));
            let mut rig = running(build, &format!("{before}{turning}L M19\nL M5"));
            rig.until(20.0, "M19", |rig| rig.contacts(7, 8) == decades(19));
            assert!(rig.bit("A17"), "M05 goes out with it");
            rig.until(0.1, "the strobe", |rig| rig.bit("A21"));
            rig.until(30.0, "the end of the strobe", |rig| !rig.bit("A21"));
            assert!(rig.bit("M2007"), "in position");
            assert_eq!(
                rig.contacts(7, 8),
                decades(19),
                "E17 is looked at after the strobe"
            );
            assert!(
                (angle(&rig) - target).abs() < 20.0 * 360.0 / 4096.0 + 0.1,
                "{} for {target}",
                angle(&rig)
            );
            code_ends(&mut rig);
            assert!(rig.bit("M2007"), "held");
            rig.until(2.0, "the end", |rig| rig.control.snapshot().ended);
            rig.seconds(0.1);
            assert!(!rig.bit("M2007"), "M05 lets go");
        }
    }
}

/// Without its bits in MP158 M19 is a function like others.
#[test]
fn m19_without_option_bits() {
    let mut rig = running(orienting(), "L M19");
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    assert!(!rig.bit("M2007"));
}

/// M2501 turns the spindle at MP258 without encoder [001:3115].
#[test]
fn m2501_turns_at_mp258() {
    let mut build = terminals()
        .mp("78=3000")
        .mp("258=60")
        .mp("168=0")
        .program("1.H", "L M8");
    build.plc.push_str("       U     E40\n       =     M2501\n");
    let mut rig = build.rig();
    rig.power_on();
    rig.event("fault input E40 1");
    rig.seconds(1.0);
    let rpm = rig.machine.spindle().unwrap().rpm;
    // A step of 12 bits is 3000 / 9 * 10 / 2048 = 1.6 rpm; the plant turns 6000 rpm at 9 V.
    assert!((rpm - 120.0).abs() < 4.0, "{rpm}");
}

/// A0 to A3 with the axes that are closed.
fn releases(rig: &Rig) -> String {
    rig.contacts(0, 4)
}

/// Switched on, before the reference run.
fn asked(build: Build) -> Rig {
    let mut rig = build.rig();
    rig.command("ce");
    rig.until(10.0, "the reference run is asked for", |rig| rig.bit("M2057"));
    rig
}

/// No release before the reference run; with it one after the other in the order of MP59, here Z X Y; then they stay closed
/// [001:484].
#[test]
fn axis_releases_follow_the_reference_run() {
    let mut rig = asked(terminals().mp("59=12"));
    rig.seconds(1.0);
    assert_eq!(releases(&rig), "0000");
    rig.start();
    let mut seen = vec![releases(&rig)];
    rig.until(0.1, "it starts", |_| true);
    for _ in 0..10_000 {
        rig.cycle();
        let now = releases(&rig);
        if seen.last() != Some(&now) {
            seen.push(now);
        }
    }
    assert_eq!(seen, ["0000", "0010", "1010", "1110"]);
    assert!(rig.bit("M2051"), "Manual");
}

/// "Manual traverse" opens the loops in every mode; a movement closes that of its axis for its time; 0 V closes all
/// [001:486-493].
#[test]
fn manual_traverse_opens_the_loops() {
    for mode in ["manual", "handwheel", "mdi", "single", "full"] {
        let mut rig = terminals().program("1.H", "L IX+10 R0 F1000\nL IY+10").rig();
        rig.power_on();
        rig.command(&format!("mode {mode}"));
        rig.seconds(0.1);
        assert_eq!(releases(&rig), "1110", "{mode}");
        rig.contact("manual", true);
        rig.seconds(0.1);
        assert_eq!(releases(&rig), "0000", "{mode}");
        rig.contact("manual", false);
        rig.seconds(0.1);
        assert_eq!(releases(&rig), "1110", "{mode}");
    }
    // By a direction button.
    let mut rig = terminals().rig();
    rig.power_on();
    rig.contact("manual", true);
    rig.seconds(0.1);
    let from = rig.machine.axis('X').unwrap().position;
    rig.event("key X+ press");
    rig.seconds(1.0);
    assert_eq!(releases(&rig), "1000");
    rig.event("key X+ release");
    rig.seconds(1.0);
    assert_eq!(releases(&rig), "0000");
    assert!(rig.machine.axis('X').unwrap().position > from + 1.0);
    // In a program, axis by axis.
    let mut rig = terminals().program("1.H", "L IX+10 R0 F1000\nL IY+10").rig();
    rig.power_on();
    rig.contact("manual", true);
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    let mut seen = vec![releases(&rig)];
    while !rig.control.snapshot().ended {
        assert!(
            rig.control.time_us() < 200_000_000,
            "{seen:?} {:?} {:?}",
            rig.messages(),
            rig.control.snapshot()
        );
        rig.cycle();
        let now = releases(&rig);
        if seen.last() != Some(&now) {
            seen.push(now);
        }
    }
    rig.seconds(0.1);
    assert_eq!(releases(&rig), "0000");
    let both = ["1000", "0100"].map(|only| seen.iter().any(|seen| seen == only));
    assert_eq!(both, [true; 2], "{seen:?}");
}

/// Under "manual traverse" X moves alone, then with Y, then Y alone, then with Z: each block closes the loops of its axes for its
/// time, none of which opens and closes again before it begins.
#[test]
fn axes_of_a_block_close_together_under_manual_traverse() {
    let blocks = "L IX+5 R0 F1000\nL IX+5 IY+5\nL IY+5\nL IY+5 IZ+5";
    let mut rig = terminals().program("1.H", blocks).rig();
    rig.power_on();
    rig.contact("manual", true);
    rig.seconds(0.1);
    assert_eq!(releases(&rig), "0000");
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    let mut seen = vec![releases(&rig)];
    let end = rig.control.time_us() + 20_000_000;
    while !rig.control.snapshot().ended || releases(&rig) != "0000" {
        assert!(rig.control.time_us() < end, "{seen:?}");
        rig.cycle();
        let now = releases(&rig);
        if seen.last() != Some(&now) {
            seen.push(now);
        }
    }
    // An axis that the block before has moved may stay closed, or open for the scan in which the next block is begun.
    let blocks = ["1000", "1100", "0100", "0110"];
    let only: Vec<_> = seen
        .iter()
        .filter(|seen| blocks.contains(&seen.as_str()))
        .collect();
    assert_eq!(only, blocks, "{seen:?}");
}

/// An axis that was turned by hand while its loop was open: with MP158 + 16384 it stays where it is, without it goes back to
/// its nominal value [001:495-499]. A force of 60 N against a friction of 50 N moves
/// 10 kg for 0.1 s: (1 m/s^2 (0.1 s)^2) / 2 = 5 mm, and 1 mm more until it stands.
#[test]
fn the_actual_value_becomes_the_nominal_value() {
    for (mp158, stays) in [(16_384, true), (0, false)] {
        let mut rig = terminals()
            .plant(
                "[axis.X]",
                "[axis.X]\nmass = 10\nfriction = 50\nforce = 3000\nreset_ms = 20",
            )
            .mp(&format!("158={mp158}"))
            .rig();
        rig.power_on();
        rig.contact("manual", true);
        rig.seconds(0.1);
        let from = rig.machine_position('X');
        rig.event("force X 60");
        rig.seconds(0.1);
        rig.event("force X 0");
        rig.seconds(2.0);
        let moved = rig.machine_position('X');
        assert!((1.0..9.0).contains(&(moved - from)), "{from} {moved}");
        rig.contact("manual", false);
        rig.seconds(3.0);
        let wanted = if stays { moved } else { from };
        assert!(
            (rig.machine_position('X') - wanted).abs() < 0.02,
            "{wanted} {}",
            rig.machine_position('X')
        );
        assert_eq!(rig.messages(), [""; 0]);
    }
}

/// A4 while a program runs, A5 in the automatic modes [001:1032-1042].
#[test]
fn status_outputs() {
    let mut rig = asked(terminals().program("1.H", "L IX+20 R0 F1000\nL IX-20\nL M7"));
    assert_eq!(rig.contacts(4, 2), "01", "the reference run is no manual mode");
    rig.power_on();
    for (mode, automatic) in [
        ("manual", '0'),
        ("handwheel", '0'),
        ("mdi", '1'),
        ("single", '1'),
        ("full", '1'),
    ] {
        rig.command(&format!("mode {mode}"));
        rig.seconds(0.1);
        assert_eq!(rig.contacts(4, 2), format!("0{automatic}"), "{mode}");
    }
    // PROGRAMMING AND EDITING is on the screen, and not beside a run.
    rig.command("screen 1 0 1 0 0");
    rig.seconds(0.1);
    assert_eq!((rig.contacts(4, 2).as_str(), rig.bit("M2050")), ("00", true));
    rig.command("select 1.H");
    rig.start();
    rig.seconds(0.5);
    assert_eq!(rig.contacts(4, 2), "11");
    rig.command("screen 0 0 256 0 0");
    rig.event("key NC_STOP press");
    rig.seconds(0.5);
    assert_eq!(rig.contacts(4, 2), "01", "interrupted");
    rig.event("key NC_STOP release");
    rig.start();
    rig.until(10.0, "the end", |rig| rig.control.snapshot().ended);
    rig.seconds(0.1);
    assert_eq!(rig.contacts(4, 2), "01");
}

/// Path speed, mm/min.
fn path_speed(rig: &Rig) -> f64 {
    rig.control.observe(&"path.speed".parse().unwrap())
}

/// E21 moves a program at rapid traverse whatever F says, on arcs as fast as they may be, and back at F when it is let go
/// [001:465-469]; MP74 bit 0 says whether the override acts on it [001:3262].
#[test]
fn the_rapid_button_moves_programs() {
    for (mp74, percent, wanted) in [(7, 100, 10_000.0), (7, 50, 5000.0), (6, 50, 10_000.0)] {
        let mut rig = running(
            terminals().mp(&format!("74={mp74}")),
            "L IX+150 R0 F300\nL IY+1 F300",
        );
        rig.event(&format!("override feed {percent}"));
        rig.seconds(1.0);
        let usual = 300.0 * f64::from(percent) / 100.0;
        assert!((path_speed(&rig) - usual).abs() < 1.0, "{}", path_speed(&rig));
        rig.event("key RAPID press");
        rig.seconds(0.6);
        assert!(
            (path_speed(&rig) - wanted).abs() < 1.0,
            "MP74 = {mp74}: {}",
            path_speed(&rig)
        );
        rig.event("key RAPID release");
        rig.seconds(0.6);
        assert!((path_speed(&rig) - usual).abs() < 1.0, "{}", path_speed(&rig));
        rig.event("override feed 100");
        rig.event("key RAPID press");
        rig.until(10.0, "the end", |rig| rig.control.snapshot().ended);
        assert_eq!(rig.messages(), [""; 0]);
    }
    // A circle of 20 mm: MP55 = 0.25 m/s^2 allows sqrt(250 * 20) = 70.7 mm/s, 4243 mm/min.
    let mut rig = running(
        terminals(),
        "CC IX+20 IY+0\nC IX+40 IY+0 DR+ R0 F300\nC IX-40 IY+0 DR+",
    );
    rig.event("key RAPID press");
    rig.seconds(0.8);
    let most = (250.0f64 * 20.0).sqrt() * 60.0;
    let speed = path_speed(&rig);
    assert!(speed > 0.9 * most && speed < 1.001 * most, "{speed}");
}

/// Start together with a direction button latches the movement with MP68 = 1, stop ends it [001:1026-1028].
#[test]
fn start_latches_a_direction_button() {
    for (mp68, runs) in [(1, true), (0, false)] {
        let mut rig = terminals().mp(&format!("68={mp68}")).rig();
        rig.power_on();
        rig.event("key X+ press");
        rig.seconds(0.3);
        rig.event("key NC_START press");
        rig.seconds(0.2);
        rig.event("key NC_START release");
        rig.event("key X+ release");
        rig.seconds(0.5);
        let speed = |rig: &Rig| rig.machine.axis('X').unwrap().speed_per_min.abs();
        assert_eq!(speed(&rig) > 100.0, runs, "MP68 = {mp68}");
        rig.event("key NC_STOP press");
        rig.seconds(1.0);
        assert!(speed(&rig) < 1.0);
    }
}

/// E18 gives the feed: M2451 with its complement.
#[test]
fn feed_rate_release() {
    let mut rig = running(terminals(), "L IX+30 R0 F1000");
    rig.seconds(0.5);
    rig.contact("release", false);
    rig.seconds(0.5);
    assert!(
        !rig.bit("M2451") && rig.bit("M2467") && rig.machine.axis('X').unwrap().speed_per_min.abs() < 1.0
    );
    rig.contact("release", true);
    rig.until(10.0, "the end without start", |rig| rig.control.snapshot().ended);
}
