//! A panel that is served, in a folder of its own, and what speaks with it.

#![allow(dead_code, reason = "each test uses a part")]

pub mod pictures;

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use bahn_panel::{Live, Station, load};
use bahn_server::{Server, ServerOptions};
use serde_json::{Value, json};
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

/// A panel of the mill.
pub struct Panel {
    server: Option<Server>,
    folder: PathBuf,
    pub address: SocketAddr,
}

impl Panel {
    pub fn start() -> Panel {
        Panel::with(|_| {})
    }

    /// The same with a folder that something was done to.
    pub fn with(what: impl FnOnce(&Path)) -> Panel {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("bahn-server-{}-{number}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let machines = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../machines/mill");
        copy(&machines, &folder);
        what(&folder);
        let station = Station::power_on(load(&folder).unwrap()).unwrap();
        let options = ServerOptions {
            listen: "127.0.0.1:0".parse().unwrap(),
            token: None,
        };
        let server = Server::start(Live::start(station), options).unwrap();
        Panel {
            address: server.address(),
            server: Some(server),
            folder,
        }
    }

    /// A file of the machine's folder.
    pub fn file(&self, name: &str) -> String {
        std::fs::read_to_string(self.folder.join(name)).unwrap()
    }

    /// Status and body of a request.
    pub fn request(&self, method: &str, path: &str, headers: &[(&str, &str)], body: &str) -> (u16, String) {
        let mut stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
        let mut request = format!("{method} {path} HTTP/1.1\r\nConnection: close\r\n");
        if !headers.iter().any(|(name, _)| *name == "Host") {
            request += &format!("Host: {}\r\n", self.address);
        }
        for (name, value) in headers {
            request += &format!("{name}: {value}\r\n");
        }
        request += &format!("Content-Length: {}\r\n\r\n{body}", body.len());
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        // A refused body may break the connection behind its answer.
        let _ = stream.read_to_end(&mut answer);
        let answer = String::from_utf8_lossy(&answer).into_owned();
        let status = answer.split(' ').nth(1).and_then(|status| status.parse().ok());
        let body = answer.split_once("\r\n\r\n").map_or("", |(_, body)| body);
        (status.unwrap_or_default(), body.to_owned())
    }

    pub fn get(&self, path: &str) -> Value {
        let (status, body) = self.request("GET", path, &[], "");
        assert_eq!(status, 200, "{path}: {body}");
        serde_json::from_str(&body).unwrap()
    }

    pub fn screen(&self) -> Value {
        self.get("/api/screen")
    }

    /// Gives an input; its status.
    pub fn give(&self, input: &Value) -> u16 {
        self.request("POST", "/api/command", &[], &input.to_string()).0
    }

    pub fn press(&self, key: &str) {
        let (status, body) = self.request("POST", "/api/key", &[], &json!({ "key": key }).to_string());
        assert_eq!(status, 200, "{key}: {body}");
    }

    /// Waits until a screen is so.
    pub fn until(&self, what: impl Fn(&Value) -> bool) -> Value {
        let end = Instant::now() + Duration::from_secs(60);
        loop {
            let screen = self.screen();
            if what(&screen) {
                return screen;
            }
            assert!(Instant::now() < end, "{screen:#}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Waits until so much time of the machine has passed, s.
    pub fn wait(&self, seconds: f64) {
        let now = || self.get("/api/snapshot")["t"].as_f64().unwrap();
        let end = now() + seconds;
        while now() < end {
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// A viewer of this name.
    pub fn viewer(&self, name: &str) -> Viewer {
        let url = format!("ws://{}/ws?name={name}", self.address);
        let (socket, _) = tungstenite::connect(url).unwrap();
        if let MaybeTlsStream::Plain(stream) = socket.get_ref() {
            stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        }
        Viewer { socket }
    }
}

impl Drop for Panel {
    fn drop(&mut self) {
        if let Some(server) = self.server.take() {
            let _ = server.end();
        }
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

/// Somebody who looks on.
pub struct Viewer {
    socket: WebSocket<MaybeTlsStream<TcpStream>>,
}

impl Viewer {
    pub fn send(&mut self, message: &Value) {
        self.socket.send(Message::text(message.to_string())).unwrap();
    }

    /// The value of the next region of a name for which something holds.
    pub fn until(&mut self, name: &str, what: impl Fn(&Value) -> bool) -> Value {
        loop {
            let Message::Binary(bytes) = self.socket.read().unwrap() else {
                continue;
            };
            let regions = rmpv::decode::read_value(&mut bytes.as_ref()).unwrap();
            let regions: Value = serde_json::to_value(&regions).unwrap();
            for region in regions.as_array().unwrap() {
                if region[0] == name && what(&region[1]) {
                    return region[1].clone();
                }
            }
        }
    }
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        match entry.file_type().unwrap().is_dir() {
            true if entry.file_name() == "state" => {}
            true => copy(&entry.path(), &target),
            false => drop(std::fs::copy(entry.path(), target).unwrap()),
        }
    }
}

/// The position of an axis as the screen shows it.
pub fn position(screen: &Value, letter: &str) -> f64 {
    let axes = screen["status"]["axes"].as_array().unwrap();
    let axis = axes.iter().find(|axis| axis["letter"] == letter).unwrap();
    axis["value"].as_str().unwrap().parse().unwrap()
}
