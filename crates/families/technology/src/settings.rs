//! What a channel parameter list sets, typed: what the channel does with each function [004:195-234].
//!
//! Decision: Free spindle functions (`spindle_m_fct_free 1`) need an entry in `m_synch` as any other; without that
//! switch they are internal (also `technology/src/channel/resolve.rs`)
//!
//! Decision: A spindle without `bezeichnung` is called S, S2, S3 by its index; the main spindle is `spindel[0]`
//! unless `main_spindle_ax_nr` names another

use std::collections::BTreeMap;

use bahn_path::Synchronisation;

use crate::synch::Synch;

/// Numbers of M and H functions that a list has, from 0 on [004:195-204].
pub const FUNCTIONS: usize = 1000;

/// M functions that the channel knows by itself: without an entry they are not output and nothing waits for them, but
/// they may be programmed [004:48] [004:204]. M5 is missing in the manual's list; it is like M3 and M4 (inferred).
pub(crate) const INTERNAL_M: [u32; 10] = [0, 1, 2, 3, 4, 5, 17, 19, 29, 30];

/// The functions of a spindle among them, unless they are free [004:159]: then they are known with an entry only.
pub(crate) const SPINDLE_M: [u32; 4] = [3, 4, 5, 19];

/// All that a channel parameter list sets, with the values of an empty list as default.
///
/// ```
/// use bahn_technology::{ChannelSettings, Synchronisation};
/// let settings = ChannelSettings::default();
/// // An internal function is known, any other is not before the list says how it is synchronised.
/// assert_eq!(settings.m.get(30).unwrap().synch.unwrap().kind, Synchronisation::NoSynch);
/// assert_eq!(settings.m.get(25).unwrap().synch, None);
/// assert!(settings.m.get(1000).is_none());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelSettings {
    /// M functions by their numbers, with their synchronisation.
    pub m: FunctionTable,
    /// H functions by their numbers, with their synchronisation.
    pub h: FunctionTable,
    /// Spindles by the index of `spindel[i]`.
    pub spindles: BTreeMap<usize, SpindleSettings>,
    /// Logical axis number of the main spindle; without one it is `spindel[0]` (public: `main_spindle_ax_nr`).
    pub main_spindle_axis: Option<u32>,
    /// By what the main spindle is called in programs, beside its own name (public: `main_spindle_name`).
    pub main_spindle_name: String,
    /// P-CHAN-00052: M40 to M45 select the gear stage of the main spindle [004:198].
    pub gear_change: bool,
    /// P-CHAN-00098: M3, M4, M5 and M19 are ordinary M functions [004:201].
    pub spindle_m_free: bool,
    /// P-CHAN-00118: M6 calls a program, and takes no additive value [004:105] (public: what it does).
    pub m6_implicit_call: bool,
    /// P-CHAN-00033: the end of a program waits for all late functions [004:225].
    pub late_sync_ready: bool,
    /// Output ahead by distance or time.
    pub pre_output: PreOutput,
    /// Output at a place within a block.
    pub micro_joint: MicroJoint,
    /// Measuring an edge, G108 and G107.
    pub edge_banding: EdgeBanding,
}

impl Default for ChannelSettings {
    fn default() -> ChannelSettings {
        let mut m = FunctionTable::default();
        for number in INTERNAL_M
            .into_iter()
            .filter(|number| !SPINDLE_M.contains(number))
        {
            if let Some(function) = m.get_mut(number) {
                function.synch = Some(Synchronisation::NoSynch.into());
            }
        }
        ChannelSettings {
            m,
            h: FunctionTable::default(),
            spindles: BTreeMap::new(),
            main_spindle_axis: None,
            main_spindle_name: "S".to_owned(),
            gear_change: false,
            spindle_m_free: false,
            m6_implicit_call: false,
            late_sync_ready: false,
            pre_output: PreOutput::default(),
            micro_joint: MicroJoint::default(),
            edge_banding: EdgeBanding::default(),
        }
    }
}

impl ChannelSettings {
    /// The main spindle and its index: the one with the axis of `main_spindle_ax_nr`, otherwise `spindel[0]`.
    pub fn main_spindle(&self) -> Option<(usize, &SpindleSettings)> {
        let by_axis = self.main_spindle_axis.and_then(|axis| {
            let mut spindles = self.spindles.iter();
            spindles.find(|(_, spindle)| spindle.log_axis == Some(axis))
        });
        by_axis
            .or_else(|| self.spindles.get_key_value(&0))
            .map(|(index, spindle)| (*index, spindle))
    }

    /// The spindle that a program calls so: by its own name, or the main spindle by `S`.
    pub fn spindle_called(&self, name: &str) -> Option<(usize, &SpindleSettings)> {
        let mut spindles = self.spindles.iter();
        let named = spindles.find(|(index, spindle)| spindle.name(**index).eq_ignore_ascii_case(name));
        named.map(|(index, spindle)| (*index, spindle)).or_else(|| {
            self.main_spindle()
                .filter(|_| self.main_spindle_name.eq_ignore_ascii_case(name))
        })
    }
}

/// What a list says of one M or H function.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FunctionSettings {
    /// P-CHAN-00041, P-CHAN-00027: the synchronisation. `None` is `NOT_VALID`: to program it is P-ERR-20157 [004:42].
    pub synch: Option<Synch>,
    /// P-CHAN-00070, P-CHAN-00107: the lead, a distance in 0.1 µm, or a time in 1 µs with `MET_SVS` and `MET_MOS` [004:216].
    pub lead: u32,
    /// P-CHAN-00040, P-CHAN-00026: how long the PLC is thought to take, µs [004:225].
    pub process_time_us: u32,
    /// P-CHAN-00039, P-CHAN-00025: the axis or spindle to whose range it goes when it is programmed without one
    /// [004:195-198].
    pub default_target: Option<String>,
}

/// M or H functions by number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FunctionTable(Vec<FunctionSettings>);

impl Default for FunctionTable {
    fn default() -> FunctionTable {
        FunctionTable(vec![FunctionSettings::default(); FUNCTIONS])
    }
}

impl FunctionTable {
    /// What the list says of a function; `None` when no list has its number.
    pub fn get(&self, number: u32) -> Option<&FunctionSettings> {
        self.0.get(usize::try_from(number).ok()?)
    }

    /// The settings of a function, to change them.
    pub fn get_mut(&mut self, number: u32) -> Option<&mut FunctionSettings> {
        self.0.get_mut(usize::try_from(number).ok()?)
    }

    /// All, to change them.
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = &mut FunctionSettings> {
        self.0.iter_mut()
    }

    /// All with their numbers.
    pub fn iter(&self) -> impl Iterator<Item = (u32, &FunctionSettings)> {
        (0..).zip(&self.0)
    }
}

/// What a list says of one spindle.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SpindleSettings {
    /// `bezeichnung`: the name of the spindle; see [`SpindleSettings::name`].
    pub label: Option<String>,
    /// `log_achs_nr`, the logical axis number.
    pub log_axis: Option<u32>,
    /// `achs_mode` with 0x00040000: the PLC drives the spindle, all its M functions are output in its range [004:168].
    pub plc_spindle: bool,
    /// P-CHAN-00069, `plc_control`: the PLC drives it, and all of it goes through the range of the channel [004:171].
    pub plc_control: bool,
    /// P-CHAN-00081 and P-CHAN-00080: the S word [004:228] (public: P-CHAN-00081).
    pub s: SpindleFunction,
    /// P-CHAN-00045 and P-CHAN-00044: M3 [004:210] [004:228].
    pub m3: SpindleFunction,
    /// P-CHAN-00047 and P-CHAN-00046: M4 [004:210] [004:228].
    pub m4: SpindleFunction,
    /// P-CHAN-00049 and P-CHAN-00048: M5 [004:213] [004:231].
    pub m5: SpindleFunction,
    /// P-CHAN-00043 and P-CHAN-00042: M19 [004:213] [004:231].
    pub m19: SpindleFunction,
}

impl SpindleSettings {
    /// The mode of an axis that the PLC drives [004:168].
    pub const EXTERNAL: u32 = 0x0004_0000;

    /// Its name: `bezeichnung`; without one `S` for `spindel[0]`, `S2` for `spindel[1]` and so on (inferred).
    pub fn name(&self, index: usize) -> String {
        match &self.label {
            Some(label) => label.clone(),
            None if index == 0 => "S".to_owned(),
            None => format!("S{}", index + 1),
        }
    }

    /// What the list says of M3, M4, M5 or M19; `None` for any other function.
    pub fn m(&self, number: u32) -> Option<SpindleFunction> {
        match number {
            3 => Some(self.m3),
            4 => Some(self.m4),
            5 => Some(self.m5),
            19 => Some(self.m19),
            _ => None,
        }
    }
}

/// What a list says of a function of one spindle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpindleFunction {
    /// The synchronisation; `None` when the list does not say it, which is `NO_SYNCH` [004:210].
    pub synch: Option<Synch>,
    /// How long spindle or PLC are thought to take, µs.
    pub process_time_us: u32,
}

/// Output ahead by distance or time, `MEP_*` and `MET_*` [004:222].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PreOutput {
    /// P-CHAN-00209: times are those of the velocity profile in force, not of a linear one.
    pub active_profile: bool,
    /// P-CHAN-00212: distance and time to go are worked out, and the look-ahead turns to the next place only after this one.
    pub value_to_go: bool,
    /// P-CHAN-00274: blocks that are looked ahead, 50 to 200.
    pub blocks: u32,
}

impl Default for PreOutput {
    fn default() -> PreOutput {
        PreOutput {
            active_profile: false,
            value_to_go: false,
            blocks: 50,
        }
    }
}

/// Output at a place within a block that is split for it [004:111-147].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MicroJoint {
    /// P-CHAN-00600 with `FCT_M_PRE_OUTPUT`. Without it a lead of a type that has none is a licence error [004:216].
    pub enabled: bool,
    /// P-CHAN-00603: how many blocks back a place may lie [004:123].
    pub blocks: u32,
    /// P-CHAN-00604: how far back the blocks are kept, 0.1 µm; 0 is without limit (public).
    pub distance: u32,
    /// P-CHAN-00760: how far the real place may be from the planned one, 0.1 µm; 0 is without limit [004:135].
    pub tolerance: u32,
}

impl Default for MicroJoint {
    fn default() -> MicroJoint {
        MicroJoint {
            enabled: false,
            blocks: 10,
            distance: 0,
            tolerance: 0,
        }
    }
}

/// Measuring an edge between G108 and G107, with `MNE_SNS` [004:69] (public: its parameter).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EdgeBanding {
    /// P-CHAN-00030: distance to go after the measuring event, 0.1 µm; `V.G.RW` changes it.
    pub residual_path: u32,
}
