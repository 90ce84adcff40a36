//! Telegrams: four characters of a command and its parameters.

use std::fmt;

/// What a telegram is about: four characters, `R_VR`.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Command(pub [u8; 4]);

impl Command {
    /// The command is done.
    pub const T_OK: Command = Command(*b"T_OK");
    /// Not done: class and number of the error follow.
    pub const T_ER: Command = Command(*b"T_ER");
    /// The file is complete.
    pub const T_FD: Command = Command(*b"T_FD");
    /// A block of a file cannot be taken: class and number of the error follow.
    pub const T_BD: Command = Command(*b"T_BD");
    /// A message to or from the PLC [000:15841].
    pub const M_PC: Command = Command(*b"M_PC");

    /// The answer that carries data: `S_VR` to `R_VR`.
    #[must_use]
    pub fn answer(self) -> Command {
        let [_, _, a, b] = self.0;
        Command([b'S', b'_', a, b])
    }
}

impl fmt::Display for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.escape_ascii().fmt(f)
    }
}

impl fmt::Debug for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// A telegram. Numbers have their highest byte first; strings end with a zero byte (public).
///
/// ```
/// use bahn_link::lsv2::{Command, Telegram};
///
/// let login = Telegram::new(Command(*b"A_LG")).string("INSPECT");
/// assert_eq!(login.bytes(), b"A_LGINSPECT\0");
/// let read = Telegram::from_bytes(b"R_RI\x00\x18").ok_or("too short")?;
/// assert_eq!((read.command.to_string(), read.fields().word()), ("R_RI".to_owned(), Some(24)));
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Telegram {
    /// What it is about.
    pub command: Command,
    /// The parameters of the command, bytes.
    pub data: Vec<u8>,
}

impl Telegram {
    /// A telegram without parameters.
    pub fn new(command: Command) -> Telegram {
        Telegram {
            command,
            data: Vec::new(),
        }
    }

    /// One with data as they are.
    pub fn with(command: Command, data: Vec<u8>) -> Telegram {
        Telegram { command, data }
    }

    /// The telegram of command and parameters; `None` without a whole command.
    pub fn from_bytes(bytes: &[u8]) -> Option<Telegram> {
        let (command, data) = bytes.split_first_chunk::<4>()?;
        Some(Telegram::with(Command(*command), data.to_vec()))
    }

    /// Command and parameters as bytes.
    pub fn bytes(&self) -> Vec<u8> {
        [self.command.0.as_slice(), &self.data].concat()
    }

    /// A byte after the parameters.
    #[must_use]
    pub fn byte(mut self, value: u8) -> Telegram {
        self.data.push(value);
        self
    }

    /// A number of 16 bits after the parameters.
    #[must_use]
    pub fn word(mut self, value: u16) -> Telegram {
        self.data.extend(value.to_be_bytes());
        self
    }

    /// A number of 32 bits after the parameters.
    #[must_use]
    pub fn long(mut self, value: u32) -> Telegram {
        self.data.extend(value.to_be_bytes());
        self
    }

    /// A string after the parameters, in Latin 1; characters that it has not are `?`.
    #[must_use]
    pub fn string(mut self, text: &str) -> Telegram {
        let byte = |character: char| u8::try_from(u32::from(character)).unwrap_or(b'?');
        // A zero byte would end it early.
        self.data.extend(text.chars().map(byte).filter(|byte| *byte != 0));
        self.data.push(0);
        self
    }

    /// Bytes after the parameters.
    #[must_use]
    pub fn raw(mut self, bytes: &[u8]) -> Telegram {
        self.data.extend_from_slice(bytes);
        self
    }

    /// The parameters, one after the other.
    pub fn fields(&self) -> Fields<'_> {
        Fields(&self.data)
    }
}

/// Parameters that are read one after the other; what is not there is `None`.
#[derive(Clone, Copy, Debug)]
pub struct Fields<'a>(&'a [u8]);

impl<'a> Fields<'a> {
    /// Takes the next byte of the parameters.
    pub fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*first)
    }

    /// The next number of 16 bits.
    pub fn word(&mut self) -> Option<u16> {
        let (bytes, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(u16::from_be_bytes(*bytes))
    }

    /// The next number of 32 bits.
    pub fn long(&mut self) -> Option<u32> {
        let (bytes, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(u32::from_be_bytes(*bytes))
    }

    /// The next string; the last one may lack its zero byte.
    pub fn string(&mut self) -> Option<String> {
        if self.0.is_empty() {
            return None;
        }
        let end = self.0.iter().position(|byte| *byte == 0);
        let (text, rest) = self.0.split_at(end.unwrap_or(self.0.len()));
        self.0 = rest.split_first().map_or(&[], |(_, rest)| rest);
        Some(text.iter().map(|byte| char::from(*byte)).collect())
    }

    /// Takes the bytes that are left of the parameters.
    pub fn rest(&self) -> &'a [u8] {
        self.0
    }
}
