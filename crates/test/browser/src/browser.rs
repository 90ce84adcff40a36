//! The browser as a process.

use std::cell::RefCell;
use std::fs;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use serde_json::json;

use crate::connection::Connection;
use crate::error::BrowserError;
use crate::page::Page;

/// Names of the program, most common first.
const NAMES: [&str; 4] = [
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
];
/// Longest time from start to the first answer.
const START: Duration = Duration::from_secs(60);
/// Longest time to end by itself.
const END: Duration = Duration::from_secs(5);

/// No window, no sandbox (it opens pages of tests only, and containers have none), nothing asked of the network by the
/// browser itself, drawing by software.
const OPTIONS: [&str; 18] = [
    "--headless=new",
    "--no-sandbox",
    "--remote-debugging-port=0",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--hide-scrollbars",
    "--mute-audio",
    "--no-first-run",
    "--no-default-browser-check",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-dev-shm-usage",
    "--disable-extensions",
    "--disable-sync",
    "--disable-features=Translate,OptimizationHints,MediaRouter",
    "--force-color-profile=srgb",
];

/// A browser without a window. It ends when this is dropped.
#[derive(Debug)]
pub struct Browser {
    child: Child,
    profile: PathBuf,
    port: u16,
    connection: RefCell<Connection>,
}

impl Browser {
    /// The Chromium of this host: `BAHN_CHROMIUM`, or the first of its usual names in the search path.
    pub fn installed() -> Option<PathBuf> {
        if let Some(named) = std::env::var_os("BAHN_CHROMIUM") {
            return Some(PathBuf::from(named));
        }
        let folders = std::env::var_os("PATH")?;
        let folders: Vec<PathBuf> = std::env::split_paths(&folders).collect();
        let mut files = NAMES
            .iter()
            .flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
        files.find(|file| file.is_file())
    }

    /// A browser for a test. `None`, said on the standard error, where no Chromium is installed and nobody demands one:
    /// under continuous integration (`CI` is set) its absence is an error.
    ///
    /// # Errors
    /// As [`Browser::start`].
    pub fn for_test() -> Result<Option<Browser>, BrowserError> {
        if Browser::installed().is_none() && std::env::var_os("CI").is_none() {
            eprintln!("SKIPPED: {}", BrowserError::NotInstalled);
            return Ok(None);
        }
        Browser::start().map(Some)
    }

    /// Starts the browser with an empty profile.
    ///
    /// # Errors
    /// When no browser is installed, or it does not start.
    pub fn start() -> Result<Browser, BrowserError> {
        let program = Browser::installed().ok_or(BrowserError::NotInstalled)?;
        let profile = empty_folder().map_err(|error| BrowserError::Start(error.to_string()))?;
        let mut child = Command::new(program)
            .args(OPTIONS)
            .arg(format!("--user-data-dir={}", profile.display()))
            .arg("about:blank")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| BrowserError::Start(error.to_string()))?;
        let connected =
            address(&mut child).and_then(|address| Ok((port_of(&address)?, Connection::new(&address)?)));
        match connected {
            Ok((port, connection)) => Ok(Browser {
                child,
                profile,
                port,
                connection: RefCell::new(connection),
            }),
            Err(error) => {
                end(&mut child, &profile);
                Err(error)
            }
        }
    }

    /// A new tab, which shares nothing with others but the profile; pages may be used in threads of their own.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn page(&self) -> Result<Page, BrowserError> {
        let made = self
            .connection
            .borrow_mut()
            .call("Target.createTarget", json!({ "url": "about:blank" }))?;
        let id = made["targetId"].as_str().unwrap_or_default();
        Page::new(Connection::new(&format!(
            "ws://127.0.0.1:{}/devtools/page/{id}",
            self.port
        ))?)
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let asked = self.connection.borrow_mut().call("Browser.close", json!({}));
        let until = Instant::now() + END;
        while asked.is_ok() && Instant::now() < until {
            if matches!(self.child.try_wait(), Ok(Some(_))) {
                break;
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        end(&mut self.child, &self.profile);
    }
}

fn end(child: &mut Child, profile: &Path) {
    // It may have ended already; what is left of the profile is in the folder for temporary files.
    let _ = child.kill();
    let _ = child.wait();
    let _ = fs::remove_dir_all(profile);
}

fn empty_folder() -> io::Result<PathBuf> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let folder = std::env::temp_dir().join(format!("bahn-browser-{}-{number}", std::process::id()));
    fs::create_dir_all(&folder)?;
    Ok(folder)
}

/// Where the browser listens: it says so on its standard error, which is then read on so that it never blocks.
fn address(child: &mut Child) -> Result<String, BrowserError> {
    let Some(errors) = child.stderr.take() else {
        return Err(BrowserError::Start("it has no standard error".to_owned()));
    };
    let (said, heard) = mpsc::channel();
    std::thread::spawn(move || {
        let mut lines = BufReader::new(errors);
        let (mut line, mut all) = (String::new(), String::new());
        while matches!(lines.read_line(&mut line), Ok(count) if count > 0) {
            if let Some(address) = line.trim().strip_prefix("DevTools listening on ") {
                let _ = said.send(Ok(address.to_owned()));
                break;
            }
            all.push_str(&line);
            line.clear();
        }
        // Nobody hears this when it has come up.
        let _ = said.send(Err(all));
        let _ = io::copy(&mut lines.by_ref(), &mut io::sink());
    });
    match heard.recv_timeout(START) {
        Ok(Ok(address)) => Ok(address),
        Ok(Err(all)) => Err(BrowserError::Start(all)),
        Err(_) => Err(BrowserError::Start(format!("nothing for {} s", START.as_secs()))),
    }
}

fn port_of(address: &str) -> Result<u16, BrowserError> {
    let host = address
        .strip_prefix("ws://")
        .and_then(|rest| rest.split('/').next());
    host.and_then(|host| host.rsplit(':').next()?.parse().ok())
        .ok_or_else(|| BrowserError::Start(format!("it listens at {address}")))
}
