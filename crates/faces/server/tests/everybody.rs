//! The page is for everybody: the rules of axe-core (labels, roles, contrast, order) hold for its parts, in light and
//! dark colours, on desktop and phone; and it is there, and answers, at once.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use std::path::Path;
use std::time::Duration;

use bahn_browser::{Browser, Page};
use serde_json::Value;
use support::Panel;

const PATIENCE: Duration = Duration::from_secs(30);

/// The rules, which `make axe` fetches.
fn rules() -> Option<String> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../out/axe.min.js");
    let rules = std::fs::read_to_string(file).ok();
    if rules.is_none() {
        eprintln!("skipped: out/axe.min.js is not there, see `make axe`");
    }
    rules
}

fn open(panel: &Panel, browser: &Browser, [width, height]: [u32; 2]) -> Page {
    let mut page = browser.page().unwrap();
    page.viewport(width, height, width < 600).unwrap();
    page.open(&format!("http://{}/", panel.address)).unwrap();
    let ready = "document.querySelectorAll('[data-region=softkeys] button').length === 10";
    page.wait_until(ready, PATIENCE).unwrap();
    page
}

/// What is wrong by the rules: rule, help and the elements.
fn wrong(page: &mut Page) -> Vec<String> {
    let found = page
        .evaluate(
            "axe.run(document, { runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'] })
                .then(({ violations }) => violations.map(({ id, help, nodes }) =>
                    `${id}: ${help}: ${nodes.map((node) => `${node.target} ${node.any[0]?.message ?? ''}`).join('; ')}`))",
        )
        .unwrap();
    let found = found.as_array().unwrap().iter();
    found.map(|line| line.as_str().unwrap().to_owned()).collect()
}

#[test]
fn the_rules_of_accessibility_hold_everywhere() {
    let (Some(browser), Some(rules)) = (Browser::for_test().unwrap(), rules()) else {
        return;
    };
    let panel = Panel::start();
    for size in [[1400, 900], [390, 800]] {
        let mut page = open(&panel, &browser, size);
        page.evaluate(&rules).unwrap();
        for keys in [
            &[][..],
            &["CE"],
            &["PROGRAM"],
            &["PGM_NR"],
            &["END", "L", "X"],
            &["END", "TEST"],
            &["GRAPHICS"],
            &["MANUAL", "MOD"],
            &["END", "HELP"],
            &["END"],
        ] {
            for key in keys {
                panel.press(key);
            }
            std::thread::sleep(Duration::from_millis(150));
            for dark in [false, true] {
                page.dark(dark).unwrap();
                let wrong = wrong(&mut page);
                assert!(
                    wrong.is_empty(),
                    "{size:?}, after {keys:?}, dark {dark}:\n{}",
                    wrong.join("\n")
                );
            }
        }
        for tab in ["machine", "teacher", "keyboard"] {
            page.evaluate(&format!(
                "document.querySelector('.tabs [data-tab={tab}]').click()"
            ))
            .unwrap();
            page.evaluate("for (const details of document.querySelectorAll('details')) details.open = true")
                .unwrap();
            let wrong = wrong(&mut page);
            assert!(wrong.is_empty(), "{size:?}, {tab}:\n{}", wrong.join("\n"));
        }
        assert_eq!(page.complaints(), [] as [String; 0]);
    }
}

/// Times from a key of the keyboard to the frame that shows its effect, ms, in ascending order.
fn answers(page: &mut Page, keys: &[&str]) -> Vec<f64> {
    page.evaluate(
        "globalThis.answers = [];
         globalThis.pressed = null;
         addEventListener('keydown', (event) => { pressed = event.timeStamp; }, true);
         new MutationObserver(() => {
             if (pressed === null) return;
             const since = pressed;
             pressed = null;
             requestAnimationFrame(() => answers.push(performance.now() - since));
         }).observe(document.querySelector('[data-region=dialogue]'), { subtree: true, childList: true, characterData: true, attributes: true });",
    )
    .unwrap();
    for (number, key) in keys.iter().enumerate() {
        page.press(key).unwrap();
        page.wait_until(&format!("answers.length > {number}"), PATIENCE)
            .unwrap();
    }
    let answers = page.evaluate("answers").unwrap();
    let mut answers: Vec<f64> = answers
        .as_array()
        .unwrap()
        .iter()
        .filter_map(Value::as_f64)
        .collect();
    answers.sort_by(f64::total_cmp);
    answers
}

/// A first screen is there by then, ms.
const FIRST_SCREEN_MS: f64 = 3000.0;
/// So often the page is loaded at most.
const LOADS: usize = 10;

/// Loads the page again: when its first screen is there, ms.
fn load(page: &mut Page) -> f64 {
    page.reload().unwrap();
    page.wait_until("document.title !== 'Bahn'", PATIENCE).unwrap();
    page.wait_until(
        "performance.getEntriesByName('first-contentful-paint').length === 1",
        PATIENCE,
    )
    .unwrap();
    page.number("performance.getEntriesByName('first-contentful-paint')[0].startTime")
        .unwrap()
}

#[test]
fn the_page_is_there_and_answers_at_once() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = Panel::start();
    let mut page = open(&panel, &browser, [1400, 900]);
    // Once more, as everybody but the first sees it. What else a machine does can only make it later: the shortest of some
    // times is that of the page.
    let mut first_screen = f64::INFINITY;
    for _ in 0..LOADS {
        first_screen = first_screen.min(load(&mut page));
        if first_screen < FIRST_SCREEN_MS {
            break;
        }
    }
    let bytes = page
        .number("performance.getEntries().reduce((sum, entry) => sum + (entry.encodedBodySize ?? 0), 0)")
        .unwrap();
    for key in ["CE", "PROGRAM", "PGM_NR"] {
        panel.press(key);
    }
    panel.until(|screen| {
        screen["dialogue"]["prompt"]
            .as_str()
            .is_some_and(|prompt| !prompt.is_empty())
    });
    std::thread::sleep(Duration::from_millis(200));
    let keys = ["1", "2", "Backspace"].repeat(40);
    let answers = answers(&mut page, &keys);
    let (median, p95) = (answers[answers.len() / 2], answers[answers.len() * 95 / 100]);
    println!(
        "first screen {first_screen:.0} ms, {bytes:.0} bytes; a key: median {median:.1} ms, 95 of 100 within {p95:.1} ms"
    );
    // A screen is there in 1 s, and 95 of 100 keys are answered in 50 ms, where nothing else is done; a host that does much
    // else must have the middle one by then.
    assert!(
        first_screen < FIRST_SCREEN_MS && bytes < 1e6,
        "{first_screen} ms, {bytes} bytes"
    );
    assert!(median < 50.0, "{answers:?}");
}
