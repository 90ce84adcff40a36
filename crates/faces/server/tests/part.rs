//! The part in the page while it is cut: it is the machine's own part, bit for bit, live and after a reload.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use std::time::{Duration, Instant};

use bahn_browser::{Browser, Page};
use serde_json::json;
use support::{Panel, pictures};

/// How long a person waits; the host may be slow.
const PATIENCE: Duration = Duration::from_secs(60);

/// Three tools: a plate is faced, a pocket is milled along arcs, a hole goes through.
fn program(passes: u32, rounds: u32) -> String {
    let mut text = String::from(
        "BEGIN PGM LIVE MM\nBLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+100 Y+80 Z+0\n\
         TOOL CALL 3 Z S2000\nL Z+50 R0 FMAX M3\nL X-20 Y+5 R0 FMAX\nL Z-1 R0 FMAX\n",
    );
    for pass in 0..passes * rounds {
        let y = 5.0 + 70.0 * f64::from(pass % passes) / f64::from(passes);
        let x = if pass % 2 == 0 { 120 } else { -20 };
        text += &format!("L Y+{y:.3} F500\nL X{x:+} F500\n");
    }
    text += "L Z+50 R0 FMAX\nTOOL CALL 2 Z S3000\nL X+30 Y+40 R0 FMAX M3\nL Z-7.3 R0 F200\nCC X+50 Y+40\nC X+30 Y+40 DR+ F300\n\
             L Z+50 R0 FMAX\nTOOL CALL 1 Z S1500\nL X+50 Y+40 R0 FMAX M3\nL Z-25 R0 F100\nL Z+50 R0 FMAX M2\nEND PGM LIVE MM\n";
    text
}

fn panel(passes: u32, rounds: u32) -> Panel {
    let text = program(passes, rounds);
    Panel::with(|folder| std::fs::write(folder.join("programs/LIVE.H"), text).unwrap())
}

/// The heights in the page, decoded there.
fn shown(page: &mut Page) -> Vec<u16> {
    let script = "(() => { const { heights } = document.querySelector('.stage').view.sheet; let text = ''; \
                  for (let k = 0; k < heights.length; k++) text += heights[k].toString(16).padStart(4, '0'); return text; })()";
    let text = page.evaluate(script).unwrap();
    let text = text.as_str().unwrap();
    let number = |k: usize| u16::from_str_radix(&text[4 * k..4 * k + 4], 16).unwrap();
    (0..text.len() / 4).map(number).collect()
}

fn until(page: &mut Page, condition: &str) {
    page.wait_until(condition, PATIENCE).unwrap();
}

/// Cells that are not untouched.
const CUT: &str = "(document.querySelector('.stage').view?.sheet.heights.filter(h => h < 65535).length ?? 0)";

/// Until the page has the part as it is; the machine stands.
fn same(panel: &Panel, page: &mut Page) {
    let along = page
        .number("document.querySelector('.stage').view.sheet.columns[0]")
        .unwrap();
    let expected = panel.heights(along as usize);
    let end = Instant::now() + PATIENCE;
    loop {
        let shown = shown(page);
        assert_eq!(shown.len(), expected.len());
        if shown == expected {
            assert!(shown.iter().any(|height| *height < 65535));
            return;
        }
        let other = shown.iter().zip(&expected).filter(|(a, b)| a != b).count();
        assert!(Instant::now() < end, "{other} of {} cells differ", shown.len());
        std::thread::sleep(Duration::from_millis(100));
    }
}

fn open(panel: &Panel, browser: &Browser) -> Page {
    let mut page = browser.page().unwrap();
    page.viewport(1440, 900, false).unwrap();
    page.dark(false).unwrap();
    page.open(&format!("http://{}/", panel.address)).unwrap();
    until(
        &mut page,
        "document.querySelectorAll('[data-region=softkeys] button').length === 10",
    );
    page
}

fn choose(panel: &Panel, mode: &str) {
    panel.press(mode);
    for key in ["PGM_NR", "L", "I", "V", "E", "ENT"] {
        // Letters of the alpha keyboard share their names with path functions.
        panel.press(key);
    }
    panel.until(|screen| {
        screen["program"]["title"]
            .as_str()
            .is_some_and(|title| title.contains("LIVE"))
    });
}

#[test]
fn a_test_run_is_seen_while_it_cuts() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = panel(400, 1);
    panel.to_manual();
    let mut page = open(&panel, &browser);
    choose(&panel, "TEST");
    page.click("[data-key=\"3D_VIEW\"]").unwrap();
    until(
        &mut page,
        "document.querySelector('.stage .nothing').checkVisibility()",
    );
    panel.press("START");
    // Seen while it is cut, and loaded anew in the middle.
    until(&mut page, &format!("{CUT} > 1000"));
    page.reload().unwrap();
    until(&mut page, &format!("{CUT} > 1000"));
    let tools = "document.querySelector('.stage').view?.drawnPath.count > 800";
    until(&mut page, tools);
    // To its end: the hole goes through.
    until(
        &mut page,
        "document.querySelector('.stage').view.sheet.heights.includes(0)",
    );
    same(&panel, &mut page);
    until(&mut page, "document.querySelector('.stage').view.settled");
    pictures::take(&mut page, "test-run-3d");

    // The blank is whole again.
    panel.press("GRAPHICS");
    panel.press("BLK_FORM");
    until(&mut page, &format!("{CUT} === 0"));
    assert_eq!(
        page.number("document.querySelector('.stage').view.drawnPath.count")
            .unwrap(),
        0.0
    );
    assert_eq!(page.complaints(), [] as [String; 0]);
}

/// The same while the machine cuts: the tool goes along with it, and the part after an NC stop is the machine's.
#[test]
fn a_program_run_is_seen_on_a_phone() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    // Many rounds: the run does not end before a slow browser has seen it.
    let panel = panel(12, 40);
    panel.to_manual();
    let mut page = open(&panel, &browser);
    page.viewport(390, 800, true).unwrap();
    choose(&panel, "FULL");
    page.tap("[data-key=\"3D_VIEW\"]").unwrap();
    panel.press("NC_START");
    panel.until(|screen| screen["status"]["star"] == "steady");
    assert_eq!(panel.give(&json!({"speed": 20})), 200);
    until(&mut page, &format!("{CUT} > 20000"));
    panel.press("NC_STOP");
    panel.until(|screen| screen["status"]["star"] == "blinking");
    assert_eq!(panel.give(&json!({"speed": 1})), 200);
    panel.wait(0.5);
    // What is executed is cut element by element: the tool stands further on.
    same(&panel, &mut page);
    let place = |axis: usize| format!("document.querySelector('.stage').view.toolAt[{axis}]");
    let position = |name: &str| support::position(&panel.screen(), name);
    for (axis, name, corner) in [(0, "X", 0.0), (1, "Y", 0.0), (2, "Z", -20.0)] {
        let shown = page.number(&place(axis)).unwrap() + corner;
        assert!(
            (shown - position(name)).abs() < 0.01,
            "{name}: {shown} {}",
            position(name)
        );
    }
    until(&mut page, "document.querySelector('.stage').view.settled");
    assert!(page.number("document.documentElement.scrollWidth").unwrap() <= 390.0);
    pictures::take(&mut page, "phone-run-3d");
    assert_eq!(page.complaints(), [] as [String; 0]);
}
