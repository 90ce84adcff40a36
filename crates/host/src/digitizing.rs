//! The program that a digitizing writes: kept in memory until the range is scanned, then stored as a whole.

use std::sync::Arc;

use bahn_control::{Digitized, DigitizedNews};
use bahn_path::{ScanJob, ScanPoint};
use bahn_program::DigitizedText;

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
}

impl Text {
    fn new(job: ScanJob) -> Text {
        let mut blocks = DigitizedText::new(job);
        let mut last = String::with_capacity(PIECE + BLOCK);
        last.push_str(&blocks.begin());
        Text {
            job,
            blocks,
            pieces: Vec::new(),
            last,
            points: 0,
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

    fn finish(mut self) -> Complete {
        self.last.push_str(&self.blocks.end());
        self.pieces.push(Arc::from(self.last.as_bytes()));
        Complete {
            name: self.job.program.as_str().to_owned(),
            points: self.points,
            pieces: self.pieces,
        }
    }
}

impl Digitizing {
    /// Takes what a cycle of the channel said; a program when that was its last point.
    pub fn follow(&mut self, news: DigitizedNews) -> Option<Complete> {
        if news.number == self.seen {
            return None;
        }
        self.seen = news.number;
        match news.what? {
            Digitized::Begins(job) => self.text = Some(Text::new(job)),
            Digitized::Point(point) => {
                if let Some(text) = &mut self.text {
                    text.point(&point);
                }
            }
            Digitized::BrokenOff => self.text = None,
            Digitized::Complete => return self.text.take().map(Text::finish),
        }
        None
    }
}
