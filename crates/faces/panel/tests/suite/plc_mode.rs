//! The PLC mode by keys: table, editor, compiler, trace and logic diagram of the machine that runs.

use crate::support::Trainee;
use bahn_exchange::Operand;

const HIGH: char = '\u{2580}';

/// Enters the code number; the main menu has the keys.
fn plc_mode(trainee: &mut Trainee) {
    trainee.press("PROGRAM MOD");
    trainee.down_to("CODE NUMBER");
    trainee.press("ENT").number("807667").press("ENT");
}

fn line(trainee: &mut Trainee) -> String {
    let lines = trainee.screen().program.lines;
    lines.into_iter().find(|line| line.current).unwrap().text
}

fn title(trainee: &mut Trainee) -> String {
    trainee.screen().program.title
}

fn text(trainee: &mut Trainee, text: &str) {
    let json = serde_json::json!({ "text": text }).to_string();
    trainee.give(&json).wait(0.1);
}

fn value(trainee: &Trainee, operand: &str) -> String {
    let operand: Operand = operand.parse().unwrap();
    operand
        .read(trainee.station.control().exchange().plc())
        .to_string()
}

#[test]
fn the_code_number_opens_the_mode_until_power_off() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("PROGRAM MOD");
    let has_edit = |trainee: &mut Trainee| {
        let lines = trainee.screen().program.lines;
        lines.iter().any(|line| line.text == "PLC EDIT")
    };
    assert!(!has_edit(&mut trainee));
    trainee.press("END");
    plc_mode(&mut trainee);
    assert_eq!(title(&mut trainee), "PLC PROGRAMMING");
    let program = trainee.station.control().plc().program().clone();
    let time = trainee.station.control().plc().time();
    let lines = trainee.screen().program.lines;
    let expected = [
        format!("PROCESSING TIME: MAXIMUM  {:>4.0} %", time.maximum_percent()),
        format!("CODE LENGTH      {:>13} KBYTE", program.size_bytes.div_ceil(1024)),
        "RUNTIME PGM      MAIN.PLC".to_owned(),
    ];
    assert!(program.size_bytes > 0 && time.maximum_percent() > 0.0);
    for (place, expected) in [0, 2, 3].into_iter().zip(expected) {
        assert_eq!(lines[place].text, expected);
    }
    // The program is told the code number in D276.
    assert_eq!(value(&trainee, "D276"), "807667");
    trainee.soft("END");
    assert!(has_edit(&mut trainee), "the menu has it without the number");
    trainee.down_to("PLC EDIT");
    trainee.press("ENT");
    assert_eq!(title(&mut trainee), "PLC PROGRAMMING");
    trainee.press("END");
    // By MOD and the soft key PLC EDIT [000:11195-11197].
    trainee.soft("PLC EDIT");
    assert_eq!(title(&mut trainee), "PLC PROGRAMMING");
    trainee.press("END END");
    trainee.give(r#"{"power":false}"#).wait(0.5);
    trainee.give(r#"{"power":true}"#).ready();
    trainee.press("PROGRAM MOD");
    assert!(!has_edit(&mut trainee));
}

#[test]
fn a_tnc_360_has_no_plc_mode() {
    let mut trainee = Trainee::at("mill-tnc360");
    trainee.ready();
    plc_mode(&mut trainee);
    assert_eq!(trainee.messages().last().unwrap(), "ENTRY VALUE INCORRECT");
    assert_ne!(title(&mut trainee), "PLC PROGRAMMING");
}

#[test]
fn the_table_shows_and_sets_operands() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    plc_mode(&mut trainee);
    trainee.soft("TABLE");
    // M3000 is message 76 of the PLC, which the program leaves alone: M2924 + n.
    trainee.press("GOTO").number("3000").press("ENT");
    assert!(
        line(&mut trainee).starts_with("M3000   0"),
        "{}",
        line(&mut trainee)
    );
    trainee.soft("SET");
    assert!(
        line(&mut trainee).starts_with("M3000   1"),
        "{}",
        line(&mut trainee)
    );
    assert_eq!(trainee.messages(), ["PLC: ERROR 76"]);
    trainee.number("0").press("ENT");
    assert_eq!(trainee.messages(), [""; 0]);
    trainee.number("2").press("ENT");
    assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"]);
    trainee.press("CE CE");
    // A word, hexadecimal and decimal.
    trainee.soft("GOTO");
    trainee.press("W").number("900").press("ENT");
    assert_eq!(
        (title(&mut trainee).as_str(), line(&mut trainee).as_str()),
        ("TABLE W", "W900    0")
    );
    trainee.soft("HEX/DECIMAL");
    trainee.typed("1F");
    trainee.press("ENT");
    assert_eq!(
        (line(&mut trainee).as_str(), value(&trainee, "W900").as_str()),
        ("W900    001F", "31")
    );
    trainee.soft("HEX/DECIMAL");
    trainee.number("-2").press("ENT");
    assert_eq!(
        (line(&mut trainee).as_str(), value(&trainee, "B900").as_str()),
        ("W900    -2", "-1")
    );
    // What the control itself writes is live, with its name.
    trainee.soft("I");
    assert_eq!(title(&mut trainee), "TABLE I");
    trainee.press("GOTO");
    trainee.typed("S1");
    trainee.press("ENT");
    assert_eq!(
        trainee.messages(),
        ["ENTRY VALUE INCORRECT"],
        "strings have no table"
    );
}

/// The line of the main program's first instruction.
fn begin_of(main: &str) -> usize {
    main.lines()
        .position(|line| line.contains("L     M2719"))
        .unwrap()
        + 1
}

/// Opens the main file at its first instruction.
fn edit(trainee: &mut Trainee, line: usize) {
    trainee.soft("EDIT");
    trainee.press("ENT GOTO").number(&line.to_string()).press("ENT");
    assert_eq!(
        title(trainee),
        format!("FILE MAIN.PLC  LINE {line}  COLUMN 1  INSERT")
    );
}

#[test]
fn a_faulty_line_is_found_and_mended() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    plc_mode(&mut trainee);
    let main = trainee.file("plc/MAIN.PLC");
    let begin = begin_of(&main);
    edit(&mut trainee, begin);
    // `LN M3100`, `= M3001` by keys, then a line that no PLC knows.
    trainee.typed("LN");
    trainee.soft("BLANK");
    trainee.typed("M3100");
    trainee.press("ENT");
    trainee.soft("=");
    trainee.soft("BLANK");
    trainee.typed("M3001");
    trainee.press("ENT");
    assert_eq!(trainee.messages(), [""; 0]);
    text(&mut trainee, "XYZ M1\n");
    trainee.press("ENT");
    assert_eq!(trainee.messages(), ["INPUT ERROR 0 not a valid command"]);
    trainee.press("CE");
    let edited = trainee.file("plc/MAIN.PLC");
    let mut expected: Vec<&str> = main.lines().collect();
    // Set in the columns of the manual [000:4155-4199]; a line with an error is not [000:11925].
    let typed_lines = ["LN     M3100", "=      M3001", "XYZ M1"];
    expected.splice(begin - 1..begin - 1, typed_lines);
    assert_eq!(edited.lines().collect::<Vec<_>>(), expected);
    // Half a line is on the medium, too.
    trainee.typed("EM");
    let half = trainee.file("plc/MAIN.PLC");
    assert_eq!(half.len(), edited.len() + 2);
    assert!(half.lines().nth(begin + 2).unwrap().starts_with("EM "));
    // The line that was left is in columns now, after its blanks.
    trainee.press("CE CE END");
    let (left, comment) = main.lines().nth(begin - 1).unwrap().split_once(';').unwrap();
    let (instruction, operand) = left.trim().split_once(' ').unwrap();
    let (operand, blanks) = (operand.trim(), left.len() - left.trim_start().len());
    let set = format!("{}{instruction:<7}{operand:<11};{comment}", " ".repeat(blanks));
    expected[begin + 2] = &set;
    assert_eq!(trainee.file("plc/MAIN.PLC").lines().collect::<Vec<_>>(), expected);
    trainee.soft("COMPILE");
    trainee.press("ENT");
    assert_eq!(title(&mut trainee), "COMPILE: ERRORS");
    let (shown, wrong) = (line(&mut trainee), begin + 2);
    let expected = format!("MAIN.PLC:{wrong} INPUT ERROR 0 not a valid command");
    assert!(shown.starts_with(&expected), "{shown}");
    trainee.press("ENT");
    assert_eq!(line(&mut trainee), format!("{wrong:>6} XYZ M1"));
    trainee.soft("DELETE LINE");
    trainee.press("END");
    trainee.soft("COMPILE");
    trainee.press("ENT");
    let said = trainee.messages();
    assert!(said[0].starts_with("MAIN.PLC: 0 ERRORS, "), "{said:?}");
    assert!(said[0].ends_with("RUNS FROM THE NEXT POWER-ON"), "{said:?}");
    // It can be switched off here without END.
    let mut trainee = trainee.killed();
    trainee.wait(5.0).press("CE").wait(2.0);
    let shown = trainee.messages();
    assert!(
        shown.contains(&"PLC: ERROR 77".to_owned()),
        "M3100 is 0: {shown:?}"
    );
}

#[test]
fn what_was_compiled_runs_from_the_next_power_on() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    plc_mode(&mut trainee);
    let main = trainee.file("plc/MAIN.PLC");
    edit(&mut trainee, begin_of(&main));
    text(&mut trainee, "LN M3100\n= M3001\n");
    trainee.press("ENT END");
    trainee.soft("COMPILE");
    trainee.press("ENT CE").wait(1.0);
    assert_eq!(trainee.messages(), [""; 0], "the program of before runs on");
    let lines = trainee.screen().program.lines;
    assert_eq!(lines[5].text, "MAIN.PLC: COMPILED, RUNS FROM THE NEXT POWER-ON");
    let before_s = trainee.screen().time_s;
    trainee.give(r#"{"power":false}"#).wait(0.5);
    trainee.give(r#"{"power":true}"#).wait(5.0).press("CE").wait(2.0);
    let shown = trainee.messages();
    assert!(shown.contains(&"PLC: ERROR 77".to_owned()), "{shown:?}");
    // Who looks back finds the program of then, and that of now where he came from.
    let now_s = trainee.screen().time_s;
    let running = |trainee: &Trainee| trainee.station.control().plc().program().files[0].lines.len();
    let new = main.lines().count() + 2;
    assert_eq!(running(&trainee), new);
    trainee.station.go_to(before_s - 1.0).unwrap();
    assert_eq!(running(&trainee), main.lines().count());
    trainee.station.go_to(now_s).unwrap();
    assert_eq!(running(&trainee), new);
}

/// Once after power-on a text and a bar; what module 9081 tells stands in W902. M3112 clears it all.
const WINDOW_CALLS: &str = "L M3111\nJPT WINDOW_SHOWN\nLN M3111\nS M3111\nSUBM WINDOW_SHOW\n= B900\nLBL WINDOW_SHOWN\n\
    CM 9081\nPL W902\nL M3112\nJPF WINDOW_KEPT\nR M3112\nSUBM WINDOW_CLEAR\n= B901\nLBL WINDOW_KEPT\n";
const WINDOW_MODULES: &str = "LBL WINDOW_SHOW\nL S\"SPINDLE\"\n= S0\nPS K+0\nPS K+10\nPS K+0\nPS K+0\nCM 9082\n\
    PS K+1\nPS K+100\nPS K+40\nPS K+11\nPS K+12\nCM 9083\nEM\nLBL WINDOW_CLEAR\nCM 9080\nEM\n";

#[test]
fn the_window_of_the_plc_is_seen_and_the_plc_knows() {
    let mut trainee = Trainee::with("mill", |folder| {
        let path = folder.join("plc/MAIN.PLC");
        let main = std::fs::read_to_string(&path).unwrap();
        let at = main.find("       L     M2719").unwrap();
        let (head, body) = main.split_at(at);
        let cut = body.find("; ---- After power-on").unwrap();
        let (body, rest) = body.split_at(cut);
        let changed = format!("{head}{WINDOW_CALLS}{body}{WINDOW_MODULES}{rest}");
        std::fs::write(path, changed).unwrap();
    });
    trainee.ready();
    let window = trainee.screen().plc_window.unwrap();
    assert_eq!(window[0].text.trim_end(), format!("{:10}SPINDLE", ""));
    assert_eq!(window[1].bar, Some([100, 40, 11, 12]));
    assert_eq!(value(&trainee, "W902"), "3");
    // It is there in every mode.
    trainee.press("PROGRAM").wait(0.1);
    assert_eq!(value(&trainee, "W902"), "3");
    plc_mode(&mut trainee);
    trainee.soft("TABLE");
    trainee.press("GOTO").number("3112").press("ENT");
    trainee.soft("SET");
    trainee.wait(0.5);
    assert_eq!(trainee.screen().plc_window, None);
}

#[test]
fn what_somebody_else_has_written_is_not_lost() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    plc_mode(&mut trainee);
    trainee.soft("EDIT");
    trainee.press("ENT");
    trainee.write("plc/MAIN.PLC", "EM\n");
    trainee.typed("A");
    assert_eq!(
        trainee.messages(),
        ["FILE WAS CHANGED OUTSIDE, AND IS READ AGAIN"]
    );
    assert_eq!(
        (trainee.file("plc/MAIN.PLC").as_str(), line(&mut trainee).as_str()),
        ("EM\n", "     1 EM")
    );
    // FIND, and overwriting; a file of the control's own letters stays one.
    trainee.press("CE END");
    let latin = b"L I4 ;T\xfcr\r\n= O2\r\nEM\r\n";
    std::fs::write(trainee.folder().join("plc/MAIN.PLC"), latin).unwrap();
    trainee.soft("EDIT");
    trainee.press("ENT");
    trainee.soft("FIND");
    trainee.typed("O2");
    trainee.press("ENT");
    assert_eq!(line(&mut trainee), "     2 = O2");
    trainee.soft("INSERT/OVERWRITE");
    trainee.press("RIGHT RIGHT RIGHT 3 END");
    let written = std::fs::read(trainee.folder().join("plc/MAIN.PLC")).unwrap();
    assert_eq!(written, b"L I4 ;T\xfcr\r\n=      O3\r\nEM\r\n");
}

#[test]
fn trace_shows_what_the_latest_scan_did() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    plc_mode(&mut trainee);
    trainee.soft("TRACE");
    assert_eq!(title(&mut trainee), "TRACE MAIN.PLC");
    // M2719 is set since the first scan: instruction, operand, logic accumulator.
    let words = |text: String| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let first = words(line(&mut trainee));
    let main = trainee.file("plc/MAIN.PLC");
    let number = main.lines().position(|line| line.contains("M2719")).unwrap() + 1;
    assert_eq!(first[1..6].join(" "), format!("{number} L M2719 1 1"));
    assert_eq!(first[0], "*");
    // What belongs to the first scan after power-on is passed by.
    trainee.soft("FIND");
    trainee.typed("M2487");
    trainee.press("ENT");
    let passed = line(&mut trainee);
    assert!(
        !passed.starts_with('*') && passed.ends_with("S M2487"),
        "{passed}"
    );
    // A display that stands does not follow.
    trainee.soft("GOTO");
    trainee.number(&number.to_string()).press("ENT");
    assert!(line(&mut trainee).contains("L M2719"));
    trainee.soft("STOP DISPLAY");
    let stands = trainee.screen().program.lines;
    trainee.wait(0.5);
    assert_eq!(trainee.screen().program.lines, stands);
    trainee.soft("START DISPLAY");
    trainee.soft("LOGIC DIAGRAM");
    assert_eq!(title(&mut trainee), "LOGIC DIAGRAM");
}

#[test]
fn the_diagram_catches_an_edge() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    plc_mode(&mut trainee);
    trainee.soft("TRACE");
    trainee.soft("LOGIC DIAGRAM");
    for operand in ["M3100", "M2719"] {
        trainee.press("ENT");
        trainee.typed(operand);
        trainee.press("ENT DOWN");
    }
    trainee.press("UP UP 1");
    assert_eq!(line(&mut trainee), "M3100  1");
    trainee.soft("START TRACE");
    trainee.wait(11.0);
    let records = |trainee: &mut Trainee| trainee.screen().status.flags.contains(&"PCTR".to_owned());
    assert!(records(&mut trainee), "it waits for the event");
    trainee.soft("TRACE IN CODE");
    assert_eq!(title(&mut trainee), "TRACE MAIN.PLC");
    trainee.press("END");
    trainee.soft("TABLE");
    trainee.press("GOTO").number("3100").press("ENT");
    trainee.soft("SET");
    assert!(records(&mut trainee));
    trainee.press("END").wait(11.0);
    assert!(!records(&mut trainee), "512 scans of 20 ms are after it");
    trainee.soft("TRACE");
    trainee.soft("LOGIC DIAGRAM");
    let expected = format!("M3100  1  {}{}", "_".repeat(32), HIGH.to_string().repeat(32));
    assert_eq!(line(&mut trainee), expected);
    let lines = trainee.screen().program.lines;
    assert_eq!(
        lines[1].text,
        format!("M2719  -  {}", HIGH.to_string().repeat(64))
    );
    assert!(
        title(&mut trainee).contains(" / 1024  TRIGGER "),
        "{}",
        title(&mut trainee)
    );
    // To the left there are only scans before it.
    trainee.soft("<");
    assert_eq!(line(&mut trainee), format!("M3100  1  {}", "_".repeat(64)));
    // DEL erases a row; a word has no place in it.
    trainee.press("DEL");
    assert!(line(&mut trainee).starts_with("M2719"), "{}", line(&mut trainee));
    trainee.soft("OPERAND");
    trainee.typed("W900");
    trainee.press("ENT");
    assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"]);
}

/// The soft keys beside the instruction list: operands are selected, and a recording starts and stops without leaving it.
#[test]
fn a_recording_starts_beside_the_instruction_list() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    plc_mode(&mut trainee);
    trainee.soft("TRACE");
    trainee.soft("START TRACE");
    assert_eq!(
        trainee.messages(),
        ["KEY NON-FUNCTIONAL"],
        "no operand is selected"
    );
    trainee.press("CE");
    trainee.soft("SELECT M/I/O/T/C");
    assert_eq!(trainee.screen().program.title, "LOGIC DIAGRAM");
    trainee.press("ENT M 1 0 ENT").wait(0.1);
    trainee.soft("TRACE IN CODE");
    assert_eq!(trainee.screen().program.title, "TRACE MAIN.PLC");
    trainee.soft("START TRACE");
    trainee.wait(1.0);
    trainee.soft("STOP TRACE");
    trainee.soft("LOGIC DIAGRAM");
    let title = trainee.screen().program.title;
    assert!(title.starts_with("LOGIC DIAGRAM  SCANS "), "{title}");
    trainee.wait(1.0);
    assert_eq!(trainee.screen().program.title, title, "nothing more is recorded");
}

/// "The main program must have the status flag M": COMPILE of another file gives it to that one [000:14608]. It is the main
/// program of the machine from the next power-on; the one before is a file like others.
#[test]
fn compiling_another_file_makes_it_the_main_program() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    let main = trainee.file("plc/MAIN.PLC");
    let mut lines: Vec<&str> = main.lines().collect();
    // ERROR 77 is shown with M3001; M3100 is 0.
    let begin = begin_of(&main) - 1;
    lines.splice(begin..begin, ["LN     M3100", "=      M3001"]);
    trainee.write("plc/OTHER.PLC", &(lines.join("\n") + "\n"));
    plc_mode(&mut trainee);
    trainee.soft("COMPILE");
    trainee.down_to("OTHER.PLC");
    trainee.press("ENT");
    let said = trainee.messages();
    assert!(said[0].starts_with("OTHER.PLC: 0 ERRORS, "), "{said:?}");
    assert!(said[0].ends_with("RUNS FROM THE NEXT POWER-ON"), "{said:?}");
    trainee.press("CE").wait(1.0);
    assert_eq!(trainee.messages(), [""; 0], "the program of before runs on");
    trainee.soft("COMPILE");
    trainee.down_to("OTHER.PLC");
    assert!(
        line(&mut trainee).contains("M RUNTIME PGM"),
        "{}",
        line(&mut trainee)
    );
    trainee.down_to("MAIN.PLC");
    assert!(
        !line(&mut trainee).contains("RUNTIME PGM"),
        "{}",
        line(&mut trainee)
    );
    trainee.press("END");
    // It runs from the next power-on, also when all is read anew.
    trainee.give(r#"{"power":false}"#).wait(0.5);
    trainee.give(r#"{"power":true}"#);
    runs_other(&mut trainee);
    runs_other(&mut trainee.killed());
}

fn runs_other(trainee: &mut Trainee) {
    trainee.wait(5.0).press("CE").wait(2.0);
    let shown = trainee.messages();
    assert!(shown.contains(&"PLC: ERROR 77".to_owned()), "{shown:?}");
    let running = &trainee.station.control().plc().program().files[0].name;
    assert_eq!(running, "OTHER.PLC");
}
