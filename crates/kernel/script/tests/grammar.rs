//! The lines, times and words that every script has.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::path::Path;

use bahn_script::{Base, Fault, Script, Times, Verbs, Words};
use bahn_text::Diagnostic;
use proptest::prelude::*;

/// It does whatever is said, and has one rule: `keep N`.
#[derive(Default)]
struct Echo {
    kept: Vec<f64>,
}

impl Verbs for Echo {
    type Action = String;
    type Condition = String;

    fn action<'a>(&mut self, what: &'a str) -> Result<String, Fault<'a>> {
        match what {
            "" => Err(Fault::new(what, "nothing is done")),
            what => Ok(what.to_owned()),
        }
    }

    fn end<'a>(&mut self, what: &'a str) -> Result<String, Fault<'a>> {
        Ok(format!("no {what}"))
    }

    fn looks(&self, action: &String) -> bool {
        action.starts_with("look")
    }

    fn condition<'a>(&mut self, text: &'a str) -> Result<Vec<String>, Fault<'a>> {
        Ok(vec![text.to_owned()])
    }

    fn message(&mut self, text: &str) -> Result<Vec<String>, String> {
        Ok(vec![format!("message {text}")])
    }

    fn rule<'a>(&mut self, _: &'a str, words: &mut Words<'a>, times: &Times) -> Result<(), Fault<'a>> {
        match words.one_of(&["keep", "wait", "last"])? {
            "keep" => self.kept.push(words.number("a number")?),
            "wait" => self.kept.push(times.duration_of(words, "a time")? as f64),
            _ => {
                let (from, to) = times.span_of(words)?;
                self.kept.extend([from as f64, to as f64]);
            }
        }
        Ok(())
    }
}

/// A cycle takes 3 ms.
fn read(text: &str) -> (Script<String, String>, Vec<Diagnostic>, Vec<f64>) {
    let mut echo = Echo::default();
    let (script, faults) = Script::read(
        Path::new("s.txt"),
        text,
        Times::of_cycle(3000).up_to(1e6),
        &mut echo,
    );
    (script, faults, echo.kept)
}

#[test]
fn a_line_has_a_time_and_what_happens() {
    let text = "; a comment\n1.5: a # b\n+0.5: say \"x; y: z\" ; said\n\n 20 cycles:  name#1 \nstart+3: c\n+1: d\nstart: e\n";
    let (script, faults, _) = read(text);
    assert_eq!(faults, []);
    let lines = script.lines.iter();
    let lines = lines.map(|line| (line.number, line.base, line.offset_us, line.action.as_str()));
    use Base::*;
    assert!(lines.eq([
        (2, PowerOn, 1_500_000, "a"),
        (3, PowerOn, 2_000_000, "say \"x; y: z\""),
        // 20 times 3 ms.
        (5, PowerOn, 60_000, "name#1"),
        (6, Start, 3_000_000, "c"),
        (7, Start, 4_000_000, "d"),
        (8, Start, 0, "e"),
    ]));
    assert_eq!(script.place(3), "s.txt:3");
}

/// A condition waits from the line before on, and what follows counts from it; a number before a colon is its channel.
#[test]
fn conditions_begin_a_chain() {
    let (script, faults, _) = read("1: a\nwhen 2:X > 5: b\n+20 cycles: c\nafter message \"A B\": d\n2: e");
    assert_eq!(faults, []);
    let lines = script.lines.iter();
    let lines: Vec<_> = lines
        .map(|line| (line.base, line.offset_us, line.condition.concat()))
        .collect();
    use Base::*;
    assert_eq!(
        lines,
        [
            (PowerOn, 1_000_000, String::new()),
            (PowerOn, 1_000_000, "2:X > 5".to_owned()),
            (Condition(0), 60_000, String::new()),
            (Condition(0), 60_000, "message A B".to_owned()),
            (PowerOn, 2_000_000, String::new()),
        ]
    );
}

/// Cycle 5 begins after four of them; what looks at it looks when it has ended.
#[test]
fn cycles_are_numbered_from_1() {
    let (script, ..) = read("cycle 1: a\ncycle 5: look\n+0: look\ncycle 5: b\n");
    let lines = script.lines.iter().map(|line| (line.offset_us, line.after));
    assert!(lines.eq([(0, false), (15_000, true), (15_000, false), (12_000, false)]));
}

#[test]
fn a_span_of_time_begins_and_ends() {
    let (script, faults, _) = read("2..2.5: a\n+1: b\nstart+1..+2: c\ncycle 1..cycle 3: d\n");
    assert_eq!(faults, []);
    let lines = script
        .lines
        .iter()
        .map(|line| (line.base, line.offset_us, line.action.as_str()));
    use Base::*;
    assert!(lines.eq([
        (PowerOn, 2_000_000, "a"),
        (PowerOn, 2_500_000, "no a"),
        (PowerOn, 3_500_000, "b"),
        (Start, 1_000_000, "c"),
        (Start, 3_000_000, "no c"),
        (PowerOn, 0, "d"),
        (PowerOn, 6_000, "no d"),
    ]));
}

/// Rules stand without a time; a comment ends them wherever it begins.
#[test]
fn rules_are_words() {
    let (_, faults, kept) = read("keep 3#three\n keep 4.5 ; four\nwait 2 cycles\nwait 0.5\nlast 1..2 # s");
    assert_eq!(faults, []);
    assert_eq!(kept, [3.0, 4.5, 6000.0, 500_000.0, 1e6, 2e6]);
}

/// Each fault has its place, and what is meant where it can be guessed.
#[test]
fn faults_have_their_places() {
    for (text, line, column, length, said, help) in [
        ("1: a\nfive: b", 2, 1, 4, "no time", None),
        ("cycle 0: a", 1, 1, 7, "no cycle", None),
        ("+2.5 cycles: a", 1, 2, 10, "no time", None),
        ("1e7: a", 1, 1, 3, "no time", None),
        ("after rain: a", 1, 1, 10, "after message TEXT", None),
        ("start 3: a", 1, 1, 7, "+ and a time", None),
        ("2..1: a", 1, 1, 4, "before it begins", None),
        ("1..start: a", 1, 1, 8, "same moment", None),
        ("  1:", 1, 5, 1, "nothing", None),
        (
            "kepe 3",
            1,
            1,
            4,
            "`keep`, `wait` or `last`",
            Some("did you mean `keep`?"),
        ),
        ("keep -3", 1, 6, 2, "not a number", None),
        ("keep", 1, 5, 1, "missing", None),
        ("keep 3 4", 1, 8, 1, "too much", None),
        ("wait ü", 1, 6, 1, "not a time", None),
        ("last 1", 1, 6, 1, "span of time", None),
    ] {
        let (_, faults, _) = read(text);
        let [fault] = faults.as_slice() else {
            panic!("{text}: {faults:?}");
        };
        let place = (fault.span.line, fault.span.column, fault.span.length);
        assert_eq!(place, (line, column, length), "{text}: {fault}");
        assert!(fault.message.contains(said), "{text}: {fault}");
        assert_eq!(fault.help.as_deref(), help, "{text}");
        assert_eq!(fault.source, text.lines().nth(line as usize - 1).unwrap());
    }
    // A file that is no script at all is not told line by line.
    let (_, faults, _) = read(&"?: a\n".repeat(2000));
    assert_eq!(faults.len(), 1001);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_a_script_or_faults_with_their_lines(
        text in prop_oneof![".{0,60}", "((when |cycle |start)?[+0-9a-z. ]{0,8}(: ?)?[a-zA-Z0-9.#; \"]{0,12}\n){0,6}"],
    ) {
        let (script, faults, _) = read(&text);
        let lines = text.lines().count() as u32;
        prop_assert!(faults.iter().all(|fault| (1..=lines).contains(&fault.span.line)));
        prop_assert!(script.lines.iter().all(|line| (1..=lines).contains(&line.number)));
    }
}
