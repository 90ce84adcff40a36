//! What stands around the screen: every text has a row in the table, no row is there for nothing, and a page of a German
//! control has no English word.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use std::collections::BTreeSet;
use std::path::Path;
use std::time::Duration;

use bahn_browser::{Browser, Page};
use bahn_service::{Key, Language, texts_around};
use serde_json::json;
use support::Panel;

fn sources(folders: &[&str]) -> String {
    let mut text = String::new();
    let mut folders: Vec<_> = folders
        .iter()
        .map(|folder| Path::new(env!("CARGO_MANIFEST_DIR")).join(folder))
        .collect();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => folders.push(path),
                false => text += &std::fs::read_to_string(path).unwrap(),
            }
        }
    }
    text
}

/// What stands between two texts, wherever it does.
fn between<'a>(text: &'a str, begin: &'a str, end: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(begin)
        .skip(1)
        .filter_map(move |rest| Some(rest.split_once(end)?.0))
}

#[test]
fn every_text_has_its_row_and_every_row_its_text() {
    let (english, german) = (texts_around(Language::English), texts_around(Language::German));
    assert!(english.keys().eq(german.keys()));
    assert!(english.iter().all(|(name, text)| name == text));
    let page = sources(&["web", "../../part/viewer/web"]);
    let mut used: BTreeSet<&str> = BTreeSet::new();
    for begin in [
        "words(\"",
        "words('",
        "say(\"",
        "said(\"span\", \"",
        "button(\"",
        "fold(\"",
        "labelled(\"",
        "list(\"",
    ] {
        used.extend(between(&page, begin, &begin[begin.len() - 1..]));
    }
    // say(node, "text").
    let said = between(&page, "say(", ";").filter_map(|call| call.split_once(", \"")?.1.split('"').next());
    used.extend(said.filter(|text| text.len() > 1 && !["aria-label", "label", "title"].contains(text)));
    for tag in between(&page, " data-words=\"", "<") {
        let Some((names, text)) = tag.split_once("\">") else {
            continue;
        };
        used.extend(names.split(' ').any(|name| name == "text").then_some(text.trim()));
    }
    assert!(used.len() > 60, "{}", used.len());
    let missing: Vec<_> = used.iter().filter(|text| !german.contains_key(*text)).collect();
    assert!(missing.is_empty(), "{missing:#?}");

    let all = page
        + &sources(&[
            "src",
            "../terminal/src",
            "../panel/src",
            "../panel900/src",
            "../screen/src",
            "../graphics/src",
            "../why/src",
            "../service/src",
        ]);
    let keys: BTreeSet<_> = Key::ALL.iter().map(|key| key.label()).collect();
    let idle: Vec<_> = german
        .keys()
        .filter(|text| !keys.contains(*text) && !all.contains(**text))
        .collect();
    assert!(idle.is_empty(), "{idle:#?}");
}

/// All that is read or spoken outside of the screen of the control: texts, labels, titles.
const SPOKEN: &str = "(() => { const said = new Set(); const walk = (node) => { \
    for (const name of ['aria-label', 'title', 'alt', 'label']) if (node.getAttribute?.(name)) said.add(node.getAttribute(name)); \
    for (const child of node.childNodes) child.nodeType === 3 ? said.add(child.textContent.trim()) : walk(child); }; \
    walk(document.body); return [...said].join('\\n'); })()";

fn spoken(page: &mut Page) -> Vec<String> {
    let text = page.evaluate(SPOKEN).unwrap();
    text.as_str().unwrap().lines().map(str::to_owned).collect()
}

/// The language is chosen in MOD.
fn to_german(panel: &Panel) {
    panel.press("MOD");
    let menu = panel.until(|screen| screen["program"]["kind"] == "list");
    let lines = menu["program"]["lines"].as_array().unwrap();
    let place = lines
        .iter()
        .position(|line| line["text"].as_str().unwrap().contains("ENGLISH"));
    for _ in 0..place.unwrap_or_else(|| panic!("{lines:#?}")) {
        panel.press("DOWN");
    }
    panel.press("ENT");
    panel.until(|screen| screen["look"]["language"] == "de");
}

/// What is said in English only: what is the same in both languages proves nothing, nor what is another word in German.
fn left(said: &[String]) -> Vec<String> {
    let table = texts_around(Language::German);
    let german: BTreeSet<_> = table.values().copied().collect();
    let is_english = |text: &&String| {
        // What is engraved on a key is the same everywhere.
        let known = table
            .get(text.as_str())
            .filter(|_| Key::from_name(text).is_none());
        known.is_some_and(|german| german != text) && !german.contains(text.as_str())
    };
    said.iter().filter(is_english).cloned().collect()
}

/// The language of MOD is that of the page, at once; what was drawn before is drawn anew.
#[test]
fn the_page_speaks_as_the_control_does() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = Panel::start();
    let mut page = browser.page().unwrap();
    page.viewport(1440, 900, false).unwrap();
    page.open(&format!("http://{}/", panel.address)).unwrap();
    let patience = Duration::from_secs(60);
    let ready = "document.querySelectorAll('[data-region=softkeys] button').length === 10";
    page.wait_until(ready, patience).unwrap();
    panel.to_manual();
    // The drawer and the part from every side have been opened once.
    page.click("[data-key=\"3D_VIEW\"]").unwrap();
    page.click(".drawer summary").unwrap();
    page.wait_until(
        "document.querySelectorAll('.drawer option').length > 10",
        patience,
    )
    .unwrap();
    let english = spoken(&mut page);
    assert_eq!(page.evaluate("document.documentElement.lang").unwrap(), "en");
    let answer = panel.get("/api/texts");
    assert_eq!(
        (&answer["language"], &answer["texts"]["Machine"]),
        (&json!("en"), &json!("Machine"))
    );

    to_german(&panel);
    page.wait_until("document.documentElement.lang === 'de'", patience)
        .unwrap();
    page.wait_until(
        "document.querySelector('.drawer optgroup').label === 'Achsen und Spindel'",
        patience,
    )
    .unwrap();
    assert!(left(&english).len() > 60, "{english:#?}");
    assert_eq!(left(&spoken(&mut page)), [] as [String; 0]);
    let said = |page: &mut Page, script: &str| page.evaluate(script).unwrap();
    assert_eq!(
        said(
            &mut page,
            "document.querySelector('[data-key=\"TOOL_DEF\"]').ariaLabel"
        ),
        "TOOL DEF: Werkzeug-Definition"
    );
    assert_eq!(
        said(
            &mut page,
            "document.querySelector('[data-key=\"NC_START\"]').ariaLabel"
        ),
        "Maschinentaste NC START"
    );
    assert_eq!(
        said(
            &mut page,
            "document.querySelector('[data-key=\"SK1\"]').ariaLabel.split(':')[0]"
        ),
        "Softkey 1"
    );
    page.click("#help-button").unwrap();
    let rows = page.text("#help tbody").unwrap();
    assert!(
        rows.contains("Vorschub-Override") && rows.contains("Buchstaben und Ziffern"),
        "{rows}"
    );

    // A page that is opened on a German control begins in German.
    page.reload().unwrap();
    page.wait_until(ready, patience).unwrap();
    assert_eq!(left(&spoken(&mut page)), [] as [String; 0]);
    let (status, _) = panel.request("GET", "/api/texts?language=xx", &[], "");
    assert_eq!(status, 404);
    assert_eq!(panel.get("/api/texts?language=en")["texts"]["Machine"], "Machine");
    assert_eq!(page.complaints(), [] as [String; 0]);
}

/// A TNC 360 has the keys that its manual shows; others are refused with a word.
#[test]
fn the_keyboard_is_that_of_the_model() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    for (machine, has) in [("mill-tnc360", false), ("mill", true)] {
        let panel = Panel::of(machine, |_| {});
        panel.to_manual();
        let mut page = browser.page().unwrap();
        page.viewport(1440, 900, false).unwrap();
        page.open(&format!("http://{}/", panel.address)).unwrap();
        let ready = "document.querySelectorAll('[data-region=softkeys] button').length === 10";
        page.wait_until(ready, Duration::from_secs(60)).unwrap();
        for key in ["SCREEN", "CHF", "V", "W", "B"] {
            let seen =
                format!("document.querySelector('[data-region=keyboard] [data-key=\"{key}\"]') !== null");
            assert_eq!(page.evaluate(&seen).unwrap(), has, "{machine} {key}");
            let (status, body) = panel.request("POST", "/api/key", &[], &json!({ "key": key }).to_string());
            assert_eq!(status, if has { 200 } else { 409 }, "{machine} {key}: {body}");
            assert!(
                has || body.contains(&format!("the TNC 360 has no key {key}")),
                "{body}"
            );
            panel.press("CE");
        }
        let group = "document.querySelector('.group.letter') !== null";
        assert_eq!(page.evaluate(group).unwrap(), has);
        for key in ["GRAPHICS", "IV", "L", "HELP", "X"] {
            let seen =
                format!("document.querySelector('[data-region=keyboard] [data-key=\"{key}\"]') !== null");
            assert_eq!(page.evaluate(&seen).unwrap(), true, "{machine} {key}");
        }
        assert_eq!(page.complaints(), [] as [String; 0]);
    }
}
