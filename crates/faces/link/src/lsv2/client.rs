//! A client: asks a device, over whatever carries telegrams.

use std::io::{self, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use super::{Command, ErrorNumber, Features, Level, TcpReader, Telegram, encode};

/// The device answers within.
const ANSWER: Duration = Duration::from_secs(10);
/// Sizes of telegrams that can be asked for, with the numbers of their system commands (public).
const SIZES: [(usize, u16); 5] = [(4096, 7), (3072, 6), (2048, 5), (1024, 3), (512, 4)];
/// Length and command of a telegram, and two bytes that are left free (public).
const HEAD: usize = 10;
/// A telegram, before more is asked for (public).
const BLOCK: usize = 256;

/// Why the device did not do it.
#[derive(Debug, thiserror::Error)]
pub enum ClientError {
    /// The line cannot be opened, read or written.
    #[error("{0}")]
    Line(#[from] io::Error),
    /// The device says so.
    #[error("the control answers: {0}")]
    Device(ErrorNumber),
    /// It answers something else.
    #[error("the control answers {0} to {1}")]
    Unexpected(Command, Command),
}

impl ClientError {
    /// The number of the error that the device has answered.
    pub fn number(&self) -> Option<ErrorNumber> {
        match self {
            ClientError::Device(number) => Some(*number),
            _ => None,
        }
    }
}

/// What carries telegrams to a device and back.
pub trait Transport {
    /// Sends a telegram.
    ///
    /// # Errors
    /// When the line does not take it.
    fn send(&mut self, telegram: &Telegram) -> io::Result<()>;

    /// Waits for a telegram.
    ///
    /// # Errors
    /// When none comes in time.
    fn receive(&mut self) -> io::Result<Telegram>;
}

/// Sends and receives telegrams over TCP.
pub struct TcpTransport {
    stream: TcpStream,
    reader: TcpReader,
}

impl TcpTransport {
    /// Connects to a device.
    ///
    /// # Errors
    /// When nobody is there.
    pub fn connect(address: impl ToSocketAddrs) -> io::Result<TcpTransport> {
        let mut failed = io::Error::new(io::ErrorKind::NotFound, "there is no such address");
        for address in address.to_socket_addrs()? {
            match TcpStream::connect_timeout(&address, ANSWER) {
                Ok(stream) => {
                    stream.set_nodelay(true)?;
                    stream.set_read_timeout(Some(ANSWER))?;
                    stream.set_write_timeout(Some(ANSWER))?;
                    return Ok(TcpTransport {
                        stream,
                        reader: TcpReader::default(),
                    });
                }
                Err(error) => failed = error,
            }
        }
        Err(failed)
    }
}

impl Transport for TcpTransport {
    fn send(&mut self, telegram: &Telegram) -> io::Result<()> {
        self.stream.write_all(&encode(telegram))
    }

    fn receive(&mut self) -> io::Result<Telegram> {
        let mut bytes = [0; 8192];
        loop {
            let next = self.reader.telegram();
            if let Some(telegram) = next.map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))? {
                return Ok(telegram);
            }
            match self.stream.read(&mut bytes) {
                Ok(0) => {
                    return Err(io::Error::new(
                        io::ErrorKind::UnexpectedEof,
                        "the control has hung up",
                    ));
                }
                Ok(read) => self.reader.push(bytes.get(..read).unwrap_or_default()),
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                    return Err(io::Error::new(
                        io::ErrorKind::TimedOut,
                        "the control does not answer",
                    ));
                }
                Err(error) => return Err(error),
            }
        }
    }
}

/// A file or folder of the device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RemoteEntry {
    /// The name of the file or folder.
    pub name: String,
    /// Size of the file, bytes.
    pub size: u32,
    /// When it was written.
    pub modified: SystemTime,
    /// A folder, not a file.
    pub is_folder: bool,
    /// The file is protected against erasing and writing.
    pub protected: bool,
}

/// Someone who asks a device.
pub struct Client<T> {
    transport: T,
    /// What the device says that it is: control, NC software, PLC program, options.
    versions: Vec<String>,
    block: usize,
}

impl<T: Transport> Client<T> {
    /// Logs in to look, and asks for the largest telegrams and for confirmed uploads.
    ///
    /// # Errors
    /// When the device does not answer, or does not let in.
    pub fn open(transport: T, password: Option<&str>) -> Result<Client<T>, ClientError> {
        let mut client = Client {
            transport,
            versions: Vec::new(),
            block: BLOCK,
        };
        client.log_in(Level::Inspect, password)?;
        let versions = client.ask(&request(b"R_VR"))?;
        let mut fields = versions.fields();
        client.versions = std::iter::from_fn(|| fields.string()).collect();
        let parameters = client.ask(&request(b"R_PR"))?;
        let largest = block_of(&parameters);
        if let Some((size, number)) = SIZES.iter().find(|(size, _)| *size <= largest) {
            client.order(&request(b"C_CC").word(*number))?;
            client.block = *size;
        }
        client.order(&request(b"C_CC").word(19))?;
        Ok(client)
    }

    /// Logs in.
    ///
    /// # Errors
    /// When the password is wrong.
    pub fn log_in(&mut self, level: Level, password: Option<&str>) -> Result<(), ClientError> {
        let login = request(b"A_LG").string(level.name());
        self.order(&password.iter().fold(login, |login, text| login.string(text)))
    }

    /// Control, NC software, PLC program, options.
    pub fn versions(&self) -> &[String] {
        &self.versions
    }

    /// Sends a telegram and waits for its answer.
    fn exchange(&mut self, telegram: &Telegram) -> Result<Telegram, ClientError> {
        self.transport.send(telegram)?;
        loop {
            let answer = self.transport.receive()?;
            // A message of the PLC may come between.
            if answer.command != Command::M_PC {
                return match ErrorNumber::of(&answer) {
                    Some(number) => Err(ClientError::Device(number)),
                    None => Ok(answer),
                };
            }
        }
    }

    /// Sends a command that is answered `T_OK`.
    ///
    /// # Errors
    /// When the device does not do it.
    pub fn order(&mut self, telegram: &Telegram) -> Result<(), ClientError> {
        let answer = self.exchange(telegram)?;
        match answer.command == Command::T_OK {
            true => Ok(()),
            false => Err(ClientError::Unexpected(answer.command, telegram.command)),
        }
    }

    /// Sends a request that is answered with data.
    ///
    /// # Errors
    /// When the device does not answer it.
    pub fn ask(&mut self, telegram: &Telegram) -> Result<Telegram, ClientError> {
        let answer = self.exchange(telegram)?;
        match answer.command == telegram.command.answer() {
            true => Ok(answer),
            false => Err(ClientError::Unexpected(answer.command, telegram.command)),
        }
    }

    /// Sends a request that is answered by many telegrams, each given to `take`.
    ///
    /// # Errors
    /// When the device does not answer it, or `take` fails.
    pub(crate) fn ask_all(
        &mut self,
        telegram: &Telegram,
        mut take: impl FnMut(&Telegram) -> Result<(), ClientError>,
    ) -> Result<(), ClientError> {
        let mut answer = self.exchange(telegram)?;
        while answer.command == telegram.command.answer() {
            take(&answer)?;
            answer = self.exchange(&Telegram::new(Command::T_OK))?;
        }
        match answer.command == Command::T_FD {
            true => Ok(()),
            false => Err(ClientError::Unexpected(answer.command, telegram.command)),
        }
    }

    /// What is in a folder; without a path in the one where the device begins.
    ///
    /// # Errors
    /// When the folder does not exist.
    pub fn list(&mut self, path: Option<&str>) -> Result<Vec<RemoteEntry>, ClientError> {
        if let Some(path) = path {
            self.order(&request(b"C_DC").string(path))?;
        }
        let control = self.versions.first().map_or("", String::as_str);
        let features = Features::of(control);
        let mut entries = Vec::new();
        self.ask_all(&request(b"R_DR").byte(0), |answer| {
            entries.extend(entry(answer, features));
            Ok(())
        })?;
        Ok(entries)
    }

    /// Reads a file into a writer, as it is; how many bytes it has.
    ///
    /// # Errors
    /// When there is none, or the writer does not take it.
    pub fn get(&mut self, remote: &str, to: &mut dyn Write) -> Result<u64, ClientError> {
        let mut bytes = 0;
        self.ask_all(&request(b"R_FL").string(remote).byte(1), |answer| {
            bytes += answer.data.len() as u64;
            Ok(to.write_all(&answer.data)?)
        })?;
        Ok(bytes)
    }

    /// Writes a file from a reader, as it is. The device has it when this has come back.
    ///
    /// # Errors
    /// When the device does not take it; nothing of it is there then.
    pub fn put(&mut self, from: &mut dyn Read, remote: &str) -> Result<u64, ClientError> {
        self.order(&request(b"C_FL").string(remote).byte(1))?;
        let mut data = vec![0; self.block - HEAD];
        let mut bytes = 0;
        loop {
            let read = match from.read(&mut data) {
                Ok(0) => break,
                Ok(read) => read,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => {
                    // What was sent so far is forgotten.
                    let _ = self
                        .transport
                        .send(&Telegram::new(Command::T_ER).byte(1).byte(25));
                    return Err(error.into());
                }
            };
            let block = data.get(..read).unwrap_or_default().to_vec();
            self.order(&Telegram::with(Command(*b"S_FL"), block))?;
            bytes += read as u64;
        }
        self.order(&Telegram::new(Command::T_FD))?;
        Ok(bytes)
    }

    /// Deletes a file.
    ///
    /// # Errors
    /// When there is none, or it is protected.
    pub fn delete(&mut self, remote: &str) -> Result<(), ClientError> {
        self.order(&request(b"C_FD").string(remote))
    }

    /// The screen as a BMP file, by way of a file on the device that is gone afterwards.
    ///
    /// # Errors
    /// When the device does not do it.
    pub fn screen(&mut self) -> Result<Vec<u8>, ClientError> {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let path = format!("TNC:\\SCREEN_{}_{}.BMP", std::process::id(), now.as_millis());
        self.order(&request(b"C_CC").word(12).string(&path))?;
        let mut bytes = Vec::new();
        let got = self.get(&path, &mut bytes);
        let deleted = self.delete(&path);
        got?;
        deleted?;
        Ok(bytes)
    }
}

fn request(command: &[u8; 4]) -> Telegram {
    Telegram::new(Command(*command))
}

/// The largest telegram of `S_PR` (public).
fn block_of(parameters: &Telegram) -> usize {
    const AT: usize = 14 * 4 + 8 + 8 * 4 + 2;
    let bytes = parameters.data.get(AT..AT + 2).unwrap_or_default();
    bytes.iter().fold(0, |size, byte| size << 8 | usize::from(*byte))
}

/// A file or folder of `S_DR` or `S_FI`.
fn entry(answer: &Telegram, features: Features) -> Option<RemoteEntry> {
    let mut fields = answer.fields();
    let (size, time, attributes) = (fields.long()?, fields.long()?, fields.long()?);
    Some(RemoteEntry {
        name: fields.string()?,
        size,
        modified: UNIX_EPOCH + Duration::from_secs(time.into()),
        is_folder: features.is_folder(attributes),
        protected: features.is_protected(attributes),
    })
}
