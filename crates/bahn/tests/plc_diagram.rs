//! `bahn plc diagram`.

mod support;

use support::Folder;

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
        "cycles 1 to 8\n      O2 ___\u{2580}\u{2580}\u{2580}__\n      W8 ||||||||\n"
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
    // 70 for the names, 12 for a cycle; O2 rises behind three cycles.
    assert!(
        svg.contains("points=\"70,50 106,50 106,34 142,34 142,50 166,50\""),
        "{svg}"
    );
    assert_eq!(svg.matches("<rect x=").count(), 8);
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
