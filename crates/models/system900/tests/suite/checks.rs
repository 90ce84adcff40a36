//! What of a data file does not go together: every fault at its place.

use bahn_system900::{DataFile, check};
use bahn_text::Severity;

const SAMPLE: &str = include_str!("../data/two-channels.q");

/// One channel with X and Y; each line has its number from 1 on.
const BASE: [&str; 10] = [
    "q2: 2",
    "q3: 40000",
    "q102: 10000",
    "q103: 5000",
    "q104: 18000",
    "q105: 2000",
    "q110: $01010058",
    "q111: $02020059",
    "q202: 20000",
    "q203: 2000",
];

/// Errors and warnings of the base with further lines, from 11 on; a line for a number of the base takes its place.
fn faults(lines: &[&str]) -> (Vec<String>, Vec<String>) {
    let mut all: Vec<&str> = BASE.to_vec();
    for line in lines {
        let number = line.split(':').next().unwrap();
        match all
            .iter()
            .position(|known| known.split(':').next() == Some(number))
        {
            Some(at) => all[at] = line,
            None => all.push(line),
        }
    }
    let checked = check(&DataFile::read(all.join("\n").as_bytes()));
    let of = |severity| {
        let faults = checked
            .faults
            .iter()
            .filter(move |fault| fault.severity == severity);
        faults.map(ToString::to_string).collect()
    };
    (of(Severity::Error), of(Severity::Warning))
}

fn errors(lines: &[&str]) -> Vec<String> {
    faults(lines).0
}

#[test]
fn the_sample_is_without_fault() {
    let checked = check(&DataFile::read(SAMPLE.as_bytes()));
    assert_eq!(checked.faults, []);
    let axes: Vec<String> = checked
        .channels
        .iter()
        .flat_map(|channel| {
            channel.axes.iter().map(|axis| {
                format!(
                    "{}:{}:{}:{}:{}",
                    channel.channel, axis.logical, axis.name, axis.physical, axis.key
                )
            })
        })
        .collect();
    assert_eq!(
        axes,
        [
            "1:1:X:1:1",
            "1:2:Y:2:2",
            "1:3:Z:3:3",
            "2:1:Y3:4:66",
            "2:2:Z:5:0",
            "2:3:C:6:0"
        ]
    );
    assert_eq!(faults(&[]), (vec![], vec![]));
}

/// q2 is 1 to 8, q3 30000 to 50000 [002:381-385] [002:3].
#[test]
fn blocks_end_within_q3() {
    for value in ["0", "9", "1.5", "--", "-1"] {
        assert!(
            errors(&[&format!("q2: {value}")]).contains(&"1:5: q2 is a whole number from 1 to 8".to_owned())
        );
    }
    for value in ["29999", "50001", "--"] {
        let found = errors(&[&format!("q3: {value}")]);
        assert!(
            found.contains(&"2:5: q3 is a whole number from 30000 to 50000".to_owned()),
            "{found:?}"
        );
    }
    // 36000 + 1000 + 3000 = 40000: the last one is q39999.
    assert_eq!(errors(&["q202: 36000", "q203: 1000"]), [""; 0]);
    assert_eq!(
        errors(&["q202: 36000", "q203: 1001"]),
        ["9:7: the fixed parameters of channel 2 ends at q40000, beyond q39999"]
    );
    assert_eq!(
        errors(&["q3: 30000", "q104: 29999"]),
        ["5:7: user block 2 of channel 1 ends at q31998, beyond q29999"]
    );
}

/// User blocks may lie over one another, never over fixed parameters or q0 to q8399 [002:709-711].
#[test]
fn blocks_lie_beside_one_another() {
    assert_eq!(errors(&["q104: 8400", "q105: 1600"]), [""; 0]);
    assert_eq!(
        errors(&["q104: 8399", "q105: 1600"]),
        ["5:7: user block 2 of channel 1 begins within q0 to q8399"]
    );
    // P7000 to P9999 of channel 1 are q15000 to q17999.
    assert_eq!(
        errors(&["q104: 17999"]),
        ["5:7: user block 2 of channel 1 lies over the fixed parameters of channel 1"]
    );
    assert_eq!(
        errors(&["q202: 13000", "q203: 3000"]),
        [
            "9:7: the fixed parameters of channel 2 lies over the fixed parameters of channel 1",
            "9:7: the fixed parameters of channel 2 lies over user block 2 of channel 1",
            "9:7: user block 1 of channel 2 lies over the fixed parameters of channel 1"
        ]
    );
    let (errors, warnings) = faults(&["q106: 10000", "q107: 100"]);
    assert_eq!(errors, [""; 0]);
    assert_eq!(
        warnings,
        ["11:7: user block 3 of channel 1 lies over user block 1 of channel 1"]
    );
}

#[test]
fn counts_have_a_range() {
    for (line, range) in [
        ("q103: 0", "1 to 7000"),
        ("q103: 7001", "1 to 7000"),
        ("q105: 0", "1 to 10000"),
        ("q105: 10001", "1 to 10000"),
        ("q105: 1.5", "1 to 10000"),
        ("q171: 0", "1 to 10000"),
        ("q172: -1", "0 to 10000"),
        ("q173: 33", "1 to 32"),
        ("q174: 10", "0 to 9"),
        ("q176: -5", "0 to 10000"),
        ("q178: 0", "1 to 10000"),
        ("q177: -1", "0 to 10000"),
        ("q179: 10001", "0 to 10000"),
        ("q159: 10", "0 to 9"),
    ] {
        let found = errors(&[line]);
        let number = line.split(':').next().unwrap();
        let wanted = format!("{number} is a whole number from {range}");
        assert!(
            found.iter().any(|fault| fault.ends_with(&wanted)),
            "{line}: {found:?}"
        );
    }
    assert_eq!(
        errors(&["q170: 1.5", "q175: -1"]),
        [
            "11:7: q170 is no number of a parameter",
            "12:7: q175 is no number of a parameter"
        ]
    );
}

#[test]
fn axes_are_there_once() {
    assert_eq!(
        errors(&["q112: $0021005A"]),
        ["11:7: there is no physical axis 33, the last is 32"]
    );
    assert_eq!(
        errors(&["q112: $00030058"]),
        ["11:7: channel 1 has an axis X already"]
    );
    assert_eq!(
        errors(&["q112: $00030358", "q113: $00040000", "q114: $00050000"]),
        [""; 0],
        "X3, and two without name"
    );
    // In another channel the same letter is another axis.
    assert_eq!(errors(&["q210: $00030058"]), [""; 0]);
    let (errors, warnings) = faults(&[
        "q210: $00010058",
        "q112: $0002005A",
        "q113: $00000041",
        "q114: $50070042",
    ]);
    assert_eq!(errors, [""; 0]);
    assert_eq!(
        warnings,
        [
            "11:7: physical axis 1 is one of channel 1, too",
            "12:7: channel 1 has physical axis 2 already",
            "13:7: logical axis 4 of channel 1 has no physical axis",
            "14:7: there is no key 80, the last is 79"
        ]
    );
}

#[test]
fn planes_have_axes() {
    assert_eq!(errors(&["q152: $000201"]), [""; 0]);
    assert_eq!(
        errors(&["q152: $030201"]),
        ["11:7: channel 1 has no logical axis 3 for a plane"]
    );
    assert_eq!(
        errors(&["q252: $000201"]),
        ["11:7: channel 2 has no logical axis 1 for a plane"]
    );
    assert_eq!(
        errors(&["P8841: $000900"]),
        ["11:8: channel 1 has no logical axis 9 for a plane"]
    );
}

/// P20000 to P21999 are the second block, P0 to P4999 the first.
#[test]
fn zero_points_and_tools_lie_in_user_blocks() {
    let zero = ["q170: 20000", "q171: 1", "q172: 0", "q173: 32"];
    let of = |lines: &[&'static str]| errors(&[&zero[..], lines].concat());
    // 7 * 32 = 224: up to P20223.
    assert_eq!(of(&["q175: 20224", "q176: 50", "q178: 20"]), [""; 0]);
    let overlap = "15:7: zero points and tools of channel 1 lie over one another";
    assert_eq!(of(&["q175: 20223", "q176: 50", "q178: 20"]), [overlap]);
    assert_eq!(
        of(&["q175: 21500", "q176: 50", "q178: 20"]),
        ["15:7: the tools of channel 1, P21500 to P22499, do not lie in one of its user blocks"]
    );
    assert_eq!(
        errors(&["q170: 6000", "q173: 3"]),
        ["11:7: the zero points of channel 1, P6000 to P6020, do not lie in one of its user blocks"]
    );
    assert_eq!(errors(&["q170: 4979", "q173: 3"]), [""; 0]);
    assert_eq!(
        errors(&["q170: 7000", "q173: 3"]).len(),
        1,
        "the fixed parameters are no user block"
    );
}

#[test]
fn couplings_and_spindles_have_axes() {
    assert_eq!(
        errors(&["P11480: 1", "P11481: 2", "P11640: 2", "P11660: 0"]),
        [""; 0]
    );
    for line in [
        "P11480: 3",
        "P11481: 3",
        "P11621: 33",
        "P11640: 3",
        "P11780: -1",
        "q1640: 1.5",
    ] {
        let found = errors(&[line]);
        let value = line.split(": ").nth(1).unwrap();
        assert_eq!(found.len(), 1, "{line}: {found:?}");
        assert!(
            found[0].ends_with(&format!("no channel has a physical axis {value}")),
            "{found:?}"
        );
        assert!(found[0].starts_with("11:"), "{found:?}");
    }
    assert_eq!(
        errors(&["q142: 9"]),
        ["11:7: q142 is a spindle block from 1 to 8"]
    );
}

#[test]
fn doubtful_functions() {
    let (errors, warnings) = faults(&["P11051: $50454004", "P11058: $41000000"]);
    assert_eq!(errors, [""; 0]);
    assert_eq!(
        warnings,
        [
            "11:9: M4 does not stop: it goes out neither before nor after the path",
            "11:9: M5 calls no cycle: only numbers above 30 do",
            "11:9: M6 calls no cycle: only numbers above 30 do",
            "11:9: M7 branches: its other bits do not count",
            "12:9: M35 calls a cycle: its other bits do not count"
        ]
    );
}

#[test]
fn a_channel_without_descriptor_is_doubtful() {
    let (errors, warnings) = faults(&["q2: 3"]);
    assert_eq!(errors, [""; 0]);
    assert_eq!(
        warnings,
        ["1:5: q302 and q303 do not say where the parameters of channel 3 lie"]
    );
    // Half a block, or another one alone, is none.
    let half = |lines: &str| {
        let checked = check(&DataFile::read(lines.as_bytes()));
        checked.faults.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let said = "q102 and q103 do not say where the parameters of channel 1 lie";
    assert_eq!(half("q4: 1\nq102: 10000\n"), [format!("2:7: {said}")]);
    assert_eq!(half("q4: 1\nq103: 100\n"), [format!("2:7: {said}")]);
    assert_eq!(half("q104: 10000\nq105: 100\n"), [format!("1:7: {said}")]);
    // A file may hold changes alone.
    let alone = check(&DataFile::read(b"q110: $00010058\nP12004: 8000\n"));
    assert_eq!(alone.errors().count(), 0);
}
