//! The part from above, coloured by how far it is from what it was to be.

use super::legend::{Legend, Swatch};
use super::plan::{frame, rulers};
use super::{Area, Page, fit};
use crate::deviation::Deviation;
use crate::part::Part;
use bahn_picture::{Colour, Image, mix};

/// What is as it was to be, what is left, what is missing.
const GOOD: Colour = [222, 226, 222];
const LEFT: Colour = [196, 48, 36];
const MISSING: Colour = [32, 84, 190];
/// Colour where there is nothing to compare.
const NOTHING: Colour = [255, 255, 255];
/// Fields of the legend on each side.
const FIELDS: i32 = 4;

impl Part {
    /// The part seen against the tool axis: red where material is left, blue where too much was removed, full colour at
    /// this deviation, mm, and beyond.
    pub fn deviation_view(&self, page: &Page, deviation: &Deviation, full_mm: f64) -> Image {
        let pens = page.pens();
        let (mut image, area) = page.start(pens.background);
        let size = page.text_size();
        let fields = (-FIELDS..=FIELDS).rev().map(|field| {
            let off = f64::from(field) / f64::from(FIELDS) * full_mm;
            (Swatch::Plain(colour(off, full_mm)), format!("{off:+.3}"))
        });
        let legend = Legend {
            title: "mm off".to_owned(),
            fields: fields.collect(),
        };
        let beside = 3.0 * size;
        let right = beside + legend.width(size) + size;
        let inner = area.shrunk(5.0 * size, 2.5 * size, right, 3.5 * size);
        let drawing = fit([self.setup.size[0], self.setup.size[1]], &inner);
        self.draw_deviation(&mut image, deviation, &drawing, full_mm, pens.background);
        frame(&mut image, &drawing, page);
        rulers(&mut image, self, &drawing, size, pens);
        let room = Area {
            min: [drawing.max[0] + beside, area.min[1] + 0.9 * size],
            max: [area.max[0], area.max[1] - size],
        };
        legend.draw(&mut image, &room, drawing.min[1] - 1.6 * size, size, pens);
        image
    }

    fn draw_deviation(
        &self,
        image: &mut Image,
        deviation: &Deviation,
        drawing: &Area,
        full_mm: f64,
        background: Colour,
    ) {
        let [width, height] = drawing.size();
        let [left, top] = drawing.min.map(|value| value as usize);
        let [sx, sy] = [self.setup.size[0] / width, self.setup.size[1] / height];
        let rows = image.rows_mut().skip(top).take(height as usize).enumerate();
        for (py, row) in rows {
            for (px, pixel) in row.iter_mut().skip(left).take(width as usize).enumerate() {
                let (x, y) = (
                    (px as f64 + 0.5) * sx,
                    self.setup.size[1] - (py as f64 + 0.5) * sy,
                );
                let column = self.grid.cell_at(x, y).map(|(i, j)| j * self.grid.nx + i);
                let off = column.and_then(|place| deviation.columns.get(place));
                *pixel = off.map_or(background, |off| colour(f64::from(*off), full_mm));
            }
        }
    }
}

fn colour(off: f64, full_mm: f64) -> Colour {
    if off.is_nan() {
        return NOTHING;
    }
    let end = if off > 0.0 { LEFT } else { MISSING };
    mix(GOOD, end, (off.abs() / full_mm).min(1.0))
}
