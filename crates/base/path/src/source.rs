//! How every stage pulls path elements from the stage before it.

use crate::{BlockRef, PathElement, Position, ScanFault, ScanJob, ScanPoint, Scanned};

/// A stage that yields path elements. Everything is pulled: a stage asks for the next element only
/// when it has room, so programs of any length run in constant memory. Stages that split, join or
/// annotate elements take an `ElementSource` and are one themselves.
pub trait ElementSource {
    /// What can be wrong with a program.
    type Error;

    /// The next step of the path. After [`Step::End`] and [`Step::Error`] the answer stays the same;
    /// after [`Step::Barrier`] the source waits for [`ElementSource::resume`].
    fn next(&mut self) -> Step<Self::Error>;

    /// Goes on after a barrier with what was found out there. Without a barrier it does nothing.
    fn resume(&mut self, live: LiveData);
}

/// An answer of an [`ElementSource`].
#[derive(Clone, Debug, PartialEq)]
pub enum Step<E> {
    /// The next element of the path.
    Element(PathElement),
    /// What follows depends on live data: everything before must be executed first.
    Barrier(Barrier),
    /// A drip-fed source has nothing yet. The path is planned to a stop at the end of what is known.
    Starved,
    /// The program has ended.
    End,
    /// The program cannot go on.
    Error(E),
}

/// Why the source waits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Barrier {
    /// A probing movement: from `from` in a straight line to `to` at most; the answer is
    /// [`LiveData::touch`] [003:4401-4410].
    Probe {
        /// The block that probes.
        block: BlockRef,
        /// Pre-position, tip of the stylus.
        from: Position,
        /// The farthest position to probe to, mm or degrees.
        to: Position,
        /// Probing feed, mm/min.
        feed_mm_min: f64,
        /// Radius of the stylus, mm.
        stylus_radius: f64,
    },
    /// A tool is measured with the tool probe; the answer is [`LiveData::touch`], where the axes stand then, with the
    /// results in [`LiveData::q_values`] [000:7960-8058].
    MeasureTool(ToolMeasuring),
    /// A surface is digitized; the answer is [`LiveData::scan`].
    Scan {
        /// The last block of the cycle.
        block: BlockRef,
        /// What is scanned, and how.
        job: ScanJob,
    },
    /// A programmed stop (STOP, M0, M1): the operator or the driver lets it go on.
    Stop {
        /// The block that stops the run.
        block: BlockRef,
    },
    /// Data that the PLC may write (Q100-Q107) must be current before the next block is read.
    Acknowledge {
        /// The block whose strobe is waited for.
        block: BlockRef,
    },
}

/// What a measurement of a tool on the tool probe is to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolMeasuring {
    /// The block that measures.
    pub block: BlockRef,
    /// What of the tool is measured.
    pub part: MeasuredPart,
    /// Each tooth on its own, with the spindle oriented.
    pub teeth: bool,
    /// The tool is compared with its data: the difference becomes its oversize; else its data become what was found.
    pub check: bool,
    /// Height of the tool axis at which nothing is in the way, path coordinates, mm.
    pub height: f64,
    /// The Q parameter that takes what was found: 0 good, 1 worn, 2 broken.
    pub result: Option<u16>,
}

/// What a tool probe measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasuredPart {
    /// The length of the tool.
    Length,
    /// The radius of the tool.
    Radius,
    /// The place and the width of its own contact, with a tool whose data are exact: calibrating.
    Probe,
}

/// What was found out at a barrier.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LiveData {
    /// Where the stylus touched; `None` when it did not.
    pub touch: Option<Touch>,
    /// How a scan ended; `None` where nothing was scanned: every surface is then taken for digitized.
    pub scan: Option<Scanned>,
    /// Q parameters that were written meanwhile (by the PLC: Q100-Q107): number, value.
    pub q_values: Vec<(u16, f64)>,
    /// How much longer the tool in the spindle is, and how much greater its radius, than was known before it was
    /// measured, mm: it counts so from here on.
    pub tool_differences_mm: [f64; 2],
}

impl LiveData {
    /// Of a scan that could not begin: where the stylus stayed.
    pub fn not_scanned(at: ScanPoint) -> LiveData {
        let fault = Some(ScanFault::Inaccessible);
        LiveData {
            scan: Some(Scanned { at, fault }),
            ..LiveData::default()
        }
    }
}

/// A touch of the probe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Position of the stylus tip's centre at the touch.
    pub position: Position,
}
