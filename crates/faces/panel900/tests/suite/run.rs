//! Whole runs, from power-on on.

use crate::support::Panel;

/// Reference points of both channels, AUTO, and START.
fn start(panel: &mut Panel) {
    panel.keys("REFERENCE CH2 REFERENCE CH1");
    panel.until(60.0, |panel| {
        ["P8709", "2:P8709"]
            .iter()
            .all(|name| panel.number(name) == Some(1.0))
    });
    panel.keys("SEQUENCE");
    panel.until(1.0, |panel| panel.number("P8703") == Some(2.0));
    panel.keys("START");
    panel.until(1.0, |panel| panel.number("P8685") == Some(2.0));
}

#[test]
fn a_program_runs_from_power_on_to_its_end_by_keys_alone() {
    let mut panel = Panel::of_the_portal();
    let screen = panel.screen();
    assert_eq!(screen.mode, "HAND");
    assert_eq!(
        screen.why,
        ["Program 1000 waits for AUTO: SEQUENCE or SINGLE, then START"]
    );
    assert!(screen.lamps["HAND"] && !screen.lamps["START"]);
    start(&mut panel);
    panel.run(3.0);
    let screen = panel.screen();
    assert!(screen.lamps["START"] && screen.lamps["SEQUENCE"] && !screen.lamps["HAND"]);
    assert_eq!(screen.headings[0].title, "CHANNEL 1  AUTO, SEQUENCE ▶");
    let beside = screen.beside.unwrap();
    let current: Vec<_> = beside.lines.iter().filter(|line| line.current).collect();
    let block = format!("N{}", panel.number("P8901").unwrap());
    assert!(
        current.len() == 1 && current[0].text.starts_with(&block),
        "{block}: {beside:#?}"
    );
    panel.until(600.0, |panel| panel.number("P8685") == Some(0.0));
    // N370 leads over the last hole, N390 up; both stand in the coordinates of G54.
    let screen = panel.screen();
    let shown: Vec<_> = screen
        .status
        .axes
        .iter()
        .map(|axis| axis.value.as_str())
        .collect();
    assert_eq!(shown, ["+20.000", "+180.000", "+100.000"]);
    assert_eq!(screen.why, ["START runs program 1000"]);
    assert!(screen.messages.is_empty(), "{:?}", screen.messages);
    assert!(panel.0.state_json().contains("\"ended\":true"));
}

#[test]
fn stop_start_and_abort() {
    let mut panel = Panel::of_the_portal();
    start(&mut panel);
    panel.run(3.0);
    panel.keys("STOP");
    panel.until(2.0, |panel| panel.number("P8685") == Some(1.0));
    let block = panel.number("P8901").unwrap();
    let screen = panel.screen();
    assert!(screen.lamps["STOP"] && !screen.lamps["START"]);
    assert_eq!(screen.why, [format!("Stopped at N{block}: START goes on")]);
    // While a program is on its way no other one is chosen.
    panel.keys("SK2");
    assert_eq!(
        panel.enter("2000").unwrap_err().to_string(),
        "A program is on its way in channel 1"
    );
    panel.keys("SK1 START");
    panel.until(1.0, |panel| panel.number("P8685") == Some(2.0));
    panel.keys("ABORT");
    panel.until(2.0, |panel| panel.number("P8685") == Some(0.0));
}

#[test]
fn two_channels_have_a_page_each() {
    let mut panel = Panel::of_the_portal();
    let axes = |panel: &mut Panel| -> String {
        let axes = &panel.screen().status.axes;
        axes.iter().map(|axis| axis.label.trim().to_owned()).collect()
    };
    assert_eq!(axes(&mut panel), "XYZ");
    panel.keys("CHANNEL");
    assert_eq!(axes(&mut panel), "XYZC");
    let screen = panel.screen();
    assert_eq!(
        screen
            .headings
            .iter()
            .map(|heading| heading.active)
            .collect::<Vec<_>>(),
        [false, true]
    );
    assert_eq!(screen.beside.unwrap().title, "P2000");
    assert!(screen.status.axes[3].degrees);
    // Both run at once.
    panel.keys("CH1");
    start(&mut panel);
    panel.keys("CH2 START");
    panel.until(1.0, |panel| panel.number("2:P8685") == Some(2.0));
    assert_eq!(panel.number("P8685"), Some(2.0));
    assert_eq!(panel.tap("CH3").unwrap_err().to_string(), "there is no channel 3");
}
