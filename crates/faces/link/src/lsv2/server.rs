//! The server on TCP: a thread for each connection, and limits for what comes from outside.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{IpAddr, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::machine_commands::from_plc;
use super::{ErrorNumber, Passwords, Session, Site, TcpReader, encode};

/// Connections at once, at most.
const CONNECTIONS: usize = 16;
/// The middle of a telegram lasts no longer.
const TELEGRAM: Duration = Duration::from_secs(3);
/// Somebody who does not log in is not waited for longer.
const LOGIN: Duration = Duration::from_secs(30);
/// Somebody who says nothing is not waited for longer.
const IDLE: Duration = Duration::from_secs(3600);
/// Somebody who takes nothing is not waited for longer.
const WRITE: Duration = Duration::from_secs(10);
/// So often a connection looks whether there is a message, or an end.
const LOOK: Duration = Duration::from_millis(100);
/// A wrong password costs so much time.
const WRONG_PASSWORD: Duration = Duration::from_millis(500);
/// Telegrams of a connection in a second: a file at 160 MB/s.
const RATE: u32 = 40_000;

/// How a device is served.
#[derive(Clone, Debug)]
pub struct ServerOptions {
    /// The address at which the server listens.
    pub listen: SocketAddr,
    /// Passwords of the levels.
    pub passwords: Passwords,
}

impl ServerOptions {
    /// Whether it may listen there: others than this computer need a password for each level.
    ///
    /// # Errors
    /// In words, what is missing.
    pub fn check(&self) -> Result<(), String> {
        let is_alone = match self.listen.ip() {
            IpAddr::V6(ip) => ip
                .to_ipv4_mapped()
                .map_or(ip.is_loopback(), |ip| ip.is_loopback()),
            IpAddr::V4(ip) => ip.is_loopback(),
        };
        let missing: Vec<&str> = self.passwords.missing().map(|level| level.name()).collect();
        match is_alone || missing.is_empty() {
            true => Ok(()),
            false => Err(format!(
                "{} can be reached by others: set a password for {} (--password LEVEL=TEXT)",
                self.listen,
                missing.join(", ")
            )),
        }
    }
}

/// What the threads share.
struct Shared {
    site: Arc<Site>,
    ends: AtomicBool,
    count: AtomicUsize,
    /// Both directions of each are closed at the end.
    streams: Mutex<Vec<(usize, TcpStream)>>,
}

impl Shared {
    fn streams(&self) -> std::sync::MutexGuard<'_, Vec<(usize, TcpStream)>> {
        self.streams.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A server that runs until it is dropped.
pub struct Server {
    shared: Arc<Shared>,
    address: SocketAddr,
    listener: Option<JoinHandle<()>>,
}

/// A port that is open; whoever connects waits until it is served.
pub struct OpenPort(TcpListener);

impl OpenPort {
    /// Opens the port.
    ///
    /// # Errors
    /// When a password is missing, or the port is taken.
    pub fn open(options: &ServerOptions) -> io::Result<OpenPort> {
        options
            .check()
            .map_err(|text| io::Error::new(ErrorKind::PermissionDenied, text))?;
        TcpListener::bind(options.listen).map(OpenPort)
    }

    /// Answers from now on.
    ///
    /// # Errors
    /// When there is no thread for it.
    pub fn serve(self, site: Arc<Site>) -> io::Result<Server> {
        let OpenPort(listener) = self;
        let address = listener.local_addr()?;
        let shared = Arc::new(Shared {
            site,
            ends: AtomicBool::new(false),
            count: AtomicUsize::new(0),
            streams: Mutex::default(),
        });
        let accepting = Arc::clone(&shared);
        let listener = std::thread::Builder::new()
            .name("lsv2".to_owned())
            .spawn(move || accept(&listener, &accepting))?;
        Ok(Server {
            shared,
            address,
            listener: Some(listener),
        })
    }
}

impl Server {
    /// Opens the port and answers.
    ///
    /// # Errors
    /// When a password is missing, or the port is taken.
    pub fn start(site: impl Into<Arc<Site>>, options: &ServerOptions) -> io::Result<Server> {
        OpenPort::open(options)?.serve(site.into())
    }

    /// The address at which the server listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Connections that there are.
    pub fn connections(&self) -> usize {
        self.shared.count.load(Ordering::Acquire)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.shared.ends.store(true, Ordering::Release);
        for (_, stream) in self.shared.streams().iter() {
            // It may be closed already.
            let _ = stream.shutdown(std::net::Shutdown::Both);
        }
        // Wakes the listener, which sees that it ends.
        let mut address = self.address;
        if address.ip().is_unspecified() {
            address.set_ip(match address {
                SocketAddr::V4(_) => IpAddr::from([127, 0, 0, 1]),
                SocketAddr::V6(_) => IpAddr::from([0, 0, 0, 0, 0, 0, 0, 1]),
            });
        }
        let woken = TcpStream::connect_timeout(&address, LOOK);
        if woken.is_ok()
            && let Some(listener) = self.listener.take()
        {
            let _ = listener.join();
        }
        let until = Instant::now() + TELEGRAM;
        while self.connections() > 0 && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

fn accept(listener: &TcpListener, shared: &Arc<Shared>) {
    for (number, stream) in listener.incoming().enumerate() {
        if shared.ends.load(Ordering::Acquire) {
            return;
        }
        let Ok(stream) = stream else {
            // Too many files are open: those that end make room.
            std::thread::sleep(LOOK);
            continue;
        };
        if shared.count.load(Ordering::Acquire) >= CONNECTIONS {
            turn_away(stream);
            continue;
        }
        let Ok(copy) = stream.try_clone() else { continue };
        shared.streams().push((number, copy));
        shared.count.fetch_add(1, Ordering::AcqRel);
        let served = Arc::clone(shared);
        let thread = std::thread::Builder::new()
            .name("lsv2 connection".to_owned())
            .spawn(move || {
                // However it ends, the connection does.
                let _ = serve(stream, &served);
                leave(&served, number);
            });
        if thread.is_err() {
            leave(shared, number);
        }
    }
}

fn leave(shared: &Shared, number: usize) {
    shared.streams().retain(|(known, _)| *known != number);
    shared.count.fetch_sub(1, Ordering::AcqRel);
}

/// There is no room: that is sent to it, if it takes it.
fn turn_away(mut stream: TcpStream) {
    let _ = stream.set_nonblocking(true);
    let _ = stream.write_all(&encode(&ErrorNumber::TOO_MANY.telegram()));
}

/// Serves a connection to its end.
fn serve(mut stream: TcpStream, shared: &Shared) -> io::Result<()> {
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(LOOK))?;
    stream.set_write_timeout(Some(WRITE))?;
    let mut session = Session::new(&shared.site);
    let mut reader = TcpReader::default();
    let mut bytes = vec![0; 8192];
    let mut heard = Instant::now();
    // When the telegram began that is not complete yet.
    let mut began: Option<Instant> = None;
    let mut pace = Pace::new();
    while !shared.ends.load(Ordering::Acquire) {
        match stream.read(&mut bytes) {
            Ok(0) => return Ok(()),
            Ok(read) => {
                heard = Instant::now();
                reader.push(bytes.get(..read).unwrap_or_default());
            }
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                let patience = if session.is_logged_in() { IDLE } else { LOGIN };
                if heard.elapsed() > patience || is_late(began) {
                    return Ok(());
                }
                if session.takes_messages()
                    && let Some(message) = shared.site.device.plc_message()
                {
                    stream.write_all(&encode(&from_plc(&message)))?;
                }
                continue;
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        }
        loop {
            let telegram = match reader.telegram() {
                Ok(Some(telegram)) => telegram,
                Ok(None) => break,
                Err(_) => {
                    stream.write_all(&encode(&ErrorNumber::BAD_FORMAT.telegram()))?;
                    return Ok(());
                }
            };
            pace.keep();
            let wrong = session.wrong_passwords();
            // A telegram is complete: the next one has its own time.
            began = None;
            let answer = session.take(&telegram);
            if session.wrong_passwords() > wrong {
                std::thread::sleep(WRONG_PASSWORD);
            }
            if let Some(answer) = answer {
                stream.write_all(&encode(&answer))?;
            }
            if session.is_over() {
                return Ok(());
            }
        }
        began = began.filter(|_| reader.is_within());
        if reader.is_within() && is_late(Some(*began.get_or_insert_with(Instant::now))) {
            return Ok(());
        }
    }
    Ok(())
}

fn is_late(began: Option<Instant>) -> bool {
    began.is_some_and(|began| began.elapsed() > TELEGRAM)
}

/// Lets no connection have more than its rate.
struct Pace {
    since: Instant,
    telegrams: u32,
}

impl Pace {
    /// Telegrams between two looks at the clock.
    const LOOK: u32 = RATE / 100;

    fn new() -> Pace {
        Pace {
            since: Instant::now(),
            telegrams: 0,
        }
    }

    fn keep(&mut self) {
        self.telegrams += 1;
        if self.telegrams < Pace::LOOK {
            return;
        }
        let least = Duration::from_millis(10);
        if let Some(rest) = least.checked_sub(self.since.elapsed()) {
            std::thread::sleep(rest);
        }
        *self = Pace::new();
    }
}
