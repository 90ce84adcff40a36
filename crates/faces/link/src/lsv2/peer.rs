//! What hosts expect of a control by what `R_VR` says that it is (public): a table, read once where a name comes in.

use bahn_store::Attributes;

/// What one control does otherwise than another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Features {
    /// Bit of a folder among the attributes of a file.
    folder: u32,
    /// Bit of what is protected.
    protected: u32,
    /// A folder in which a host is can be removed; the host is in the one above then.
    pub(super) removes_own_folder: bool,
}

/// Controls that do otherwise than the others, by what their names begin with, in capitals and without blanks.
const PEERS: [(&str, Features); 1] = [(
    "ITNC530",
    Features {
        folder: 0x40,
        protected: 0x20,
        removes_own_folder: true,
    },
)];

/// All others, this one among them.
const OTHERS: Features = Features {
    folder: 0x20,
    protected: 0x40,
    removes_own_folder: false,
};

impl Default for Features {
    fn default() -> Features {
        OTHERS
    }
}

impl Features {
    /// What is shown in lists.
    pub(super) const SHOWN: u32 = 0x01;
    const CHANGEABLE: u32 = 0x02;

    /// Those of a control by what it says that it is.
    pub fn of(control: &str) -> Features {
        let name = control.replace(' ', "").to_ascii_uppercase();
        let found = PEERS.iter().find(|(peer, _)| name.starts_with(peer));
        found.map_or(OTHERS, |(_, features)| *features)
    }

    /// File attributes as the bits of the telegram.
    pub(super) fn encode(self, attributes: &Attributes) -> u32 {
        let bit = |on: bool, bit: u32| if on { bit } else { 0 };
        Features::SHOWN
            | bit(!attributes.protected, Features::CHANGEABLE)
            | bit(attributes.protected, self.protected)
            | bit(attributes.is_folder, self.folder)
    }

    /// Bits that say that something is a folder.
    pub(super) fn is_folder(self, bits: u32) -> bool {
        bits & self.folder != 0
    }

    /// Bits that say that something is protected.
    pub(super) fn is_protected(self, bits: u32) -> bool {
        bits & self.protected != 0
    }
}
