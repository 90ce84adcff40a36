//! Which tool cut every column last, and whether in rapid traverse.

use std::ops::Range;

use crate::track::ColumnByColumn;

/// Kept only for pictures that ask for it: one byte for each column.
#[derive(Clone, Debug)]
pub(crate) struct Cutters {
    /// 0 where nothing was cut.
    pub marks: Vec<u8>,
    /// Tools by the number of their mark less one.
    tools: Vec<Option<u32>>,
    current: u8,
}

/// What a mark says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cutter {
    /// Number of the tool among those that cut, from 0.
    pub index: usize,
    pub rapid: bool,
}

/// A column that is lowered by less keeps its mark: what is rough by rounding is no cut (inferred), mm.
const LEAST_CUT_MM: f32 = 0.002;
/// The bit of a mark that tells rapid traverse.
const RAPID: u8 = 0x80;
/// Tools that are told apart; all others share the last mark.
const MOST_TOOLS: usize = 0x7f;

impl Cutter {
    /// `None` for the mark of an untouched column.
    pub fn of(mark: u8) -> Option<Cutter> {
        Some(Cutter {
            index: usize::from(mark & !RAPID).checked_sub(1)?,
            rapid: mark & RAPID != 0,
        })
    }
}

impl Cutters {
    pub fn new(columns: usize) -> Cutters {
        Cutters {
            marks: vec![0; columns],
            tools: vec![None],
            current: 1,
        }
    }

    /// The tool that cuts from now on.
    pub fn take_tool(&mut self, tool: Option<u32>) {
        let index = match self.tools.iter().position(|known| *known == tool) {
            Some(index) => index,
            None if self.tools.len() < MOST_TOOLS => {
                self.tools.push(tool);
                self.tools.len() - 1
            }
            None => MOST_TOOLS - 1,
        };
        self.current = index as u8 + 1;
    }

    /// The mark of a cut that is made now.
    pub fn mark(&self, rapid: bool) -> u8 {
        self.current | if rapid { RAPID } else { 0 }
    }

    /// Who cut a column last; `None` for an untouched one.
    pub fn at(&self, column: usize) -> Option<Cutter> {
        Cutter::of(*self.marks.get(column)?)
    }

    /// Number of a tool; `None` for what was in the spindle before the first TOOL CALL.
    pub fn tool(&self, index: usize) -> Option<u32> {
        self.tools.get(index).copied().flatten()
    }

    /// All tools that were taken, with their marks in feed and in rapid traverse.
    pub fn known(&self) -> impl Iterator<Item = (Option<u32>, [u8; 2])> {
        (1_u8..)
            .zip(&self.tools)
            .map(|(mark, tool)| (*tool, [mark, mark | RAPID]))
    }

    /// The cutters that left a column, each once, in the order of their first call.
    pub fn seen(&self) -> Vec<Cutter> {
        let mut seen = [false; 256];
        for mark in &self.marks {
            seen[usize::from(*mark)] = true;
        }
        (0..=u8::MAX)
            .zip(seen)
            .filter_map(|(mark, seen)| seen.then(|| Cutter::of(mark)).flatten())
            .collect()
    }

    /// The same for other columns.
    pub fn with_marks(&self, marks: Vec<u8>) -> Cutters {
        Cutters {
            marks,
            ..self.clone()
        }
    }
}

/// Marks the columns that the tool is going to lower.
pub(crate) struct Mark<'a> {
    pub cells: &'a [f32],
    pub marks: &'a mut [u8],
    pub width: usize,
    pub first_row: usize,
    pub mark: u8,
}

impl ColumnByColumn for Mark<'_> {
    fn each(&mut self, row: usize, columns: Range<usize>, heights: impl Iterator<Item = f32>) {
        let start = (row - self.first_row) * self.width;
        let columns = start + columns.start..start + columns.end;
        let cells = self.cells.get(columns.clone()).unwrap_or_default();
        let marks = self.marks.get_mut(columns).unwrap_or_default();
        for ((cell, mark), height) in cells.iter().zip(marks).zip(heights) {
            if height + LEAST_CUT_MM < *cell {
                *mark = self.mark;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_tools_than_marks_share_the_last() {
        let mut cutters = Cutters::new(1);
        for tool in 0..300 {
            cutters.take_tool(Some(tool));
            assert_eq!(cutters.mark(false) & RAPID, 0);
            assert_ne!(cutters.mark(true) & !RAPID, 0);
        }
        cutters.take_tool(Some(0));
        assert_eq!(cutters.mark(false), 2);
    }
}
