//! A part that is being cut, for any number of viewers: each is sent what it lacks.

use std::sync::Arc;

use bahn_workpiece::Part;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

use crate::coder::PartCoder;
use crate::scene::{marks, tools};
use crate::trail::{Had, Trail, order};

/// A part that is being cut. Whoever cuts gives it the part now and then; a viewer that was too slow for what came
/// meanwhile gets the newest, and nothing waits for it.
#[derive(Clone, Debug)]
pub struct PartStream {
    id: u64,
    program: String,
    frame: Frame,
    coder: PartCoder,
    /// The difference between the last two versions, for those that keep up.
    latest: Option<Arc<[u8]>>,
    /// Colours of tools and marks, and how often they were others.
    colours: Value,
    repainted: u64,
}

/// Where the part lies.
#[derive(Clone, Debug, PartialEq)]
struct Frame {
    axes: [bahn_path::Axis; 3],
    min: [f64; 3],
    size: [f64; 3],
    cells: [usize; 2],
}

/// What a viewer was sent. A new one was sent nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sent {
    id: u64,
    version: u64,
    path: Had,
    repainted: u64,
    tool: (Option<[i64; 3]>, usize),
}

/// What a viewer lacks.
#[derive(Clone, Debug, Serialize)]
pub struct PartNews {
    /// Number of the part: another number is another part, of which nothing was sent before.
    pub id: u64,
    /// `program`, `axes`, `min`, `size` in mm, `cells`: of a part of which nothing was sent before.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub head: Option<Value>,
    /// `tools` and `marks` with their colours.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub colours: Option<Value>,
    /// Tiles, as `PartView.tiles` of the page takes them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tiles: Option<Bytes>,
    /// From which point on the path is another one.
    pub from: usize,
    /// The points from there on, as `readPath` of the page reads them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<Bytes>,
    /// Number of the tool among `tools`.
    pub tool: usize,
    /// Where it stands, from the corner of the blank, mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
}

/// Bytes that stay bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bytes(pub Arc<[u8]>);

impl Serialize for Bytes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(&self.0)
    }
}

impl Frame {
    fn of(part: &Part, coder: &PartCoder) -> Frame {
        let (min, max) = (part.min(), part.max());
        Frame {
            axes: part.axes(),
            min,
            size: [0, 1, 2].map(|k| max[k] - min[k]),
            cells: coder.cells(),
        }
    }
}

impl PartStream {
    /// Of a part with its path. The number is one that no part before had, and greater than 0.
    pub fn new(id: u64, program: &str, part: &Part, trail: &Trail) -> PartStream {
        let coder = PartCoder::new(part);
        let mut stream = PartStream {
            id,
            program: program.to_owned(),
            frame: Frame::of(part, &coder),
            coder,
            latest: None,
            colours: Value::Null,
            repainted: 0,
        };
        stream.take(part, trail);
        stream
    }

    /// Whether a part is one of this blank.
    pub fn fits(&self, part: &Part) -> bool {
        let (min, max) = (part.min(), part.max());
        let size = [0, 1, 2].map(|k| max[k] - min[k]);
        (self.frame.axes, self.frame.min, self.frame.size) == (part.axes(), min, size)
    }

    /// Takes the part as it is now.
    pub fn take(&mut self, part: &Part, trail: &Trail) {
        if let Some(bytes) = self.coder.changes(part) {
            self.latest = Some(bytes.into());
        }
        let cutters = part.cutters();
        let colours = json!({ "tools": tools(trail.tools(), &cutters), "marks": marks(&cutters) });
        if colours != self.colours {
            self.colours = colours;
            self.repainted += 1;
        }
    }

    /// What a viewer lacks that was sent this; `None` when it has everything. `at` is where the tool stands, X, Y, Z,
    /// when that is not the end of the path.
    pub fn news(&self, trail: &Trail, at: Option<[f64; 3]>, sent: &mut Sent) -> Option<PartNews> {
        let had = match sent.id == self.id {
            true => *sent,
            false => Sent::default(),
        };
        let order = order(self.frame.axes);
        let (end, tool) = trail.tool_at();
        let at = at.or(end).map(|at| {
            let along = |axis: usize| at.get(axis).copied().unwrap_or_default();
            [0, 1, 2].map(|k| along(order[k]) - self.frame.min[k])
        });
        let now = Sent {
            id: self.id,
            version: self.coder.version(),
            path: trail.now(),
            repainted: self.repainted,
            // A thousandth of a mm is not seen.
            tool: (at.map(|at| at.map(|mm| (mm * 1000.0).round() as i64)), tool),
        };
        if *sent == now {
            return None;
        }
        *sent = now;
        let from = trail.lacks_from(had.path);
        Some(PartNews {
            id: self.id,
            head: (had.id != self.id).then(|| self.head()),
            colours: (had.repainted != now.repainted).then(|| self.colours.clone()),
            tiles: self.tiles(had.version),
            from,
            path: (had.path != now.path).then(|| Bytes(trail.written(from, order, self.frame.min).into())),
            tool,
            at,
        })
    }

    fn head(&self) -> Value {
        let Frame {
            axes,
            min,
            size,
            cells,
        } = &self.frame;
        json!({
            "program": self.program, "axes": axes.map(|axis| axis.to_string()), "min": min, "size": size,
            "cells": cells,
        })
    }

    fn tiles(&self, version: u64) -> Option<Bytes> {
        let now = self.coder.version();
        match &self.latest {
            _ if version == now => None,
            Some(latest) if version + 1 == now => Some(Bytes(Arc::clone(latest))),
            _ => Some(Bytes(self.coder.since(version).into())),
        }
    }
}
