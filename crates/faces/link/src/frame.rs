//! Blocks with check characters [000:17351-17440].
//!
//! Decision: With 8 data bits the check character checks the eighth, too; a blank before ETB is taken away only where
//! the check character says that it was put there

use crate::settings::Settings;
use crate::text::LINE_MAX;
use crate::{DC1, DC3};

/// Which kind of block: how it begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// SOH: the header of a file, or an error of the device.
    Header,
    /// STX: a line of text.
    Text,
}

/// A piece of the conversation that has come whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Piece {
    /// A block that is right, without what frames it.
    Block(Kind, Vec<u8>),
    /// A block that is wrong.
    Wrong,
    /// End of text, ETX.
    Etx,
    /// End of transmission, EOT.
    Eot,
    /// The block was right.
    Ack,
    /// The block was wrong and is sent again, NAK.
    Nak,
    /// Any other character between blocks.
    Other(u8),
}

/// The characters from the first to ETB, its check character and DC1.
///
/// The check character is the exclusive or of all of them, so that each bit is even in number [000:17377-17394].
pub(crate) fn encode(settings: &Settings, kind: Kind, text: &[u8]) -> Vec<u8> {
    let control = &settings.control;
    let mut block = Vec::with_capacity(text.len() + 5);
    block.push(match kind {
        Kind::Header => control.soh,
        Kind::Text => control.stx,
    });
    block.extend_from_slice(text);
    let check = settings.characters.mask(self::check(&block)) ^ control.etb;
    if settings.printable_check && check < b' ' {
        block.push(b' ');
    }
    block.push(control.etb);
    block.push(settings.characters.mask(self::check(&block)));
    if settings.with_dc1 {
        block.push(DC1);
    }
    block
}

/// The check character of some characters. With 7 data bits it has 7; with 8 it checks the eighth, too *(inferred)*.
pub(crate) fn check(characters: &[u8]) -> u8 {
    characters.iter().fold(0, |check, byte| check ^ byte)
}

/// Makes pieces of bytes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Decoder {
    state: State,
    text: Vec<u8>,
    check: u8,
    /// Text that stands in no block: the character that began it was damaged.
    stray: bool,
    /// The block is damaged, whatever its check character says.
    spoilt: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    Between,
    Inside(Kind),
    /// The next character is a check character, whatever it looks like.
    Check(Kind),
}

impl Decoder {
    /// Whether a block has begun and is not yet whole.
    pub fn is_inside(&self) -> bool {
        self.state != State::Between
    }

    /// Forgets the block that has begun.
    pub fn reset(&mut self) {
        *self = Decoder::default();
    }

    /// Takes a byte from the line; the piece that it completes.
    pub fn take(&mut self, settings: &Settings, byte: u8) -> Option<Piece> {
        match self.state {
            State::Between => self.between(settings, byte),
            State::Inside(kind) => {
                self.inside(settings, kind, byte);
                None
            }
            State::Check(kind) => {
                let mask = |byte| settings.characters.mask(byte);
                let is_right = mask(self.check) == mask(byte) && !self.spoilt;
                let text = std::mem::take(&mut self.text);
                self.reset();
                // Only a check character that would be a control character has its blank.
                let is_filled = settings.printable_check && matches!(mask(byte), 0x20..=0x3F);
                match is_right.then(|| strip(text, is_filled)).flatten() {
                    Some(text) => Some(Piece::Block(kind, text)),
                    None => Some(Piece::Wrong),
                }
            }
        }
    }

    fn between(&mut self, settings: &Settings, byte: u8) -> Option<Piece> {
        let control = &settings.control;
        let begins = |kind| State::Inside(kind);
        let pieces = [
            (control.etx, Piece::Etx),
            (control.eot, Piece::Eot),
            (control.ack, Piece::Ack),
            (control.nak, Piece::Nak),
        ];
        if byte == control.soh || byte == control.stx {
            self.reset();
            self.check = byte;
            self.state = begins(if byte == control.soh {
                Kind::Header
            } else {
                Kind::Text
            });
            return None;
        }
        if byte == control.etb && self.stray {
            self.spoilt = true;
            self.state = State::Check(Kind::Text);
            return None;
        }
        self.stray |= byte >= b' ' && byte != 0x7F;
        let found = pieces.into_iter().find(|(character, _)| *character == byte);
        Some(found.map_or(Piece::Other(byte), |(_, piece)| piece))
    }

    fn inside(&mut self, settings: &Settings, kind: Kind, byte: u8) {
        if byte == settings.control.etb {
            self.check ^= byte;
            self.state = State::Check(kind);
            return;
        }
        match byte {
            // They may stand anywhere, and NUL is nothing.
            DC1 | DC3 | 0 => return,
            b'\t' | b'\n' | b'\r' | 0x0C | b' '.. => {}
            _ => self.spoilt = true,
        }
        self.check ^= byte;
        if self.text.len() < 2 * LINE_MAX {
            self.text.push(byte);
        } else {
            self.spoilt = true;
        }
    }
}

/// The text of a block, without the ends of lines that some devices send in it, and without the blank that fills a block
/// whose check character would be a control character.
fn strip(text: Vec<u8>, is_filled: bool) -> Option<Vec<u8>> {
    let is_end = |byte: &u8| matches!(byte, b'\r' | b'\n' | 0x0C);
    let from = text.iter().position(|byte| !is_end(byte)).unwrap_or(text.len());
    let to = text
        .iter()
        .rposition(|byte| !is_end(byte))
        .map_or(from, |last| last + 1);
    let mut line = text.get(from..to)?.to_vec();
    // Ends of lines within a block would make two lines of it.
    if line.iter().any(is_end) {
        return None;
    }
    if is_filled && line.last() == Some(&b' ') {
        line.pop();
    }
    Some(line)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mode;
    use bahn_parameters::{ControlModel, ParameterList};
    use proptest::prelude::*;

    fn settings(printable_check: bool) -> Settings {
        let list = ParameterList::reference(ControlModel::Tnc415b);
        Settings {
            printable_check,
            ..Settings::of(&list, Mode::Fe1)
        }
    }

    /// The examples of the manuals: 1F [000:17383-17394], 72 [001:2060-2073], and with the blank 3F [000:17015-17017].
    #[test]
    fn check_characters_of_the_manuals() {
        for (text, printable, bytes) in [
            ("H15E", false, "01 48 31 35 45 17 1F 11"),
            ("%15E", false, "01 25 31 35 45 17 72 11"),
            ("H15E", true, "01 48 31 35 45 20 17 3F 11"),
            ("%15E", true, "01 25 31 35 45 17 72 11"),
            ("LPPPA", false, "01 4C 50 50 50 41 17 4B 11"),
        ] {
            let block = encode(&settings(printable), Kind::Header, text.as_bytes());
            let shown: Vec<String> = block.iter().map(|byte| format!("{byte:02X}")).collect();
            assert_eq!(shown.join(" "), bytes);
        }
        let block = encode(&settings(false), Kind::Text, b"0 BEGIN PGM 1 MM");
        assert_eq!(block[block.len() - 2], 0x09);
    }

    fn decode(settings: &Settings, bytes: &[u8]) -> Vec<Piece> {
        let mut decoder = Decoder::default();
        bytes
            .iter()
            .filter_map(|byte| decoder.take(settings, *byte))
            .collect()
    }

    #[test]
    fn the_character_after_etb_is_a_check_character_whatever_it_is() {
        let settings = settings(false);
        // Check characters DC1, DC3, ETX, EOT, ACK, SOH and 0.
        for wanted in [0x11, 0x13, 0x03, 0x04, 0x06, 0x01, 0x00] {
            let filler = check(&[0x02, b'@', b'`', 0x17]) ^ wanted;
            let text = [b'@', b'`', filler | 0x20, filler & 0x20 ^ 0x20];
            let text: Vec<u8> = text.into_iter().filter(|byte| *byte >= b' ').collect();
            let block = encode(&settings, Kind::Text, &text);
            let pieces = decode(&settings, &block);
            assert_eq!(
                pieces.first(),
                Some(&Piece::Block(Kind::Text, text)),
                "{wanted:02X}"
            );
        }
    }

    #[test]
    fn damaged_blocks_are_wrong() {
        let settings = settings(false);
        let block = encode(&settings, Kind::Text, b"1 L X+10 Y+20 R0 F500");
        let right = Piece::Block(Kind::Text, b"1 L X+10 Y+20 R0 F500".to_vec());
        for at in 0..block.len() - 1 {
            for bit in 0..7 {
                let mut damaged = block.clone();
                damaged[at] ^= 1 << bit;
                let pieces = decode(&settings, &damaged);
                assert!(!pieces.contains(&right), "{at} {bit}");
            }
            let mut lost = block.clone();
            lost.remove(at);
            assert!(!decode(&settings, &lost).contains(&right), "{at}");
        }
        // Without its first character a block is known to be one.
        assert!(decode(&settings, &block[1..]).contains(&Piece::Wrong));
    }

    proptest! {
        #[test]
        fn what_is_encoded_is_decoded(text in "[ -~\t]{0,120}", printable: bool) {
            let settings = settings(printable);
            let text = text.as_bytes();
            for kind in [Kind::Header, Kind::Text] {
                let block = encode(&settings, kind, text);
                let check = block[block.len() - 2];
                prop_assert!(!printable || check >= b' ');
                let pieces = decode(&settings, &block);
                // One blank at the end may be taken for that of the check character.
                let stripped = text.strip_suffix(b" ").filter(|_| printable).unwrap_or(text);
                let found = match pieces.first() {
                    Some(Piece::Block(found, text)) if *found == kind => text.clone(),
                    other => return Err(TestCaseError::fail(format!("{other:?}"))),
                };
                prop_assert!(found == text || found == stripped);
            }
        }
    }
}
