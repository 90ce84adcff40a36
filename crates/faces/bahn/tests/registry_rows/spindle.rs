//! Rows of spindle and tools, with the standard PLC program at the terminals.

use crate::bench::{Probe, Row, Verdict, both, holds, pair, same, signal};
use crate::mill::mill;
use crate::support::{Build, Rig};
use crate::terminals::terminals;

pub const ROWS: &[Row] = &[
    Row(61..=61, Probe::Acts(tool_numbers)),
    Row(62..=62, Probe::Acts(speed_output)),
    Row(63..=63, Probe::Acts(code_limits)),
    Row(70..=70, Probe::Acts(swing_voltage)),
    Row(78..=85, Probe::Acts(gears)),
    Row(86..=89, Probe::Acts(voltages)),
    Row(120..=122, Probe::Acts(strobe_times)),
    Row(124..=125, Probe::Acts(swing_times)),
    Row(156..=156, Probe::Acts(m19_by_plc_position)),
    Row(157..=157, Probe::Acts(next_tool_numbers)),
    Row(168..=168, Probe::Acts(ramp)),
    Row(172..=172, Probe::Acts(polarity)),
    Row(184..=184, Probe::Acts(least_voltage)),
    Row(190..=190, Probe::Acts(speed_zero)),
    Row(225..=225, Probe::Acts(central_tools)),
    Row(238..=238, Probe::Acts(kv)),
    Row(239..=239, Probe::Acts(counting)),
    Row(240..=240, Probe::Acts(reference_angle)),
    Row(246..=246, Probe::Acts(window)),
    Row(248..=248, Probe::Acts(orientation_speed)),
    Row(258..=258, Probe::Acts(speed_without_encoder)),
];

/// The bench with changes of its list, separated by blanks, and a program.
fn terminal_bench(mps: &str, blocks: &str) -> Build {
    terminals().mps("61=0 168=0").mps(mps).program("1", blocks)
}

/// The program runs.
fn running(build: Build) -> Rig {
    let mut rig = build.rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select 1");
    rig.start();
    rig
}

/// The program has come to its end, or to a message, and the spindle to its speed.
fn ended(build: Build) -> Rig {
    let mut rig = running(build);
    rig.until(60.0, "the end", |rig| {
        rig.control.has_ended() || !rig.messages().is_empty()
    });
    rig.seconds(0.2);
    rig
}

/// What goes out with strobes while a program runs: `S` or `T` or `M`, and the code on A7 to A14.
fn strobes(build: Build) -> Vec<String> {
    let mut rig = running(build);
    let mut seen = Vec::new();
    let mut before = false;
    let end_us = rig.control.time_us() + 30_000_000;
    while !rig.control.has_ended() && rig.messages().is_empty() {
        assert!(rig.control.time_us() < end_us, "{seen:?}");
        rig.cycle();
        let strobe = ["A20", "A21", "A22"].into_iter().position(|line| rig.bit(line));
        if let Some(kind) = strobe.filter(|_| !before) {
            seen.push(format!("{} {}", ["S", "M", "T"][kind], rig.contacts(7, 8)));
        }
        before = strobe.is_some();
    }
    seen
}

/// The strobes of one kind.
fn of(kind: &str, build: Build) -> Vec<String> {
    let all = strobes(build).into_iter();
    all.filter_map(|seen| Some(seen.strip_prefix(kind)?.trim().to_owned()))
        .collect()
}

/// The lines of a number below 10: units 8-4-2-1, lowest first.
fn code(number: u8) -> String {
    (0..8)
        .map(|bit| if number >> bit & 1 == 1 { '1' } else { '0' })
        .collect()
}

/// TOOL CALL 1, again 1, 2. 0: nothing; 1: changes; 2: each; 3: the numbers of the pockets [001:1583-1585].
fn tool_numbers(number: u16) -> Verdict {
    let calls = |value: u8| {
        let blocks = "TOOL CALL 1 Z\nTOOL CALL 1 Z\nTOOL CALL 2 Z";
        let build = terminal_bench(&format!("225=9 62=0 {number}={value}"), blocks);
        of("T", build.tools([1, 2]))
    };
    let codes = |numbers: &[u8]| numbers.iter().map(|number| code(*number)).collect::<Vec<_>>();
    same(
        [0, 1, 2].map(calls),
        [codes(&[]), codes(&[1, 2]), codes(&[1, 1, 2])],
    )
}

/// After TOOL CALL the next tool goes out: 0: not; 1: when it changes; 2: at every TOOL CALL [001:1587-1590].
fn next_tool_numbers(number: u16) -> Verdict {
    let calls = |value: u8| {
        let blocks = "TOOL CALL 1 Z\nTOOL DEF 2\nTOOL DEF 2\nTOOL DEF 3";
        let build = terminal_bench(&format!("225=9 62=0 {number}={value}"), blocks);
        of("T", build.tools([1, 2, 3]))
    };
    let codes = |numbers: &[u8]| numbers.iter().map(|number| code(*number)).collect::<Vec<_>>();
    same(
        [0, 1, 2].map(calls),
        [codes(&[]), codes(&[2, 3]), codes(&[2, 2, 3])],
    )
}

/// S500 twice, S1500 in gear 2. 0: nothing; 1: codes that change; 2: all codes; 3: gears that change, from the first one on; 4: all gears; 5:
/// the voltage alone. S500 is S74, S1500 rounds to S83 or S84 [001:1488-1490].
fn speed_output(number: u16) -> Verdict {
    let found = [0, 1, 2, 3, 4, 5].map(|value: u8| {
        let blocks = "TOOL CALL 0 Z S500\nTOOL CALL 0 Z S500\nTOOL CALL 0 Z S1400\nL M3";
        let list = format!("78=1000 79=2000 {number}={value}");
        let count = of("S", terminal_bench(&list, blocks)).len();
        let volts = signal(&ended(terminal_bench(&list, blocks)), "output.S");
        (count, (volts * 10.0).round() / 10.0)
    });
    same(
        found,
        [(0, 0.0), (2, 0.0), (3, 0.0), (1, 6.3), (3, 6.3), (0, 6.3)],
    )
}

/// S1000 is S80. 1991 permits S01 to S99; 20602 ends at S60 [001:748-761].
fn code_limits(number: u16) -> Verdict {
    let seen = both(number, "20602", |mps| {
        let build = terminal_bench(&format!("62=2 63=1991 {mps}"), "TOOL CALL 0 Z S1000");
        of("S", build).len()
    });
    same(seen, [1, 0])
}

/// A gear change that waits for E17.
fn changing(mps: &str) -> Rig {
    let list = format!("62=3 78=1000 79=2000 70=0.8 124=12 125=5 {mps}");
    let mut rig = running(terminal_bench(&list, "TOOL CALL 0 Z S1500"));
    rig.contact("completed", false);
    rig.until(2.0, "the gear", |rig| rig.bit("A8"));
    rig
}

/// The voltage of a gear change [001:896] [001:1562-1565].
fn swing_voltage(number: u16) -> Verdict {
    let seen = both(number, "1.6", |mps| {
        let mut rig = changing(mps);
        let mut most = 0.0_f64;
        for _ in 0..200 {
            rig.cycle();
            most = most.max(signal(&rig, "output.S").abs());
        }
        most
    });
    pair(seen, [0.8, 1.6], 0.006)
}

/// How long the voltage has one sign and the other, s.
fn swings(mps: &str) -> [f64; 2] {
    let mut rig = changing(mps);
    let mut edge = |positive: bool| {
        rig.until(3.0, "a change of sign", |rig| {
            let volts = signal(rig, "output.S");
            volts.abs() > 0.1 && (volts > 0.0) == positive
        });
        rig.control.time_us() as f64 * 1e-6
    };
    edge(false);
    let [up, down, end] = [true, false, true].map(&mut edge);
    [down - up, end - down]
}

/// MP124 is the time of one direction, MP125 that of the other, in units of 20 ms; each may be late by two scans
/// [001:896].
fn swing_times(number: u16) -> Verdict {
    let [[first, second], [first_changed, second_changed]] = both(number, "30", swings);
    let late = 0.046;
    let wanted = if number == 124 { [0.6, 0.1] } else { [0.24, 0.6] };
    for (found, wanted) in [first, second, first_changed, second_changed]
        .into_iter()
        .zip([0.24, 0.1, wanted[0], wanted[1]])
    {
        holds((wanted - 0.006..wanted + late).contains(&found), || {
            format!("{found} s, not {wanted}")
        })?;
    }
    Ok(())
}

/// Strobe on, strobe off, code off, s after the code.
fn times(mps: &str) -> [f64; 3] {
    let mut rig = running(terminal_bench(&format!("120=2 121=7 122=20 {mps}"), "L M7"));
    let mut at = |so: &dyn Fn(&Rig) -> bool| {
        rig.until(10.0, "the strobe", so);
        rig.control.time_us() as f64 * 1e-6
    };
    let code = at(&|rig| rig.bit("A7"));
    [
        at(&|rig| rig.bit("A21")) - code,
        at(&|rig| !rig.bit("A21")) - code,
        at(&|rig| !rig.bit("A7")) - code,
    ]
}

/// MP120 until the strobe comes, MP121 until it goes, MP122 until E17 is looked at, in units of 20 ms [001:548-552].
fn strobe_times(number: u16) -> Verdict {
    let value = ["4", "12", "30"][usize::from(number - 120)];
    let [before, after] = both(number, value, times);
    let mut wanted = [0.04, 0.14, 0.4];
    for (seen, change) in [(before, None), (after, Some(usize::from(number - 120)))] {
        if let Some(place) = change {
            wanted[place] = [0.08, 0.24, 0.6][place];
        }
        for (found, wanted) in seen.into_iter().zip(wanted) {
            holds((wanted - 0.006..wanted + 0.046).contains(&found), || {
                format!("{seen:?}: {found} s, not {wanted}")
            })?;
        }
    }
    Ok(())
}

/// Output S while the spindle turns at a speed, V: its gears are 500 to 4000 rpm.
fn volts_at(mps: &str, rpm: u32, percent: u32) -> f64 {
    let list = "62=5 78=500 79=1000 80=1500 81=2000 82=2500 83=3000 84=3500 85=4000 86=9 87=9.9 88=120 89=50";
    let blocks = format!("TOOL CALL 0 Z S{rpm}\nL M3");
    let mut rig = ended(terminal_bench(list, &blocks).mps(mps));
    rig.event(&format!("override spindle {percent}"));
    rig.seconds(0.3);
    signal(&rig, "output.S")
}

/// A step of the output, V.
const STEP: f64 = 10.0 / 2048.0;

/// Each gear has 9 V at its greatest speed [001:1502-1512].
fn gears(number: u16) -> Verdict {
    let rated = 500 * u32::from(number - 77);
    let rpm = rated - 200;
    let changed = rated - 100;
    let seen = both(number, &changed.to_string(), |mps| volts_at(mps, rpm, 100));
    let volts = |rated: u32| 9.0 * f64::from(rpm) / f64::from(rated);
    pair(seen, [volts(rated), volts(changed)], STEP)
}

/// MP86 at 100 %, MP87 the limit, MP88 and MP89 the override's limits [001:1538-1551].
fn voltages(number: u16) -> Verdict {
    let (value, rpm, percent, wanted) = match number {
        86 => ("8", 2000, 100, [9.0, 8.0]),
        87 => ("9.4", 3900, 120, [9.9, 9.4]),
        88 => ("105", 2000, 150, [9.9, 9.45]),
        _ => ("80", 2000, 10, [4.5, 7.2]),
    };
    let seen = both(number, value, |mps| volts_at(mps, rpm, percent));
    pair(seen, wanted, 2.0 * STEP)
}

/// 9 V at 0.01 V/ms take 0.9 s, at 0.005 V/ms 1.8 s [001:1567-1570].
fn ramp(number: u16) -> Verdict {
    let seen = both(number, "0.005", |mps| {
        let blocks = "TOOL CALL 0 Z S3000\nL M3";
        let mut rig = running(terminal_bench(&format!("62=5 78=3000 168=0.01 {mps}"), blocks));
        rig.until(5.0, "the ramp", |rig| signal(rig, "output.S") > 0.01);
        let from = rig.control.time_us();
        rig.until(5.0, "9 V", |rig| signal(rig, "output.S") > 8.99);
        (rig.control.time_us() - from) as f64 * 1e-6
    });
    pair(seen, [0.9, 1.8], 0.03)
}

/// The signs for M03 and M04 [001:1572].
fn polarity(number: u16) -> Verdict {
    let signs = [0, 1, 2, 3].map(|value: u8| {
        [3, 4].map(|m: u8| {
            let blocks = format!("TOOL CALL 0 Z S3000\nL M{m}");
            let rig = ended(terminal_bench(&format!("62=5 78=3000 {number}={value}"), &blocks));
            signal(&rig, "output.S").signum()
        })
    });
    same(signs, [[1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [-1.0, -1.0]])
}

/// S30 of 3000 rpm is 0.09 V; MP184 puts out 0.5 V at the least [001:1553-1560].
fn least_voltage(number: u16) -> Verdict {
    let seen = both(number, "0.5", |mps| {
        let list = format!("62=5 78=3000 184=0 {mps}");
        signal(
            &ended(terminal_bench(&list, "TOOL CALL 0 Z S30\nL M3")),
            "output.S",
        )
    });
    pair(seen, [0.09, 0.5], STEP)
}

/// S0 is refused where MP190 = 1 [001:1573-1575].
fn speed_zero(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| {
        let list = format!("62=5 78=3000 190=0 {mps}");
        ended(terminal_bench(&list, "TOOL CALL 0 Z S0\nL M3"))
            .messages()
            .len()
    });
    same(seen, [0, 1])
}

/// Without a central tool memory no pocket goes out, and the tools of the mill are those that its programs define
/// [001:1600-1607].
fn central_tools(number: u16) -> Verdict {
    let pockets = both(number, "9", |mps| {
        let list = format!("225=0 62=0 61=3 {mps}");
        of("T", terminal_bench(&list, "TOOL CALL 1 Z").tools([1])).len()
    });
    same(pockets, [0, 1])?;
    let central = ["MP225    : 0", "MP225    : 99"].map(|line| {
        let change = [("parameters.mp", "MP225    : 99", line)];
        mill(&change, |machine| Some(machine.tools.is_some()))
    });
    same(central, [Some(false), Some(true)])
}

/// The option: kv 1, window 20 increments, 100 rpm, mark at 45 degrees; M19 orients to it.
const ORIENTING: &str = "62=5 237=1 238=1 239=0 246=20 248=100 240=45 78=6000 156=200 158=4096";

/// The spindle is oriented by M19 from standstill.
fn oriented(mps: &str) -> Rig {
    ended(terminal_bench(&format!("{ORIENTING} {mps}"), "L M19"))
}

fn angle(rig: &Rig) -> f64 {
    rig.control.snapshot().spindle.angle_deg.unwrap_or(f64::NAN)
}

/// 0: no M19; 1: M19 orients [001:3109].
pub fn orientation_by(number: u16) -> Verdict {
    let held = [0, 1].map(|value: u8| {
        let list = format!("{ORIENTING} {number}={value}");
        let mut rig = running(terminal_bench(&list, "L M19"));
        rig.seconds(4.0);
        rig.bit("M2007")
    });
    same(held, [false, true])
}

/// M19 to MP240, where no cycle says another angle [001:3137]; 20 increments are 1.8 degrees.
fn reference_angle(number: u16) -> Verdict {
    pair(both(number, "90", |mps| angle(&oriented(mps))), [45.0, 90.0], 1.9)
}

/// M19 with MP158 + 8192 goes to MP156 [001:3117-3137].
fn m19_by_plc_position(number: u16) -> Verdict {
    let seen = both(number, "120", |mps| angle(&oriented(&format!("158=8192 {mps}"))));
    pair(seen, [200.0, 120.0], 1.9)
}

/// Seconds from M19 on until the spindle is in position, and its greatest speed, rpm.
fn orientation(mps: &str) -> [f64; 2] {
    let mut rig = running(terminal_bench(&format!("{ORIENTING} {mps}"), "L M19"));
    rig.until(5.0, "M19", |rig| rig.bit("A21"));
    let from = rig.control.time_us();
    let mut most = 0.0_f64;
    while !rig.bit("M2007") {
        assert!(rig.control.time_us() - from < 30_000_000, "{:?}", rig.messages());
        rig.cycle();
        most = most.max(signal(&rig, "S.rpm").abs());
    }
    [(rig.control.time_us() - from) as f64 * 1e-6, most]
}

/// A greater kv factor brings it into a narrow window earlier [001:3110].
fn kv(number: u16) -> Verdict {
    let [[slow, _], [fast, _]] = both(number, "5", |mps| orientation(&format!("246=4 {mps}")));
    holds(fast < slow - 0.02, || format!("{slow} s, {fast} s"))
}

/// A wide window is reached earlier [001:3113].
fn window(number: u16) -> Verdict {
    let [[slow, _], [fast, _]] = both(number, "300", |mps| orientation(&format!("246=4 {mps}")));
    holds(fast < slow - 0.02, || format!("{slow} s, {fast} s"))
}

/// The speed with which the mark is looked for [001:3114].
fn orientation_speed(number: u16) -> Verdict {
    let seen = both(number, "200", |mps| orientation(mps)[1]);
    pair(seen, [100.0, 200.0], 8.0)
}

/// What the encoder counts [001:3111]: M03 turns at 1000 rpm.
fn counting(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| {
        let blocks = "TOOL CALL 0 Z S1000\nL M3";
        let mut rig = ended(terminal_bench(&format!("{ORIENTING} {mps}"), blocks));
        let from = signal(&rig, "S.angle");
        rig.seconds(0.1);
        (signal(&rig, "S.angle") - from).signum()
    });
    pair(seen, [1.0, -1.0], 0.0)
}

/// M2501, here with E40, turns the spindle without encoder [001:3115]: 60 rpm of 3000 at 9 V, changed to 120.
fn speed_without_encoder(number: u16) -> Verdict {
    let seen = both(number, "120", |mps| {
        let mut build = terminal_bench(&format!("62=5 78=3000 258=60 {mps}"), "L M8");
        build.plc.push_str("       U     E40\n       =     M2501\n");
        let mut rig = build.rig();
        rig.power_on();
        rig.event("fault input E40 1");
        rig.seconds(0.5);
        signal(&rig, "output.S")
    });
    pair(seen, [0.18, 0.36], STEP)
}
