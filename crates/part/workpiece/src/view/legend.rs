//! Heights as colours, and the legend that says which.

use std::collections::BTreeSet;

use super::Area;
use super::scale::{number, round_step};
use super::scheme::Pens;
use crate::part::Part;
use bahn_picture::{Anchor, text_width};
use bahn_picture::{Colour, Image, mix};

/// A part with no more depths than this has one field of the legend for each (inferred).
const FEW_DEPTHS: usize = 10;

/// Heights that differ by less are one depth, mm.
const SAME_DEPTH_MM: f32 = 0.002;

/// Colours by depth between the highest and the deepest point that is not cut through (inferred).
pub(super) struct DepthShade {
    /// The colour of the upper face; the standard scale without.
    top: Option<Colour>,
    scale: Scale,
    /// The height of the lower face of the blank, mm.
    zero: f64,
    axis: String,
    /// Whether nothing is left somewhere.
    holes: bool,
}

/// Heights over the lower face, mm, from high to low.
enum Scale {
    /// Few depths, a colour each: highest and lowest of what counts as one.
    Depths(Vec<[f32; 2]>),
    /// Levels of equal share, and the highest and lowest column of each; the upper face alone is the first.
    Levels(Range, Vec<Option<[f32; 2]>>),
    Continuous(Range),
}

/// Heights between which the colours are shared out.
#[derive(Clone, Copy)]
struct Range {
    top: f32,
    deepest: f32,
}

impl Range {
    /// 0 at the top, 1 at the deepest point.
    fn depth(self, height: f32) -> f64 {
        let range = f64::from(self.top - self.deepest);
        if range > 0.0 {
            f64::from(self.top - height) / range
        } else {
            0.0
        }
    }

    fn level(self, height: f32, levels: usize) -> usize {
        let depth = self.depth(height);
        if depth <= 1e-6 {
            0
        } else {
            let rest = (levels - 1) as f64;
            (depth * rest - 1e-6).ceil().clamp(1.0, rest) as usize
        }
    }
}

impl DepthShade {
    /// `levels` of brightness where the depths are many; 0 for a continuous scale.
    pub fn new(part: &Part, levels: u8, top: Option<Colour>) -> DepthShade {
        let left = || part.heights.iter().copied().filter(|height| *height > 0.0);
        let range = Range {
            top: part.top(),
            deepest: left().fold(part.top(), f32::min),
        };
        let scale = if levels == 0 {
            Scale::Continuous(range)
        } else if let Some(depths) = few_depths(left()) {
            Scale::Depths(depths)
        } else {
            let count = usize::from(levels.max(2));
            let mut found: Vec<Option<[f32; 2]>> = vec![None; count];
            for height in left() {
                if let Some(found) = found.get_mut(range.level(height, count)) {
                    let [high, low] = found.unwrap_or([height; 2]);
                    *found = Some([high.max(height), low.min(height)]);
                }
            }
            Scale::Levels(range, found)
        };
        DepthShade {
            scale,
            top,
            zero: part.min()[2],
            axis: part.axes()[2].to_string(),
            holes: part.heights.iter().any(|height| *height <= 0.0),
        }
    }

    /// Colour in which this height is drawn, mm above the lower face of the blank.
    pub fn colour(&self, height: f32) -> Colour {
        let part = |k: usize, count: usize| k as f64 / count.saturating_sub(1).max(1) as f64;
        let share = match &self.scale {
            Scale::Continuous(range) => range.depth(height),
            Scale::Levels(range, found) => part(range.level(height, found.len()), found.len()),
            Scale::Depths(depths) => {
                let above = depths.partition_point(|[_, low]| *low > height + 0.5 * SAME_DEPTH_MM);
                part(above.min(depths.len().saturating_sub(1)), depths.len())
            }
        };
        self.top
            .map_or_else(|| gradient(share), |top| mix(top, [0; 3], DARKEST * share))
    }

    /// The legend: a field for each depth or level that the part has, with its true heights.
    pub fn legend(&self) -> Legend {
        let mut fields: Vec<(Swatch, String)> = match &self.scale {
            Scale::Depths(depths) => {
                let step = decimals(depths.iter().map(|[high, _]| self.zero + f64::from(*high)));
                let field = |[high, _]: &[f32; 2]| {
                    let text = number(self.zero + f64::from(*high), step);
                    (Swatch::Plain(self.colour(*high)), text)
                };
                depths.iter().map(field).collect()
            }
            Scale::Levels(range, found) => {
                let step = round_step(f64::from(range.top - range.deepest) / 100.0).min(0.1);
                let field = |[high, low]: [f32; 2]| {
                    let ends = [high, low].map(|height| number(self.zero + f64::from(height), step));
                    let text = if ends[0] == ends[1] {
                        ends[0].clone()
                    } else {
                        ends.join(" … ")
                    };
                    (Swatch::Plain(self.colour(low)), text)
                };
                found.iter().copied().flatten().map(field).collect()
            }
            Scale::Continuous(range) => {
                const LABELS: u32 = 7;
                let tall = range.top - range.deepest;
                let step = round_step(f64::from(tall) / 100.0).min(0.1);
                let count = if tall > 0.0 { LABELS } else { 1 };
                let field = |k: u32| {
                    let height = range.top - tall * k as f32 / (LABELS - 1) as f32;
                    let from = |offset: f32| {
                        let share = (k as f32 + offset) / (LABELS - 1) as f32;
                        gradient(f64::from(share))
                    };
                    let text = number(self.zero + f64::from(height), step);
                    (Swatch::Blend(from(-0.5), from(0.5)), text)
                };
                (0..count).map(field).collect()
            }
        };
        if self.holes {
            fields.push((Swatch::Hatched, "through".to_owned()));
        }
        Legend {
            title: format!("{} mm", self.axis),
            fields,
        }
    }
}

/// The depths of a part from high to low, when they are few.
fn few_depths(heights: impl Iterator<Item = f32>) -> Option<Vec<[f32; 2]>> {
    // Heights above 0 are in the order of their bits.
    let mut found = BTreeSet::new();
    let mut last = None;
    for height in heights {
        if last != Some(height) && found.insert(height.to_bits()) && found.len() > 16 * FEW_DEPTHS {
            return None;
        }
        last = Some(height);
    }
    let mut depths: Vec<[f32; 2]> = Vec::new();
    for height in found.into_iter().rev().map(f32::from_bits) {
        match depths.last_mut() {
            Some([high, low]) if *high - height < SAME_DEPTH_MM => *low = height,
            _ => depths.push([height; 2]),
        }
    }
    (depths.len() <= FEW_DEPTHS).then_some(depths)
}

/// The step that writes all values to 0.01 mm without needless zeros.
fn decimals(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let whole = |step: f64| {
        values
            .clone()
            .all(|value| ((value / step).round() * step - value).abs() < 0.005)
    };
    [1.0, 0.1].into_iter().find(|step| whole(*step)).unwrap_or(0.01)
}

/// What a field of a legend looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Swatch {
    Plain(Colour),
    /// From one colour above to another one below.
    Blend(Colour, Colour),
    /// Hatched: the tool went through the part.
    Hatched,
}

/// Fields of colour, each with what it means.
pub(super) struct Legend {
    pub title: String,
    pub fields: Vec<(Swatch, String)>,
}

impl Legend {
    /// Width of the fields, in heights of the text.
    const FIELD: f64 = 1.6;
    const GAP: f64 = 0.6;

    /// Width at a size of text, pixels.
    pub fn width(&self, size: f64) -> f64 {
        let widest = self
            .fields
            .iter()
            .map(|(_, text)| text_width(text, size))
            .fold(0.0, f64::max);
        (widest + (Legend::FIELD + Legend::GAP) * size).max(text_width(&self.title, size))
    }

    /// Height of the title and the fields at a size of text, at most that of the area.
    fn tall(&self, size: f64, room: f64) -> [f64; 2] {
        let title = 1.6 * size;
        let each = (room - title) / self.fields.len().max(1) as f64;
        [title, each.clamp(1.0, 2.2 * size)]
    }

    /// Draws it in an area, no higher than it must be; `top` is where it begins when there is room.
    pub fn draw(&self, image: &mut Image, area: &Area, top: f64, size: f64, pens: Pens) {
        let [title, each] = self.tall(size, area.size()[1]);
        let height = title + each * self.fields.len() as f64;
        let top = top.min(area.max[1] - height).max(area.min[1]);
        let left = area.min[0].round();
        let right = (left + Legend::FIELD * size).round();
        let text_size = size.min(each / 1.15);
        image.text(
            [left, top + 0.5 * size],
            Anchor::Left,
            size,
            pens.ink,
            &self.title,
        );
        for (k, (swatch, text)) in self.fields.iter().enumerate() {
            let y = [k, k + 1].map(|k| (top + title + k as f64 * each).round());
            swatch.fill(image, [left, y[0]], [right, y[1]], pens.background);
            image.outline(&rectangle([left, y[0]], [right, y[1]]), 1.0, pens.faint);
            let at = [right + Legend::GAP * size, 0.5 * (y[0] + y[1])];
            image.text(at, Anchor::Left, text_size, pens.ink, text);
        }
    }
}

impl Swatch {
    fn fill(self, image: &mut Image, min: [f64; 2], max: [f64; 2], background: Colour) {
        let rows = (max[1] - min[1]).max(1.0);
        for y in min[1] as i64..max[1] as i64 {
            for x in min[0] as i64..max[0] as i64 {
                let colour = match self {
                    Swatch::Plain(colour) => colour,
                    Swatch::Blend(above, below) => mix(above, below, (y as f64 + 0.5 - min[1]) / rows),
                    Swatch::Hatched => hatched((x + y) as usize, background),
                };
                image.blend(x, y, colour, 1.0);
            }
        }
    }
}

fn rectangle([left, top]: [f64; 2], [right, bottom]: [f64; 2]) -> [[f64; 2]; 5] {
    [
        [left, top],
        [right, top],
        [right, bottom],
        [left, bottom],
        [left, top],
    ]
}

/// Hatching where nothing is left, by the count of pixels along a diagonal.
pub(super) fn hatched(stripe: usize, background: Colour) -> Colour {
    if stripe % 8 < 2 {
        THROUGH_STRIPE
    } else {
        background
    }
}

/// From the light skin of the blank to a dark, deep blue: even steps of brightness.
fn gradient(share: f64) -> Colour {
    const STOPS: [Colour; 5] = [
        [236, 239, 242],
        [174, 199, 222],
        [107, 152, 192],
        [52, 99, 145],
        [20, 46, 84],
    ];
    let place = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let k = (place as usize).min(STOPS.len() - 2);
    mix(STOPS[k], STOPS[k + 1], place - k as f64)
}

/// How dark the deepest point is, where the upper face has a colour of its own.
const DARKEST: f64 = 0.75;
const THROUGH_STRIPE: Colour = [224, 168, 120];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Resolution, Workpiece};
    use bahn_path::{Blank, Plane};

    fn brightness(colour: Colour) -> u32 {
        colour.into_iter().map(u32::from).sum()
    }

    /// 7 mm thick, from Z-7 to Z0, with columns of these heights over the lower face.
    fn part(heights: &[f32]) -> Part {
        let blank = Blank {
            plane: Plane::XY,
            min: [0.0, 0.0, -7.0],
            max: [heights.len() as f64, 1.0, 0.0],
        };
        let mut part = Workpiece::new(&blank, Resolution::Millimetres(1.0))
            .unwrap()
            .finished();
        part.heights.copy_from_slice(heights);
        part
    }

    fn labels(heights: &[f32], levels: u8) -> Vec<String> {
        let legend = DepthShade::new(&part(heights), levels, None).legend();
        legend.fields.into_iter().map(|(_, text)| text).collect()
    }

    /// Every 0.5 mm from 7 mm to 1 mm: 13 depths are not few.
    fn staircase() -> Vec<f32> {
        (0..13).map(|k| 7.0 - 0.5 * k as f32).collect()
    }

    #[test]
    fn deeper_is_darker() {
        for (levels, heights) in [(0, staircase()), (7, vec![7.0, 6.9, 4.0, 1.0]), (13, staircase())] {
            let shade = DepthShade::new(&part(&heights), levels, None);
            let colours: Vec<u32> = heights.iter().map(|h| brightness(shade.colour(*h))).collect();
            assert!(colours.windows(2).all(|pair| pair[0] > pair[1]), "{colours:?}");
        }
    }

    #[test]
    fn few_depths_have_a_field_each() {
        let heights = [7.0, 6.9, 4.0, 1.0, 0.0, 4.0, 4.0004];
        assert_eq!(labels(&heights, 7), ["0", "−0.1", "−3.0", "−6.0", "through"]);
        assert_eq!(labels(&[7.0, 2.0], 7), ["0", "−5"]);
        // The upper face is gone: it has no field.
        assert_eq!(labels(&[6.75, 2.0], 7), ["−0.25", "−5.00"]);
    }

    /// The deepest point that is left is 6 mm deep; the upper face alone is the first of 7 levels, so
    /// each of the others holds 1 mm: with steps of 0.5 mm two of them.
    #[test]
    fn ranges_are_those_of_the_part() {
        let whole = [
            "0",
            "−0.5 … −1.0",
            "−1.5 … −2.0",
            "−2.5 … −3.0",
            "−3.5 … −4.0",
            "−4.5 … −5.0",
            "−5.5 … −6.0",
        ];
        assert_eq!(labels(&staircase(), 7), whole);
    }

    #[test]
    fn levels_without_columns_have_no_field() {
        // 11 depths in the first and the last millimetre only.
        let heights: Vec<f32> = (0..10).map(|k| 6.9 - 0.1 * k as f32).chain([1.0]).collect();
        assert_eq!(labels(&heights, 7), ["−0.1 … −1.0", "−6.0"]);
    }
}
