//! Many segments at once, shared out to the cores by bands of rows.

use std::ops::Range;

use pulp::Simd;
use rayon::prelude::*;

use crate::cutters::Mark;
use crate::grid::Grid;
use crate::raster::{BAND_ROWS, GROUP, least};
use crate::round::List;
use crate::track::{ColumnByColumn, Segment, Sink, Start, Track};

/// A rapid traverse is reported when it is deeper in the material than this (inferred), mm.
const RAPID_CUT_MM: f32 = 0.002;

/// Segments that wait to be cut.
#[derive(Clone, Debug, Default)]
pub(crate) struct Batch {
    segments: Vec<Segment>,
    /// Segments that are looked at for a cut in rapid traverse.
    rapid: Vec<bool>,
    /// The tracks of the segments.
    tracks: Vec<Track>,
    /// What the columns that a segment cuts are marked with; 0 when nobody asks.
    marks: Vec<u8>,
    bands: Vec<Vec<u32>>,
}

impl Batch {
    pub fn len(&self) -> usize {
        self.segments.len()
    }

    pub fn push(&mut self, mut segment: Segment, rapid: bool, mark: u8) {
        // A cut that is looked for must be there when its segment is cut, and not before.
        if let (Some(last), Some(false), false) = (self.segments.last_mut(), self.rapid.last(), rapid)
            && segment.start == Start::Cut
            && self.marks.last() == Some(&mark)
        {
            last.share_end(&mut segment);
        }
        self.segments.push(segment);
        self.rapid.push(rapid);
        self.marks.push(mark);
    }

    /// Cuts all segments in their order and forgets them. The answer says which rapid segments
    /// removed material, by index. `marked` keeps a mark for each column, when it is asked for.
    pub fn cut(&mut self, grid: &Grid, heights: &mut [f32], marked: Option<&mut [u8]>) -> Vec<u32> {
        self.bands.resize_with(grid.ny.div_ceil(BAND_ROWS), Vec::new);
        for (index, segment) in self.segments.iter().enumerate() {
            let rows = segment.rows(grid);
            if !rows.is_empty() {
                for band in self
                    .bands
                    .iter_mut()
                    .take(rows.end.div_ceil(BAND_ROWS))
                    .skip(rows.start / BAND_ROWS)
                {
                    band.push(index as u32);
                }
            }
        }
        self.segments
            .par_iter()
            .map(|segment| Track::new(segment, grid))
            .collect_into_vec(&mut self.tracks);
        let (segments, rapid, marks, tracks) = (&self.segments, &self.rapid, &self.marks, &self.tracks);
        let mut marked = marked.map(|marked| marked.chunks_mut(BAND_ROWS * grid.nx));
        let marked: Vec<Option<&mut [u8]>> = (0..self.bands.len())
            .map(|_| marked.as_mut().and_then(Iterator::next))
            .collect();
        let mut hits: Vec<u32> = heights
            .par_chunks_mut(BAND_ROWS * grid.nx)
            .zip(self.bands.par_iter_mut())
            .zip(marked)
            .enumerate()
            .filter(|(_, ((_, todo), _))| !todo.is_empty())
            .flat_map_iter(|(band, ((cells, todo), mut marked))| {
                let first = band * BAND_ROWS;
                let rows = first..(first + BAND_ROWS).min(grid.ny);
                let (mut hits, mut list) = (Vec::new(), List::default());
                for index in todo.drain(..) {
                    let at = index as usize;
                    let (Some(segment), Some(rapid), Some(track)) =
                        (segments.get(at), rapid.get(at), tracks.get(at))
                    else {
                        continue;
                    };
                    let rows = segment.rows_in(grid, &rows);
                    let before = at.checked_sub(1).and_then(|before| tracks.get(before));
                    let hit = *rapid && is_rapid_cut(segment, grid, rows.clone(), cells, first);
                    if hit {
                        hits.push(index);
                    }
                    // A wall that is passed too near is no cut in rapid traverse.
                    if let (true, Some(marked), Some(mark)) = (hit || !*rapid, &mut marked, marks.get(at)) {
                        let mut sink = Mark {
                            cells: &*cells,
                            marks: marked,
                            width: grid.nx,
                            first_row: first,
                            mark: *mark,
                        };
                        track.sweep(before, grid, rows.clone(), &mut list, &mut sink);
                    }
                    let mut cut = Cut {
                        cells: &mut *cells,
                        width: grid.nx,
                        first_row: first,
                    };
                    track.sweep(before, grid, rows, &mut list, &mut cut);
                }
                hits
            })
            .collect();
        self.segments.clear();
        self.rapid.clear();
        self.marks.clear();
        hits.sort_unstable();
        hits.dedup();
        hits
    }
}

fn is_rapid_cut(segment: &Segment, grid: &Grid, rows: Range<usize>, cells: &[f32], first_row: usize) -> bool {
    let mut detect = Detect {
        cells,
        width: grid.nx,
        first_row,
        found: false,
    };
    let thinner = Segment {
        tool: segment.tool.thinner(grid),
        ..*segment
    };
    let rows = thinner.rows_in(grid, &rows);
    Track::new(&thinner, grid).sweep(None, grid, rows, &mut List::default(), &mut detect);
    detect.found
}

/// Lowers the columns to the tool.
struct Cut<'a> {
    cells: &'a mut [f32],
    width: usize,
    first_row: usize,
}

impl Sink for Cut<'_> {
    #[inline(always)]
    fn level(&mut self, row: usize, columns: Range<usize>, height: f32) {
        let start = (row - self.first_row) * self.width;
        for cell in self
            .cells
            .get_mut(start + columns.start..start + columns.end)
            .unwrap_or_default()
        {
            *cell = if height < *cell { height } else { *cell };
        }
    }

    #[inline(always)]
    fn shaped(&mut self, row: usize, columns: Range<usize>, height: impl Fn(f32) -> f32) {
        let start = (row - self.first_row) * self.width;
        let cells = self
            .cells
            .get_mut(start + columns.start..start + columns.end)
            .unwrap_or_default();
        for (k, cell) in cells.iter_mut().enumerate() {
            let height = height(k as i32 as f32);
            *cell = if height < *cell { height } else { *cell };
        }
    }

    #[inline(always)]
    fn group<S: Simd>(&mut self, simd: S, row: usize, columns: Range<usize>, heights: [f32; GROUP]) {
        let start = (row - self.first_row) * self.width + columns.start;
        let cells = self.cells.get_mut(start..).unwrap_or_default();
        match cells.first_chunk_mut::<GROUP>() {
            Some(cells) if columns.len() == GROUP => {
                let ((cells, _), (heights, _)) = (S::as_mut_simd_f32s(cells), S::as_simd_f32s(&heights));
                for (cell, height) in cells.iter_mut().zip(heights) {
                    *cell = simd.min_f32s(*height, *cell);
                }
            }
            _ => {
                for (cell, height) in cells.iter_mut().zip(heights).take(columns.len()) {
                    *cell = least(height, *cell);
                }
            }
        }
    }
}

/// Finds out whether any column is higher than the tool.
struct Detect<'a> {
    cells: &'a [f32],
    width: usize,
    first_row: usize,
    found: bool,
}

impl ColumnByColumn for Detect<'_> {
    fn each(&mut self, row: usize, columns: Range<usize>, heights: impl Iterator<Item = f32>) {
        if self.found {
            return;
        }
        let start = (row - self.first_row) * self.width;
        let cells = self
            .cells
            .get(start + columns.start..start + columns.end)
            .unwrap_or_default();
        self.found = cells
            .iter()
            .zip(heights)
            .any(|(cell, height)| *cell > height + RAPID_CUT_MM);
    }
}
