//! A page is opened, used and looked at as a person does.
#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

use std::io::{Read, Write};
use std::net::TcpListener;
use std::time::Duration;

use bahn_browser::{Browser, BrowserError, Page};

const PAGE: &str = "data:text/html,<!DOCTYPE html><meta name='viewport' content='width=device-width'>\
    <style>body{margin:0;background:white} @media (prefers-color-scheme: dark){body{background:black}}</style>\
    <button style='width:100px;height:40px'>on</button><input id='text'><div id='log'></div>\
    <script>const log=[];for(const kind of ['click','keydown','keyup','pointerdown','pointermove','pointerup','wheel'])\
    addEventListener(kind,e=>log.push([kind,e.pointerType%3F%3Fe.code%3F%3F'',e.shiftKey,e.target.tagName]),true)</script>";

fn page(browser: &Browser) -> Page {
    let mut page = browser.page().unwrap();
    page.viewport(400, 300, false).unwrap();
    page.open(PAGE).unwrap();
    page
}

fn log(page: &mut Page) -> Vec<String> {
    let log = page
        .evaluate("log.splice(0).map(entry => entry.join(' '))")
        .unwrap();
    log.as_array()
        .unwrap()
        .iter()
        .map(|entry| entry.as_str().unwrap().to_owned())
        .collect()
}

#[test]
fn mouse_touch_and_keys_arrive() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let mut page = page(&browser);
    page.click("button").unwrap();
    let seen = log(&mut page);
    assert!(seen.contains(&"click mouse false BUTTON".to_owned()), "{seen:?}");

    page.drag([200.0, 150.0], [300.0, 200.0]).unwrap();
    let seen = log(&mut page);
    assert_eq!(
        seen.iter().filter(|line| line.starts_with("pointermove")).count(),
        13,
        "{seen:?}"
    );

    page.click("#text").unwrap();
    page.type_text("A+b 1").unwrap();
    page.press("Shift+ArrowLeft").unwrap();
    page.press("Delete").unwrap();
    assert_eq!(
        page.evaluate("document.querySelector('#text').value").unwrap(),
        "A+b "
    );
    let seen = log(&mut page);
    assert!(
        seen.contains(&"keydown ArrowLeft true INPUT".to_owned()),
        "{seen:?}"
    );
    assert!(
        seen.contains(&"keyup ShiftLeft false INPUT".to_owned()),
        "{seen:?}"
    );

    page.viewport(360, 740, true).unwrap();
    page.tap("button").unwrap();
    page.wait_until("log.some(entry => entry[0] == 'click')", Duration::from_secs(5))
        .unwrap();
    let seen = log(&mut page);
    assert!(
        seen.contains(&"pointerdown touch false BUTTON".to_owned()),
        "{seen:?}"
    );
    assert_eq!(page.number("innerWidth").unwrap(), 360.0);
}

#[test]
fn colours_and_pictures_are_those_of_the_window() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let mut page = page(&browser);
    for (dark, colour) in [(false, "rgb(255, 255, 255)"), (true, "rgb(0, 0, 0)")] {
        page.dark(dark).unwrap();
        assert_eq!(
            page.evaluate("getComputedStyle(document.body).backgroundColor")
                .unwrap(),
            colour
        );
        let picture = page.screenshot().unwrap();
        // Width and height stand after the head of a PNG.
        assert_eq!(&picture[..8], b"\x89PNG\r\n\x1a\n");
        assert_eq!(
            &picture[16..24],
            &[
                0,
                0,
                400_u32.to_be_bytes()[2],
                400_u32.to_be_bytes()[3],
                0,
                0,
                1,
                44
            ]
        );
    }
}

#[test]
fn complaints_and_requests_are_kept() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = format!("http://{}/", listener.local_addr().unwrap());
    std::thread::spawn(move || {
        for stream in listener.incoming() {
            let mut stream = stream.unwrap();
            let _ = stream.read(&mut [0; 4096]);
            let body = "<p>there</p>";
            let _ = write!(
                stream,
                "HTTP/1.1 200 OK\r\nContent-Type: text/html\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{body}",
                body.len()
            );
        }
    });
    let mut page = page(&browser);
    assert!(page.complaints().is_empty(), "{:?}", page.complaints());
    page.open(&address).unwrap();
    assert_eq!(page.text("p").unwrap(), "there");
    assert!(page.requests().contains(&address), "{:?}", page.requests());
    page.evaluate(
        "console.error('bad', 7); console.log('fine'); setTimeout(() => { throw new Error('late') })",
    )
    .unwrap();
    page.wait_until("1 + 1 == 2", Duration::from_secs(1)).unwrap();
    std::thread::sleep(Duration::from_millis(100));
    assert_eq!(page.complaints()[0], "bad 7");
    assert!(page.complaints()[1].contains("late"), "{:?}", page.complaints());
    assert_eq!(page.said(), ["fine"]);

    assert!(
        matches!(page.evaluate("nothing.here"), Err(BrowserError::Script(text)) if text.contains("nothing"))
    );
    assert!(matches!(page.click("#none"), Err(BrowserError::NoElement(_))));
    let never = page.wait_until("1 == 2", Duration::from_millis(50));
    assert!(matches!(never, Err(BrowserError::Never { last, .. }) if last == "false"));
}

/// Software drawing is there: a point of WebGL is read back.
#[test]
fn webgl_draws() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let mut page = page(&browser);
    let drawn = page
        .evaluate(
            "(() => { const gl = document.createElement('canvas').getContext('webgl2'); gl.clearColor(1, 0.5, 0, 1);
             gl.clear(gl.COLOR_BUFFER_BIT); const p = new Uint8Array(4);
             gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, p); return [...p]; })()",
        )
        .unwrap();
    assert_eq!(drawn, serde_json::json!([255, 128, 0, 255]));
}
