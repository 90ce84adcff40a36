//! Telegrams on TCP: the length of the parameters, then command and parameters (public).

use super::Telegram;

/// Parameters of a telegram at most: the largest block, 4096 bytes.
pub const DATA_MAX: usize = 4096;
/// Length of the head of a telegram: its length and command, bytes.
const HEAD: usize = 8;

/// A telegram as it travels.
pub fn encode(telegram: &Telegram) -> Vec<u8> {
    let length = u32::try_from(telegram.data.len()).unwrap_or(u32::MAX);
    [
        length.to_be_bytes().as_slice(),
        &telegram.command.0,
        &telegram.data,
    ]
    .concat()
}

/// The other side sends what is no telegram: longer than any. Nothing that follows can be understood.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a telegram of {0} bytes is longer than any")]
pub struct TooLong(pub u32);

/// Makes telegrams of the bytes that arrive, in whatever pieces.
#[derive(Clone, Debug, Default)]
pub struct TcpReader {
    bytes: Vec<u8>,
    /// Where the next telegram begins.
    at: usize,
}

impl TcpReader {
    /// Takes what has arrived.
    pub fn push(&mut self, bytes: &[u8]) {
        if self.at == self.bytes.len() {
            self.bytes.clear();
            self.at = 0;
        } else if self.at > DATA_MAX {
            self.bytes.drain(..self.at);
            self.at = 0;
        }
        self.bytes.extend_from_slice(bytes);
    }

    /// The next telegram that is complete.
    ///
    /// # Errors
    /// When it is longer than any.
    pub fn telegram(&mut self) -> Result<Option<Telegram>, TooLong> {
        let waiting = self.bytes.get(self.at..).unwrap_or_default();
        let Some((length, rest)) = waiting.split_first_chunk::<4>() else {
            return Ok(None);
        };
        let length = u32::from_be_bytes(*length);
        let size = usize::try_from(length).unwrap_or(usize::MAX);
        if size > DATA_MAX {
            return Err(TooLong(length));
        }
        let Some(bytes) = rest.get(..4 + size) else {
            return Ok(None);
        };
        let telegram = Telegram::from_bytes(bytes);
        self.at += HEAD + size;
        Ok(telegram)
    }

    /// Part of a telegram has arrived.
    pub(crate) fn is_within(&self) -> bool {
        self.at < self.bytes.len()
    }
}
