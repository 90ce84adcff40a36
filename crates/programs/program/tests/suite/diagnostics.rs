//! All faults of a program in one pass, each at its place.

use bahn_parameters::ControlModel::{Tnc155, Tnc360, Tnc415b};
use bahn_parameters::InchFeed;
use bahn_parameters::MessageId::{self, *};
use bahn_program::{Fault, MAX_DIAGNOSTICS, Program, Reading, Unit, check_limits};
use bahn_text::Severity;

fn program(text: impl AsRef<[u8]>) -> Program {
    Program::from_bytes("TEST.H", text.as_ref().to_vec())
}

/// Message, block, and what is underlined.
fn underlined(program: &Program, diagnostic: &Fault) -> (MessageId, u32, String) {
    let line = program.text_of_line(diagnostic.span.line);
    let text = line
        .chars()
        .skip(diagnostic.span.column as usize - 1)
        .take(diagnostic.span.length as usize)
        .collect();
    (diagnostic.message, diagnostic.block, text)
}

fn faults(text: &str) -> Vec<(MessageId, u32, String)> {
    let program = program(format!("BEGIN PGM 1 MM\n{text}\nEND PGM 1 MM\n"));
    program
        .diagnostics(None)
        .iter()
        .map(|diagnostic| underlined(&program, diagnostic))
        .collect()
}

fn fault(text: &str) -> (MessageId, u32, String) {
    let mut all = faults(text);
    assert_eq!(all.len(), 1, "{text}: {all:?}");
    all.swap_remove(0)
}

fn found(message: MessageId, block: u32, text: &str) -> (MessageId, u32, String) {
    (message, block, text.to_owned())
}

#[test]
fn a_good_program_has_none() {
    let text = "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S500\nLBL 1\nL X+5 R0 FMAX\nLBL 0\nCALL LBL 1\n\
                CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP -2\n; between\nCYCL DEF 1.2 DEPTH -9\n\
                CYCL DEF 1.3 PECKG -9\nCYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F80\nCYCL CALL\n\
                CYCL DEF 8.0 MIRROR\nCYCL DEF 8.1\nCYCL DEF 7.0 DATUM\nCYCL DEF 7.1 X+1\nCYCL DEF 7.2 Y+1\n\
                CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL 1\nCYCL DEF 12.0 PGM CALL\nCYCL DEF 12.1 PGM 5\n\
                CYCL DEF 68.0 HOLES\nCYCL DEF 68.1 Q1=+5\nTCH PROBE 0.0 REF. PLANE Q5 X-\nTCH PROBE 0.1 X+5 Y+0 Z-5";
    assert_eq!(faults(text), []);
}

/// A block of a cycle that cannot be read is one fault; the blocks after it miss nothing else.
#[test]
fn a_block_of_a_cycle_that_cannot_be_read_has_no_echo() {
    let all = faults(
        "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 Xa\nCYCL DEF 7.2 Y+5\nCYCL DEF 7.3 Z+5\nL X+5 R0 F9\n\
                      CYCL DEF 7.2 Y+5",
    );
    let expected = [
        found(EntryValueIncorrect, 2, "Xa"),
        found(CyclIncomplete, 6, "CYCL DEF 7.2 Y+5"),
    ];
    assert_eq!(all, expected);
}

/// A cycle of later controls is named itself, not a parameter of it that no control here has.
#[test]
fn a_cycle_that_the_control_does_not_have_is_named() {
    let program = program("BEGIN PGM 1 MM\nCYCL DEF 247 DATUM SETTING ~\n  Q339=+1 ; NUMBER\nEND PGM 1 MM\n");
    let all = program.diagnostics(Some(Tnc415b.limits().into()));
    assert_eq!(all.len(), 1, "{all:?}");
    assert_eq!(underlined(&program, &all[0]), found(BlockNotKnown, 1, "247"));
}

#[test]
fn all_faults_in_one_pass_in_the_order_of_blocks() {
    let all = faults("L Xnan\nCALL LBL 9\nL X+5 X+6 ; twice\nAPPR LT X+5\nERROR = X\n  L Z+1.2.3 R0");
    assert_eq!(
        all,
        [
            found(EntryValueIncorrect, 1, "Xnan"),
            found(LabelNumberNotAllocated, 2, "9"),
            found(AxisDoubleProgrammed, 3, "X+6"),
            found(BlockNotSupported, 4, "APPR"),
            found(ErrorBlock, 5, "ERROR = X"),
            found(EntryValueIncorrect, 6, "+1.2.3"),
        ]
    );
}

#[test]
fn labels() {
    assert_eq!(
        fault("LBL 5\nL X+1\nLBL 0\nLBL 5"),
        found(LabelNumberAllocated, 4, "5")
    );
    assert_eq!(fault("CALL LBL0"), found(JumpToLabelZeroNotPermitted, 1, "0"));
    assert_eq!(
        fault("FN9: IF +1 EQU +1 GOTO LBL 0"),
        found(JumpToLabelZeroNotPermitted, 1, "0")
    );
    assert_eq!(
        fault("FN 9: IF +Q1 EQU +Q2 GOTO LBL 77"),
        found(LabelNumberNotAllocated, 1, "77")
    );
    let contour = "LBL 1\nLBL 0\nCYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL 1/3";
    assert_eq!((fault(contour).0, fault(contour).1), (LabelNumberNotAllocated, 4));
}

/// One fault names the missing labels of a list, each once, and only some of many: a list of 100,000 labels is
/// read once.
#[test]
fn one_fault_for_the_labels_of_a_list() {
    let detail = |labels: &str| {
        let block = format!("CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL {labels}");
        let program = program(format!("BEGIN PGM 1 MM\nLBL 1\nLBL 0\n{block}\nEND PGM 1 MM\n"));
        let faults = program.diagnostics(None);
        assert_eq!(faults.len(), 1, "{} labels", labels.len());
        faults[0].detail.to_string()
    };
    assert_eq!(detail("1/3/1/3"), "no block sets label 3");
    assert_eq!(detail("5/1/3/5"), "no block sets labels 3, 5");
    // 2 to 254 are 253 labels: 12 of them and 241 more.
    let many: Vec<String> = (0..100_000).map(|at| (at % 254 + 1).to_string()).collect();
    let named: Vec<String> = (2..14).map(|label: u32| label.to_string()).collect();
    assert_eq!(
        detail(&many.join("/")),
        format!("no block sets labels {}, and 241 more", named.join(", "))
    );
}

#[test]
fn cycles_with_missing_or_unordered_blocks() {
    let cut = "CYCL DEF 2.0 TAPPING\nCYCL DEF 2.1 SET UP -2\nL X+1 FMAX M99";
    assert_eq!(fault(cut), found(CyclIncomplete, 1, "CYCL DEF 2.0 TAPPING"));
    let unordered = "CYCL DEF 9.0 DWELL\nCYCL DEF 9.1 DWELL 1\nCYCL DEF 2.0 TAPPING\nCYCL DEF 2.2 DEPTH -2\n\
                     CYCL DEF 2.1 SET UP -2\nCYCL DEF 2.3 DWELL 0\nCYCL DEF 2.4 F100";
    assert_eq!(
        fault(unordered),
        found(CyclIncomplete, 4, "CYCL DEF 2.2 DEPTH -2")
    );
    assert_eq!(
        fault("CYCL DEF 7.1 X+5\nCYCL DEF 7.2 Y+5"),
        found(CyclIncomplete, 1, "CYCL DEF 7.1 X+5")
    );
    assert_eq!(
        fault("CYCL DEF 9.0 DWELL\nCYCL DEF 9.1 DWELL"),
        found(CyclIncomplete, 2, "CYCL DEF 9.1 DWELL")
    );
    assert_eq!(fault("TCH PROBE 0.0 REF. PLANE Q5 X-").0, CyclIncomplete);
    assert_eq!(
        fault("CYCL DEF 10.0 ROTATION"),
        found(CyclIncomplete, 1, "CYCL DEF 10.0 ROTATION")
    );
    // A block that cannot be read may be the missing one.
    assert_eq!(
        fault("CYCL DEF 9.0 DWELL\nCYCL DEF 9.1 DWELL 1.2.3").0,
        EntryValueIncorrect
    );
}

#[test]
fn begin_and_end() {
    let warnings = |text: &str| {
        let program = program(text);
        let all = program.diagnostics(None);
        assert!(
            all.iter()
                .all(|diagnostic| diagnostic.severity == Severity::Warning),
            "{all:?}"
        );
        all.iter()
            .map(|diagnostic| underlined(&program, diagnostic))
            .collect::<Vec<_>>()
    };
    assert_eq!(
        warnings("L X+5"),
        [
            found(UnexpectedText, 0, "L X+5"),
            found(EndOfProgramMissing, 2, "L")
        ],
        "an implied END has no text of its own"
    );
    assert_eq!(
        warnings("BEGIN PGM A MM\nEND PGM B MM"),
        [found(UnexpectedText, 1, "END PGM B MM")]
    );
    assert_eq!(
        warnings("BEGIN PGM A MM\nEND PGM a INCH"),
        [found(UnexpectedText, 1, "END PGM a INCH")]
    );
    assert_eq!(warnings("BEGIN PGM MM\nEND PGM MM"), []);
    assert_eq!(
        warnings("; made by hand\nBEGIN PGM A MM\nEND PGM A MM\n\n BEGIN PGM B MM\n"),
        [
            found(UnexpectedText, 0, "; made by hand"),
            found(UnexpectedText, 1, "BEGIN PGM B MM")
        ]
    );
    let second = fault("BEGIN PGM 2 MM");
    assert_eq!(second, found(UnexpectedText, 1, "BEGIN PGM 2 MM"));
}

#[test]
fn joined_lines_and_code_pages_keep_their_columns() {
    assert_eq!(
        fault("L X+5 ~\n   Y+6 oops ; c"),
        found(UnexpectedText, 1, "oops")
    );
    let latin = program(b"BEGIN PGM 1 MM\n; H\xf6he\n; \xc3\xb6\n12 L X+5 \xf6\xe4 Z+1\nEND PGM 1 MM");
    let all = latin.diagnostics(None);
    assert_eq!(
        underlined(&latin, &all[0]),
        found(UnexpectedText, 3, "\u{f6}\u{e4}")
    );
    assert_eq!((all[0].span.line, all[0].span.column), (4, 10));
    let marked = program("\u{feff}L X+5 oops\nEND PGM");
    let all = marked.diagnostics(None);
    assert_eq!(underlined(&marked, &all[1]), found(UnexpectedText, 1, "oops"));
}

#[test]
fn endless_faults_are_bounded() {
    let garbage = program("garbage\n".repeat(100_000));
    assert_eq!(garbage.diagnostics(None).len(), MAX_DIAGNOSTICS);
    let labels = program("LBL 1\n".repeat(100_000));
    assert_eq!(labels.diagnostics(None).len(), MAX_DIAGNOSTICS);
}

#[test]
fn limits_of_the_control_model() {
    let at = |text: &str| {
        let program = program(format!("BEGIN PGM 1 MM\nLBL 1\n{text}\nEND PGM 1 MM\n"));
        let all = program.diagnostics(Some(Tnc360.limits().into()));
        assert!(all.len() <= 1, "{text}: {all:?}");
        all.first().map(|diagnostic| {
            let (message, _, text) = underlined(&program, diagnostic);
            (message, text)
        })
    };
    let entry = |text: &str| Some((EntryValueIncorrect, text.to_owned()));
    assert_eq!(at("L X+30000 Y-30000 R0 F29999 M99"), None);
    assert_eq!(at("L X+30000.001"), entry("+30000.001"));
    assert_eq!(at("L IZ -30001 F5"), entry("-30001"));
    assert_eq!(at("L X+5 F30000"), entry("30000"));
    assert_eq!(at("TOOL CALL 1 Z S100000"), entry("100000"));
    assert_eq!(at("TOOL CALL 255 Z S1"), entry("255"));
    assert_eq!(at("TOOL DEF 255 L+0 R+1"), entry("255"));
    assert_eq!(at("CALL LBL 1 REP 65534/65534"), None);
    assert_eq!(at("CALL LBL 1 REP 65535/65535"), entry("65535"));
    assert_eq!(at("CALL LBL 1 REP 0/0"), entry("0"));
    assert_eq!(at("LBL 255"), entry("255"));
    assert_eq!(at("LP PR+5 PA+361"), entry("+361"));
    assert_eq!(at("CP IPA+5400 DR+"), None);
    assert_eq!(at("CP IPA+5401 DR+"), entry("+5401"));
    assert_eq!(at("L X+Q124"), entry("Q124"));
    assert_eq!(at("FN0: Q1 = +Q124"), entry("Q124"));
    assert_eq!(at("FN14: ERROR = 500"), entry("500"));
    assert_eq!(at("Q1 = SIN 30").map(|(message, _)| message), Some(BlockNotKnown));
    assert_eq!(
        at("CYCL DEF 20.0 CONTOUR DATA").map(|(message, _)| message),
        Some(BlockNotKnown)
    );
    assert_eq!(
        at("CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 100").map(|(message, _)| message),
        Some(EntryValueIncorrect)
    );
}

#[test]
fn limits_are_those_of_the_unit_and_the_model() {
    let operation = |text: &str| program(text).decode(0).blocks.swap_remove(1).operation;
    // 30 000 mm are 1181.1 inch; 29 999 mm/min are 1181 inch per minute [003:2144].
    let limits = Tnc360.limits();
    assert!(check_limits(&operation("L X+1181"), Unit::Inch, limits).is_none());
    assert!(check_limits(&operation("L X+1182"), Unit::Inch, limits).is_some());
    assert!(check_limits(&operation("L A+20000"), Unit::Inch, limits).is_none());
    assert!(check_limits(&operation("L X+1 F1181"), Unit::Inch, limits).is_none());
    assert!(check_limits(&operation("L X+1 F1182"), Unit::Inch, limits).is_some());
    // On the TNC 155 rapid traverse is 6299 tenths of an inch per minute [001:471].
    let tenths = Tnc155.limits();
    assert!(check_limits(&operation("L X+1 F6299"), Unit::Inch, tenths).is_none());
    assert!(check_limits(&operation("L X+1 F6300"), Unit::Inch, tenths).is_some());
    let whole = Reading {
        limits: tenths,
        inch_feed: InchFeed::Whole,
    };
    assert!(check_limits(&operation("L X+1 F630"), Unit::Inch, whole).is_none());
    assert!(check_limits(&operation("L X+1 F631"), Unit::Inch, whole).is_some());
    for text in ["Q1 = SIN 30", "L X+Q150", "CYCL DEF 19.0 PLANE", "L X+40000"] {
        assert!(
            check_limits(&operation(text), Unit::Mm, Tnc415b.limits()).is_none(),
            "{text}"
        );
        assert!(
            check_limits(&operation(text), Unit::Mm, limits).is_some(),
            "{text}"
        );
    }
}

#[test]
fn a_din_iso_program_is_one_line() {
    for text in [
        "%1000 G71 *\nN10 G00 G40 X+5 *\nN20 X+7 *\nN99999 %1000 G71 *\n",
        "N10 G30 G17 X+0 *\nN20 G31 X+100 *\n",
    ] {
        let program = program(text);
        let all = program.diagnostics(None);
        assert_eq!(all.len(), 1, "{all:?}");
        assert_eq!(
            (all[0].message, all[0].block, all[0].span.line),
            (BlockNotSupported, 1, 1)
        );
    }
}

#[test]
fn an_unknown_unit_is_warned_of() {
    let program = program("BEGIN PGM 7 CM\nEND PGM 7 CM");
    let all = program.diagnostics(None);
    assert_eq!(all.len(), 1, "{all:?}");
    assert_eq!(
        (all[0].message, all[0].severity),
        (UnexpectedText, Severity::Warning)
    );
    assert!(all[0].detail.starts_with("CM is no unit"), "{}", all[0].detail);
}
