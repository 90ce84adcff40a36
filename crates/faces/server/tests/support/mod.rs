//! A panel that is served, in a folder of its own, and what speaks with it.

#![allow(dead_code, reason = "each test uses a part")]

#[path = "../../../../machine/host/tests/support/copy.rs"]
mod copy;

pub mod pictures;

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use bahn_server::{Server, ServerOptions, Tokens};
use bahn_service::{Live, MachineService, Operated, Station, load};
pub use copy::copy;
use serde_json::{Value, json};
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

/// A panel of the mill.
pub struct Panel {
    live: Option<Live>,
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
        Panel::of("mill", what)
    }

    /// That of another of the shipped machines.
    pub fn of(machine: &str, what: impl FnOnce(&Path)) -> Panel {
        Panel::served(machine, Tokens::default(), what)
    }

    /// The same where others must know something.
    pub fn served(machine: &str, tokens: Tokens, what: impl FnOnce(&Path)) -> Panel {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("bahn-server-{}-{number}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let machines = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../../machines")
            .join(machine);
        copy(&machines, &folder);
        what(&folder);
        let station = Station::power_on(load(&folder).unwrap()).unwrap();
        Panel::over(station, folder, tokens)
    }

    /// That of a station whose folder is removed in the end.
    pub fn over(station: Station, folder: PathBuf, tokens: Tokens) -> Panel {
        let options = ServerOptions {
            listen: "127.0.0.1:0".parse().unwrap(),
            tokens,
        };
        let live = Live::start(station);
        let server = Server::start(MachineService::of(&live).unwrap(), options).unwrap();
        Panel {
            address: server.address(),
            live: Some(live),
            server: Some(server),
            folder,
        }
    }

    /// That of a machine of any family, which somebody else ends; the folder is removed in the end.
    pub fn of_machine(machine: impl Operated + 'static, folder: PathBuf) -> Panel {
        let options = ServerOptions {
            listen: "127.0.0.1:0".parse().unwrap(),
            tokens: Tokens::default(),
        };
        let server = Server::start(machine, options).unwrap();
        Panel {
            address: server.address(),
            live: None,
            server: Some(server),
            folder,
        }
    }

    /// The heights of the part that is being cut, as the page has them: 16 bits, 0 a hole, 65535 untouched, a step
    /// 1/65535 of the thickness of the blank; of a page that has so many cells along an axis, each of them the middle
    /// one of as many columns.
    pub fn heights(&self, along: usize) -> Vec<u16> {
        let link = self.live.as_ref().unwrap().link();
        let cut = link.with(Station::being_cut).unwrap().unwrap();
        let part = cut.part().unwrap();
        let top = part.max()[2] - part.min()[2];
        let code = |height: &f32| match f64::from(*height) {
            none if none <= 0.0 => 0,
            whole if whole >= top => 65535,
            other => (other / top * 65535.0).round().clamp(1.0, 65534.0) as u16,
        };
        let [nx, ny] = part.columns();
        let stride = nx.div_ceil(along);
        let middle =
            |count: usize| (0..count.div_ceil(stride)).map(move |k| (k * stride + stride / 2).min(count - 1));
        middle(ny)
            .flat_map(|j| middle(nx).map(move |i| j * nx + i))
            .map(|column| code(&part.heights_mm()[column]))
            .collect()
    }

    /// What somebody sees who stands at the machine.
    pub fn at_the_machine<T: Send + 'static>(
        &self,
        what: impl FnOnce(&mut Station) -> T + Send + 'static,
    ) -> T {
        let link = self.live.as_ref().unwrap().link();
        link.with(what).unwrap()
    }

    /// Memory of this process, which is that of the station and its server, KiB.
    pub fn memory_kib(&self) -> u64 {
        let status = std::fs::read_to_string("/proc/self/status").unwrap();
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
        line.unwrap().trim().trim_end_matches(" kB").parse().unwrap()
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
        // A refused body may break the connection after its answer.
        let _ = stream.read_to_end(&mut answer);
        let answer = String::from_utf8_lossy(&answer).into_owned();
        let status = answer.split(' ').nth(1).and_then(|status| status.parse().ok());
        let body = answer.split_once("\r\n\r\n").map_or("", |(_, body)| body);
        (status.unwrap_or_default(), body.to_owned())
    }

    /// Status, head and body of what is not text.
    pub fn bytes(&self, path: &str) -> (u16, String, Vec<u8>) {
        let mut stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
        let request = format!(
            "GET {path} HTTP/1.1\r\nConnection: close\r\nHost: {}\r\n\r\n",
            self.address
        );
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        let end = answer.windows(4).position(|four| four == b"\r\n\r\n").unwrap();
        let head = String::from_utf8_lossy(&answer[..end]).into_owned();
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        (status, head, answer.split_off(end + 4))
    }

    /// Chooses a program in the operating mode that is on.
    pub fn choose(&self, name: &str) {
        self.press("PGM_NR");
        for letter in name.chars() {
            self.press(&letter.to_string());
        }
        self.press("ENT");
        self.until(|screen| {
            screen["program"]["title"]
                .as_str()
                .is_some_and(|title| title.contains(name))
        });
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

    /// Waits until a screen is so. What hangs ends, too; what is slow beside other work does not count as such.
    pub fn until(&self, what: impl Fn(&Value) -> bool) -> Value {
        let end = Instant::now() + Duration::from_secs(300);
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

    /// From POWER INTERRUPTED to MANUAL OPERATION.
    pub fn to_manual(&self) {
        self.until(|screen| screen["messages"][0]["text"] == "POWER INTERRUPTED");
        self.press("CE");
        self.until(|screen| screen["mode"] == "PASS OVER REFERENCE MARKS");
        self.until(|screen| screen["messages"].as_array().is_some_and(Vec::is_empty));
        // The drives are ready a moment after the control voltage.
        self.wait(1.0);
        assert_eq!(self.give(&json!({"speed": 100})), 200);
        self.press("NC_START");
        self.until(|screen| screen["mode"] == "MANUAL OPERATION");
        assert_eq!(self.give(&json!({"speed": 1})), 200);
    }

    /// A viewer of this name, who has a key of his own.
    pub fn viewer(&self, name: &str) -> Viewer {
        Viewer::of(&format!(
            "ws://{}/ws?name={name}&key={name}-0123456789abcdef",
            self.address
        ))
    }
}

impl Drop for Panel {
    fn drop(&mut self) {
        if let Some(server) = self.server.take() {
            server.end();
        }
        if let Some(live) = self.live.take() {
            let _ = live.end();
        }
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

/// Somebody who looks on.
pub struct Viewer {
    socket: WebSocket<MaybeTlsStream<TcpStream>>,
}

impl Viewer {
    /// A viewer at an address of the server.
    pub fn of(url: &str) -> Viewer {
        let (socket, _) = tungstenite::connect(url).unwrap();
        if let MaybeTlsStream::Plain(stream) = socket.get_ref() {
            stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        }
        Viewer { socket }
    }

    /// The next message, whatever it is.
    pub fn receive(&mut self) {
        drop(self.socket.read().unwrap());
    }

    pub fn send(&mut self, message: &Value) {
        self.socket.send(Message::text(message.to_string())).unwrap();
    }

    /// Waits until an input of this number was taken or refused.
    pub fn answered(&mut self, number: u64) {
        loop {
            let Message::Binary(bytes) = self.socket.read().unwrap() else {
                continue;
            };
            let regions = rmpv::decode::read_value(&mut bytes.as_ref()).unwrap();
            for region in regions.as_array().unwrap() {
                match region[0].as_str() {
                    Some("taken") if region[1].as_u64() == Some(number) => return,
                    Some("refused") => return,
                    _ => {}
                }
            }
        }
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

/// The position of an axis as the screen shows it.
pub fn position(screen: &Value, letter: &str) -> f64 {
    let axes = screen["status"]["axes"].as_array().unwrap();
    let axis = axes.iter().find(|axis| axis["letter"] == letter).unwrap();
    axis["value"].as_str().unwrap().parse().unwrap()
}
