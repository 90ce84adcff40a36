//! How a port transfers: mode, and what the machine parameters say for it.

use std::time::Duration;

use bahn_parameters::equipment::Behaviour;
use bahn_parameters::interfaces::{ControlCharacters, Mode, TransferFormat};
use bahn_parameters::{ControlModel, ParameterList};

use crate::Characters;

/// Time of error N, and after which a device that is silent in a transfer is dead. The manual gives none [000:17599]; this
/// is that of later controls *(inferred)*.
pub const PATIENCE: Duration = Duration::from_secs(3);

/// Everything that a protocol knows of its port.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The control whose messages are shown.
    pub model: ControlModel,
    /// Blocks with check characters; otherwise the standard protocol.
    pub blockwise: bool,
    /// Frame of a character.
    pub characters: Characters,
    /// Characters of the protocol.
    pub control: ControlCharacters,
    /// A check character is never a control character [000:17015-17017].
    pub printable_check: bool,
    /// DC1 stands after each check character [000:17399-17403].
    pub with_dc1: bool,
    /// The other side is stopped by RTS, otherwise by DC3 [000:17059-17063].
    pub stop_by_rts: bool,
    /// EOT is never sent [000:17262-17264].
    pub never_eot: bool,
    /// The directory is asked for by an escape sequence [000:17460-17464].
    pub asks_directory: bool,
    /// Programs are sent with a decimal comma [001:1923].
    pub decimal_comma: bool,
    /// Time of error N and of a dead device.
    pub patience: Duration,
    /// Time of one character; zero where nothing paces them.
    pub character_time: Duration,
}

impl Settings {
    /// What a list of machine parameters says for a mode.
    pub fn of(parameters: &ParameterList, mode: Mode) -> Settings {
        let interfaces = parameters.interface_parameters();
        let fixed = Settings {
            model: parameters.model(),
            blockwise: mode != Mode::Me,
            characters: Characters::FIXED,
            control: parameters.fixed_characters(),
            printable_check: false,
            with_dc1: true,
            stop_by_rts: false,
            never_eot: mode == Mode::Me,
            asks_directory: mode == Mode::Fe1,
            decimal_comma: interfaces.decimal_comma,
            patience: PATIENCE,
            character_time: Duration::ZERO,
        };
        let index = match mode {
            Mode::Ext1 => 0,
            Mode::Ext2 => 1,
            Mode::Me | Mode::Fe1 | Mode::Fe2 => return fixed,
        };
        let [ext1, ext2, _] = interfaces.formats;
        fixed.with_format(&[ext1, ext2][index]).with_flow_of(parameters)
    }

    /// A TNC 151/155 of software level 05 or later controls the flow of a blockwise transfer by ACK and NAK alone, whatever
    /// MP222 says of RTS and DC3; before, DC1 stands behind headers and blocks (inferred from the tables) [001:1946-1948].
    fn with_flow_of(self, parameters: &ParameterList) -> Settings {
        let old = parameters.model().limits().has_old_numbers();
        let by_answers = parameters.equipment().does(Behaviour::FlowByAcknowledgement);
        match old && self.blockwise && by_answers {
            true => Settings {
                with_dc1: false,
                stop_by_rts: false,
                ..self
            },
            false => self,
        }
    }

    /// What a list says for a line of the PLC: EXT3 [000:15609-15636].
    pub fn of_plc(parameters: &ParameterList) -> Settings {
        let [.., ext3] = parameters.interface_parameters().formats;
        Settings::of(parameters, Mode::Fe2).with_format(&ext3)
    }

    fn with_format(self, format: &TransferFormat) -> Settings {
        Settings {
            blockwise: format.blockwise,
            characters: Characters::of_format(format),
            control: format.characters,
            printable_check: format.printable_check,
            with_dc1: format.stop_by_dc3,
            stop_by_rts: format.stop_by_rts,
            ..self
        }
    }

    /// The same on a port of a certain speed and with another patience.
    pub fn on(self, baud: Option<u32>, patience: Duration) -> Settings {
        Settings {
            patience,
            character_time: baud.map_or(Duration::ZERO, |baud| self.characters.time(baud)),
            ..self
        }
    }

    /// A moment in which what belongs together has come: three characters, and what systems need to hand them over.
    pub(crate) fn moment(&self) -> Duration {
        Duration::from_millis(50) + self.character_time * 3
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    #[test]
    fn modes_are_written_as_they_are_read() {
        for (name, mode) in Mode::ALL {
            assert_eq!(
                (mode.to_string().as_str(), name.to_uppercase().parse()),
                (name, Ok(mode))
            );
        }
        assert_eq!("fe".parse::<Mode>(), Err(()));
    }

    #[test]
    fn fixed_modes_do_not_ask_the_list() {
        let mut list = ParameterList::reference(ControlModel::Tnc425);
        list.set(5200, 0, 33.0).unwrap();
        list.set(5020, 0, 3.0).unwrap();
        list.set(5030, 0, 1.0).unwrap();
        let me = Settings::of(&list, Mode::Me);
        assert!(!me.blockwise && me.never_eot && me.control == ControlCharacters::STANDARD);
        let [fe1, fe2] = [Mode::Fe1, Mode::Fe2].map(|mode| Settings::of(&list, mode));
        assert!(fe1.blockwise && fe1.with_dc1 && !fe1.never_eot && fe1.characters == Characters::FIXED);
        assert_eq!(
            Settings {
                asks_directory: false,
                ..fe1
            },
            fe2
        );
        let ext = Settings::of(&list, Mode::Ext1);
        assert!(ext.blockwise && ext.printable_check && !ext.with_dc1 && ext.control.stx == b'!');
        assert_eq!(ext.characters.data_bits, 8);
        assert!(!Settings::of(&list, Mode::Ext2).blockwise);
    }
}
