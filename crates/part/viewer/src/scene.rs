//! Everything that the page of a run shows, as one piece of data.

use std::io::{self, Write};

use bahn_path::{Axis, BlockRef, PathElement};
use bahn_workpiece::{CutBy, Part};
use flate2::Compression;
use flate2::write::DeflateEncoder;
use serde::Serialize;
use serde_json::{Value, json};

use crate::history::History;
use crate::sheet::{TILE, WHOLE};
use crate::track::{Track, TrackTool};
use crate::trail;

/// Bytes of the part's moments that a page may have; when there are more, every other moment is left out.
const MOST_BYTES: usize = 1_100_000;
/// Rows of the block list; further blocks are not listed.
const MOST_ROWS: usize = 100_000;

/// Collects what the page of a run shows, while it runs.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    track: Track,
    history: Option<History>,
}

impl Recording {
    /// Takes an element that was executed and cut, with the time of its end since the beginning, s.
    pub fn element(&mut self, element: &PathElement, end_s: f64) {
        self.track.element(element, end_s);
    }

    /// Whether [`Recording::part`] is to be called now.
    #[inline]
    pub fn wants_part(&self, time_s: f64) -> bool {
        self.history.as_ref().is_none_or(|history| history.is_due(time_s))
    }

    /// Keeps the part as it is at a time. It must always be of the same blank.
    pub fn part(&mut self, part: &Part, time_s: f64) {
        self.history
            .get_or_insert_with(|| History::new(part))
            .take(time_s, part);
    }

    /// The programs of which something was executed, by their numbers; always the main program.
    pub fn programs(&self) -> Vec<u16> {
        self.track.programs()
    }
}

/// What is said of a run beside path and part.
#[derive(Clone, Debug, Default)]
pub struct About {
    /// Name of the program.
    pub title: String,
    /// The control model that ran the program.
    pub model: String,
    /// The listings of the programs that took part, the main program first.
    pub listings: Vec<Listing>,
    /// What is known of the run, as names and values.
    pub facts: Vec<(String, String)>,
    /// What ended the run.
    pub error: Option<Remark>,
    /// What the operator should know.
    pub warnings: Vec<Remark>,
    /// Machining time, s; `None` when it never ends.
    pub time_s: Option<f64>,
}

/// The listing of a program.
#[derive(Clone, Debug, Default)]
pub struct Listing {
    /// Number of the program in [`BlockRef::program`].
    pub program: u16,
    /// The name of the program.
    pub name: String,
    /// Its blocks from BEGIN PGM on.
    pub blocks: Vec<String>,
}

/// Something to know about a block.
#[derive(Clone, Debug, Default)]
pub struct Remark {
    /// The text of the remark.
    pub text: String,
    /// Where; `None` when it is about no block.
    pub block: Option<BlockRef>,
    /// How often it came up.
    pub count: u64,
}

#[derive(Serialize)]
struct RemarkRow<'a> {
    text: &'a str,
    row: Option<u32>,
    count: u64,
}

/// Where the listing of a program begins in the list.
struct Rows {
    /// Program, first row, count of rows.
    programs: Vec<(u16, u32, u32)>,
}

impl Rows {
    fn of(listings: &[Listing]) -> Rows {
        let mut first = 0;
        let mut programs = Vec::new();
        for listing in listings {
            let room = MOST_ROWS.saturating_sub(first as usize);
            let count = listing.blocks.len().min(room) as u32;
            programs.push((listing.program, first, count));
            first += count;
        }
        Rows { programs }
    }

    fn row(&self, block: BlockRef) -> Option<u32> {
        let (_, first, count) = self
            .programs
            .iter()
            .find(|(program, ..)| *program == block.program)?;
        (block.block < *count).then_some(first + block.block)
    }
}

/// Where things lie that have no blank: the path gives the size.
struct Frame {
    axes: [Axis; 3],
    min: [f64; 3],
    size: [f64; 3],
    /// The places of `axes` among X, Y, Z.
    order: [usize; 3],
}

impl Frame {
    fn of(part: Option<&Part>, track: &Track) -> Frame {
        let (axes, min, max) = match part {
            Some(part) => (part.axes(), part.min(), part.max()),
            None => {
                let [min, max] = track.bounds().unwrap_or([[0.0; 3], [100.0; 3]]);
                ([Axis::X, Axis::Y, Axis::Z], min, max)
            }
        };
        Frame {
            axes,
            min,
            size: [0, 1, 2].map(|k| f64::max(max[k] - min[k], 1e-3)),
            order: trail::order(axes),
        }
    }
}

/// The data of the page, deflated: a head as JSON after its length, then the listing, the moments of the part
/// and the path; their lengths stand in the head.
pub(crate) fn write(recording: Recording, part: Option<&Part>, about: &About) -> io::Result<Vec<u8>> {
    let Recording { track, mut history } = recording;
    let mut moments = Vec::new();
    if let (Some(history), Some(part)) = (&mut history, part) {
        history.take(about.time_s.unwrap_or(0.0), part);
        loop {
            moments = history.written();
            if deflated(&moments)?.len() <= MOST_BYTES || !history.halve() {
                break;
            }
        }
    }
    let frame = Frame::of(part, &track);
    let rows = Rows::of(&about.listings);
    let path = track.written(0, frame.order, frame.min, |block| rows.row(block));
    let listing = listing(about);
    let head = head(about, &rows, &frame, part, &track, history.as_ref());
    let mut head = head;
    head["lengths"] = json!([listing.len(), moments.len(), path.len()]);
    let head = head.to_string();
    let mut data = Vec::new();
    data.extend_from_slice(&(head.len() as u32).to_le_bytes());
    for piece in [head.as_bytes(), listing.as_bytes(), &moments, &path] {
        data.extend_from_slice(piece);
    }
    deflated(&data)
}

fn head(
    about: &About,
    rows: &Rows,
    frame: &Frame,
    part: Option<&Part>,
    track: &Track,
    history: Option<&History>,
) -> Value {
    let remark = |remark: &Remark| {
        let row = remark.block.and_then(|block| rows.row(block));
        json!(RemarkRow {
            text: &remark.text,
            row,
            count: remark.count
        })
    };
    let programs: Vec<_> = about
        .listings
        .iter()
        .zip(&rows.programs)
        .map(|(listing, (_, first, count))| {
            json!({ "name": listing.name, "first": first, "rows": count,
                                                    "blocks": listing.blocks.len() })
        })
        .collect();
    let cutters = part.map(Part::cutters).unwrap_or_default();
    let (tools, marks) = (tools(track.tools(), &cutters), marks(&cutters));
    json!({
        "title": about.title, "model": about.model, "facts": about.facts, "time_s": about.time_s,
        "error": about.error.as_ref().map(remark),
        "warnings": about.warnings.iter().map(remark).collect::<Vec<_>>(),
        "programs": programs, "tools": tools, "marks": marks, "tolerance": track.tolerance_mm(),
        "axes": frame.axes.map(|axis| axis.to_string()), "min": frame.min, "size": frame.size,
        "cells": history.map(|history| history.sheet().columns),
        "removed_mm3": part.map(Part::removed_mm3), "tile": TILE, "whole": WHOLE,
    })
}

/// The tools of a path with the colours in which the part shows them.
pub(crate) fn tools(tools: &[TrackTool], cutters: &[CutBy]) -> Vec<Value> {
    let colour_of = |number: Option<u32>| {
        let cutter = cutters.iter().find(|cutter| cutter.tool == number);
        cutter.map(|cutter| cutter.colours[0])
    };
    let described = |tool: &TrackTool| {
        json!({
            "number": tool.number, "axis": tool.axis.to_string(), "radius": tool.shape.radius,
            "corner": tool.shape.corner_radius, "length": tool.shape.length,
            "point": tool.shape.point_angle_deg, "colour": colour_of(tool.number),
        })
    };
    tools.iter().map(described).collect()
}

/// The marks of cells with their colours.
pub(crate) fn marks(cutters: &[CutBy]) -> Vec<Value> {
    let described =
        |cutter: &CutBy| json!({ "tool": cutter.tool, "marks": cutter.marks, "colours": cutter.colours });
    cutters.iter().map(described).collect()
}

/// A line for each block, in the order of the rows.
fn listing(about: &About) -> String {
    let mut text = String::new();
    let blocks = about.listings.iter().flat_map(|listing| &listing.blocks);
    for block in blocks.take(MOST_ROWS) {
        text.extend(block.chars().map(|c| if c.is_control() { ' ' } else { c }));
        text.push('\n');
    }
    text
}

fn deflated(data: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(data)?;
    encoder.finish()
}
