//! A touch probe in the spindle and the solids that it can touch.

use crate::reader::Section;

/// A box with faces parallel to the axes, in positions of the axes X, Y and Z.
#[derive(Clone, Copy, Debug)]
struct Solid {
    min: [f64; 3],
    max: [f64; 3],
}

/// See the module. The tip is a ball; its centre is `length` below the reference point of the spindle,
/// minus its radius.
#[derive(Clone, Debug)]
pub(crate) struct Probe {
    length: f64,
    radius: f64,
    offset: [f64; 2],
    solids: Vec<Solid>,
    pub inserted: bool,
    pub ready: bool,
    pub battery_low: bool,
    /// It says that it is deflected whatever it touches.
    pub early: bool,
}

impl Probe {
    /// Reads `[probe]`.
    pub fn read(section: Section) -> Probe {
        let solids = section.list("solid").into_iter().map(|section| {
            let min = section.numbers::<3>("min");
            let max = section.numbers::<3>("max");
            if let (Some(min), Some(max)) = (min, max) {
                if min.iter().zip(&max).any(|(min, max)| min >= max) {
                    section.fault("min lies below max in X, Y and Z".to_owned());
                }
            } else {
                section.fault("a solid needs min and max".to_owned());
            }
            section.finish();
            Solid {
                min: min.unwrap_or_default(),
                max: max.unwrap_or_default(),
            }
        });
        let probe = Probe {
            solids: solids.collect(),
            length: section.needed_number("length", 0.0..=1000.0),
            radius: section.needed_number("radius", 0.0..=100.0),
            offset: section.numbers("offset").unwrap_or_default(),
            inserted: section.flag("inserted").unwrap_or(false),
            ready: true,
            battery_low: false,
            early: false,
        };
        section.finish();
        probe
    }

    /// Whether the ball touches a solid with the axes X, Y, Z at a position.
    pub fn deflected(&self, [x, y, z]: [f64; 3]) -> bool {
        let centre = [
            x + self.offset[0],
            y + self.offset[1],
            z - self.length + self.radius,
        ];
        let distance_squared = |solid: &Solid| {
            let ends = solid.min.iter().zip(&solid.max);
            centre
                .iter()
                .zip(ends)
                .map(|(at, (min, max))| (at - at.clamp(*min, *max)).powi(2))
                .sum::<f64>()
        };
        self.inserted
            && self
                .solids
                .iter()
                .any(|solid| distance_squared(solid) <= self.radius * self.radius)
    }
}
