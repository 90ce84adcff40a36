//! The part as the graphics show it, in half blocks: two pixels one above the other in each cell.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, sync_channel};

use bahn_panel::Picture;
use bahn_service::Operated;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Position, Rect};

use crate::palette::Palette;

/// A view is drawn at this size at least, pixels, and made smaller then: its margins are those of its letters, which
/// have the same size in all smaller pictures.
const LEAST: u32 = 450;
/// From dark to bright, where there are no colours.
const SHADES: [char; 4] = ['░', '▒', '▓', '█'];

/// A picture of so many columns, two pixels in each cell.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Mosaic {
    columns: u16,
    rows: u16,
    /// In rows from the top, twice as many as cells.
    pixels: Vec<[u8; 3]>,
}

impl Mosaic {
    /// A picture made smaller: each pixel is the mean of `factor` x `factor`.
    fn shrunk(columns: u16, rows: u16, factor: u32, large: &[[u8; 3]]) -> Mosaic {
        let factor = factor as usize;
        let width = usize::from(columns) * factor;
        let mean = |x: usize, y: usize| {
            let mut sum = [0_usize; 3];
            for row in 0..factor {
                let from = (y * factor + row) * width + x * factor;
                for pixel in large.get(from..from + factor).unwrap_or_default() {
                    for (sum, part) in sum.iter_mut().zip(pixel) {
                        *sum += usize::from(*part);
                    }
                }
            }
            sum.map(|sum| u8::try_from(sum / (factor * factor)).unwrap_or(u8::MAX))
        };
        let places = (0..2 * usize::from(rows)).flat_map(|y| (0..usize::from(columns)).map(move |x| (x, y)));
        Mosaic {
            columns,
            rows,
            pixels: places.map(|(x, y)| mean(x, y)).collect(),
        }
    }

    fn pixel(&self, column: u16, row: u16) -> Option<[u8; 3]> {
        let place = usize::from(row) * usize::from(self.columns) + usize::from(column);
        (column < self.columns)
            .then(|| self.pixels.get(place).copied())
            .flatten()
    }

    /// Draws it at the upper left corner of an area. What has the colour of its corner is background, and left free.
    pub fn draw(&self, buffer: &mut Buffer, area: Rect, palette: Palette) {
        let area = area.intersection(buffer.area);
        let background = self.pixel(0, 0);
        for row in 0..area.height.min(self.rows) {
            for column in 0..area.width.min(self.columns) {
                let pair = [2 * row, 2 * row + 1].map(|row| self.pixel(column, row));
                let pair = pair.map(|pixel| pixel.filter(|_| pixel != background));
                if let Some(cell) = buffer.cell_mut(Position::new(area.x + column, area.y + row)) {
                    paint_cell(cell, pair, palette);
                }
            }
        }
    }
}

/// Two pixels in a cell; `None` is background.
fn paint_cell(cell: &mut Cell, pair: [Option<[u8; 3]>; 2], palette: Palette) {
    let colour = |pixel: Option<[u8; 3]>| pixel.and_then(|pixel| palette.picture(pixel));
    match (pair, pair.map(colour)) {
        ([None, None], _) => {
            cell.set_char(' ');
        }
        (_, [Some(upper), Some(lower)]) => {
            cell.set_char('▀').set_fg(upper).set_bg(lower);
        }
        (_, [Some(upper), None]) => {
            cell.set_char('▀').set_fg(upper);
        }
        (_, [None, Some(lower)]) => {
            cell.set_char('▄').set_fg(lower);
        }
        ([Some(upper), Some(lower)], _) => {
            cell.set_char(shade(upper, lower));
        }
        // Without colours half a cell has the shade of the other half.
        ([Some(pixel), None] | [None, Some(pixel)], _) => {
            cell.set_char(shade(pixel, pixel));
        }
    }
}

/// How bright a cell is.
fn shade(upper: [u8; 3], lower: [u8; 3]) -> char {
    let bright = |[red, green, blue]: [u8; 3]| {
        // The shares of red, green and blue in what the eye sees, per mille.
        299 * usize::from(red) + 587 * usize::from(green) + 114 * usize::from(blue)
    };
    let mean = (bright(upper) + bright(lower)) / 2000;
    SHADES[(mean * SHADES.len() / 256).min(SHADES.len() - 1)]
}

/// A picture that is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Wanted {
    /// The number of the picture; a new one has a higher one.
    pub serial: u64,
    /// Width, columns of cells.
    pub columns: u16,
    /// Height, rows of cells.
    pub rows: u16,
}

/// Draws pictures on a thread of its own, one at a time.
pub(crate) struct Painter {
    orders: SyncSender<Wanted>,
    painted: Receiver<(Wanted, Option<Mosaic>)>,
    /// What is being drawn.
    busy: bool,
    /// What was drawn last, and what came of it.
    last: Option<(Wanted, Option<Mosaic>)>,
}

impl Painter {
    /// Draws the graphics of a machine.
    pub fn of(machine: Arc<dyn Operated>) -> Painter {
        let (orders, ordered) = sync_channel::<Wanted>(1);
        let (sender, painted) = sync_channel(1);
        // It ends with its orders.
        std::thread::spawn(move || {
            for wanted in ordered {
                if sender.send((wanted, paint(machine.as_ref(), wanted))).is_err() {
                    return;
                }
            }
        });
        Painter {
            orders,
            painted,
            busy: false,
            last: None,
        }
    }

    /// Asks for a picture unless it is there or another one is being drawn; whether a new one has come.
    pub fn follow(&mut self, wanted: Option<Wanted>) -> bool {
        let mut news = false;
        match self.painted.try_recv() {
            Ok(painted) => {
                self.last = Some(painted);
                self.busy = false;
                news = true;
            }
            Err(TryRecvError::Empty | TryRecvError::Disconnected) => {}
        }
        let is_there = |wanted: &Wanted| self.last.as_ref().is_some_and(|(last, _)| last == wanted);
        if let Some(wanted) = wanted.filter(|wanted| !self.busy && !is_there(wanted)) {
            self.busy = self.orders.try_send(wanted).is_ok();
        }
        news
    }

    /// The picture that was drawn last.
    pub fn last(&self) -> Option<&Mosaic> {
        self.last.as_ref()?.1.as_ref()
    }
}

/// Draws what the graphics show now.
fn paint(machine: &dyn Operated, wanted: Wanted) -> Option<Mosaic> {
    mosaic(&machine.picture().ok()??, wanted)
}

/// A picture in so many cells.
pub(crate) fn mosaic(picture: &Picture, wanted: Wanted) -> Option<Mosaic> {
    let (width, height) = (u32::from(wanted.columns), 2 * u32::from(wanted.rows));
    if width == 0 || height == 0 {
        return None;
    }
    let factor = LEAST.div_ceil(width.min(height));
    let pixels = picture.pixels(factor * width, factor * height).ok()??;
    Some(Mosaic::shrunk(wanted.columns, wanted.rows, factor, &pixels))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::style::Color;

    #[test]
    fn a_cell_has_the_mean_of_two_squares() {
        // Three columns and one row of cells from 9 x 6 pixels: white, black and white above, greys below.
        let large: Vec<[u8; 3]> = (0..54)
            .map(|place| match (place / 9 < 3, place % 9 / 3) {
                (true, 1) => [0; 3],
                (true, _) => [255; 3],
                (false, 2) => [255; 3],
                (false, _) => [if place % 2 == 0 { 90 } else { 110 }; 3],
            })
            .collect();
        let mosaic = Mosaic::shrunk(3, 1, 3, &large);
        // Of nine numbers of which every other is even there are four or five.
        let mean = |bright: usize| [u8::try_from((bright * 110 + (9 - bright) * 90) / 9).unwrap(); 3];
        let below = [mean(5), mean(4)];
        assert!(mosaic.pixels[3] == below[0] || mosaic.pixels[3] == below[1]);
        assert_eq!(mosaic.pixels[..3], [[255; 3], [0; 3], [255; 3]]);
        assert_eq!(mosaic.pixels[5], [255; 3]);
        let grey = |place: usize| {
            let [part, ..] = mosaic.pixels[place];
            Color::Rgb(part, part, part)
        };
        let mut buffer = Buffer::empty(Rect::new(0, 0, 4, 2));
        mosaic.draw(&mut buffer, Rect::new(1, 1, 3, 1), Palette::True);
        // White is the background.
        let cells =
            [(0, 1), (1, 1), (2, 1), (3, 1)].map(|at| (buffer[at].symbol(), buffer[at].fg, buffer[at].bg));
        assert_eq!(
            cells,
            [
                (" ", Color::Reset, Color::Reset),
                ("▄", grey(3), Color::Reset),
                ("▀", Color::Rgb(0, 0, 0), grey(4)),
                (" ", Color::Reset, Color::Reset),
            ]
        );
        mosaic.draw(&mut buffer, Rect::new(1, 0, 3, 1), Palette::Plain);
        // 100 of 255, and the mean of 0 and 100.
        assert_eq!(
            [(1, 0), (2, 0), (3, 0)].map(|at| buffer[at].symbol()),
            ["▒", "░", " "]
        );
        // What is smaller than the picture has its upper left part.
        mosaic.draw(&mut buffer, Rect::new(0, 0, 1, 1), Palette::True);
        assert_eq!(buffer[(0, 0)].symbol(), "▄");
    }
}
