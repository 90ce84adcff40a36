//! A connection that is made again when its peer has closed.

use std::io;
use std::net::{TcpStream, ToSocketAddrs as _};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// How long a connection may take.
const CONNECT: Duration = Duration::from_secs(5);
/// From one try to the next *(inferred)*.
const PAUSE: Duration = Duration::from_millis(500);

/// Connects to an address by TCP.
pub(super) fn connect(address: &str) -> io::Result<TcpStream> {
    let mut last = io::Error::from(io::ErrorKind::AddrNotAvailable);
    for address in address.to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, CONNECT) {
            Ok(stream) => {
                prepare(&stream)?;
                return Ok(stream);
            }
            Err(error) => last = error,
        }
    }
    Err(last)
}

/// Sets a connection up.
pub(super) fn prepare(stream: &TcpStream) -> io::Result<()> {
    stream.set_nonblocking(true)?;
    // A block is answered before the next one goes.
    stream.set_nodelay(true)
}

/// Tries until somebody answers, on a thread of its own: who cannot be reached holds nobody up.
#[derive(Debug)]
pub(super) struct Redial {
    address: String,
    begun: Instant,
    trial: Option<JoinHandle<io::Result<TcpStream>>>,
}

impl Redial {
    /// Tries to reach this address again.
    pub fn new(address: String) -> Redial {
        Redial {
            address,
            begun: Instant::now(),
            trial: None,
        }
    }

    /// The connection, when there is one by now.
    pub fn look(&mut self) -> Option<TcpStream> {
        if let Some(trial) = self.trial.take_if(|trial| trial.is_finished()) {
            // Who did not answer may do so next time.
            return trial.join().ok().and_then(Result::ok);
        }
        if self.trial.is_none() && self.begun.elapsed() >= PAUSE {
            self.begun = Instant::now();
            let address = self.address.clone();
            let trial = std::thread::Builder::new().name("connect".into());
            self.trial = trial.spawn(move || connect(&address)).ok();
        }
        None
    }
}
