//! Data files: what is read, what is refused and where, what is written.

use bahn_system900::{Change, DataFile, Memory, Name};
use bahn_text::Severity;

const SAMPLE: &str = include_str!("../data/two-channels.q");

fn number(memory: &Memory, name: &str) -> Option<f64> {
    memory.cell(name.parse().unwrap()).unwrap().number()
}

/// Errors as `line:column: message`.
fn errors(text: &str) -> Vec<String> {
    of(text, Severity::Error)
}

fn of(text: &str, severity: Severity) -> Vec<String> {
    let file = DataFile::read(text.as_bytes());
    let faults = file.faults().iter().filter(|fault| fault.severity == severity);
    faults.map(ToString::to_string).collect()
}

#[test]
fn the_sample_is_read() {
    let file = DataFile::read(SAMPLE.as_bytes());
    assert_eq!(file.faults(), []);
    let memory = file.memory();
    assert_eq!((memory.channels(), memory.count()), (2, 40_000));
    for (name, value) in [
        ("q20", None),
        ("q2004", Some(12_000.0)),
        ("P12004", Some(12_000.0)),
        ("P12020", Some(1.5)),
        ("q1640", Some(6.0)),
        ("P21010", Some(4.975)),
        ("2:P7000", Some(0.0)),
        ("2:P7001", None),
        ("P1000", Some(7.0)),
        ("q18000", Some(100.25)),
    ] {
        assert_eq!(number(memory, name), value, "{name}");
    }
    assert_eq!(memory.q(Name::P(2, 7000)).unwrap(), 22_000);
}

/// Blanks and case do not count, comments are anywhere, the last line counts.
#[test]
fn how_lines_are_written() {
    let text = "Q 2 :2;two\n q3:40000\r\n{ over\nq1: 5\nlines } q 102 : 10000 {x} $00000001\nq103: 10\n\
                q202: 20000\nq203: 10\nq10:99\nk2 : p3 : -1.5 ; {\nK1:P7000:$ff\nP1:--\n";
    let file = DataFile::read(text.as_bytes());
    assert_eq!(file.faults(), []);
    let memory = file.memory();
    assert_eq!(number(memory, "q20003"), Some(-1.5));
    assert_eq!(number(memory, "q10010"), Some(255.0));
    assert_eq!(number(memory, "q1"), None, "within a comment");
    // In UTF-16, too.
    let wide: Vec<u8> = [0xff, 0xfe]
        .into_iter()
        .chain("q5: 7".bytes().flat_map(|byte| [byte, 0]))
        .collect();
    assert_eq!(number(DataFile::read(&wide).memory(), "q5"), Some(7.0));
}

/// Each fault has its place; what can be read is read.
#[test]
fn every_fault_in_one_go() {
    let text = "hello\nq5\nq5:\nq5: x\nq5: 99999999999\nq5: 1 $12\nq5: 1 $00000001 x\nq5: 0.12345678901\nqx: 1\n\
                q50000: 1\nq40000: 1\n  P0: 3 ; höher\nq10: 98\nq5: 7\n";
    assert_eq!(
        errors(text),
        [
            "1:1: a line is `NAME: VALUE [STATUS]`",
            "2:1: a line is `NAME: VALUE [STATUS]`",
            "3:1: q5 has no value",
            "4:5: `x` is no value: 12.5, -3, $1F, --",
            "5:5: q5: 99999999999 does not go into four bytes",
            "6:7: `$12` is no status: $ and eight hexadecimal digits, as $30020401",
            "7:17: after the status nothing follows but a comment",
            "8:5: 0.12345678901 has more than 9 decimals",
            "9:1: `qx` is no parameter: q102, P7000, 2:P7000",
            "10:1: q50000 is no parameter: the last one is q49999",
            "11:1: q40000 is no parameter: the last one is q29999",
            "12:3: P0: q102 and q103 of the channel do not say where it lies",
            "13:6: q10 is 99 in a data file and nothing else",
        ]
    );
    assert_eq!(number(DataFile::read(text.as_bytes()).memory(), "q5"), Some(7.0));
}

#[test]
fn a_comment_ends() {
    let message = "the comment that begins here does not end";
    assert_eq!(
        errors("q5: 1\nq6: 2 { and so on\nq7: 3\n"),
        [format!("2:7: {message}")]
    );
    assert_eq!(
        errors("q5: 1 { a\nq6: 2 { b }\nq7: 3\n"),
        [format!("1:7: {message}")]
    );
}

/// `q10: 99` activates the descriptors; before it a line of a channel beyond the first is a fault, and so is one of a channel
/// above q2 [002:409-430].
#[test]
fn a_line_of_another_channel_stands_after_q10() {
    let begin = "q2: 2\nq102: 10000\nq103: 5000\nq202: 20000\nq203: 2000\nP0: 1\n";
    let fault = "channel 2 is not active: `q10: 99` stands before its lines";
    assert_eq!(errors(&format!("{begin}2:P0: 1\n")), [format!("7:1: {fault}")]);
    assert_eq!(errors(&format!("{begin}q10: 99\n2:P0: 1\n")), [""; 0]);
    let above = "8:1: 3:P0: there is no channel 3, q2 is 2";
    assert_eq!(errors(&format!("{begin}q10: 99\n3:P0: 1\n")), [above]);
    // Activated is what q2 says then.
    let later = format!("{begin}q10: 99\nq2: 3\nq302: 25000\nq303: 100\n3:P0: 1\n");
    assert_eq!(
        errors(&later),
        ["11:1: channel 3 is not active: `q10: 99` stands before its lines"]
    );
    // P12153 is one of a channel, too.
    let own = format!("{begin}q210: $00010058\n2:P12153: 1\n");
    assert_eq!(errors(&own), [format!("8:1: {fault}")]);
}

#[test]
fn what_is_doubtful_is_said() {
    let warnings = |text: &str| of(text, Severity::Warning);
    assert_eq!(
        warnings("q102: 10000\nq103: 10\nP7000: 1\nq10010: 2\n"),
        ["4:1: q10010 stands in line 3 already; this line counts"]
    );
    assert_eq!(
        warnings("q5: 1 $00000000\nq6: -- $00000001\n"),
        [
            "1:7: the status says that q5 is cleared; the value counts",
            "2:8: the status says that q6 is loaded; the value counts"
        ]
    );
    assert_eq!(
        warnings("q102: 10000\nq103: 10\nP0: 1\nq102: 11000\n"),
        [
            "4:1: q102 stands in line 1 already; this line counts",
            "4:7: q102 moves parameters of channel 1; what stood before this line stays where it was"
        ]
    );
}

fn change(name: &str, value: Option<&str>, status: Option<&str>) -> Change {
    Change {
        name: name.parse().unwrap(),
        value: value.map(str::to_owned),
        status: status.map(|status| status.parse().unwrap()),
    }
}

fn changed(text: &str, changes: &[Change]) -> Result<String, String> {
    let file = DataFile::read(text.as_bytes()).changed(changes)?;
    Ok(file.text().to_owned())
}

/// Lines, order and comments stay; the line that counts gets the value, a parameter without one a line at the end.
#[test]
fn a_change_keeps_the_file() {
    let text = "q102: 10000 ; begin\nq103: 5000\nP5: 1 $02000001 {a} ; b\nP5: 2.5 $02000001 ; c";
    assert_eq!(
        changed(text, &[change("q10005", Some("7.125"), None)]).unwrap(),
        "q102: 10000 ; begin\nq103: 5000\nP5: 1 $02000001 {a} ; b\nP5: 7.125 $03000001 ; c"
    );
    assert_eq!(
        changed(text, &[change("P5", Some("--"), None)]).unwrap(),
        "q102: 10000 ; begin\nq103: 5000\nP5: 1 $02000001 {a} ; b\nP5: -- $02000000 ; c"
    );
    assert_eq!(
        changed(text, &[change("P5", None, Some("$30000000"))]).unwrap(),
        "q102: 10000 ; begin\nq103: 5000\nP5: 1 $02000001 {a} ; b\nP5: $FA $30000001 ; c",
        "250 are $FA"
    );
    assert_eq!(
        changed(
            text,
            &[
                change("P6", Some("$1f"), None),
                change("P7", None, Some("$30000000"))
            ]
        )
        .unwrap(),
        format!("{text}\nP6: $1F\nP7: -- $30000000\n")
    );
}

/// The second channel gets its line after the descriptors are active.
#[test]
fn a_line_of_another_channel_activates_it() {
    let text = "q2: 2\nq102: 10000\nq103: 5000\nq202: 20000\nq203: 2000\n";
    let with = changed(text, &[change("2:P7000", Some("3"), None)]).unwrap();
    assert_eq!(with, format!("{text}q10: 99\n2:P7000: 3\n"));
    assert_eq!(errors(&with), [""; 0]);
}

/// A value that does not parse, is too great, or makes the file wrong changes nothing.
#[test]
fn a_change_is_refused() {
    let refused = |name, value| {
        changed(
            SAMPLE,
            &[change("q20", Some("1"), None), change(name, Some(value), None)],
        )
    };
    for (name, value, why) in [
        ("q5", "far", "q5: `far` is no value: 12.5, -3, $1F, --"),
        ("q5", "3000000000", "q5: 3000000000 does not go into four bytes"),
        ("P6000", "1", "P6000: its block has 5000 parameters, q103"),
        (
            "q2",
            "9",
            "line 4 of the changed file: q2 is a whole number from 1 to 8",
        ),
        (
            "q103",
            "8000",
            "line 10 of the changed file: q103 is a whole number from 1 to 7000",
        ),
        ("q10", "170", "20:6: q10 is 99 in a data file and nothing else"),
    ] {
        let said = refused(name, value).unwrap_err();
        match name {
            "q10" => assert!(
                said.ends_with("q10 is 99 in a data file and nothing else"),
                "{said}"
            ),
            _ => assert_eq!(said, why),
        }
    }
    assert!(refused("q5", "2").unwrap().ends_with("q20: 1\nq5: 2\n"));
}
