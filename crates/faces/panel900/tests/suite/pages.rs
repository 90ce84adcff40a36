//! The pages of the soft keys.

use crate::support::Panel;

#[test]
fn positions_are_those_that_are_asked_for() {
    let mut panel = Panel::of_the_portal();
    let screen = panel.screen();
    assert_eq!(screen.program.kind, bahn_screen::WindowKind::Positions);
    assert_eq!(screen.status.position_type, "DISPLAY");
    assert_eq!(screen.beside.unwrap().title, "P1000");
    let mut types = Vec::new();
    for _ in 0..5 {
        panel.keys("SK7");
        types.push(panel.screen().status.position_type);
    }
    assert_eq!(types, ["NOMINAL", "ACTUAL", "LAG ERROR", "REMAINING", "DISPLAY"]);
    panel.keys("SK8");
    let page = panel.page();
    assert!(
        page[0].contains("NOMINAL") && page[0].contains("LAG ERROR"),
        "{page:?}"
    );
    assert!(page[1].starts_with(" X") && page.len() == 4, "{page:?}");
    // Nothing is entered here.
    assert_eq!(panel.tap("7").unwrap_err().to_string(), "nothing is entered here");
}

#[test]
fn a_program_is_chosen_by_its_number_or_with_the_cursor() {
    let mut panel = Panel::of_the_portal();
    panel.keys("SK2");
    assert_eq!(panel.page(), ["* P1000", "  P2000", "  P9001", "  P9002"]);
    panel.keys("DOWN ENT");
    panel.run(0.01);
    assert_eq!(panel.number("P8800"), Some(2000.0));
    assert_eq!(panel.screen().beside.unwrap().title, "P2000");
    assert_eq!(
        panel.enter("P77").unwrap_err().to_string(),
        "There is no program 77"
    );
    // What was typed stays.
    assert_eq!(panel.screen().dialogue.entry, "P77");
    panel.keys("CE 1 0 0 0 ENT");
    assert_eq!(panel.number("P8800"), Some(1000.0));
}

#[test]
fn a_parameter_shows_its_value_its_status_and_what_it_means() {
    let mut panel = Panel::of_the_portal();
    panel.keys("SK3 P 8 8 0 0 ENT");
    let page = panel.page();
    assert_eq!(page[0], "P8800 = 1000");
    let row = bahn_system900::row("P8800".parse().unwrap()).unwrap();
    assert!(page.contains(&format!("P8800: {}", row.title)), "{page:?}");
    assert!(page.iter().any(|line| line.contains("loaded")), "{page:?}");
    // Without a channel it is one of the channel that is shown.
    panel.keys("CH2 SK8");
    panel.enter("P8800").unwrap();
    assert_eq!(panel.page()[0], "2:P8800 = 2000");
    panel.enter("P12151").unwrap();
    assert!(panel.page()[0].starts_with("2:P12151 = ") && panel.page()[0].ends_with(" mm"));
    panel.enter("q102").unwrap();
    assert_eq!(panel.page()[0], "q102 = 10000");
    panel.keys("DOWN");
    assert!(panel.page()[0].starts_with("q103 = 3000"));
}

#[test]
fn a_value_is_entered_cleared_and_refused() {
    let mut panel = Panel::of_the_portal();
    panel.keys("SK3");
    panel.enter("P7").unwrap();
    panel.keys("DOLLAR 1 F ENT");
    assert_eq!(panel.number("P7"), Some(31.0));
    panel.keys("1 2 POINT 5 ENT");
    assert_eq!(panel.number("P7"), Some(12.5));
    panel.keys("SIGN 3 BACK 4 ENT");
    assert_eq!(panel.number("P7"), Some(-4.0));
    assert_eq!(
        panel.enter("12x").unwrap_err().to_string(),
        "`12x` is no value: 12.5, -3, $1F, --"
    );
    assert_eq!(panel.said(), "`12x` is no value: 12.5, -3, $1F, --");
    assert_eq!(panel.screen().dialogue.entry, "12x");
    panel.keys("CE SK7");
    assert_eq!(panel.number("P7"), None);
    assert!(
        panel
            .enter("3:P500")
            .unwrap_err()
            .to_string()
            .contains("there is no channel 3")
    );
    assert!(panel.said().contains("there is no channel 3"));
}

#[test]
fn a_lock_holds_an_entry_back_and_the_value_stays() {
    let mut panel = Panel::of_the_portal();
    panel.keys("SK3");
    let before = panel.number("P12020");
    // Key switch 2 closes parameter lock 1, statuses and axes.
    panel.enter("P11001=1").unwrap();
    let refused = panel.enter("P12020=3").unwrap_err().to_string();
    assert!(refused.starts_with("P12020 is locked by "), "{refused}");
    assert_eq!(panel.said(), refused);
    assert_eq!(panel.number("P12020"), before);
    panel.keys("CE");
    assert_eq!(panel.said(), "");
    panel.enter("P11001=0").unwrap();
    panel.enter("P12020=3").unwrap();
    assert_eq!(panel.number("P12020"), Some(3.0));
}

#[test]
fn zero_points_are_entered_at_their_page() {
    let mut panel = Panel::of_the_portal();
    panel.keys("SK4");
    let screen = panel.screen();
    assert_eq!(screen.program.title, "ZERO POINTS, CHANNEL 1, AREA 1, SHIFT 1");
    let zero = bahn_system900::ZeroPoints::of(panel.0.host().unwrap().control().memory(), 1);
    let cell = |area, point: &str, group, axis| {
        let found = zero.cells.iter().find(|cell| {
            (cell.area, cell.point.as_str(), cell.group, cell.axis) == (area, point, group, axis)
        });
        format!("P{}", found.unwrap().p)
    };
    // G54 is the second one; its Y is the second axis.
    panel.keys("DOWN RIGHT");
    assert_eq!(
        panel.screen().dialogue.prompt,
        format!("G54 {} =", cell(1, "G54", 1, 2))
    );
    panel.enter("-7.25").unwrap();
    assert_eq!(panel.number(&cell(1, "G54", 1, 2)), Some(-7.25));
    panel.keys("SK7 SK8");
    let screen = panel.screen();
    assert_eq!(screen.program.title, "ZERO POINTS, CHANNEL 1, AREA 2, SHIFT 2");
    // Key switch 4 locks zero points and tools.
    panel.keys("SK3");
    panel.enter("P11003=1").unwrap();
    panel.keys("SK4");
    let name = cell(2, "G54", 2, 2);
    assert_eq!(
        panel.enter("1").unwrap_err().to_string(),
        format!("{name} is locked by the editing lock of zero points")
    );
}

#[test]
fn tools_are_entered_at_their_page() {
    let mut panel = Panel::of_the_portal();
    let tools = bahn_system900::Tools::of(panel.0.host().unwrap().control().memory(), 1);
    let tool = &tools.records[1];
    panel.keys("SK5 DOWN RIGHT RIGHT RIGHT RIGHT");
    let screen = panel.screen();
    assert_eq!(screen.program.title, "TOOLS, CHANNEL 1");
    assert_eq!(screen.program.total, tools.records.len());
    // The fifth column is the radius, ten parameters after the first one.
    let name = format!("P{}", tool.p + 10);
    assert!(
        screen.dialogue.prompt.contains(&name),
        "{}",
        screen.dialogue.prompt
    );
    panel.enter("6.5").unwrap();
    assert_eq!(panel.number(&name), Some(6.5));
    assert_eq!(panel.number(&format!("P{}", tool.p)), tool.group);
}

#[test]
fn messages_have_their_info_and_are_acknowledged() {
    let mut panel = Panel::of_the_portal();
    panel
        .give("{\"action\":\"P8504=2, P8505=11, P8503=2001\"}")
        .unwrap();
    panel.run(0.01);
    assert!(panel.said().starts_with("M2001"), "{}", panel.said());
    panel.keys("SK6");
    let screen = panel.screen();
    assert_eq!(screen.program.title, "MESSAGES, 1 PENDING, 0 ACKNOWLEDGED");
    assert!(
        screen.program.lines[0].text.contains("axis 2"),
        "{:?}",
        screen.program.lines
    );
    panel.keys("SK8");
    let page = panel.page();
    let named = bahn_system900::named_message("2001").unwrap();
    assert!(
        page.contains(&named.cause.to_owned()) && page.contains(&"Info1: 11".to_owned()),
        "{page:?}"
    );
    panel.keys("SK8 SK7");
    assert_eq!(
        panel.screen().program.title,
        "MESSAGES, 0 PENDING, 1 ACKNOWLEDGED"
    );
    assert_eq!(panel.said(), "");
    // RESET does the same.
    panel.give("{\"action\":\"P8503=2001\"}").unwrap();
    panel.run(0.01);
    assert!(panel.screen().lamps["RESET"]);
    panel.keys("RESET");
    assert_eq!(panel.said(), "");
}

#[test]
fn the_second_language_is_german() {
    let mut panel = Panel::of_the_portal();
    panel.give("{\"action\":\"P11130=1\"}").unwrap();
    let screen = panel.screen();
    assert_eq!(screen.soft_keys.keys[0], "POSITIONEN");
    assert!(screen.headings[0].title.starts_with("KANAL 1"));
    assert_eq!(
        screen.why,
        ["Programm 1000 wartet auf AUTO: SEQUENCE oder SINGLE, dann START"]
    );
}
