//! The standard PLC program of the TNC 151 and 155 at the terminals: codes, strobes, decoded functions [001:458-900].

mod support;
#[path = "support/terminals.rs"]
mod terminals;

use bahn_tnc::RunState;
use support::{Build, Rig};
use terminals::terminals;

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
    assert_eq!(
        seen(terminals().mp("214=2"), "L M89\nL M7"),
        printed(&[7]),
        "M89 calls a cycle"
    );
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
