//! `bahn plc diagram`.

use crate::support::Folder;
use serde_json::json;

fn folder() -> Folder {
    let folder = Folder::new();
    // W8 counts; O2 is 1 from the fourth cycle to the sixth.
    folder.write(
        "MAIN.PLC",
        "INC W8\nL W8\n> K+3\n= M1\nL W8\n< K+7\nA M1\n= O2\nEM\n",
    );
    folder
}

#[test]
fn diagrams_show_levels_and_numbers() {
    let run = folder().bahn("plc diagram MAIN.PLC --show O2,W8 --cycles 8");
    assert_eq!(run.code(), 0, "{}", run.err());
    // Numbers are drawn where they change; a cycle leaves room for the bar only.
    assert_eq!(
        run.out(),
        "cycles 1 to 8\n      O2 ___\u{2580}\u{2580}\u{2580}__\n      W8 ||||||||| 1..8, last 8\n"
    );
    let folder = folder();
    folder.write(
        "W.txt",
        "cycle 1: D40=-3, S0=\"OIL\"\ncycle 6: D40=1000, S0=\"A\"\n",
    );
    let run = folder.bahn("plc diagram MAIN.PLC --show D40,S0 --cycles 12 --script W.txt");
    assert_eq!(
        run.out(),
        "cycles 1 to 12\n     D40 |-3  |1000\n      S0 |~~~~|\"A\"   | last \"A\"\n"
    );
    // The second row begins with cycle 65.
    let run = folder.bahn("plc diagram MAIN.PLC --show W8 --cycles 70");
    assert!(run.out().contains("|| 1..64, last 64\n"), "{}", run.out());
    assert!(run.out().ends_with("||||||| 65..70, last 70\n"), "{}", run.out());
}

#[test]
fn diagrams_are_data_too() {
    let folder = folder();
    let run =
        folder.bahn("plc diagram MAIN.PLC --show O2,W8 --trigger O2=1 --before 1 --cycles 5 --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert_eq!(
        run.json(),
        json!({"first_cycle": 3, "trigger_cycle": 4, "operands": [
            {"operand": "O2", "values": [0, 1, 1, 1, 0]},
            {"operand": "W8", "values": [3, 4, 5, 6, 7]},
        ]})
    );
    assert_eq!(
        folder
            .bahn("plc diagram MAIN.PLC --show O2 --svg o.svg --format json")
            .code(),
        2
    );
}

#[test]
fn triggers_choose_the_cycles() {
    let folder = folder();
    let run = folder.bahn("plc diagram MAIN.PLC --show O2 --trigger O2=1 --before 2 --cycles 6");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert_eq!(
        run.out(),
        "cycles 2 to 7\n           v trigger\n      O2 __\u{2580}\u{2580}\u{2580}_\n"
    );
    let run = folder.bahn("plc diagram MAIN.PLC --show O2 --trigger O2=1 --before 5 --cycles 6");
    assert!(run.out().starts_with("cycles 1 to 6\n"), "{}", run.out());
    // 0 is the negative edge, not the level of the first cycle.
    let run = folder.bahn("plc diagram MAIN.PLC --show O2 --trigger O2=0 --before 1 --cycles 3");
    assert_eq!(
        run.out(),
        "cycles 6 to 8\n          v trigger\n      O2 \u{2580}__\n"
    );
    let run = folder.bahn("plc diagram MAIN.PLC --show O2 --trigger O3=1 --limit 50");
    assert_eq!(run.code(), 1);
    assert!(run.err().contains("within 50 cycles"), "{}", run.err());
}

#[test]
fn drawings_are_written() {
    let folder = folder();
    let run = folder.bahn("plc diagram MAIN.PLC --show O2,W8 --cycles 8 --svg out.svg");
    assert_eq!(run.code(), 0, "{}", run.err());
    let svg = folder.read("out.svg");
    // 70 for the names, 12 for a cycle; O2 rises after three cycles.
    assert!(
        svg.contains("points=\"70,50 106,50 106,34 142,34 142,50 166,50\""),
        "{svg}"
    );
    assert_eq!(svg.matches("<rect x=").count(), 8);
    // A number of one digit fits into a cycle, one of two does not: it is shown by the pointer.
    assert_eq!(
        (
            svg.matches(">8</text>").count(),
            svg.matches("<title>8</title>").count()
        ),
        (1, 1)
    );
    folder.bahn("plc diagram MAIN.PLC --show W8 --cycles 10 --svg out.svg");
    let svg = folder.read("out.svg");
    assert_eq!(
        (
            svg.matches(">10</text>").count(),
            svg.matches("<title>10</title>").count()
        ),
        (0, 1)
    );
    let many: Vec<String> = (0..17).map(|n| format!("M{n}")).collect();
    let run = folder.bahn(&format!("plc diagram MAIN.PLC --show {}", many.join(",")));
    assert_eq!(run.code(), 2);
}

#[test]
fn the_full_screen_view_needs_a_terminal() {
    let run = folder().bahn("plc watch MAIN.PLC --show O2");
    assert_eq!(run.code(), 2);
    assert!(run.err().contains("terminal"), "{}", run.err());
}
