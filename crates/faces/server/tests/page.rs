//! What stands around the screen, in a real browser: the time line, the lessons, the teacher's drawer, the colours, and that
//! everything is in sight on windows of all sizes.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use std::time::Duration;

use bahn_browser::{Browser, Page};
use serde_json::json;
use support::{Panel, pictures, position};

/// How long a person waits; the host may be slow.
const PATIENCE: Duration = Duration::from_secs(60);

fn open(panel: &Panel, browser: &Browser) -> Page {
    let mut page = browser.page().unwrap();
    page.viewport(1440, 900, false).unwrap();
    page.dark(false).unwrap();
    page.open(&format!("http://{}/", panel.address)).unwrap();
    ready(&mut page);
    page
}

fn ready(page: &mut Page) {
    until(
        page,
        "document.querySelectorAll('[data-region=softkeys] button').length === 10",
    );
}

fn until(page: &mut Page, condition: &str) {
    page.wait_until(condition, PATIENCE).unwrap();
}

/// Chooses an option by a piece of its text; as a person does, with an event.
fn choose(page: &mut Page, selector: &str, text: &str) {
    let script = format!(
        "(() => {{ const list = document.querySelector('{selector}'); \
         const option = [...list.options].find(option => option.textContent.includes('{text}')); \
         list.value = option.value; list.dispatchEvent(new Event('change', {{ bubbles: true }})); return true; }})()"
    );
    until(
        page,
        &format!(
            "[...document.querySelector('{selector}').options].some(option => option.textContent.includes('{text}'))"
        ),
    );
    page.evaluate(&script).unwrap();
}

#[test]
fn the_time_line_leads_back_and_on() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = Panel::start();
    panel.to_manual();
    let mut page = open(&panel, &browser);
    let began = panel.get("/api/snapshot")["t"].as_f64().unwrap();
    let stood = position(&panel.screen(), "X");
    assert_eq!(panel.give(&json!({"key": "X+", "down": true})), 200);
    panel.until(|screen| position(screen, "X") > stood + 2.0);
    assert_eq!(panel.give(&json!({"key": "X+", "down": false})), 200);
    panel.wait(1.0);
    let moved = position(&panel.screen(), "X");

    // Dragged back to before the axis moved: time stands there, and the axis stands where it stood.
    let slider = "document.querySelector('[data-region=timeline] input')";
    let back = format!("{slider}.value = {began}; {slider}.dispatchEvent(new Event('input'))");
    page.evaluate(&back).unwrap();
    panel.until(|screen| screen["machine"]["paused"] == true && (position(screen, "X") - stood).abs() < 0.01);
    until(
        &mut page,
        "document.querySelector('[data-region=timeline] .moment').textContent.includes(' of ')",
    );
    let on = "[...document.querySelectorAll('[data-region=timeline] button')].find(button => button.textContent === 'Go on')";
    until(&mut page, &format!("!{on}.disabled"));
    // To the newest moment, back again, and on from there: another branch, and the old one can still be gone to.
    let newest = "[...document.querySelectorAll('[data-region=timeline] button')].find(button => button.textContent === 'Newest')";
    until(&mut page, &format!("!{newest}.disabled"));
    page.evaluate(&format!("{newest}.click()")).unwrap();
    panel.until(|screen| (position(screen, "X") - moved).abs() < 0.01);
    page.evaluate(&back).unwrap();
    panel.until(|screen| (position(screen, "X") - stood).abs() < 0.01);
    page.evaluate(&format!("{on}.click()")).unwrap();
    panel.until(|screen| screen["machine"]["paused"] == false);
    assert_eq!(panel.give(&json!({"key": "Y+", "down": true})), 200);
    panel.wait(0.3);
    assert_eq!(panel.give(&json!({"key": "Y+", "down": false})), 200);
    let branches = "[data-region=timeline] select:last-of-type";
    choose(&mut page, branches, "Way 1");
    panel.until(|screen| (position(screen, "X") - moved).abs() < 0.01);
    assert_eq!(page.complaints(), [] as [String; 0]);
}

#[test]
fn a_lesson_is_begun_hinted_and_ended() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = Panel::start();
    let known = panel.get("/api/lessons");
    let known = known.as_array().unwrap();
    assert_eq!(known.len(), 10);
    let title = known
        .iter()
        .find_map(|lesson| {
            lesson["name"]
                .as_str()?
                .contains("door")
                .then(|| lesson["title"].as_str())?
        })
        .unwrap();
    let mut page = open(&panel, &browser);
    page.click(".lessons summary").unwrap();
    choose(&mut page, ".lessons select", title);
    page.click(".lessons .choose button").unwrap();
    until(
        &mut page,
        "document.querySelector('.lesson h2')?.checkVisibility()",
    );
    assert_eq!(page.text(".lesson h2").unwrap(), title);
    panel.until(|screen| screen["lesson"]["title"] == title && screen["lesson"]["state"] == "running");
    // Hints come one after the other, and none before it is asked for.
    assert_eq!(
        page.number("document.querySelectorAll('.lesson .hints li').length")
            .unwrap(),
        0.0
    );
    page.click(".lesson .hint").unwrap();
    until(
        &mut page,
        "document.querySelectorAll('.lesson .hints li').length === 1",
    );
    // Nothing was done: it is not passed.
    page.click(".lesson .hand-in").unwrap();
    until(
        &mut page,
        "document.querySelector('.lesson .state').textContent.startsWith('Not passed')",
    );
    page.click(".lesson .end").unwrap();
    until(&mut page, "!document.querySelector('.lesson h2')");
    assert!(panel.screen()["lesson"].is_null());
    assert_eq!(page.complaints(), [] as [String; 0]);
}

#[test]
fn the_drawer_breaks_and_repairs() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = Panel::start();
    panel.to_manual();
    // All that the page offers is what the interface says.
    let drawer = panel.get("/api/drawer");
    let drawer = drawer.as_array().unwrap();
    let of = |name: &str, group: &str| {
        let found = drawer
            .iter()
            .find(|thing| thing["name"] == name && thing["group"] == group);
        found.unwrap_or_else(|| panic!("{name} {group}: {drawer:#?}"))
    };
    let encoder = of("X", "axes and spindle");
    let fault = &encoder["faults"][0];
    assert!(fault["action"].as_str().unwrap().starts_with("fault "), "{fault}");
    let mut page = open(&panel, &browser);
    page.click(".drawer summary").unwrap();
    until(
        &mut page,
        &format!(
            "document.querySelectorAll('.drawer .things option').length === {}",
            drawer.len()
        ),
    );
    let words = format!("X: {}", encoder["words"].as_str().unwrap());
    choose(&mut page, ".drawer .things", &words);
    choose(&mut page, ".drawer .ways", fault["words"].as_str().unwrap());
    page.click(".drawer .break").unwrap();
    panel.until(|screen| !screen["messages"].as_array().unwrap().is_empty());
    page.click(".drawer .repair").unwrap();
    let marks = panel.until(|screen| {
        let marks = screen["timeline"]["marks"].as_array().unwrap();
        marks.iter().filter(|mark| mark["kind"] == "action").count() >= 2
    });
    assert!(
        marks["timeline"]["marks"]
            .to_string()
            .contains(fault["action"].as_str().unwrap())
    );
    assert_eq!(page.complaints(), [] as [String; 0]);
}

/// Everything that is worked with is in sight, nothing is wider than the window and no line of the program is cut.
#[test]
fn all_is_in_sight_on_windows_of_all_sizes() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let lines: String = (0..40).map(|k| format!("L X+{k} Y+{k} F100\n")).collect();
    let program = format!("BEGIN PGM LINES MM\n{lines}END PGM LINES MM\n");
    let panel = Panel::with(|folder| std::fs::write(folder.join("programs/LINES.H"), program).unwrap());
    panel.to_manual();
    let mut page = open(&panel, &browser);
    panel.press("TEST");
    panel.choose("LINES");
    panel.until(|screen| screen["program"]["lines"].as_array().unwrap().len() == 16);
    // The station has them before the page.
    until(
        &mut page,
        "document.querySelectorAll('[data-region=program] .lines li').length === 16",
    );
    let inside = |selector: &str, in_what: &str| {
        format!(
            "(() => {{ const a = document.querySelector('{selector}').getBoundingClientRect(), b = {in_what}; \
             return a.top >= b.top - 0.5 && a.bottom <= b.bottom + 0.5 && a.left >= b.left - 0.5 && a.right <= b.right + 0.5; }})()"
        )
    };
    let window = "{ top: 0, left: 0, bottom: innerHeight, right: innerWidth }";
    for (width, height) in [(1280, 800), (1440, 900), (3840, 2160)] {
        page.viewport(width, height, false).unwrap();
        pictures::take(&mut page, &format!("window-{width}"));
        for seen in [
            ".emergency",
            "[data-key=\"NC_START\"]",
            "[data-key=\"X+\"]",
            ".speed select",
            "[data-region=softkeys]",
            "[data-key=\"W\"]",
        ] {
            assert_eq!(
                page.evaluate(&inside(seen, window)).unwrap(),
                true,
                "{width}: {seen}"
            );
        }
        let last = inside(
            "[data-region=program] .lines li:nth-child(16)",
            "document.querySelector('[data-region=program]').getBoundingClientRect()",
        );
        assert_eq!(page.evaluate(&last).unwrap(), true, "{width}: the last line");
    }
    // The bars of F and S have a mark at two thirds, 100 of 150 %.
    let marks = "(() => [...document.querySelectorAll('.bar')].map((bar) => { \
                 const [meter, mark] = ['meter', '.hundred'].map((name) => bar.querySelector(name).getBoundingClientRect()); \
                 return Math.abs((mark.left + mark.right) / 2 - meter.left - meter.width / 1.5) < 1.5 && mark.height > 4; }).join())()";
    assert_eq!(page.evaluate(marks).unwrap(), "true,true");
    for width in [360, 390] {
        page.viewport(width, 800, true).unwrap();
        pictures::take(&mut page, &format!("window-{width}"));
        let wide = page.number("document.documentElement.scrollWidth").unwrap();
        assert!(wide <= f64::from(width), "{width}: {wide}");
        // The arrows of the soft keys stand as they point; an axis stands on one line.
        let left_of = "document.querySelector('[data-key=SK_LEFT]').getBoundingClientRect().right <= \
                       document.querySelector('[data-key=SK_RIGHT]').getBoundingClientRect().left";
        assert_eq!(page.evaluate(left_of).unwrap(), true);
        let whole = "[...document.querySelectorAll('.axis-value')].every(axis => axis.getClientRects().length === 1 && \
                     axis.getBoundingClientRect().right <= innerWidth)";
        assert_eq!(page.evaluate(whole).unwrap(), true);
    }
    assert_eq!(page.complaints(), [] as [String; 0]);
}

/// Where a colour of MP7350 to MP7358 is seen: the parameter, a selector and a property; first in MANUAL OPERATION, then in
/// PROGRAMMING AND EDITING.
const COLOURED: [&[(&str, &str, &str)]; 2] = [
    &[
        ("MP7350", "[data-region=status]", "borderTopColor"),
        ("MP7351", ".message", "color"),
        ("MP7352.0", ".headings", "backgroundColor"),
        ("MP7352.1", ".heading", "color"),
        ("MP7352.2", "[data-region=dialogue]", "color"),
        ("MP7354.0", ".display", "backgroundColor"),
        ("MP7354.1", ".display", "color"),
        ("MP7356.0", "[data-region=status]", "backgroundColor"),
        ("MP7356.1", "[data-region=status] .axes", "color"),
        ("MP7356.2", "[data-region=status]", "color"),
        ("MP7357.0", "[data-region=softkeys]", "backgroundColor"),
        ("MP7357.1", ".key.soft", "color"),
    ],
    &[
        ("MP7353.0", ".headings", "backgroundColor"),
        ("MP7353.1", ".heading", "color"),
        ("MP7353.2", "[data-region=dialogue]", "color"),
        ("MP7355.0", ".display", "backgroundColor"),
        ("MP7355.1", ".display", "color"),
        ("MP7358.0", "[data-region=softkeys]", "backgroundColor"),
        ("MP7358.1", ".key.soft", "color"),
    ],
];

/// The colours of the control are those of its machine parameters, and the page keeps the choice.
#[test]
fn the_colours_of_the_control_are_its_parameters() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    // MP7350, MP7351, MP7352, MP7353, MP7354, MP7355, MP7356, MP7357 and MP7358: each index gets a red of its own,
    // $0RR0000, six bits, of which 3F is 255.
    let all: Vec<&str> = COLOURED.into_iter().flatten().map(|(name, ..)| *name).collect();
    let red = |name: &str| all.iter().position(|own| *own == name).unwrap() as u32 + 20;
    let panel = Panel::with(|folder| {
        let path = folder.join("parameters.mp");
        let text = std::fs::read_to_string(&path).unwrap();
        let set = |line: &str| match line.split([' ', ':']).next() {
            Some(name) if all.contains(&name) => format!("{name} : $0{:02X}0000\n", red(name)),
            _ => format!("{line}\n"),
        };
        std::fs::write(path, text.lines().map(set).collect::<String>()).unwrap();
    });
    panel.to_manual();
    let mut page = open(&panel, &browser);
    let colour = |(_, selector, property): (&str, &str, &str)| {
        format!("getComputedStyle(document.querySelector('{selector}')).{property}")
    };
    let ink = colour(("", ".display", "color"));
    let calm = page.evaluate(&ink).unwrap();
    choose(&mut page, "#scheme", "control");
    panel.press("RL");
    until(&mut page, "document.querySelector('.message') !== null");
    for (mode, seen) in ["MANUAL", "PROGRAM"].into_iter().zip(COLOURED) {
        panel.press(mode);
        if mode == "MANUAL" {
            panel.press("RL");
        }
        let programming = mode == "PROGRAM";
        until(
            &mut page,
            &format!(
                "document.querySelector('.display').classList.contains('programming') === {programming}"
            ),
        );
        for own in seen {
            let expected = format!("rgb({}, 0, 0)", red(own.0) * 255 / 63);
            until(&mut page, &format!("{} === '{expected}'", colour(*own)));
        }
    }
    page.reload().unwrap();
    ready(&mut page);
    let expected = format!("rgb({}, 0, 0)", red("MP7355.1") * 255 / 63);
    until(&mut page, &format!("{ink} === '{expected}'"));
    choose(&mut page, "#scheme", "Calm");
    assert_eq!(page.evaluate(&ink).unwrap(), calm);
    assert_eq!(page.complaints(), [] as [String; 0]);
}

/// The oscilloscope shows its curves in the window of the graphics while it records.
#[test]
fn curves_of_the_oscilloscope_are_seen() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = Panel::start();
    panel.to_manual();
    let mut page = open(&panel, &browser);
    panel.press("MOD");
    let menu = panel.until(|screen| screen["program"]["kind"] == "list");
    let lines = menu["program"]["lines"].as_array().unwrap();
    let code = lines
        .iter()
        .position(|line| line["text"].as_str().unwrap().starts_with("CODE NUMBER"));
    for _ in 0..code.unwrap() {
        panel.press("DOWN");
    }
    for key in ["ENT", "6", "8", "8", "3", "7", "9", "ENT"] {
        panel.press(key);
    }
    panel.until(|screen| screen["program"]["title"] == "OSCILLOSCOPE");
    // Channel 1: V NOMINAL, channel 2: D DIFF.
    for key in "DOWN DOWN DOWN DOWN ENT ENT DOWN DOWN ENT ENT ENT ENT ENT SK1 SK7".split(' ') {
        panel.press(key);
    }
    panel.until(|screen| screen["graphics"]["running"] == true);
    let picture = "document.querySelector('[data-region=graphics] img')";
    // Its width is known a moment before the page has counted it.
    until(
        &mut page,
        &format!(
            "{picture}.checkVisibility() && {picture}.naturalWidth > 300 && {picture}.dataset.serial !== undefined"
        ),
    );
    assert_eq!(panel.give(&json!({"key": "X+", "down": true})), 200);
    let first = page.number(&format!("Number({picture}.dataset.serial)")).unwrap();
    until(
        &mut page,
        &format!("Number({picture}.dataset.serial) > {first} + 3"),
    );
    assert_eq!(panel.give(&json!({"key": "X+", "down": false})), 200);
    panel.wait(0.5);
    panel.press("SK7");
    panel.until(|screen| screen["graphics"]["running"] == false);
    std::thread::sleep(Duration::from_millis(500));
    pictures::take(&mut page, "oscilloscope");
    assert_eq!(page.complaints(), [] as [String; 0]);
}

/// A TNC 360 has one column of text: one operating mode, and graphics in the place of the program.
#[test]
fn a_small_screen_has_one_column() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = Panel::of("mill-tnc360", |_| {});
    panel.to_manual();
    let look = json!({"layout": "one_column", "language": "en", "letters": true, "colours": {}});
    assert_eq!(panel.screen()["look"], look);
    let mut page = open(&panel, &browser);
    choose(&mut page, "#scheme", "control");
    panel.press("TEST");
    panel.until(|screen| screen["mode"] == "TEST RUN");
    panel.press("GRAPHICS");
    let shown = "[...document.querySelectorAll('.windows > .window')].filter(window => window.checkVisibility()).map(window => window.dataset.region).join()";
    until(&mut page, &format!("{shown} === 'graphics'"));
    let headings =
        "[...document.querySelectorAll('.heading')].filter(heading => heading.checkVisibility()).length";
    assert_eq!(page.number(headings).unwrap(), 1.0);
    pictures::take(&mut page, "one-column");
    for _ in 0..3 {
        panel.press("GRAPHICS");
    }
    until(&mut page, &format!("{shown} === 'program'"));
    assert_eq!(page.complaints(), [] as [String; 0]);
}
