//! Programs of a System 900: each fragment that the manual shows, and what is refused beside it.

#![allow(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

#[path = "support/system900.rs"]
mod support;

use bahn_din::system900::{
    AxisName, Condition, MFunction, Number, Parameter, Program, Relation, Value, WordKind,
};
use support::{faults, program, warnings, words};

fn whole(mantissa: i32) -> Value {
    Value::Number(Number {
        mantissa,
        decimals: 0,
    })
}

fn p(number: u16) -> Parameter {
    Parameter::new(number).unwrap()
}

fn axis(letter: char, extension: u8) -> AxisName {
    AxisName { letter, extension }
}

fn write(parameter: u16, value: Option<Value>) -> WordKind {
    WordKind::Write {
        parameter: p(parameter),
        value,
    }
}

/// The measuring flow of [002:1636-1655]: start, wait until it has ended or failed, go to what takes the value, which is
/// here the end of a move.
#[test]
fn a_measurement_is_waited_for() {
    let text = "N100 P7950:1             { start the measurement }\n\
                N110 M1                  { where the loop comes back to\n\
                N120 P7960<10.110        { wait }\n\
                N130 P7960=10.200        { it was good }\n\
                N140 M0                  { it failed }\n\
                N200 G1 X:P7961\n";
    let program = program(text);
    assert_eq!(faults(text), [""; 0]);
    assert_eq!(words(&program, 1), [write(7950, Some(whole(1)))]);
    let switch = MFunction {
        number: 1,
        target: None,
        count: None,
    };
    assert_eq!(words(&program, 2), [WordKind::M(switch)]);
    let jump = |relation, target| {
        WordKind::Jump(Condition {
            parameter: p(7960),
            relation,
            with: whole(10),
            target,
        })
    };
    assert_eq!(words(&program, 3), [jump(Relation::Less, 110)]);
    assert_eq!(words(&program, 4), [jump(Relation::Equal, 200)]);
    let content = Value::Content(p(7961));
    assert_eq!(
        words(&program, 6),
        [WordKind::G(1), WordKind::Axis(axis('X', 0), content)]
    );
    assert_eq!(
        [110, 200, 130, 150].map(|number| program.line_of(number)),
        [Some(2), Some(6), Some(4), None]
    );
}

/// [002:7826-7828]: a colon may stand before a value, words may be glued, a parameter stands before the move.
#[test]
fn words_have_a_colon_or_none() {
    let program = program("N100 G28 F100 X:100\nN110 P12113:20 X200\nN120Y100\n");
    let x = |value| WordKind::Axis(axis('X', 0), whole(value));
    assert_eq!(
        words(&program, 1),
        [WordKind::G(28), WordKind::Feed(whole(100)), x(100)]
    );
    assert_eq!(words(&program, 2), [write(12113, Some(whole(20))), x(200)]);
    let block = program.block(2).unwrap().unwrap();
    assert_eq!(block.writes().collect::<Vec<_>>(), [(p(12113), Some(whole(20)))]);
    assert_eq!(words(&program, 3), [WordKind::Axis(axis('Y', 0), whole(100))]);
    assert_eq!(program.line_of(120), Some(3));
}

/// [002:4350-4352]: `$` and hexadecimal digits are the four bytes of a parameter; `--` clears one [002:26].
#[test]
fn parameters_are_written() {
    let program =
        program("N100 G117 P8840:$00010302\nN110 P100:-- P101:-1.50 P102:P103\nN120 P8807:$FFFFFFFF\n");
    // 1 * 256 * 256 + 3 * 256 + 2
    assert_eq!(words(&program, 1)[1], write(8840, Some(whole(65536 + 768 + 2))));
    let decimal = Value::Number(Number {
        mantissa: -15,
        decimals: 1,
    });
    assert_eq!(
        words(&program, 2),
        [
            write(100, None),
            write(101, Some(decimal)),
            write(102, Some(Value::Content(p(103)))),
        ]
    );
    assert_eq!(words(&program, 3), [write(8807, Some(whole(-1)))]);
}

/// A tenth is no binary number: what is written is kept, what is calculated with is the nearest one.
#[test]
fn no_decimal_is_lost() {
    let program = program("N1 X-0.100 Y.5 Z7. U+0.000000001\n");
    let numbers: Vec<(i32, u8)> = words(&program, 1)
        .into_iter()
        .filter_map(|word| match word {
            WordKind::Axis(_, Value::Number(Number { mantissa, decimals })) => Some((mantissa, decimals)),
            _ => None,
        })
        .collect();
    assert_eq!(numbers, [(-1, 1), (5, 1), (7, 0), (1, 9)]);
    let tenth = Number {
        mantissa: -1,
        decimals: 1,
    };
    assert_eq!(tenth.value(), -0.1);
}

/// q111 = $421f0359 is the axis Y3 [002:718-825]; with an extension the colon tells the name from the value.
#[test]
fn axes_have_letter_and_extension() {
    let program = program("N10 Y3:5 Y35 C255:P8000\n");
    assert_eq!(
        words(&program, 1),
        [
            WordKind::Axis(axis('Y', 3), whole(5)),
            WordKind::Axis(axis('Y', 0), whole(35)),
            WordKind::Axis(axis('C', 255), Value::Content(p(8000))),
        ]
    );
    assert_eq!(
        faults("N10 Y0:5\n"),
        ["1:5+2 N10 Y0 is no axis: an extension is 1 to 255"]
    );
    assert_eq!(
        faults("N10 Y256:5\n"),
        ["1:5+4 N10 Y256 is no axis: an extension is 1 to 255"]
    );
    // Nobody here knows the names of the channel.
    assert_eq!(
        warnings("N10 H5\n"),
        ["1:5+2 N10 H is an axis only where the channel names one so (q110 to q141)"]
    );
}

/// S and S2 to S8 [002:858-881], tools by their group.
#[test]
fn spindles_and_tools() {
    let program = program(
        "N10 S1000 S2:500 S8:P600\nN20 T2 M6\nN30 T:P5 M16\nN40 G2 X10 Y0 I5 J-5\nN50 G3 X0 Y0 R-20 F0\n",
    );
    assert_eq!(
        words(&program, 1),
        [
            WordKind::Speed(1, whole(1000)),
            WordKind::Speed(2, whole(500)),
            WordKind::Speed(8, Value::Content(p(600))),
        ]
    );
    assert_eq!(words(&program, 2)[0], WordKind::Tool(whole(2)));
    assert_eq!(words(&program, 3)[0], WordKind::Tool(Value::Content(p(5))));
    assert_eq!(
        words(&program, 4)[3..],
        [WordKind::Centre(0, whole(5)), WordKind::Centre(1, whole(-5))]
    );
    assert_eq!(words(&program, 5)[3], WordKind::Radius(whole(-20)));
    assert_eq!(
        faults("N10 S1:5\nN20 S9:5\nN30 T1.5\nN40 T-1\nN50 S-1 F-1\n"),
        [
            "1:5+2 N10 S1 is no spindle: S, S2 to S8",
            "2:5+2 N20 S9 is no spindle: S, S2 to S8",
            "3:5+4 N30 T takes the whole group number of a tool",
            "4:5+3 N40 T takes no negative value",
            "5:5+3 N50 S takes no negative value",
            "5:9+3 N50 F takes no negative value",
        ]
    );
}

/// Extensions of M functions: the target, then how often [002:5218-5224] [002:5499].
#[test]
fn m_functions_have_extensions() {
    let program = program("N110 X1\nN120 M24.110.5\nN130 M22.200\nN140 M7.200 M007 M234\nN200 M30\n");
    let m = |number, target, count| {
        WordKind::M(MFunction {
            number,
            target,
            count,
        })
    };
    assert_eq!(words(&program, 2), [m(24, Some(110), Some(5))]);
    assert_eq!(words(&program, 3), [m(22, Some(200), None)]);
    assert_eq!(
        words(&program, 4),
        [m(7, Some(200), None), m(7, None, None), m(234, None, None)]
    );
    assert_eq!(
        faults(
            "N10 M22\nN20 M24.10\nN30 M30.10\nN40 M7.10.2.3\nN50 M7.\nN60 M99999\nN70 M24.80.2\nN80 M22.99\n"
        ),
        [
            "1:5+3 N10 M22 needs its target alone, as in `M22.200`",
            "2:5+6 N20 M24 needs its target and how often, as in `M24.110.5`",
            "3:5+6 N30 M30 takes no target",
            "4:5+9 N40 M7.10.2.3 has more than two extensions",
            "5:5+3 N50 M7. needs a number after the point, up to 2147483647",
            "6:5+6 N60 unknown M function M99999",
            "7:5+8 N70 M24 jumps back: N80 comes after it",
            "8:5+6 N80 no block has the number N99",
        ]
    );
}

/// `/` before N: P8810 skips the block [002:4241-4243]. A block without number is called by its line.
#[test]
fn blocks_may_be_skipped() {
    let text = "/ N10 X1\n\nX2\n{ remark } N0020 X3\n/X4\n";
    let program = program(text);
    let skipped = [1, 3, 4, 5].map(|line| program.block(line).unwrap().unwrap().may_be_skipped);
    assert_eq!(skipped, [true, false, false, true]);
    let names = [1, 3, 4, 5].map(|line| program.block_name(line).to_string());
    assert_eq!(names, ["N10", "#3", "N20", "#5"]);
    assert!(program.block(2).is_none());
    assert_eq!(program.numbers(), [(10, 1), (20, 4)]);
    assert_eq!(program.block_count(), 4);
}

/// All G functions that the manual explains can be read: the table names each [002:5075-5143].
#[test]
fn g_functions_are_those_of_the_table() {
    for g in [0, 3, 12, 119, 147, 153, 159, 959, 171] {
        let text = format!("N10 G{g:02}\n");
        assert_eq!(faults(&text), [""; 0], "{text}");
        assert_eq!(words(&program(&text), 1), [WordKind::G(g)]);
    }
    for g in ["G20", "G82", "G160", "G960", "G54.1", "G99999", "G"] {
        let text = format!("N10 {g} X5\n");
        assert_eq!(
            faults(&text),
            [format!("1:5+{} N10 unknown G function {g}", g.len())]
        );
    }
    assert_eq!(
        warnings("N10 G51\n"),
        ["1:5+3 N10 G51 is named in the manual and not explained: no run executes it"]
    );
}

/// The control keeps one function of each group (P9340 ff.); the mirrors of two axes are two groups [002:5119-5124].
#[test]
fn one_of_a_group_counts() {
    assert_eq!(faults("N10 G1 G17 G41 G90 G54 G61 G62\n"), [""; 0]);
    assert_eq!(
        faults("N10 G0 G1\nN20 G54 G159\nN30 G61 G60\nN40 G17 G118\nN50 G1 G01\n"),
        [
            "1:8+2 N10 G1 beside G0: one of them counts in a block",
            "2:9+4 N20 G159 beside G54: one of them counts in a block",
            "3:9+3 N30 G60 beside G61: one of them counts in a block",
            "4:9+4 N40 G118 beside G17: one of them counts in a block",
            "5:8+3 N50 G1 stands twice in the block",
        ]
    );
}

/// Eight G, M and S words have fields in the block information [002:5177-5228].
#[test]
fn eight_of_each_fit_a_block() {
    let eight = "N10 G1 G17 G28 G40 G43 G46 G53 G90 M31 M32 M33 M34 M35 M36 M37 M38\n";
    assert_eq!(faults(eight), [""; 0]);
    assert_eq!(
        faults("N10 G1 G17 G28 G40 G43 G46 G53 G90 G94 M31 M32 M33 M34 M35 M36 M37 M38 M39\n"),
        [
            "1:36+3 N10 more than 8 G words in a block",
            "1:72+3 N10 more than 8 M words in a block",
        ]
    );
}

#[test]
fn a_word_stands_once() {
    assert_eq!(
        faults("N10 X1 X2 Y3:1 Y4:1 F1 F2 T1 T2 S2:1 S2:3 I1 I2\nN20 R5 J1\n"),
        [
            "1:8+2 N10 X stands twice in the block",
            "1:24+2 N10 F stands twice in the block",
            "1:30+2 N10 T stands twice in the block",
            "1:38+4 N10 S2 stands twice in the block",
            "1:46+2 N10 I stands twice in the block",
            "2:8+2 N20 the circle has its radius and its centre: one of them counts",
        ]
    );
}

/// `G4 X2`, `G4 F2` (inferred).
#[test]
fn a_dwell_has_its_time() {
    assert_eq!(faults("N10 G4 X2\nN20 G04 F0.5\nN30 G4 X:P5 M8\n"), [""; 0]);
    assert_eq!(
        faults("N10 G4\nN20 G4 X1 F1\nN30 G4 X1 Y2\n"),
        [
            "1:5+2 N10 G4 needs its time once: `G4 X2` or `G4 F2`",
            "2:5+2 N20 G4 needs its time once: `G4 X2` or `G4 F2`",
            "3:11+2 N30 G4 moves no axis: Y beside it",
        ]
    );
}

/// Conditions: a whole number, since the point parts it from the target; one alone in its block.
#[test]
fn conditions() {
    let text = "N10 P1>-5.10\nN20 P1=P2.10\nN30 P1 < $FF.10\n";
    assert_eq!(faults(text), [""; 0]);
    let program = program(text);
    let condition = |relation, with| {
        WordKind::Jump(Condition {
            parameter: p(1),
            relation,
            with,
            target: 10,
        })
    };
    assert_eq!(words(&program, 1), [condition(Relation::Greater, whole(-5))]);
    assert_eq!(
        words(&program, 2),
        [condition(Relation::Equal, Value::Content(p(2)))]
    );
    assert_eq!(words(&program, 3), [condition(Relation::Less, whole(255))]);
    assert_eq!(
        faults("N10 P1<10\nN20 P1<=10.10\nN30 P1<.10\nN40 P1<5.99\nN50 X1 P1=1.10\nN60 P1\nN70 P1=--.10\n"),
        [
            "1:5+5 N10 P1<10 needs its target, as in `P1<10.110`",
            "2:5+4 N20 unknown comparison P1<=: <, = and > are read",
            "3:8+1 N30 P1 is compared with a whole number of four bytes or a parameter",
            "4:5+7 N40 no block has the number N99",
            "5:8+7 N50 a condition stands alone in its block",
            "6:5+2 N60 P1 needs `:` and a value, or a condition as `P1<10.110`",
            "7:8+1 N70 P1 is compared with a whole number of four bytes or a parameter",
        ]
    );
}

/// What does not fit a parameter is refused at its place: its number, four bytes, nine decimals.
#[test]
fn values_beyond_their_range() {
    assert_eq!(
        faults(
            "N10 P10500:1 P19000:1 P40000:1\nN20 X2147483648 Y-2147483648\nN30 P1:0.1234567891\nN40 P1:$123456789 P2:$G P3:\n\
             N50 X$10 Y-- Z\n"
        ),
        [
            "1:5+6 N10 P10500 is no parameter: P0 to P9999, P11000 to P18399, P20000 to P39999",
            "1:14+6 N10 P19000 is no parameter: P0 to P9999, P11000 to P18399, P20000 to P39999",
            "1:23+6 N10 P40000 is no parameter: P0 to P9999, P11000 to P18399, P20000 to P39999",
            "2:6+10 N20 X: 2147483648 is beyond the four bytes of a parameter",
            "3:8+12 N30 P1: 0.1234567891 is beyond the four bytes of a parameter",
            "4:8+10 N40 P1: $123456789 is not $ with one to eight digits 0 to 9, A to F",
            "4:22+2 N40 P2: $G is not $ with one to eight digits 0 to 9, A to F",
            "4:25+3 N40 P3 needs a number",
            "5:6+1 N50 X needs a number",
            "5:11+1 N50 Y needs a number",
            "5:14+1 N50 Z needs a number",
        ]
    );
}

/// Numbers ascend in the order of the file [002:5837-5841] (inferred): renumbering begins with 10 in steps of 10.
#[test]
fn numbers_ascend() {
    assert_eq!(
        faults("N10 X1\n/ N30 X2\n  N20 X3\nN30 X4\nN X5\nN9999999999 X6\nN40 X7 N50\n"),
        [
            "3:3+3 N20 N20 comes after N30: numbers ascend",
            "4:1+3 N30 N30 stands twice",
            "5:1+1 #5 N needs the number of the block",
            "6:1+11 N9999999999 N9999999999 is more than N2147483647",
            "7:8+3 N40 the number of a block stands at its beginning",
        ]
    );
}

/// What the manual does not show is named whole, each of it in one go.
#[test]
fn what_is_not_known_is_named() {
    assert_eq!(
        faults("N10 LBL 5\nN20 X1+2 Y[3]\n%1000\nN30 IF P1\nN40 Q5:1 (note)\nN50 X1O Y5\n"),
        [
            "1:5+3 N10 unknown word LBL",
            "1:9+1 N10 unknown word 5",
            "2:7+1 N20 unknown word +",
            "2:11+1 N20 Y needs a number",
            "3:1+5 #3 unknown word %1000",
            "4:5+2 N30 unknown word IF",
            "4:8+2 N30 P1 needs `:` and a value, or a condition as `P1<10.110`",
            "5:5+2 N40 programs have no q parameters: those from q1000 on are P11000 to P18399",
            "5:10+1 N40 unknown word (",
            "6:7+1 N50 O needs a number",
        ]
    );
    let program = program("N50 X1O Y5\n");
    let fault = &program.findings().faults[0];
    let said = program.diagnostic(bahn_text::Severity::Error, fault, "P1.900".as_ref());
    assert_eq!(said.help.as_deref(), Some("did you mean `X10`?"));
}

/// Comments: braces, to the end of the line where nothing closes them, and `;`.
#[test]
fn comments_are_no_words() {
    let program = program("N10 { X1 ; } X2 ; X3 {\n{ all\n;N20 X1\nN30 X{ five }5\n");
    assert_eq!(words(&program, 1), [WordKind::Axis(axis('X', 0), whole(2))]);
    assert!(program.block(2).is_none() && program.block(3).is_none());
    // A comment parts words as a blank does.
    assert_eq!(words(&program, 4), [WordKind::Axis(axis('X', 0), whole(5))]);
}

/// The listing is the same program.
#[test]
fn the_listing_is_tidy() {
    for (text, listed) in [
        (
            "n10g1 x : 25f2000   m7 { Start }\n",
            "N10 G1 X:25 F2000 M7 { Start }\n",
        ),
        ("/n010  p8840 : $00ff y3:-5\r\n", "/ N010 P8840:$00FF Y3:-5\r\n"),
        ("N20 p1 < p2.20 ; Wait\n", "N20 P1<P2.20 ; Wait\n"),
        ("  { aside }\n\t\nN30  p5 : --", "  { aside }\n\nN30 P5:--"),
        // What cannot be read, and a comment within a word, stay.
        ("N10  lbl 5\n", "N10  lbl 5\n"),
        ("N10  x{ five }5\n", "N10  x{ five }5\n"),
    ] {
        let program = Program::from_bytes("P1.900", text.as_bytes());
        assert_eq!(program.listing(), listed);
        assert_eq!(Program::from_bytes("P1.900", listed.as_bytes()).listing(), listed);
    }
}

/// The page of the language has each row of the table with its source.
#[test]
fn the_page_has_every_word() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../docs/system900-language.md");
    let page = std::fs::read_to_string(page).unwrap();
    for row in bahn_din::system900::meanings() {
        let unit = [", ", row.unit].concat();
        let rule = [". ", row.rule].concat();
        let said = format!(
            "| `{}` | {}{}{} | {} |",
            row.word,
            row.title,
            if row.unit.is_empty() { "" } else { &unit },
            if row.rule.is_empty() { "" } else { &rule },
            row.source
        );
        assert!(page.contains(&said), "{said}");
    }
}

/// Nothing is wrong with the shipped example and its cycle, which are tidy.
#[test]
fn the_example_is_fine() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../examples/system900/");
    for name in ["P1000.900", "Z71.900"] {
        let text = std::fs::read_to_string([folder, name].concat()).unwrap();
        assert_eq!(faults(&text), [""; 0], "{name}");
        assert_eq!(warnings(&text), [""; 0], "{name}");
    }
}
