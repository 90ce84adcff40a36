//! What the panel costs: a key until the screen has changed, ten viewers, an hour's memory.
//!
//! ```text
//! cargo bench -p bahn-server
//! ```

#![expect(clippy::unwrap_used, reason = "a bench may fail")]

#[path = "../tests/support/mod.rs"]
mod support;

use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::json;
use support::{Panel, Viewer};

/// Seconds over which the cost of viewers is taken.
const SPAN: Duration = Duration::from_secs(10);
/// Environment variable that makes a process the viewers.
const VIEWERS: &str = "BAHN_VIEWERS_OF";
/// How many look on.
const COUNT: usize = 10;

fn main() {
    if let Ok(address) = std::env::var(VIEWERS) {
        return look_on(&address);
    }
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let panel = Panel::start();
    switch_on(&panel);
    answers(&panel);
    viewers(&panel);
    hour(&panel);
}

fn switch_on(panel: &Panel) {
    panel.until(|screen| screen["messages"][0]["text"] == "POWER INTERRUPTED");
    panel.press("CE");
    panel.until(|screen| screen["mode"] == "PASS OVER REFERENCE MARKS");
    panel.wait(1.5);
    panel.give(&json!({"speed": 100}));
    panel.press("NC_START");
    panel.until(|screen| screen["mode"] == "MANUAL OPERATION");
    panel.give(&json!({"speed": 1}));
}

/// From a key that is sent to the dialogue line that shows it, both over one web socket.
fn answers(panel: &Panel) {
    for key in ["PROGRAM", "PGM_NR"] {
        panel.press(key);
    }
    let mut viewer = panel.viewer("somebody");
    viewer.until("crew", |crew| crew["operates"] == true);
    let mut times: Vec<f64> = (1..=600)
        .map(|number| {
            let key = ["1", "2", "CE"][number % 3];
            let since = Instant::now();
            viewer.send(&json!({ "n": number, "key": key }));
            viewer.until("dialogue", |_| true);
            since.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    println!(
        "a key until its screen is there: median {:.2} ms, 95 of 100 within {:.2} ms, the longest {:.2} ms",
        times[times.len() / 2],
        times[times.len() * 95 / 100],
        times[times.len() - 1]
    );
    panel.press("END");
}

/// What a program run costs at real time alone, and with ten viewers in another process.
fn viewers(panel: &Panel) {
    run(panel, "BRACKET");
    let alone = cost();
    let mut lookers = start_viewers(panel);
    std::thread::sleep(Duration::from_secs(1));
    let watched = cost();
    lookers.kill().unwrap();
    lookers.wait().unwrap();
    println!(
        "the machine alone {:.1} % of a core, {COUNT} viewers beside it {:.1} %: {:.1} % for all of them",
        alone * 100.0,
        watched * 100.0,
        (watched - alone) * 100.0
    );
}

fn run(panel: &Panel, name: &str) {
    for key in ["FULL", "PGM_NR"] {
        panel.press(key);
    }
    for letter in name.chars() {
        panel.press(&letter.to_string());
    }
    panel.press("ENT");
    panel.press("NC_START");
    panel.until(|screen| screen["status"]["star"] == "steady");
}

fn start_viewers(panel: &Panel) -> Child {
    Command::new(std::env::current_exe().unwrap())
        .env(VIEWERS, panel.address.to_string())
        .stdout(Stdio::null())
        .spawn()
        .unwrap()
}

fn look_on(address: &str) {
    let viewers = (0..COUNT).map(|number| {
        let url = format!("ws://{address}/ws?name=viewer-{number}");
        std::thread::spawn(move || {
            let mut viewer = Viewer::of(&url);
            loop {
                viewer.receive();
            }
        })
    });
    for viewer in viewers.collect::<Vec<_>>() {
        let _ = viewer.join();
    }
}

/// An hour of the machine at a hundred times its speed: a program again and again, somebody looks on.
fn hour(panel: &Panel) {
    let mut lookers = start_viewers(panel);
    panel.give(&json!({"speed": 100}));
    let now = || panel.get("/api/snapshot")["t"].as_f64().unwrap();
    let (began, since) = (now(), Instant::now());
    while now() - began < 3600.0 {
        if panel.screen()["status"]["star"] == "off" {
            panel.press("NC_START");
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    lookers.kill().unwrap();
    lookers.wait().unwrap();
    println!(
        "an hour of the machine in {:.0} s: {:.1} MB in memory, {:.1} MB at most",
        since.elapsed().as_secs_f64(),
        memory("VmRSS"),
        memory("VmHWM")
    );
}

/// Part of a core that this process has used over the span.
fn cost() -> f64 {
    let before = processor_s();
    std::thread::sleep(SPAN);
    (processor_s() - before) / SPAN.as_secs_f64()
}

/// Time of processors that this process has used, s; from the kernel's hundredths.
fn processor_s() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap();
    let fields: Vec<f64> = stat
        .rsplit(')')
        .next()
        .unwrap()
        .split_whitespace()
        .filter_map(|field| field.parse().ok())
        .collect();
    // After the name: state is no number; utime and stime are the 14th and 15th field of all.
    (fields[10] + fields[11]) / 100.0
}

/// A line of this process's status, MB.
fn memory(name: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with(name)).unwrap();
    let kilobytes: f64 = line.split_whitespace().nth(1).unwrap().parse().unwrap();
    kilobytes / 1e3
}
