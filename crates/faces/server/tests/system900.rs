//! The page of a machine with a System 900: the same page, other keys.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use std::path::Path;
use std::time::Duration;

use bahn_browser::{Browser, Page};
use bahn_host::{Machine900, PowerOn900};
use bahn_live::Live;
use bahn_panel900::{Service900, Station900};
use serde_json::json;
use support::{Panel, copy, pictures};

/// How long a person waits; the host may be slow.
const PATIENCE: Duration = Duration::from_secs(60);

/// The portal in a folder of its own, served, and what lets it run.
fn portal(name: &str) -> (Panel, Live<Station900>) {
    let folder = std::env::temp_dir().join(format!("bahn-server-900-{}-{name}", std::process::id()));
    copy(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines/portal900"),
        &folder,
    );
    let machine = Machine900::load(&folder)
        .unwrap()
        .unwrap_or_else(|faults| panic!("{faults:?}"));
    let live = Live::start(Station900::switched_on(machine, PowerOn900::fresh));
    let panel = Panel::of_machine(Service900::of(&live).unwrap(), folder);
    (panel, live)
}

/// Both heads know where they are.
fn reference(panel: &Panel) {
    assert_eq!(panel.give(&json!({"speed": 100})), 200);
    for key in ["REFERENCE", "CH2", "REFERENCE", "CH1"] {
        panel.until(|screen| screen["lamps"]["HAND"] == true);
        panel.press(key);
    }
    panel.until(|screen| screen["lamps"]["REFERENCE"] == false);
    assert_eq!(panel.give(&json!({"speed": 1})), 200);
}

#[test]
fn the_interface_is_that_of_every_machine() {
    let (panel, live) = portal("api");
    let station = panel.get("/api/station");
    assert_eq!(
        (&station["machine"], &station["model"]),
        (&json!("Portal with two heads"), &json!("System 900"))
    );
    assert_eq!(
        (&station["axes"], &station["has_past"]),
        (&json!("XYZC"), &json!(false))
    );
    let screen = panel.until(|screen| {
        screen["status"]["axes"]
            .as_array()
            .is_some_and(|axes| axes.len() == 3)
    });
    assert_eq!(screen["soft_keys"]["keys"][2], "PARAMETERS");
    assert_eq!(screen["headings"][1]["key"], "CH2");
    assert_eq!(panel.get("/api/snapshot")["channels"][1]["axes"][3]["name"], "C");
    assert_eq!(panel.get("/api/drawer"), json!([]));
    // What holds the operator back is said.
    let (status, body) = panel.request("POST", "/api/key", &[], "{\"key\":\"C+\"}");
    assert_eq!(
        (status, body.contains("channel 1 has no axis C")),
        (409, true),
        "{body}"
    );
    assert_eq!(panel.give(&json!({"go_to": 1})), 409);
    // A parameter by keys, and by what scripts do.
    for key in ["SK3", "P", "7", "ENT", "7", "ENT"] {
        panel.press(key);
    }
    panel.until(|screen| screen["program"]["lines"][0]["text"] == "P7 = 7");
    assert_eq!(panel.give(&json!({"action": "P7=8"})), 200);
    panel.until(|screen| screen["program"]["lines"][0]["text"] == "P7 = 8");
    drop(panel);
    live.end().unwrap();
}

fn open(panel: &Panel, browser: &Browser, width: u32, height: u32, phone: bool) -> Page {
    let mut page = browser.page().unwrap();
    page.viewport(width, height, phone).unwrap();
    page.dark(false).unwrap();
    page.open(&format!("http://{}/", panel.address)).unwrap();
    page.wait_until(
        "document.querySelectorAll('[data-region=softkeys] button').length === 10",
        PATIENCE,
    )
    .unwrap();
    page
}

#[test]
fn a_browser_shows_and_operates_it() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let (panel, live) = portal("page");
    reference(&panel);
    let mut page = open(&panel, &browser, 1440, 900, false);
    let wait = |page: &mut Page, condition: &str| page.wait_until(condition, PATIENCE).unwrap();
    wait(
        &mut page,
        "document.querySelectorAll('[data-region=program] .axis').length === 3",
    );
    // What this panel has not is not shown.
    for hidden in [
        "[data-region=timeline]",
        "[data-region=teacher]",
        "[data-key='3D_VIEW']",
    ] {
        wait(&mut page, &format!("document.querySelector(\"{hidden}\").hidden"));
    }
    // The channel is chosen in the header, and a program runs by keys.
    page.evaluate("document.querySelectorAll('.heading')[1].click()")
        .unwrap();
    wait(
        &mut page,
        "document.querySelectorAll('[data-region=program] .axis').length === 4",
    );
    page.evaluate("document.querySelectorAll('.heading')[0].click()")
        .unwrap();
    for key in ["SEQUENCE", "START"] {
        page.evaluate(&format!("document.querySelector(\"[data-key='{key}']\").click()"))
            .unwrap();
        wait(
            &mut page,
            &format!("document.querySelector(\"[data-key='{key}']\").classList.contains('lit')"),
        );
    }
    panel.until(|screen| {
        screen["status"]["feed_mm_min"]
            .as_f64()
            .is_some_and(|feed| feed > 100.0)
    });
    pictures::take(&mut page, "portal900");
    for (key, name) in [("SK3", "parameters"), ("SK4", "zero"), ("SK5", "tools")] {
        page.evaluate(&format!("document.querySelector(\"[data-key='{key}']\").click()"))
            .unwrap();
        if key == "SK3" {
            panel.give(&json!({"text": "P8865"}));
            panel.press("ENT");
        }
        wait(
            &mut page,
            "document.querySelector('[data-region=dialogue]').classList.contains('open')",
        );
        pictures::take(&mut page, &format!("portal900-{name}"));
    }
    panel.press("SK1");
    let mut phone = open(&panel, &browser, 390, 844, true);
    wait(
        &mut phone,
        "document.querySelectorAll('[data-region=program] .axis').length === 3",
    );
    // Nothing is wider than the window.
    wait(&mut phone, "document.documentElement.scrollWidth <= 390");
    pictures::take(&mut phone, "portal900-phone");
    drop(panel);
    live.end().unwrap();
}
