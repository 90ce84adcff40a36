//! The page by a real keyboard: the short cuts of the station, keys of the machine that are held, knobs.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use std::time::Duration;

use bahn_browser::Browser;
use serde_json::json;
use support::Panel;

#[test]
fn short_cuts_press_hold_and_turn() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = Panel::start();
    let mut page = browser.page().unwrap();
    page.viewport(1400, 900, false).unwrap();
    page.open(&format!("http://{}/", panel.address)).unwrap();
    let ready = "document.querySelectorAll('[data-region=softkeys] button').length === 10";
    page.wait_until(ready, Duration::from_secs(30)).unwrap();
    page.press("Backspace").unwrap();
    panel.until(|screen| screen["mode"] == "PASS OVER REFERENCE MARKS");
    page.press("Alt+6").unwrap();
    panel.until(|screen| screen["mode"] == "PROGRAMMING AND EDITING");
    page.press("Alt+1").unwrap();
    panel.until(|screen| screen["headings"][0]["active"] == true);

    // A key that only the page has.
    let looks = |on: bool| format!("document.querySelector('[data-key=\"3D_VIEW\"]').ariaPressed === '{on}'");
    for on in [true, false] {
        page.press("Alt+9").unwrap();
        page.wait_until(&looks(on), Duration::from_secs(10)).unwrap();
    }

    // A key of the machine is down as long as the real one.
    page.key_down("Alt").unwrap();
    page.key_down("ArrowRight").unwrap();
    panel.until(|screen| screen["machine"]["held"] == json!(["X+"]));
    page.key_up("ArrowRight").unwrap();
    panel.until(|screen| screen["machine"]["held"] == json!([]));
    // Without Alt it would be another key.
    page.key_down("ArrowUp").unwrap();
    panel.until(|screen| screen["machine"]["held"] == json!(["Y+"]));
    page.key_up("Alt").unwrap();
    panel.until(|screen| screen["machine"]["held"] == json!([]));
    page.key_up("ArrowUp").unwrap();

    let [feed, spindle] = [0, 1].map(|knob| panel.screen()["machine"]["knobs"][knob].as_f64().unwrap());
    page.press("Alt+-").unwrap();
    panel.until(|screen| screen["machine"]["knobs"] == json!([feed - 5.0, spindle]));
    page.press("Alt+,").unwrap();
    panel.until(|screen| screen["machine"]["knobs"] == json!([feed - 5.0, spindle - 5.0]));
    page.press("Alt+0").unwrap();
    panel.until(|screen| screen["machine"]["emergency_stop"] == true);

    // The help lists the same table.
    page.click("#help-button").unwrap();
    let rows = page.text("#help tbody").unwrap();
    for row in [
        "Alt+D",
        "CYCL DEF: Cycle definition",
        "NC START",
        "feed override",
        "3D VIEW",
    ] {
        assert!(rows.contains(row), "{row}: {rows}");
    }
    // It begins with its first line, and what closes it is in sight.
    assert_eq!(
        page.number("document.querySelector('#help').scrollTop").unwrap(),
        0.0
    );
    page.click("#help form button").unwrap();
    assert_eq!(
        page.evaluate("document.querySelector('#help').open").unwrap(),
        false
    );
    assert_eq!(page.complaints(), [] as [String; 0]);
}
