//! What carries the bytes: a socket, a pseudo terminal, a serial port.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use serialport::{DataBits, FlowControl, SerialPort, StopBits};

use super::poll::{Got, nothing};
use super::pty::Pty;
use super::redial::{Redial, connect, prepare};
use super::{ChannelError, Line};
use crate::{Characters, Parity};

/// How often one looks whether a connection has been made again.
const LOOK: Duration = Duration::from_millis(20);
/// How long a peer has to close after the end of what is sent.
const FAREWELL: Duration = Duration::from_millis(200);

/// The line behind a channel.
#[derive(Debug)]
pub(super) enum Wire {
    Listener {
        listener: TcpListener,
        peer: Option<TcpStream>,
    },
    Stream {
        peer: Option<TcpStream>,
        /// Connects again in the background, while that runs.
        redial: Option<Redial>,
        /// Whether a lost connection is made again.
        redials: bool,
        address: String,
    },
    Pty(Pty),
    Serial(Serial),
}

/// A serial port. Its data lines and its control lines are those of the UART.
pub(super) struct Serial {
    port: Box<dyn SerialPort>,
}

impl std::fmt::Debug for Serial {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Serial").field(&self.port.name()).finish()
    }
}

impl Wire {
    pub fn open(line: &Line, characters: Characters, baud: Option<u32>) -> Result<Wire, ChannelError> {
        let failed = |error: io::Error| ChannelError::of_system(line, &error);
        match line {
            Line::Listen(address) => {
                let listener = TcpListener::bind(address).map_err(failed)?;
                listener.set_nonblocking(true).map_err(failed)?;
                Ok(Wire::Listener { listener, peer: None })
            }
            Line::Connect(address) => connect(address)
                .map(|stream| Wire::Stream {
                    peer: Some(stream),
                    redial: None,
                    redials: false,
                    address: address.clone(),
                })
                .map_err(failed),
            Line::Pty(link) => Pty::open(link.clone()).map(Wire::Pty).map_err(failed),
            Line::Serial(name) => open_serial(name, characters, baud)
                .map(|port| Wire::Serial(Serial { port }))
                .map_err(|error| failed(error.into())),
        }
    }

    /// Connects again from now on when the peer closes.
    pub fn redial(&mut self) {
        if let Wire::Stream { redials, .. } = self {
            *redials = true;
        }
    }

    /// Where others find it, when that is not what was written.
    pub fn place(&self) -> Option<String> {
        match self {
            Wire::Listener { listener, .. } => listener.local_addr().ok().map(|address| address.to_string()),
            Wire::Pty(pty) => Some(pty.name().display().to_string()),
            Wire::Stream { .. } | Wire::Serial(_) => None,
        }
    }

    /// The symbolic link that is to go with it.
    pub fn link(&self) -> Option<&PathBuf> {
        match self {
            Wire::Pty(pty) => pty.link(),
            _ => None,
        }
    }

    /// Reads what is there, or waits for it.
    pub fn read(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<Got> {
        match self {
            Wire::Listener { listener, peer } => match peer {
                None => {
                    super::poll::readable(&*listener, wait)?;
                    match listener.accept() {
                        Ok((stream, _)) => {
                            prepare(&stream)?;
                            *peer = Some(stream);
                            Ok(Got::Opened)
                        }
                        Err(error) => nothing(&error).ok_or(error),
                    }
                }
                Some(stream) => {
                    let got = read_stream(stream, buffer, wait)?;
                    if got == Got::Closed {
                        *peer = None;
                    }
                    Ok(got)
                }
            },
            Wire::Stream {
                peer,
                redial,
                redials,
                address,
            } => match peer {
                None => {
                    *peer = redial.as_mut().and_then(Redial::look);
                    if peer.is_some() {
                        *redial = None;
                        return Ok(Got::Opened);
                    }
                    std::thread::sleep(if redial.is_some() { wait.min(LOOK) } else { wait });
                    Ok(Got::Nothing)
                }
                Some(open) => {
                    let got = read_stream(open, buffer, wait)?;
                    if got == Got::Closed {
                        *peer = None;
                        *redial = redials.then(|| Redial::new(address.clone()));
                    }
                    Ok(got)
                }
            },
            Wire::Pty(pty) => pty.read(buffer, wait),
            Wire::Serial(serial) => {
                let there = serial.port.bytes_to_read().unwrap_or_default();
                serial
                    .port
                    .set_timeout(if there > 0 { Duration::ZERO } else { wait })?;
                match serial.port.read(buffer) {
                    Ok(0) => Ok(Got::Closed),
                    Ok(count) => Ok(Got::Bytes(count)),
                    Err(error) => nothing(&error).ok_or(error),
                }
            }
        }
    }

    /// Writes what goes at once; without a peer bytes go nowhere, as on an open cable.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = match self {
            Wire::Listener { peer: None, .. } | Wire::Stream { peer: None, .. } => return Ok(bytes.len()),
            Wire::Listener {
                peer: Some(stream), ..
            }
            | Wire::Stream {
                peer: Some(stream), ..
            } => stream.write(bytes),
            Wire::Pty(pty) => pty.write(bytes),
            Wire::Serial(serial) => {
                serial.port.set_timeout(Duration::from_millis(1))?;
                serial.port.write(bytes)
            }
        };
        match written {
            // The next read reports that the peer is gone.
            Err(error) if is_gone(&error) => Ok(bytes.len()),
            Err(error) if nothing(&error).is_some() => Ok(0),
            written => written,
        }
    }

    /// Waits until something can be written.
    pub fn wait_to_write(&self, wait: Duration) -> io::Result<()> {
        match self {
            Wire::Listener {
                peer: Some(stream), ..
            }
            | Wire::Stream {
                peer: Some(stream), ..
            } => super::poll::writable(stream, wait),
            Wire::Pty(pty) => pty.wait_to_write(wait),
            _ => {
                std::thread::sleep(wait.min(Duration::from_millis(1)));
                Ok(())
            }
        }
    }

    /// CTS and DSR; a channel without such lines has both on.
    pub fn lines(&mut self) -> (bool, bool) {
        match self {
            Wire::Serial(serial) => (
                serial.port.read_clear_to_send().unwrap_or(true),
                serial.port.read_data_set_ready().unwrap_or(true),
            ),
            _ => (true, true),
        }
    }

    /// Sets RTS, where there is one.
    pub fn request_to_send(&mut self, on: bool) {
        if let Wire::Serial(serial) = self {
            // An adapter without the line has nothing to set.
            let _ = serial.port.write_request_to_send(on);
        }
    }

    /// Whether it has control lines.
    pub fn has_lines(&self) -> bool {
        matches!(self, Wire::Serial(_))
    }
}

/// A socket that is closed with something unread in it takes back what was sent and not yet read there: so it ends what it
/// sends, and reads until the peer has closed, too.
fn say_farewell(stream: &mut TcpStream) {
    let end = Instant::now() + FAREWELL;
    if stream.shutdown(Shutdown::Write).is_err() {
        return;
    }
    let mut rest = [0; 256];
    loop {
        let left = end.saturating_duration_since(Instant::now());
        let got = read_stream(stream, &mut rest, left);
        if left.is_zero() || !matches!(got, Ok(Got::Nothing | Got::Bytes(_))) {
            return;
        }
    }
}

impl Drop for Wire {
    fn drop(&mut self) {
        if let Wire::Listener {
            peer: Some(stream), ..
        }
        | Wire::Stream {
            peer: Some(stream), ..
        } = self
        {
            say_farewell(stream);
        }
    }
}

fn read_stream(stream: &mut TcpStream, buffer: &mut [u8], wait: Duration) -> io::Result<Got> {
    super::poll::readable(&*stream, wait)?;
    match stream.read(buffer) {
        Ok(0) => Ok(Got::Closed),
        Ok(count) => Ok(Got::Bytes(count)),
        Err(error) if is_gone(&error) => Ok(Got::Closed),
        Err(error) => nothing(&error).ok_or(error),
    }
}

fn open_serial(
    name: &str,
    characters: Characters,
    baud: Option<u32>,
) -> serialport::Result<Box<dyn SerialPort>> {
    serialport::new(name, baud.unwrap_or(super::BAUD))
        .data_bits(match characters.data_bits {
            7 => DataBits::Seven,
            _ => DataBits::Eight,
        })
        .parity(match characters.parity {
            None => serialport::Parity::None,
            Some(Parity::Even) => serialport::Parity::Even,
            Some(Parity::Odd) => serialport::Parity::Odd,
        })
        // One and a half stop bits are waited for as two: no UART of a personal computer sends them with 7 or 8 data bits.
        .stop_bits(match characters.half_stop_bits {
            2 => StopBits::One,
            _ => StopBits::Two,
        })
        // The protocols stop and start the transfer themselves.
        .flow_control(FlowControl::None)
        .dtr_on_open(true)
        .open()
}

/// The peer is gone.
fn is_gone(error: &io::Error) -> bool {
    use io::ErrorKind::{BrokenPipe, ConnectionAborted, ConnectionReset, NotConnected};
    matches!(
        error.kind(),
        BrokenPipe | ConnectionAborted | ConnectionReset | NotConnected
    )
}
