//! When a function goes out, and where the path waits for its acknowledgement: the types of TF5200, a row for each.
//!
//! Decision: The thirteen synchronisation types are rows of one table at the bottom of the house, since the rooms
//! that read it have no other in common

use std::fmt;

/// Synchronisation of a function with the path [004:54-57] [004:204-207].
///
/// Read a name as M-before-block, synchronisation-after-block and so on: `MVS_SNS` is output before the motion of its
/// block, and waited for after it. Whoever asks what a type does asks for its [output place](Synchronisation::output) and its
/// [wait place](Synchronisation::wait).
///
/// ```
/// use bahn_path::{OutputPlace, Synchronisation, WaitPlace};
/// let late = Synchronisation::named("MVS_SLM").unwrap();
/// assert_eq!((late.output(), late.wait()), (OutputPlace::Before, WaitPlace::Feed));
/// assert!(late.is_late() && Synchronisation::MetSvs.leads_by_time());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Synchronisation {
    /// Neither output nor waited for.
    #[default]
    NoSynch,
    /// Output before the motion, not waited for; the PLC must fetch it.
    Mos,
    /// Output and waited for before the motion: start of block.
    MvsSvs,
    /// Output before the motion, waited for after it, without a stop where the acknowledgement is in time [004:63].
    MvsSns,
    /// Output and waited for after the motion, which stops there in any case [004:66]: end of block.
    MnsSns,
    /// Output after the measuring event and the distance to go of edge banding, waited for there [004:69].
    MneSns,
    /// Output before the motion, waited for at the transition to the next G01, G02 or G03 [004:72].
    MvsSlm,
    /// Output before the motion, waited for at `#EXPL SYN`, where the program wants it
    /// ([`Function::Synchronise`](crate::Function::Synchronise)) [004:75].
    MvsSlp,
    /// Output before the motion with the time that has passed since, not waited for [004:93].
    MosTs,
    /// Output a distance ahead, not waited for [004:87].
    MepMos,
    /// Output a time ahead, not waited for [004:87].
    MetMos,
    /// Output a distance ahead, waited for before the motion of its block [004:81].
    MepSvs,
    /// Output a time ahead, waited for before the motion of its block [004:81].
    MetSvs,
}

/// Where a function goes out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputPlace {
    /// Nowhere: the PLC hears nothing of it.
    Nowhere,
    /// Before the motion of its block.
    Before,
    /// After the motion of its block.
    After,
    /// After the measuring event and the distance to go.
    Event,
    /// A distance ahead of its block.
    Distance,
    /// A time ahead of its block.
    Time,
}

/// Where the path waits for the acknowledgement of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaitPlace {
    /// The path does not wait for it.
    Nowhere,
    /// Before the motion of its block.
    Before,
    /// After the motion of its block.
    After,
    /// Where it is output.
    Output,
    /// At the next transition to a motion with a feed.
    Feed,
    /// Where the program wants it.
    Point,
}

/// What there is to know of a type.
struct Row {
    name: &'static str,
    bits: u32,
    output: OutputPlace,
    wait: WaitPlace,
}

/// The types with their names and values [004:204-207], output places and wait places [004:54-57].
const ROWS: [(Synchronisation, Row); 13] = {
    use OutputPlace::{After, Before, Distance, Event, Nowhere, Time};
    use Synchronisation as Of;
    use WaitPlace as Wait;
    const fn row(name: &'static str, bits: u32, output: OutputPlace, wait: WaitPlace) -> Row {
        Row {
            name,
            bits,
            output,
            wait,
        }
    }
    [
        (Of::NoSynch, row("NO_SYNCH", 0, Nowhere, Wait::Nowhere)),
        (Of::Mos, row("MOS", 0x1, Before, Wait::Nowhere)),
        (Of::MvsSvs, row("MVS_SVS", 0x2, Before, Wait::Before)),
        (Of::MvsSns, row("MVS_SNS", 0x4, Before, Wait::After)),
        (Of::MnsSns, row("MNS_SNS", 0x8, After, Wait::After)),
        (Of::MneSns, row("MNE_SNS", 0x20, Event, Wait::Output)),
        (Of::MvsSlm, row("MVS_SLM", 0x4000, Before, Wait::Feed)),
        (Of::MvsSlp, row("MVS_SLP", 0x8000, Before, Wait::Point)),
        (Of::MosTs, row("MOS_TS", 0x0004_0000, Before, Wait::Nowhere)),
        (Of::MepMos, row("MEP_MOS", 0x0010_0000, Distance, Wait::Nowhere)),
        (Of::MetMos, row("MET_MOS", 0x0020_0000, Time, Wait::Nowhere)),
        (Of::MepSvs, row("MEP_SVS", 0x0100_0000, Distance, Wait::Before)),
        (Of::MetSvs, row("MET_SVS", 0x0200_0000, Time, Wait::Before)),
    ]
};

impl Synchronisation {
    /// All types in ascending order of their values.
    pub fn all() -> impl Iterator<Item = Synchronisation> {
        ROWS.iter().map(|(kind, _)| *kind)
    }

    #[inline]
    fn row(self) -> &'static Row {
        &ROWS[self as usize].1
    }

    /// The type of a name, as `MVS_SVS`.
    pub fn named(name: &str) -> Option<Synchronisation> {
        Synchronisation::all().find(|kind| kind.name() == name)
    }

    /// The constant in lists, as `MVS_SVS`.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The value of the constant: 0 or one bit.
    pub fn bits(self) -> u32 {
        self.row().bits
    }

    /// Where it goes out.
    #[inline]
    pub fn output(self) -> OutputPlace {
        self.row().output
    }

    /// Where the path waits for its acknowledgement.
    #[inline]
    pub fn wait(self) -> WaitPlace {
        self.row().wait
    }

    /// Whether a lead says how far ahead it is output, without Micro Joints.
    pub fn is_pre_output(self) -> bool {
        matches!(self.output(), OutputPlace::Distance | OutputPlace::Time)
    }

    /// Whether its lead is a time; the lead of all others is a distance.
    pub fn leads_by_time(self) -> bool {
        self.output() == OutputPlace::Time
    }

    /// Whether a lead makes it the function of a Micro Joint [004:114-120].
    pub fn takes_micro_joint(self) -> bool {
        matches!(self.output(), OutputPlace::Before | OutputPlace::After) && !self.is_late()
    }

    /// Whether it may remain open over blocks until something asks for it [004:72-78].
    pub fn is_late(self) -> bool {
        matches!(self.wait(), WaitPlace::Feed | WaitPlace::Point)
    }

    /// Whether it goes out before the motion of its block and is waited for after it: the motion passes meanwhile [004:63].
    #[inline]
    pub fn spans_motion(self) -> bool {
        matches!(
            (self.output(), self.wait()),
            (OutputPlace::Before, WaitPlace::After)
        )
    }

    /// Whether the path waits for its acknowledgement anywhere; what is not waited for must be fetched all the same.
    pub fn is_waited_for(self) -> bool {
        self.wait() != WaitPlace::Nowhere
    }
}

impl fmt::Display for Synchronisation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl OutputPlace {
    /// In words: when the function goes out.
    pub fn words(self) -> &'static str {
        match self {
            OutputPlace::Nowhere => "not at all",
            OutputPlace::Before => "before the motion of its block",
            OutputPlace::After => "after the motion of its block",
            OutputPlace::Event => "after the measuring event and the distance to go",
            OutputPlace::Distance => "a distance ahead",
            OutputPlace::Time => "a time ahead",
        }
    }
}

impl WaitPlace {
    /// In words: where the path waits.
    pub fn words(self) -> &'static str {
        match self {
            WaitPlace::Nowhere => "nowhere",
            WaitPlace::Before => "before the motion of its block",
            WaitPlace::After => "after the motion of its block",
            WaitPlace::Output => "where it is output",
            WaitPlace::Feed => "at the next transition to G01, G02 or G03",
            WaitPlace::Point => "at #EXPL SYN",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_in_the_order_of_the_types() {
        for (at, (kind, row)) in ROWS.iter().enumerate() {
            assert_eq!(*kind as usize, at);
            assert!(row.bits.count_ones() <= 1, "{kind}");
            assert_eq!(Synchronisation::named(row.name), Some(*kind));
        }
        assert!(ROWS.is_sorted_by(|(_, a), (_, b)| a.bits < b.bits));
        let spans = Synchronisation::all().filter(|kind| kind.spans_motion());
        assert!(spans.eq([Synchronisation::MvsSns]));
    }

    /// The parts of a name say what the type does [004:54-57]: M function V(before), N(after) the S(block), at the E(vent), by a
    /// P(ath) or a T(ime) ahead; S(ynchronisation) before, after, late by a M(otion), late by the P(rogram); MOS without one.
    #[test]
    fn a_row_says_what_its_name_says() {
        for kind in Synchronisation::all().filter(|kind| *kind != Synchronisation::NoSynch) {
            let (output, wait) = kind.name().split_once('_').unwrap_or((kind.name(), "MOS"));
            let output = match output {
                "MOS" | "MVS" => OutputPlace::Before,
                "MNS" => OutputPlace::After,
                "MNE" => OutputPlace::Event,
                "MEP" => OutputPlace::Distance,
                "MET" => OutputPlace::Time,
                other => panic!("{other}"),
            };
            let wait = match wait {
                "MOS" | "TS" => WaitPlace::Nowhere,
                "SVS" => WaitPlace::Before,
                "SNS" if output == OutputPlace::Event => WaitPlace::Output,
                "SNS" => WaitPlace::After,
                "SLM" => WaitPlace::Feed,
                "SLP" => WaitPlace::Point,
                other => panic!("{other}"),
            };
            assert_eq!((kind.output(), kind.wait()), (output, wait), "{kind}");
        }
    }
}
