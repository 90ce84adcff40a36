//! What the PLC gets from the list: presets and numbers of the machine builder.
//!
//! Decision: Five markers choose one of MP4210.0 to .31 for a position of the TNC 355, MP4220 is its feed, MP4210.32
//! to .46 are datum corrections of five axes for three traverse ranges; on TNC 151/155 the codes 0 to 30 are MP126 to
//! MP156, and 31 is the reference mark [001:1834]

use crate::ParameterList;

/// Timers that have a preset, T0 to T47 [000:11758-11762].
const TIMERS: usize = 48;
/// Counters that have a preset [000:11826-11867].
const COUNTERS: usize = 32;
/// Positions of MP4210, which the PLC reads from D768 on.
const POSITIONS: usize = 48;
/// The first of MP4210 that the marker form takes as a datum correction [000:16182].
const CORRECTIONS_FROM: usize = 32;
/// Traverse ranges that the PLC may choose [000:3510-3520].
const RANGES: usize = 3;
/// Words of MP4310, W976 to W988 [000:11725-11740].
const WORDS: usize = 7;
/// Axes that have a feed in MP4220 [000:11720-11724].
const AXES: usize = 5;
/// One unit of the timers of the TNC 151/155, s [001:3281-3285].
const OLD_UNIT_S: f64 = 0.02;

/// The parameters of the PLC. "old" are the numbers of the TNC 151/155, which have fewer of most: 32
/// timers, 16 counters, 31 positions; the rest is 0.
#[derive(Clone, Debug, PartialEq)]
pub struct PlcParameters {
    /// The PLC program runs from the EPROM, not from the RAM: MP4010 = 0 (old MP77 = 1)
    /// [000:11896-11900] [001:3268-3270].
    pub from_eprom: bool,
    /// Start values of the timers T0 to T47, PLC cycles: MP4110, 0 to 65 535 (old MP110-125, MP193-208)
    /// [000:11758-11762].
    pub timers: [u16; TIMERS],
    /// Start values of the counters, counts: MP4120, 0 to 65 535 (old MP94-109) [000:11826-11867].
    pub counters: [u16; COUNTERS],
    /// Numbers in the doublewords D768 ff., mm or degrees; the PLC sees 10 000 times the value: MP4210
    /// (old MP126-156) [000:11670-11719].
    pub positions_mm: [f64; POSITIONS],
    /// Numbers in the words W960 to W968, also the feed of the return to the contour, mm/min: MP4220 (old
    /// MP163-166) [000:11720-11724].
    pub feeds_mm_min: [f64; AXES],
    /// Words W976 to W988, whose bits are also the markers M2192 to M2239 and M3200 to M3263: MP4310 (old
    /// MP158, MP249, MP250, MP209-212) [000:11725-11740] [001:1835-1840].
    pub words: [u16; WORDS],
    /// Correction for each PLC cycle of the compensation by lag tracking, mm: MP4070, 0.0001 to 0.005; old:
    /// none, 0 [000:3904-3912].
    pub tracking_step_mm: f64,
    /// Fast input that suppresses monitoring while W522 bit 0 is 1: MP4130, MP4131; old: none
    /// [000:5178-5188].
    pub monitoring_input: Option<MonitoringInput>,
    /// Analogue inputs of the first and second PLC extension are there: MP4410 [000:8449-8484].
    pub analogue_inputs: [bool; 2],
    /// Times of the strobes of M, S and T functions, TNC 151/155 only.
    pub strobes: Option<StrobeTimes>,
}

/// Fast PLC input that suppresses monitoring [000:5178-5188].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MonitoringInput {
    /// Number of the input: MP4130, 0 to 255.
    pub input: u8,
    /// Active at high level: MP4131 = 1.
    pub active_high: bool,
}

/// Times of the strobes with the standard PLC program of the TNC 151/155 [001:3281-3285].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrobeTimes {
    /// Until the strobe comes, s: MP120 times 20 ms.
    pub on_s: f64,
    /// Until the strobe goes, s: MP121 times 20 ms.
    pub off_s: f64,
    /// Until the acknowledgement is looked at, s: MP122 times 20 ms.
    pub test_s: f64,
}

impl PlcParameters {
    /// The position that a code of the marker form names, mm or degrees: five markers choose one of MP4210.0 to
    /// MP4210.31, in front of those of the datum correction (inferred) [000:16175-16183]. On a TNC 151/155 31 is the
    /// reference mark, from which its positions count [001:1834].
    pub fn coded_position_mm(&self, code: u32) -> Option<f64> {
        self.positions_mm.get(usize::try_from(code).ok()?).copied()
    }

    /// The datum correction of an axis in the marker form, mm or degrees: MP4210.32 to MP4210.46 [000:16182], which are
    /// X, Y, Z, 4 and 5 for each of the three traverse ranges (inferred).
    pub fn datum_correction_mm(&self, range: usize, axis: usize) -> f64 {
        let index = CORRECTIONS_FROM + range.min(RANGES - 1) * AXES + axis;
        self.positions_mm.get(index).copied().unwrap_or_default()
    }
}

impl ParameterList {
    /// What the list says for the PLC, in physical units.
    pub fn plc_parameters(&self) -> PlcParameters {
        let old = self.has_old_numbers();
        let strobes = || StrobeTimes {
            on_s: self.old(120) * OLD_UNIT_S,
            off_s: self.old(121) * OLD_UNIT_S,
            test_s: self.old(122) * OLD_UNIT_S,
        };
        let input = self.get_new(4130, 0).map(|input| MonitoringInput {
            input: input as u8,
            active_high: self.get(4131, 0) == Some(1.0),
        });
        PlcParameters {
            from_eprom: if old {
                self.old(77) == 1.0
            } else {
                self.get(4010, 0) == Some(0.0)
            },
            timers: self
                .run(4110, (110..126).chain(193..209))
                .map(|value| value as u16),
            counters: self.run(4120, 94..110).map(|value| value as u16),
            positions_mm: self.run(4210, 126..157),
            feeds_mm_min: self.run(4220, 163..167),
            words: self
                .run(4310, [158, 249, 250, 209, 210, 211, 212])
                .map(|value| value as u16),
            tracking_step_mm: self.get_new(4070, 0).unwrap_or_default(),
            monitoring_input: input,
            analogue_inputs: [0, 1].map(|bit| super::bit_of(self.get_new(4410, 0).unwrap_or_default(), bit)),
            strobes: old.then(strobes),
        }
    }

    /// Start value of timer T0 to T47 in PLC cycles: MP4110 [000:11764], on the TNC 151/155 MP110 to MP125 and
    /// MP193 to MP208 for T0 to T31 [001:1833]. 0 for a timer that the model does not have.
    pub fn timer_preset(&self, timer: u8) -> u16 {
        self.preset(4110, timer, (110..126).chain(193..209))
    }

    /// Start value of counter C0 to C31: MP4120 [000:11828], on the TNC 151/155 MP94 to MP109 for C0 to C15
    /// [001:1832]. 0 for a counter that the model does not have.
    pub fn counter_preset(&self, counter: u8) -> u16 {
        self.preset(4120, counter, 94..110)
    }

    fn preset(&self, new: u16, index: u8, mut old: impl Iterator<Item = u16>) -> u16 {
        let value = if self.has_old_numbers() {
            old.nth(index.into()).map(|number| self.old(number))
        } else {
            self.get(new, index)
        };
        // A cast of a float saturates.
        value.unwrap_or(0.0) as u16
    }

    /// A number for module 9032, as MP4230 (index 0) or MP4231 (index 1); `None` where there is none
    /// [000:14851-14875].
    pub fn plc_number(&self, list: u8, index: u8) -> Option<f64> {
        (list < 2)
            .then(|| self.get_new(4230 + u16::from(list), index))
            .flatten()
    }

    /// The values under the indices of a new number, or under the given old numbers.
    fn run<const N: usize>(&self, new: u16, old: impl IntoIterator<Item = u16>) -> [f64; N] {
        let mut values = [0.0; N];
        if self.has_old_numbers() {
            for (value, number) in values.iter_mut().zip(old) {
                *value = self.old(number);
            }
        } else {
            for (index, value) in (0u8..).zip(&mut values) {
                *value = self.get(new, index).unwrap_or_default();
            }
        }
        values
    }
}
