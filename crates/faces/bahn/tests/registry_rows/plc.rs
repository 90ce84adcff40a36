//! Rows that a PLC program reads: timers, counters, positions, feeds, markers, words; where the program comes from.

use crate::bench::{
    Probe, Row, Verdict, all, bench, bench_of_markers, bench_with, both, of_axes, only, pair, ready, same,
};
use crate::mill::mill;
use crate::support::Rig;
use crate::support::knee::asked;
use std::fmt::Write;

pub const ROWS: &[Row] = &[
    Row(77..=77, Probe::Acts(source)),
    Row(94..=109, Probe::Acts(counters)),
    Row(110..=119, Probe::Acts(timers)),
    Row(123..=123, Probe::Acts(timers)),
    Row(126..=155, Probe::Acts(positions)),
    Row(158..=158, Probe::Acts(markers)),
    Row(163..=166, Probe::Acts(feeds)),
    Row(193..=208, Probe::Acts(timers)),
    Row(209..=212, Probe::Acts(words)),
    Row(249..=250, Probe::Acts(markers)),
];

/// How long the outputs of a kind are on after E30 has closed, in scans of 20 ms.
fn scans(rig: &mut Rig, names: &[String]) -> Vec<f64> {
    rig.seconds(0.1);
    rig.event("fault input E30 1");
    let mut cycles = vec![0.0; names.len()];
    let end_us = rig.control.time_us() + 400_000;
    while rig.control.time_us() < end_us {
        rig.cycle();
        for (cycles, name) in cycles.iter_mut().zip(names) {
            *cycles += f64::from(u8::from(rig.bit(name)));
        }
    }
    let scan_us = 20_000.0;
    let per_scan = scan_us / f64::from(rig.control.cycle_us());
    cycles.iter().map(|cycles| cycles / per_scan).collect()
}

/// Only one of many is on, for so many scans.
fn only_one(place: usize, seen: [Vec<f64>; 2], scans: f64) -> Verdict {
    let [before, mut after] = seen;
    let changed = after.get(place).copied().unwrap_or_default();
    if let Some(after) = after.get_mut(place) {
        *after = 0.0;
    }
    all("unchanged", &before, &vec![0.0; before.len()], 0.0)?;
    all("the others", &after, &vec![0.0; after.len()], 0.0)?;
    all("changed", &[changed], &[scans], 0.5)
}

/// T0 to T31 are started together: each runs as long as MP110 to MP125 and MP193 to MP208 say, in units of 20 ms
/// [001:1833].
fn timers(number: u16) -> Verdict {
    let place = match number {
        110..=125 => number - 110,
        _ => number - 193 + 16,
    };
    let program = (0..32).fold(String::from("       U     E30\n"), |mut text, timer| {
        let _ = writeln!(text, "       =     T{timer}");
        text
    });
    let list: String = (110..126)
        .chain(193..209)
        .fold(String::new(), |mut text, number| {
            let _ = write!(text, " {number}=0");
            text
        });
    let names: Vec<String> = (48..80).map(|timer| format!("T{timer}")).collect();
    let seen = both(number, "8", |mps| {
        let mut rig = asked(bench_with(&edge(&program), &list).mps(mps));
        scans(&mut rig, &names)
    });
    only_one(place.into(), seen, 8.0)
}

/// The instructions that follow E30 act in the scan in which it has closed.
fn edge(program: &str) -> String {
    let edge =
        "       U     E30\n       UN    M700\n       =     M701\n       U     E30\n       =     M700\n";
    format!("{edge}{}", program.replace("U     E30", "U     M701"))
}

/// C0 to C15 are set together and count each scan: MP94 to MP109 [001:1832].
fn counters(number: u16) -> Verdict {
    let mut program = edge("       U     E30\n");
    let _ = (0..16).try_for_each(|counter| writeln!(program, "       =     C{counter}"));
    program.push_str("       U     M700\n");
    let _ = (96..112).try_for_each(|counter| writeln!(program, "       =     C{counter}"));
    let list: String = (94..110).fold(String::new(), |mut text, number| {
        let _ = write!(text, " {number}=0");
        text
    });
    let names: Vec<String> = (48..64).map(|counter| format!("C{counter}")).collect();
    let seen = both(number, "8", |mps| {
        let mut rig = asked(bench_with(&program, &list).mps(mps));
        scans(&mut rig, &names)
    });
    let [before, mut after] = seen;
    let place = usize::from(number - 94);
    let changed = std::mem::take(&mut after[place]);
    // A counter is set for the scan before it is released.
    same(
        [before, after].map(|seen| seen.into_iter().all(|scans| scans <= 1.0)),
        [true; 2],
    )?;
    all("changed", &[changed], &[8.5], 1.1)
}

/// Instructions that set markers to a number, its lowest bit first.
fn write_code(first: u16, count: u16, code: u16) -> String {
    (0..count).fold(String::new(), |mut text, bit| {
        let command = if code >> bit & 1 == 1 { 'S' } else { 'R' };
        let _ = writeln!(text, "       {command}     M{}", first + bit);
        text
    })
}

/// The PLC moves X to the position of a code: code 0 is MP126, 29 is MP155, counted from the reference mark [001:1834].
fn positions(number: u16) -> Verdict {
    let program = format!(
        "       U     E30\n{}       S     M2452\n       R     M2468\n",
        write_code(2560, 5, number - 126)
    );
    let seen = both(number, "-4.5", |mps| {
        let build = bench_of_markers(&edge(&program), "163=6000").mps(mps);
        let mut rig = ready(build);
        rig.event("fault input E30 1");
        rig.seconds(0.6);
        rig.machine_position('X')
    });
    pair(seen, [0.0, -4.5], 0.02)
}

/// The PLC moves all axes to the position of code 0, each at its own feed: MP163 to MP166 [001:1837].
fn feeds(number: u16) -> Verdict {
    let mut program = "       U     E30\n".to_owned();
    for axis in 0..4 {
        program += &write_code(2560 + 5 * axis, 5, 0);
        let _ = write!(
            program,
            "       S     M{}\n       R     M{}\n",
            2452 + axis,
            2468 + axis
        );
    }
    let list = "126=-15 163=1800 164=1800 165=1800 166=1800";
    let seen = both(number, "900", |mps| {
        let mut rig = ready(bench_of_markers(&edge(&program), list).mps(mps));
        rig.event("fault input E30 1");
        rig.seconds(0.3);
        of_axes(&rig, "nominal-speed").map(f64::abs)
    });
    only(number - 163, seen, [1800.0, 900.0], 1.0)
}

/// MP158 is M2192 to M2207, MP249 M2208 to M2223, MP250 M2224 to M2239 [001:1835] [001:1839-1840].
fn markers(number: u16) -> Verdict {
    let first = match number {
        158 => 2192,
        249 => 2208,
        _ => 2224,
    };
    let seen = both(number, "32773", |mps| {
        let rig = asked(bench("158=0 249=0 250=0").mps(mps));
        let set = (2192..2240).filter(|marker| rig.bit(&format!("M{marker}")));
        set.collect::<Vec<u16>>()
    });
    same(seen, [vec![], vec![first, first + 2, first + 15]])
}

/// MP209 to MP212 are the words W982 to W988 and the markers M3200 to M3263 [001:1838].
fn words(number: u16) -> Verdict {
    let place = number - 209;
    let seen = both(number, "9", |mps| {
        let rig = asked(bench("209=0 210=0 211=0 212=0").mps(mps));
        let words = [982, 984, 986, 988].map(|word| rig.number(&format!("W{word}")));
        let set = (3200..3264).filter(|marker| rig.bit(&format!("M{marker}")));
        (words, set.collect::<Vec<u16>>())
    });
    let mut words = [0; 4];
    words[usize::from(place)] = 9;
    let first = 3200 + 16 * place;
    same(seen, [([0; 4], vec![]), (words, vec![first, first + 3])])
}

/// The knee mill with a PLC program of its own: 0 runs it, 1 the standard program of the EPROM [001:1831].
fn source(_: u16) -> Verdict {
    let begins = ["MP77     : 0", "MP77     : 1"].map(|line| {
        let own = [
            ("machine.toml", "plc = \"standard\"", "plc = \"OWN.PLC\""),
            ("OWN.PLC", "", "; own\n       U     E0\n       =     A0\n"),
            ("parameters.mp", "MP77     : 1", line),
        ];
        mill(&own, |machine| {
            let file = machine.plc.files.first()?;
            file.lines.first().map(|line| line.starts_with("; own"))
        })
    });
    same(begins, [Some(true), Some(false)])
}
