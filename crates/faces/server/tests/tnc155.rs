//! The page of a TNC 155 in a real browser: a screen of one colour, its own keys, nothing cut off.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;
#[path = "../../panel/tests/support/tnc155.rs"]
mod tnc155;

use std::time::Duration;

use bahn_browser::{Browser, Page};
use bahn_parameters::ControlModel::Tnc155;
use serde_json::json;
use support::{Panel, pictures};

/// How long a person waits; the host may be slow.
const PATIENCE: Duration = Duration::from_secs(60);
/// Windows that people have.
const WINDOWS: [(u32, u32); 3] = [(1024, 768), (1280, 800), (1440, 900)];

fn panel(lines: &'static [&'static str]) -> Panel {
    Panel::of("mill-tnc155", |folder| tnc155::fit(folder, Tnc155, lines))
}

fn open(panel: &Panel, browser: &Browser) -> Page {
    let mut page = browser.page().unwrap();
    page.viewport(1280, 800, false).unwrap();
    page.dark(false).unwrap();
    page.open(&format!("http://{}/", panel.address)).unwrap();
    until(&mut page, "document.body.dataset.layout === 'monochrome'");
    page
}

fn until(page: &mut Page, condition: &str) {
    page.wait_until(condition, PATIENCE).unwrap();
}

/// Names of the keys that are seen, in their order on the page.
fn keys(page: &mut Page) -> Vec<String> {
    let seen = "[...document.querySelectorAll('[data-region=keyboard] .key, [data-region=softkeys] .key')]\
                .filter(key => key.checkVisibility()).map(key => key.dataset.key)";
    let seen = page.evaluate(seen).unwrap();
    let seen = seen.as_array().unwrap().iter();
    seen.map(|key| key.as_str().unwrap().to_owned()).collect()
}

/// What is written on the screen, and behind it, has shades of one colour: their hues, degrees, differ by so many at most.
const HUES: &str = "(() => { const hues = []; \
    for (const node of document.querySelectorAll('.display, .display *')) { \
      if (!node.checkVisibility() || node.matches('meter, img, progress')) continue; \
      const style = getComputedStyle(node); \
      for (const colour of [style.color, style.backgroundColor]) { \
        const [r, g, b, a] = colour.match(/[\\d.]+/g).map(Number); \
        const most = Math.max(r, g, b), least = Math.min(r, g, b), span = most - least; \
        if (a === 0 || span < 24) continue; \
        const hue = most === r ? (g - b) / span : most === g ? 2 + (b - r) / span : 4 + (r - g) / span; \
        hues.push((60 * hue + 360) % 360); } } \
    return Math.max(...hues) - Math.min(...hues); })()";

/// The screen has one colour, amber or green, whatever it shows; there is no row of soft keys, and the letters stand there with
/// MP217 = 1 alone [001:186] [001:1653].
#[test]
fn the_screen_has_one_colour_and_no_soft_keys() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = panel(&[]);
    let mut page = open(&panel, &browser);
    panel.press("CE");
    for (mode, heading) in [("PROGRAM", "PROGRAMMING AND EDITING"), ("TEST", "TEST RUN")] {
        panel.press(mode);
        panel.press("MOD");
        panel.until(|screen| screen["mode"] == heading);
        // A key that does nothing here brings a message.
        panel.press("RL");
        panel.until(|screen| screen["messages"] != json!([]));
        until(&mut page, "document.querySelectorAll('.message').length > 0");
        for scheme in ["calm", "control"] {
            let choose = format!(
                "(() => {{ const list = document.querySelector('#scheme'); list.value = '{scheme}'; \
                 list.dispatchEvent(new Event('change')); return true; }})()"
            );
            page.evaluate(&choose).unwrap();
            let differ = page.number(HUES).unwrap();
            assert!(differ < 16.0, "{mode}, {scheme}: {differ} degrees");
        }
        panel.press("CE");
    }
    let seen = keys(&mut page);
    for (key, there) in [
        ("GRAPHICS", true),
        ("MAGN", true),
        ("IV", true),
        ("SK1", false),
        ("G", false),
        ("V", false),
    ] {
        assert_eq!(seen.iter().any(|own| own == key), there, "{key}: {seen:?}");
    }
    assert_eq!(page.complaints(), [] as [String; 0]);
}

/// With MP217 = 1 the letters of the addresses are there [001:1653].
#[test]
fn mp217_shows_the_letters_of_the_keyboard() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = panel(&["MP217 : 1"]);
    let mut page = open(&panel, &browser);
    until(&mut page, "document.body.dataset.letters === 'true'");
    assert!(keys(&mut page).iter().any(|key| key == "G"));
    assert_eq!(page.complaints(), [] as [String; 0]);
}

/// Screen and keyboard are in sight as a whole, with nothing beyond the right edge.
#[test]
fn nothing_is_cut_off() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = panel(&[]);
    panel.to_manual();
    let mut page = open(&panel, &browser);
    for (width, height) in WINDOWS {
        page.viewport(width, height, false).unwrap();
        let across = "document.documentElement.scrollWidth - innerWidth";
        assert!(page.number(across).unwrap() <= 0.0, "{width} x {height}");
        for region in [".display", "[data-region=keyboard]"] {
            let [left, top, wide, tall] = page.bounds(region).unwrap();
            assert!(left >= 0.0 && top >= 0.0, "{region}");
            assert!(left + wide <= f64::from(width), "{region} at {width} x {height}");
            assert!(
                top + tall <= f64::from(height),
                "{region} at {width} x {height}: {}",
                top + tall
            );
        }
        // Nothing lies on a key.
        let covered = "[...document.querySelectorAll('.key')].filter(key => { \
                       if (!key.checkVisibility()) return false; \
                       const { left, right, top, bottom } = key.getBoundingClientRect(); \
                       const at = document.elementFromPoint((left + right) / 2, (top + bottom) / 2); \
                       return at && at !== key; }).map(key => key.dataset.key)";
        assert_eq!(page.evaluate(covered).unwrap(), json!([]), "{width} x {height}");
        // Each label fits its key.
        let wide = "[...document.querySelectorAll('[data-region=keyboard] .key')].filter(key => key.checkVisibility() && key.scrollWidth > key.clientWidth + 1).map(key => key.dataset.key)";
        assert_eq!(page.evaluate(wide).unwrap(), json!([]), "{width} x {height}");
        if (width, height) == (1280, 800) {
            pictures::take(&mut page, "tnc155");
        }
    }
    assert_eq!(page.complaints(), [] as [String; 0]);
}

/// The graphics stand in the place of the program, in shades of the colour of the screen [001:186].
#[test]
fn the_graphics_have_the_colour_of_the_screen() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = Panel::of("mill-tnc155", |folder| {
        tnc155::fit(folder, Tnc155, &[]);
        let program = "BEGIN PGM 77 MM\nBLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+100 Y+60 Z+0\nTOOL CALL 1 Z S1000\n\
                       L Z+2 R0 F15999 M3\nL X+20 Y+30 F15999\nL Z-5 F200\nL X+80 F300\nL Z+50 F15999 M2\nEND PGM 77 MM\n";
        std::fs::write(folder.join("programs/77.H"), program).unwrap();
    });
    let mut page = open(&panel, &browser);
    panel.until(|screen| screen["messages"][0]["text"] == "POWER INTERRUPTED");
    for key in [
        "CE", "TEST", "PGM_NR", "7", "7", "ENT", "ENT", "GRAPHICS", "GRAPHICS",
    ] {
        panel.press(key);
    }
    panel.until(|screen| {
        screen["graphics"]["view"] == "three_planes" && screen["graphics"]["running"] == false
    });
    let shown = "[...document.querySelectorAll('.windows > .window')].filter(window => window.checkVisibility()).map(window => window.dataset.region).join()";
    until(
        &mut page,
        &format!(
            "{shown} === 'graphics' && document.querySelector('[data-region=graphics] img').naturalWidth > 300"
        ),
    );
    assert!(page.number(HUES).unwrap() < 16.0);
    let drawn = "getComputedStyle(document.querySelector('[data-region=graphics] img')).filter.includes('grayscale(1)')";
    assert_eq!(page.evaluate(drawn).unwrap(), true);
    // The picture is there as a whole.
    let inside = "(() => { const [inner, outer] = ['[data-region=graphics] img', '[data-region=graphics]'].map(name => \
                  document.querySelector(name).getBoundingClientRect()); return inner.bottom <= outer.bottom + 0.5; })()";
    assert_eq!(page.evaluate(inside).unwrap(), true);
    pictures::take(&mut page, "tnc155-graphics");
    assert_eq!(page.complaints(), [] as [String; 0]);
}
