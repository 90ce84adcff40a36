//! A tab of the browser.

use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::base64;
use crate::connection::Connection;
use crate::error::BrowserError;

/// Longest wait for a page to load.
const LOAD: Duration = Duration::from_secs(60);
/// How often a condition is looked at.
const LOOK: Duration = Duration::from_millis(15);

/// A tab. What it logs and fetches is kept from its beginning.
#[derive(Debug)]
pub struct Page {
    connection: Connection,
    /// Keys held down that change what others do, as bits of the protocol.
    pub(crate) held: u32,
    complaints: Vec<String>,
    said: Vec<String>,
    requests: Vec<String>,
    loaded: bool,
}

/// When a page was ready, ms after its navigation began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timings {
    /// From the navigation to the first painted pixel, ms.
    pub first_paint_ms: f64,
    /// From the navigation to the end of the load event, ms.
    pub load_ms: f64,
}

impl Page {
    pub(crate) fn new(connection: Connection) -> Result<Page, BrowserError> {
        let mut page = Page {
            connection,
            held: 0,
            complaints: Vec::new(),
            said: Vec::new(),
            requests: Vec::new(),
            loaded: false,
        };
        for domain in ["Page", "Runtime", "Network", "Log"] {
            page.call(&format!("{domain}.enable"), json!({}))?;
        }
        Ok(page)
    }

    /// Gives an order of the DevTools protocol to the tab, for what has no method here.
    ///
    /// # Errors
    /// When it is refused, or the browser does not answer.
    pub fn call(&mut self, method: &str, parameters: Value) -> Result<Value, BrowserError> {
        let answer = self.connection.call(method, parameters);
        for event in self.connection.take_events() {
            self.take(&event);
        }
        answer
    }

    /// Opens an address and waits until all of it is loaded.
    ///
    /// # Errors
    /// When it cannot be opened.
    pub fn open(&mut self, address: &str) -> Result<(), BrowserError> {
        self.loaded = false;
        let answer = self.call("Page.navigate", json!({ "url": address }))?;
        if let Some(error) = answer["errorText"].as_str() {
            return Err(BrowserError::Lost(format!("{address}: {error}")));
        }
        self.wait_for_load(address)
    }

    /// Opens a file.
    ///
    /// # Errors
    /// When it cannot be opened.
    pub fn open_file(&mut self, path: &Path) -> Result<(), BrowserError> {
        let path = path
            .canonicalize()
            .map_err(|error| BrowserError::Lost(format!("{}: {error}", path.display())))?;
        self.open(&format!("file://{}", path.display()))
    }

    /// Loads the page anew.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn reload(&mut self) -> Result<(), BrowserError> {
        self.loaded = false;
        self.call("Page.reload", json!({}))?;
        self.wait_for_load("the page")
    }

    fn wait_for_load(&mut self, what: &str) -> Result<(), BrowserError> {
        let until = Instant::now() + LOAD;
        while !self.loaded {
            if Instant::now() > until {
                return Err(BrowserError::Lost(format!("{what} is never loaded")));
            }
            if let Some(event) = self.connection.event(LOOK)? {
                self.take(&event);
            }
        }
        Ok(())
    }

    /// The value of a JavaScript expression; of a promise, what it is resolved with.
    ///
    /// # Errors
    /// When it throws.
    pub fn evaluate(&mut self, expression: &str) -> Result<Value, BrowserError> {
        let mut answer = self.call(
            "Runtime.evaluate",
            json!({ "expression": expression, "awaitPromise": true, "returnByValue": true, "userGesture": true }),
        )?;
        if let Some(thrown) = answer.get("exceptionDetails") {
            return Err(BrowserError::Script(exception(thrown)));
        }
        Ok(answer["result"]["value"].take())
    }

    /// The value of an expression as a number; NaN when it is none.
    ///
    /// # Errors
    /// When it throws.
    pub fn number(&mut self, expression: &str) -> Result<f64, BrowserError> {
        Ok(self.evaluate(expression)?.as_f64().unwrap_or(f64::NAN))
    }

    /// The text of an element as it is shown.
    ///
    /// # Errors
    /// When the page has no such element.
    pub fn text(&mut self, selector: &str) -> Result<String, BrowserError> {
        let name = Value::from(selector);
        match self.evaluate(&format!("document.querySelector({name})?.innerText ?? null"))? {
            Value::String(text) => Ok(text),
            _ => Err(BrowserError::NoElement(selector.to_owned())),
        }
    }

    /// Waits until an expression is true.
    ///
    /// # Errors
    /// When it never is, with its last value; an expression that throws is not true yet.
    pub fn wait_until(&mut self, condition: &str, within: Duration) -> Result<(), BrowserError> {
        let until = Instant::now() + within;
        loop {
            let last = match self.evaluate(condition) {
                Ok(Value::Bool(true)) => return Ok(()),
                Ok(other) => other.to_string(),
                Err(BrowserError::Script(thrown)) => thrown,
                Err(error) => return Err(error),
            };
            if Instant::now() > until {
                return Err(BrowserError::Never {
                    condition: condition.to_owned(),
                    seconds: within.as_secs_f64(),
                    last,
                });
            }
            std::thread::sleep(LOOK);
        }
    }

    /// The middle of an element in the window, into which it is scrolled first.
    ///
    /// # Errors
    /// When the page has no such element, or it has no size.
    pub fn middle(&mut self, selector: &str) -> Result<[f64; 2], BrowserError> {
        let [x, y, width, height] = self.bounds(selector)?;
        Ok([x + 0.5 * width, y + 0.5 * height])
    }

    /// Left, top, width and height of an element in the window, into which it is scrolled first.
    ///
    /// # Errors
    /// When the page has no such element, or it has no size.
    pub fn bounds(&mut self, selector: &str) -> Result<[f64; 4], BrowserError> {
        let name = Value::from(selector);
        let found = self.evaluate(&format!(
            "(() => {{ const e = document.querySelector({name}); if (!e) return null;
             e.scrollIntoView({{block: 'nearest', inline: 'nearest', behavior: 'instant'}});
             const r = e.getBoundingClientRect(); return [r.x, r.y, r.width, r.height]; }})()"
        ))?;
        let side = |k: usize| found[k].as_f64().unwrap_or_default();
        let bounds = [side(0), side(1), side(2), side(3)];
        if bounds[2] <= 0.0 || bounds[3] <= 0.0 {
            return Err(BrowserError::NoElement(selector.to_owned()));
        }
        Ok(bounds)
    }

    /// Makes the window as large as this; a phone has fingers, too.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn viewport(&mut self, width: u32, height: u32, phone: bool) -> Result<(), BrowserError> {
        self.call(
            "Emulation.setDeviceMetricsOverride",
            json!({ "width": width, "height": height, "deviceScaleFactor": if phone { 2 } else { 1 },
                    "mobile": phone }),
        )?;
        self.call(
            "Emulation.setTouchEmulationEnabled",
            json!({ "enabled": phone, "maxTouchPoints": 5 }),
        )?;
        Ok(())
    }

    /// What the person prefers: dark colours or light ones.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn dark(&mut self, dark: bool) -> Result<(), BrowserError> {
        let value = if dark { "dark" } else { "light" };
        self.call(
            "Emulation.setEmulatedMedia",
            json!({ "features": [{ "name": "prefers-color-scheme", "value": value }] }),
        )?;
        Ok(())
    }

    /// Cuts the page off from the network, or connects it again.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn offline(&mut self, offline: bool) -> Result<(), BrowserError> {
        self.call(
            "Network.emulateNetworkConditions",
            json!({ "offline": offline, "latency": 0, "downloadThroughput": -1, "uploadThroughput": -1 }),
        )?;
        Ok(())
    }

    /// What is in the window, as PNG.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn screenshot(&mut self) -> Result<Vec<u8>, BrowserError> {
        let answer = self.call("Page.captureScreenshot", json!({ "format": "png" }))?;
        let data = answer["data"].as_str().unwrap_or_default();
        base64::decode(data).ok_or_else(|| BrowserError::Lost("its picture is no base64".to_owned()))
    }

    /// When the page was ready.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn timings(&mut self) -> Result<Timings, BrowserError> {
        Ok(Timings {
            first_paint_ms: self.number("performance.getEntriesByType('paint')[0]?.startTime ?? NaN")?,
            load_ms: self.number("performance.getEntriesByType('navigation')[0].loadEventEnd")?,
        })
    }

    /// Errors and warnings of the console, exceptions that nobody caught, and what the browser itself complains about.
    pub fn complaints(&mut self) -> &[String] {
        self.listen();
        &self.complaints
    }

    /// What scripts wrote to the console otherwise.
    pub fn said(&mut self) -> &[String] {
        self.listen();
        &self.said
    }

    /// The addresses of everything that was fetched, web sockets too, in their order.
    pub fn requests(&mut self) -> &[String] {
        self.listen();
        &self.requests
    }

    /// Takes events that have come and were not read yet.
    fn listen(&mut self) {
        // Whoever asks next gets the error that the connection is lost.
        while let Ok(Some(event)) = self.connection.event(Duration::ZERO) {
            self.take(&event);
        }
    }

    fn take(&mut self, event: &Value) {
        let parameters = &event["params"];
        match event["method"].as_str().unwrap_or_default() {
            "Page.loadEventFired" => self.loaded = true,
            "Network.requestWillBeSent" => self.fetched(&parameters["request"]["url"]),
            "Network.webSocketCreated" => self.fetched(&parameters["url"]),
            "Runtime.exceptionThrown" => self.complaints.push(exception(&parameters["exceptionDetails"])),
            "Log.entryAdded" => {
                let entry = &parameters["entry"];
                let text = entry["text"].as_str().unwrap_or_default();
                match entry["level"].as_str() {
                    Some("error" | "warning") => self.complaints.push(text.to_owned()),
                    _ => self.said.push(text.to_owned()),
                }
            }
            "Runtime.consoleAPICalled" => {
                let words: Vec<String> = parameters["args"]
                    .as_array()
                    .into_iter()
                    .flatten()
                    .map(|word| match &word["value"] {
                        Value::Null => word["description"].as_str().unwrap_or_default().to_owned(),
                        Value::String(text) => text.clone(),
                        other => other.to_string(),
                    })
                    .collect();
                match parameters["type"].as_str() {
                    Some("error" | "warning" | "assert") => self.complaints.push(words.join(" ")),
                    _ => self.said.push(words.join(" ")),
                }
            }
            _ => {}
        }
    }

    fn fetched(&mut self, address: &Value) {
        self.requests
            .push(address.as_str().unwrap_or_default().to_owned());
    }
}

/// What was thrown, with its place.
fn exception(details: &Value) -> String {
    details["exception"]["description"]
        .as_str()
        .or(details["text"].as_str())
        .unwrap_or_default()
        .to_owned()
}
