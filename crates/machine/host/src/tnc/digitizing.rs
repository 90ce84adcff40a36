//! The program that a digitizing writes: kept in memory until the range is scanned, then stored as a whole; or printed block by
//! block at a data interface, as the interface function PRINT says [003:6554-6557].
//!
//! Decision: With PRINT at a port digitizing stores nothing; what was printed of a scan that is broken off ends at
//! its last point. PRINT holds for scans that begin, and stays when the machine is switched on anew

use std::sync::Arc;

use bahn_path::{ScanJob, ScanPoint};
use bahn_program::DigitizedText;
use bahn_tnc::{Digitized, DigitizedNews};

/// Bytes of a piece of the text. Moments that are saved share whole pieces.
const PIECE: usize = 1 << 16;
/// A block is shorter than this.
const BLOCK: usize = 128;

/// What takes the points of a channel.
#[derive(Clone, Debug, Default)]
pub(crate) struct Digitizing {
    /// The news that were looked at.
    seen: u64,
    text: Option<Text>,
}

/// What comes of a cycle.
pub(crate) enum Written {
    /// Blocks for the data interface, each with its end of line.
    Printed(String),
    /// A program for the memory.
    Complete(Complete),
}

/// A program that has come to its end.
pub(crate) struct Complete {
    pub name: String,
    pub points: u64,
    pub pieces: Vec<Arc<[u8]>>,
}

#[derive(Clone, Debug)]
struct Text {
    job: ScanJob,
    blocks: DigitizedText,
    pieces: Vec<Arc<[u8]>>,
    last: String,
    points: u64,
    /// Blocks are printed as they come, nothing is stored.
    prints: bool,
}

impl Text {
    fn new(job: ScanJob, prints: bool) -> Text {
        let mut blocks = DigitizedText::new(job);
        let mut last = String::with_capacity(if prints { BLOCK } else { PIECE + BLOCK });
        last.push_str(&blocks.begin());
        Text {
            job,
            blocks,
            pieces: Vec::new(),
            last,
            points: 0,
            prints,
        }
    }

    fn point(&mut self, point: &ScanPoint) {
        self.points += 1;
        self.blocks.point(&mut self.last, point);
        if self.last.len() >= PIECE {
            self.pieces.push(Arc::from(self.last.as_bytes()));
            self.last.clear();
        }
    }

    fn end(&mut self) {
        self.last.push_str(&self.blocks.end());
    }

    fn finish(mut self) -> Complete {
        self.pieces.push(Arc::from(self.last.as_bytes()));
        Complete {
            name: self.job.program.as_str().to_owned(),
            points: self.points,
            pieces: self.pieces,
        }
    }
}

impl Digitizing {
    /// Takes what a cycle of the channel said; a scan that begins with it `prints` its blocks, or stores them. One that is broken
    /// off leaves nothing in the memory; what is printed ends there.
    pub fn follow(&mut self, news: DigitizedNews, prints: bool) -> Option<Written> {
        if news.number == self.seen {
            return None;
        }
        self.seen = news.number;
        let what = news.what?;
        match what {
            Digitized::Begins(job) => self.text = Some(Text::new(job, prints)),
            Digitized::Point(point) => self.text.as_mut()?.point(&point),
            Digitized::BrokenOff => self.text = None,
            Digitized::Complete => self.text.as_mut()?.end(),
        }
        let text = self.text.as_mut()?;
        if text.prints {
            return Some(Written::Printed(std::mem::take(&mut text.last)));
        }
        let over = matches!(what, Digitized::Complete);
        let text = self.text.take_if(|_| over)?;
        Some(Written::Complete(text.finish()))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use bahn_path::{Axis, ScanName, ScanPattern, ScanRules};

    fn job() -> ScanJob {
        ScanJob {
            tool_axis: Axis::Z,
            min: [0.0, 0.0, -10.0],
            max: [20.0, 20.0, 1.0],
            shift: [0.0; 3],
            clearance_mm: 40.0,
            pattern: ScanPattern::ContourLines {
                start: [0.0, 5.0, 0.0],
                approach: (Axis::Y, 1.0),
                direction: (Axis::X, 1.0),
                time_limit_s: 0.0,
            },
            travel_mm: 0.5,
            spacing_mm: 0.5,
            interval_mm: 0.2,
            stylus_radius_mm: 2.0,
            beside: [0.0; 3],
            inch: false,
            program: ScanName::new("DATA").unwrap(),
            rules: ScanRules::default(),
        }
    }

    /// What a scan of two points comes to, while PRINT says this before the first point and that after it.
    fn scanned(prints: [bool; 2]) -> Vec<Written> {
        let mut digitizing = Digitizing::default();
        let said = [
            Digitized::Begins(job()),
            Digitized::Point([1.0, 5.0, -2.0]),
            Digitized::Point([2.0, 5.0, -2.5]),
            Digitized::Complete,
        ];
        let news = (1..).zip(said).map(|(number, what)| DigitizedNews {
            number,
            what: Some(what),
        });
        let at = |number: u64| prints[usize::from(number > 1)];
        news.filter_map(|news| digitizing.follow(news, at(news.number)))
            .collect()
    }

    /// The interface function PRINT decides where the blocks go: into the memory as a whole program, or to a data interface as
    /// the points come, the same blocks [003:6554-6557].
    #[test]
    fn printed_blocks_are_those_of_the_stored_program() {
        let stored = scanned([false; 2]);
        let [Written::Complete(complete)] = stored.as_slice() else {
            panic!("one program");
        };
        let stored: Vec<u8> = complete.pieces.iter().flat_map(|piece| piece.to_vec()).collect();
        let printed: Vec<String> = scanned([true; 2])
            .into_iter()
            .map(|written| match written {
                Written::Printed(blocks) => blocks,
                Written::Complete(_) => panic!("nothing is stored"),
            })
            .collect();
        assert_eq!(printed.len(), 4, "as they come");
        assert!(
            printed[1].contains("X+1") && printed[2].contains("X+2"),
            "{printed:?}"
        );
        assert_eq!(printed.concat().into_bytes(), stored);
    }

    /// PRINT holds for what begins: a scan that is on its way goes where it has begun to go.
    #[test]
    fn a_scan_goes_on_as_it_began() {
        let [stored, printed] = [[false, true], [true, false]].map(scanned);
        assert!(matches!(stored.as_slice(), [Written::Complete(complete)] if complete.points == 2));
        assert!(printed.len() == 4 && printed.iter().all(|block| matches!(block, Written::Printed(_))));
    }
}
