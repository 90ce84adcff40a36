//! The PLC window of the screen [000:15247-15326].

/// Two lines of text, each perhaps with a bar chart in its left half.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PlcWindow {
    lines: [Line; PlcWindow::LINES],
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Line {
    cells: [Cell; PlcWindow::COLUMNS],
    bar: Option<Bar>,
}

impl Default for Line {
    fn default() -> Line {
        Line {
            cells: [Cell {
                character: b' ',
                colour: 0,
            }; PlcWindow::COLUMNS],
            bar: None,
        }
    }
}

/// A character of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// The character; `^` for one that cannot be shown.
    pub character: u8,
    /// 1 to 15; 0 for the colour of the character to the left.
    pub colour: u8,
}

/// A bar chart [000:15312-15326].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bar {
    /// Length of the grid in units, with a tick every 10 units.
    pub maximum: u32,
    /// Length of the bar in units.
    pub current: u32,
    /// Colour of the bar, 0 to 15.
    pub bar_colour: u8,
    /// Colour of margin and scale, 0 to 15.
    pub scale_colour: u8,
}

impl Bar {
    /// Longest grid in units [000:15322].
    pub const MAXIMUM: u32 = 150;

    /// Limits both lengths [000:15322].
    pub fn new(maximum: u32, current: u32, bar_colour: u8, scale_colour: u8) -> Bar {
        let maximum = maximum.min(Bar::MAXIMUM);
        Bar {
            maximum,
            current: current.min(maximum),
            bar_colour,
            scale_colour,
        }
    }
}

/// Whether the window is to be seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WindowView {
    /// The selected screen shows it.
    pub displayed: bool,
    /// That screen is in the foreground.
    pub in_foreground: bool,
}

impl PlcWindow {
    /// Lines of the window.
    pub const LINES: usize = 2;
    /// Characters of a line.
    pub const COLUMNS: usize = 38;
    /// Where text begins in a line with a bar chart: 19 characters remain [000:15318].
    pub(crate) const COLUMNS_OF_BAR: usize = 19;

    /// The characters of a line as they are shown: each has its colour. Characters with colour 0 have that
    /// of the character to their left [000:15285]; at the start of a line that is not defined and
    /// stays 0. In a line with a bar chart the text shows in the right half only.
    pub fn line(&self, line: usize) -> Vec<Cell> {
        let Some(line) = self.lines.get(line) else {
            return Vec::new();
        };
        let mut last = 0;
        let mut shown = Vec::with_capacity(PlcWindow::COLUMNS);
        for (column, cell) in line.cells.iter().enumerate() {
            last = if cell.colour == 0 { last } else { cell.colour };
            let hidden = line.bar.is_some() && column < PlcWindow::COLUMNS_OF_BAR;
            shown.push(Cell {
                character: if hidden { b' ' } else { cell.character },
                colour: last,
            });
        }
        shown
    }

    /// The text of a line as it is shown.
    pub fn text(&self, line: usize) -> String {
        let cells = self.line(line);
        cells.iter().map(|cell| char::from(cell.character)).collect()
    }

    /// The bar chart of a line.
    pub fn bar(&self, line: usize) -> Option<Bar> {
        self.lines.get(line)?.bar
    }

    pub(crate) fn clear(&mut self) {
        *self = PlcWindow::default();
    }

    pub(crate) fn write(&mut self, line: usize, column: usize, colour: u8, text: &[u8]) {
        let cells = self.lines.get_mut(line).map(|line| line.cells.iter_mut());
        for (cell, character) in cells.into_iter().flatten().skip(column).zip(text) {
            let shown = matches!(character, b' '..=b'~');
            *cell = Cell {
                character: if shown { *character } else { b'^' },
                colour,
            };
        }
    }

    pub(crate) fn show_bar(&mut self, line: usize, bar: Bar) {
        if let Some(line) = self.lines.get_mut(line) {
            line.bar = Some(bar);
        }
    }
}
