//! The page that `bahn test --html` writes, used in a browser as a person does.
#![allow(clippy::unwrap_used, reason = "what fails here fails the test")]

mod support;

use std::path::Path;
use std::time::{Duration, Instant};

use bahn_browser::{Browser, Page};
use serde_json::Value;
use support::Folder;

/// Blank 60 x 40 x 20 mm. A slot of 10 mm width and 5 mm depth along Y+20, from X-10 to X+40; then a hole of 8 mm
/// through the blank.
const BLOCKS: &str = "BLK FORM 0.1 Z X+0 Y+0 Z-20
BLK FORM 0.2 X+60 Y+40 Z+0
TOOL DEF 1 L+0 R+5
TOOL DEF 2 L+0 R+4
TOOL CALL 1 Z S1000
L X-10 Y+20 Z+5 R0 F MAX M3
L Z-5 F MAX
L X+40 F600
L Z+50 F MAX
TOOL CALL 2 Z S2000
L X+50 Y+30 F MAX M3
L Z+2 F MAX
L Z-22 F300
L Z+50 F MAX M2";
const SIZE: [f64; 3] = [60.0, 40.0, 20.0];
const LONG: Duration = Duration::from_secs(90);
const SETTLED: &str = "globalThis.bahn?.view.settled === true";

/// Writes the page; the report.
fn written(folder: &Folder, arguments: &str) -> Value {
    let (code, report) = folder.test(&format!("--html part.html {arguments}"));
    assert_eq!(code, 0, "{report}");
    report
}

fn opened(browser: &Browser, folder: &Folder, size: [u32; 2], phone: bool) -> Page {
    let mut page = browser.page().unwrap();
    page.viewport(size[0], size[1], phone).unwrap();
    page.open_file(&folder.path("part.html")).unwrap();
    page.wait_until(SETTLED, LONG).unwrap();
    page
}

/// Where a point of the blank is in the window.
fn pixel(page: &mut Page, point: [f64; 3]) -> [f64; 2] {
    let [left, top, ..] = page.bounds(".stage canvas").unwrap();
    let at = page
        .evaluate(&format!("bahn.view.camera.project({point:?})"))
        .unwrap();
    [left + at[0].as_f64().unwrap(), top + at[1].as_f64().unwrap()]
}

/// Red, green, blue and opacity of the picture at a point of the blank.
fn colour(page: &mut Page, point: [f64; 3]) -> Vec<u64> {
    let read = page.evaluate(&format!(
        "(() => {{ const v = bahn.view, gl = v.gl; v.draw(v.drawn); const [x, y] = v.camera.project({point:?});
         const p = new Uint8Array(4); gl.readPixels(Math.round(x * v.drawn), v.canvas.height - Math.round(y * v.drawn),
         1, 1, gl.RGBA, gl.UNSIGNED_BYTE, p); return [...p]; }})()"
    ));
    let read = read.unwrap();
    read.as_array()
        .unwrap()
        .iter()
        .map(|v| v.as_u64().unwrap())
        .collect()
}

/// Volume that the page shows as removed, mm³.
fn removed(page: &mut Page) -> f64 {
    let cell = SIZE[0] * SIZE[1] / page.number("bahn.view.sheet.heights.length").unwrap();
    let steps = page
        .number("bahn.view.sheet.heights.reduce((sum, height) => sum + 65535 - height, 0)")
        .unwrap();
    steps / 65535.0 * SIZE[2] * cell
}

fn current(page: &mut Page) -> String {
    page.text("#blocks [aria-selected=true] .text").unwrap()
}

#[test]
fn the_page_shows_the_part_and_asks_nobody() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let folder = Folder::with_program(BLOCKS);
    let report = written(&folder, "");
    let mut page = opened(&browser, &folder, [1100, 700], false);
    assert_eq!(page.text("#title").unwrap(), "main.H");
    // The drill comes out of the blank.
    assert_eq!(page.text("#result").unwrap(), "1 warning");

    // The skin of the blank, the floor of the slot, and past the part.
    page.click("[data-show=path]").unwrap();
    page.click("[data-show=tool]").unwrap();
    page.click("[data-view=top]").unwrap();
    page.wait_until(SETTLED, LONG).unwrap();
    let skin = colour(&mut page, [30.0, 5.0, 20.0]);
    let floor = colour(&mut page, [20.0, 20.0, 15.0]);
    let past = colour(&mut page, [-4.0, 20.0, 20.0]);
    assert_eq!((skin[3], floor[3], past[3]), (255, 255, 0));
    // The skin is bluish, what is machined is not.
    assert!(skin[2] > skin[0] + 15, "{skin:?}");
    assert!(floor[2] <= floor[0] + 5, "{floor:?}");
    // Through the hole one sees what is behind the part.
    assert_eq!(colour(&mut page, [50.0, 30.0, 20.0])[3], 0);

    let near = |a: f64, b: f64| (a - b).abs() < 2e-4 * b;
    let all = report["removed_mm3"].as_f64().unwrap();
    assert!(near(removed(&mut page), all), "{} {all}", removed(&mut page));

    assert!(page.complaints().is_empty(), "{:?}", page.complaints());
    assert_eq!(page.requests().len(), 1, "{:?}", page.requests());
    assert!(page.requests()[0].starts_with("file://"));
}

#[test]
fn the_slider_moves_part_tool_and_blocks() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let folder = Folder::with_program(BLOCKS);
    written(&folder, "");
    let mut page = opened(&browser, &folder, [1100, 700], false);
    assert_eq!(current(&mut page), "L Z+50 F MAX M2");

    // In the beginning nothing is removed.
    page.evaluate("document.querySelector('#slider').focus()")
        .unwrap();
    page.press("Home").unwrap();
    assert_eq!(removed(&mut page), 0.0);
    assert!(page.text("#time").unwrap().starts_with("0:00.0 of "));

    // Block after block; at the end of the slot the tool stands there, 50 mm x 10 mm and a half circle are gone.
    let slot = "L X+40 F600";
    for _ in 0..20 {
        if current(&mut page) == slot {
            break;
        }
        page.click("#next").unwrap();
    }
    assert_eq!(current(&mut page), slot);
    assert_eq!(
        page.evaluate("bahn.view.toolAt.map(Math.round)").unwrap(),
        serde_json::json!([40, 20, 15])
    );
    assert_eq!(page.text("#spindle").unwrap(), "T1");
    let expected = 5.0 * (40.0 * 10.0 + 0.5 * std::f64::consts::PI * 25.0);
    let there = removed(&mut page);
    assert!(there <= expected * 1.001, "{there} {expected}");
    // The part is that of a moment before: it lags behind by less than a moment.
    page.evaluate("document.querySelector('#slider').focus()")
        .unwrap();
    page.press("ArrowRight").unwrap();
    let there = removed(&mut page);
    assert!((there - expected).abs() < 0.002 * expected, "{there} {expected}");
    let spoken = page.evaluate("document.querySelector('#slider').ariaValueText ?? document.querySelector('#slider').getAttribute('aria-valuetext')").unwrap();
    assert!(spoken.as_str().unwrap().contains("L Z+50 F MAX"), "{spoken}");

    // In the middle of the slot by time: 50 mm at 600 mm/min are 5 s, the ramps at the ends are short.
    let begin = page.number("bahn.path.times[bahn.point - 2]").unwrap();
    page.evaluate(&format!("bahn.seek({begin} + 2.5)")).unwrap();
    let x = page.number("bahn.view.toolAt[0]").unwrap();
    assert!((x - 15.0).abs() < 0.5, "{x}");
    assert_eq!(current(&mut page), slot);

    // A click on a block goes there, the part with it.
    page.click("#blocks [data-row='13']").unwrap();
    assert_eq!(current(&mut page), "L Z-22 F300");
    let z = page.number("bahn.view.toolAt[2]").unwrap();
    assert!((z + 2.0).abs() < 1e-3, "{z}");
    // And the list itself by keys.
    page.evaluate("document.querySelector('#blocks').focus()")
        .unwrap();
    page.press("ArrowUp").unwrap();
    assert_eq!(current(&mut page), "L Z+2 F MAX");
    assert!(page.complaints().is_empty(), "{:?}", page.complaints());
}

#[test]
fn measuring_and_sections_are_true() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let folder = Folder::with_program(BLOCKS);
    written(&folder, "--resolution 0.1");
    let mut page = opened(&browser, &folder, [1100, 700], false);
    // On the floor of the slot: 30 mm apart; then from the floor to the skin beside it.
    page.click("[data-show=path]").unwrap();
    page.click("[data-control=measure]").unwrap();
    assert_eq!(page.text("[data-readout]").unwrap(), "Pick a point of the part.");
    let measured = |page: &mut Page, points: [[f64; 3]; 2]| -> Vec<f64> {
        for point in points {
            let at = pixel(page, point);
            page.click_at(at).unwrap();
        }
        let reported = page.text("[data-readout]").unwrap();
        let numbers = reported
            .split_whitespace()
            .filter_map(|word| word.replace('\u{2212}', "-").parse().ok());
        numbers.collect()
    };
    let [first, second] = [[8.0, 20.0, 15.0], [38.0, 20.0, 15.0]];
    page.click("[data-view=top]").unwrap();
    let found = measured(&mut page, [first, second]);
    let within = |found: &[f64], expected: [f64; 4], mm: f64| {
        assert_eq!(found.len(), 4, "{found:?}");
        for (a, b) in found.iter().zip(expected) {
            assert!((a - b).abs() <= mm, "{found:?} {expected:?}");
        }
    };
    // Pixels are coarser than cells: the mouse stands in whole ones.
    let mm = page.number("bahn.view.camera.mm").unwrap().max(0.1);
    within(&found, [30.0, 30.0, 0.0, 0.0], mm);
    let found = measured(&mut page, [[8.0, 20.0, 15.0], [8.0, 35.0, 20.0]]);
    within(&found, [f64::hypot(15.0, 5.0), 0.0, 15.0, 5.0], mm);
    // Heights do not depend on pixels: exact to a step of 16 bits.
    assert!((found[3] - 5.0).abs() <= 0.001, "{found:?}");

    // Cut open across the slot, seen from the right: its floor is 10 mm wide between its walls.
    page.evaluate(
        "(() => { const s = document.querySelector('[data-control=section]'); s.value = '0'; \
                   s.dispatchEvent(new Event('change')); })()",
    )
    .unwrap();
    page.click("[data-view=right]").unwrap();
    page.wait_until(SETTLED, LONG).unwrap();
    assert_eq!(page.text("[data-place]").unwrap(), "X 30.000");
    let cut = colour(&mut page, [30.0, 5.0, 10.0]);
    assert!(cut[0] > cut[2] + 50, "{cut:?} is no section");
    // Above the floor one looks into the slot, which is open at its other end.
    assert_eq!(colour(&mut page, [30.0, 20.0, 17.0])[3], 0);
    for (y, inside) in [(14.7, true), (15.3, false), (24.7, false), (25.3, true)] {
        let hit = page.evaluate(&format!(
            "(() => {{ const v = bahn.view; const [x, y] = v.camera.project([30, {y}, 17]); return v.pick(x, y); }})()"
        ));
        assert_eq!(!hit.unwrap().is_null(), inside, "Y{y}");
    }
    page.click("[data-control=reset]").unwrap();
    page.wait_until(SETTLED, LONG).unwrap();
    assert_eq!(
        page.evaluate("[bahn.view.clip[1], bahn.view.show.path]").unwrap(),
        serde_json::json!([[60, 40, 20], true])
    );
    assert!(page.complaints().is_empty(), "{:?}", page.complaints());
}

#[test]
fn fingers_keys_and_a_narrow_window_suffice() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let folder = Folder::with_program(BLOCKS);
    written(&folder, "--resolution 0.25");
    let mut page = opened(&browser, &folder, [360, 740], true);
    for (dark, ground) in [(false, "rgb(244, 245, 247)"), (true, "rgb(20, 24, 29)")] {
        page.dark(dark).unwrap();
        assert_eq!(
            page.evaluate("getComputedStyle(document.body).backgroundColor")
                .unwrap(),
            ground
        );
    }
    assert_eq!(
        page.number("document.documentElement.scrollWidth").unwrap(),
        360.0
    );
    // All buttons that a finger meets are large enough, and everything has a name.
    let small = "[...document.querySelectorAll('button, select')].filter(e => e.offsetParent && !e.closest('#remarks') \
                 && e.offsetHeight < 38).map(e => e.textContent)";
    assert_eq!(page.evaluate(small).unwrap(), serde_json::json!([]));
    let nameless = "[...document.querySelectorAll('button, select, input, canvas, [role=listbox]')].filter(e => \
                    !(e.textContent.trim() || e.ariaLabel)).map(e => e.outerHTML)";
    assert_eq!(page.evaluate(nameless).unwrap(), serde_json::json!([]));

    let turned = |page: &mut Page| page.number("bahn.view.camera.azimuth").unwrap();
    let [x, y] = page.middle(".stage canvas").unwrap();
    let before = turned(&mut page);
    page.swipe(&[[[x - 40.0, y], [x + 60.0, y]]]).unwrap();
    assert!((turned(&mut page) - before).abs() > 20.0, "{}", turned(&mut page));
    let mm = page.number("bahn.view.camera.mm").unwrap();
    page.swipe(&[[[x - 20.0, y], [x - 80.0, y]], [[x + 20.0, y], [x + 80.0, y]]])
        .unwrap();
    let closer = mm / page.number("bahn.view.camera.mm").unwrap();
    // The fingers were 40 pixels apart, then 160.
    assert!((closer - 4.0).abs() < 0.4, "{closer}");

    page.evaluate("document.querySelector('.stage canvas').focus()")
        .unwrap();
    for (key, stands) in [("2", [0, 90]), ("3", [0, 0]), ("4", [90, 0]), ("0", [30, 38])] {
        page.press(key).unwrap();
        let camera = page
            .evaluate("[bahn.view.camera.azimuth, bahn.view.camera.elevation]")
            .unwrap();
        assert_eq!(camera, serde_json::json!(stands), "{key}");
    }
    page.press("ArrowRight").unwrap();
    assert_eq!(turned(&mut page), 22.5);
    // Measuring without a mouse: Enter picks in the middle of the window.
    page.evaluate("document.querySelector('[data-control=measure]').focus()")
        .unwrap();
    page.press("Enter").unwrap();
    page.evaluate("document.querySelector('.stage canvas').focus()")
        .unwrap();
    page.press("Enter").unwrap();
    assert!(
        page.text("[data-readout]")
            .unwrap()
            .ends_with("Pick another point.")
    );

    // Every control is reached by the Tab key.
    let stops = "[...document.querySelectorAll('button, select, input, canvas, [role=listbox]')].filter(e => \
                 e.offsetParent && e.tabIndex >= 0).length";
    let stops = page.number(stops).unwrap() as usize;
    let mut reached = std::collections::BTreeSet::new();
    for _ in 0..stops + 3 {
        page.press("Tab").unwrap();
        let at = page.evaluate("document.activeElement.id || document.activeElement.textContent + document.activeElement.ariaLabel");
        reached.insert(at.unwrap().to_string());
    }
    assert!(
        reached.len() >= stops,
        "{} of {stops}: {reached:?}",
        reached.len()
    );
    assert!(page.complaints().is_empty(), "{:?}", page.complaints());
}

/// An error, warnings and a called program are told, and lead to their blocks.
#[test]
fn what_is_wrong_leads_to_its_block() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let folder = Folder::with_program(
        "BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+60 Y+40 Z+0\nTOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S1000\n\
         L X-10 Y+20 Z+5 R0 F MAX\nCALL PGM SUB\nL X+0 F MAX\nL X+20 <b>&",
    );
    folder.write(
        "SUB.H",
        "0 BEGIN PGM SUB MM\n1 L Z-5 F200\n2 L X+40 F200\n3 END PGM SUB MM\n",
    );
    let (code, report) = folder.test("--html part.html");
    assert_eq!(code, 1, "{report}");
    let mut page = opened(&browser, &folder, [1100, 700], false);
    assert_eq!(page.text("#result").unwrap(), "Error");
    page.click("#result").unwrap();
    let remarks = page.text("#remarks").unwrap();
    assert!(
        remarks.contains(report["error"]["message"].as_str().unwrap()),
        "{remarks}"
    );
    assert!(
        remarks.contains("cuts while the spindle stands still"),
        "{remarks}"
    );
    page.evaluate("[...document.querySelectorAll('#remarks .warning button')].find(b => b.textContent.includes('stands still')).click()")
        .unwrap();
    page.click("#tab-blocks").unwrap();
    page.wait_until(
        "document.querySelector('#blocks [aria-selected=true]') !== null",
        LONG,
    )
    .unwrap();
    assert_eq!(current(&mut page), "L X+40 F200");
    // What is no markup in the program is none in the page.
    let listed = page
        .evaluate("bahn.listing.find(text => text.includes('<b>'))")
        .unwrap();
    assert!(listed.as_str().unwrap().ends_with("L X+20 <b>&"), "{listed}");
    assert!(page.complaints().is_empty(), "{:?}", page.complaints());
}

/// A million cells: how long a picture takes is said, a program like those of the examples stays below 2 MB.
#[test]
fn a_million_cells_are_a_small_page() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let folder = Folder::new();
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../examples");
    for name in ["waves.H", "tools.tsv"] {
        std::fs::copy(examples.join(name), folder.path(name)).unwrap();
    }
    let run = folder.bahn("test waves.H --tools tools.tsv --html part.html");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(run.out().contains("part.html"), "{}", run.out());
    let bytes = std::fs::metadata(folder.path("part.html")).unwrap().len();
    assert!(bytes < 2_000_000, "{bytes}");
    let start = Instant::now();
    let mut page = opened(&browser, &folder, [1280, 800], false);
    assert_eq!(
        page.evaluate("bahn.head.cells").unwrap(),
        serde_json::json!([1000, 1000])
    );
    let ready = start.elapsed();
    let picture = "(async () => { const v = bahn.view, times = []; for (let k = 0; k < 5; k++) { v.camera.rotate(7, 0); \
                   const t = performance.now(); v.draw(v.drawn); await v.drawnNow(); times.push(performance.now() - t); } \
                   return times.sort((a, b) => a - b)[2]; })()";
    page.click("[data-show=path]").unwrap();
    page.wait_until(SETTLED, LONG).unwrap();
    let pixels = page
        .number("bahn.view.canvas.width * bahn.view.canvas.height")
        .unwrap();
    let whole = page.number(picture).unwrap();
    let seek =
        "(() => { const t = performance.now(); bahn.seek(bahn.end * 0.5); return performance.now() - t; })()";
    let seek = page.number(seek).unwrap();
    eprintln!(
        "a page of {bytes} bytes and 1,000,000 cells, drawn by software: ready in {:.1} s, a picture of the part \
         in {pixels} pixels takes {whole:.0} ms, a leap of the slider {seek:.0} ms",
        ready.as_secs_f64()
    );
    assert!(whole > 0.0 && seek < 2000.0);
    assert!(page.complaints().is_empty(), "{:?}", page.complaints());
}

/// The page is that of one program, replaces no input, and is whole or what was there before.
#[test]
fn the_page_is_written_like_other_files() {
    let folder = Folder::with_program(BLOCKS);
    let two = folder.bahn("test main.H main.H --html part.html");
    assert_eq!(two.code(), 2);
    assert!(
        two.err().contains("--html is the page of one program"),
        "{}",
        two.err()
    );
    assert_eq!(folder.bahn("test main.H --html main.H").code(), 2);
    folder.write("part.html", "before");
    assert_eq!(folder.bahn("test main.H --html none/part.html").code(), 2);
    assert_eq!(folder.read("part.html"), "before");
    written(&folder, "");
    assert!(folder.read("part.html").ends_with("</html>\n"));
    assert_eq!(folder.names(), ["main.H", "part.html"]);
    // Without graphics, or a blank, the path alone is shown.
    written(&folder, "--no-graphics");
}
