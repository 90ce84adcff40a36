//! A touch probe in the spindle and the solids that it can touch.

use crate::reader::Section;

/// A box in positions of the axes X, Y and Z; it is turned about the edge at its least X and Y.
#[derive(Clone, Copy, Debug)]
struct Solid {
    min: [f64; 3],
    max: [f64; 3],
    /// Sine and cosine of the angle.
    turned: Option<[f64; 2]>,
}

impl Solid {
    /// Square of the distance of a point, mm².
    fn distance_squared(&self, [x, y, z]: [f64; 3]) -> f64 {
        let at = match self.turned {
            None => [x, y, z],
            Some([sin, cos]) => {
                let [left, front, _] = self.min;
                let (dx, dy) = (x - left, y - front);
                [left + dx * cos + dy * sin, front - dx * sin + dy * cos, z]
            }
        };
        let ends = self.min.iter().zip(&self.max);
        at.iter()
            .zip(ends)
            .map(|(at, (min, max))| (at - at.clamp(*min, *max)).powi(2))
            .sum()
    }
}

/// A ring that stands upright; a stud when its inner radius is 0.
#[derive(Clone, Copy, Debug)]
struct Ring {
    centre: [f64; 2],
    radii: [f64; 2],
    z: [f64; 2],
}

impl Ring {
    fn distance_squared(&self, [x, y, z]: [f64; 3]) -> f64 {
        let from_centre = (x - self.centre[0]).hypot(y - self.centre[1]);
        let [inner, outer] = self.radii;
        let [low, high] = self.z;
        (from_centre - from_centre.clamp(inner, outer)).powi(2) + (z - z.clamp(low, high)).powi(2)
    }
}

/// See the module. The tip is a ball; its centre is `length` below the reference point of the spindle,
/// minus its radius.
#[derive(Clone, Debug)]
pub(crate) struct Probe {
    length: f64,
    radius: f64,
    /// How far the ball stands beside the axis of the spindle as it was inserted.
    offset: [f64; 2],
    /// The angle of the spindle when it was inserted, degrees.
    inserted_at_deg: f64,
    solids: Vec<Solid>,
    rings: Vec<Ring>,
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
            let angle = section.number("angle", -180.0..=180.0).map(f64::to_radians);
            section.finish();
            Solid {
                turned: angle.map(|angle| [angle.sin(), angle.cos()]),
                min: min.unwrap_or_default(),
                max: max.unwrap_or_default(),
            }
        });
        let rings = section.list("ring").into_iter().map(|section| {
            let given = (
                section.numbers("centre"),
                section.numbers("radii"),
                section.numbers("z"),
            );
            let (Some(centre), Some(radii), Some(z)) = given else {
                section.fault("a ring needs centre, radii and z".to_owned());
                return None;
            };
            let ring = Ring { centre, radii, z };
            if ring.radii[0] < 0.0 || ring.radii[0] >= ring.radii[1] || ring.z[0] >= ring.z[1] {
                section.fault(
                    "the inner radius lies below the outer one, the lower end below the upper one".to_owned(),
                );
            }
            section.finish();
            Some(ring)
        });
        let probe = Probe {
            rings: rings.flatten().collect(),
            solids: solids.collect(),
            length: section.needed_number("length", 0.0..=1000.0),
            radius: section.needed_number("radius", 0.0..=100.0),
            inserted_at_deg: 0.0,
            offset: section.numbers("offset").unwrap_or_default(),
            inserted: section.flag("inserted").unwrap_or(false),
            ready: true,
            battery_low: false,
            early: false,
        };
        section.finish();
        probe
    }

    /// Puts it into the spindle at an angle, degrees, or takes it out.
    pub fn insert(&mut self, inserted: bool, spindle_deg: f64) {
        self.inserted = inserted;
        self.inserted_at_deg = spindle_deg;
    }

    /// How far the ball stands beside the axis of the spindle, which turns it.
    fn beside(&self, spindle_deg: f64) -> [f64; 2] {
        let [x, y] = self.offset;
        let turned = spindle_deg - self.inserted_at_deg;
        if turned == 0.0 || self.offset == [0.0; 2] {
            return self.offset;
        }
        let (sin, cos) = turned.to_radians().sin_cos();
        [x * cos - y * sin, x * sin + y * cos]
    }

    /// Whether the ball touches a solid with the axes X, Y, Z at a position and the spindle at an angle, degrees.
    pub fn deflected(&self, [x, y, z]: [f64; 3], spindle_deg: f64) -> bool {
        let beside = self.beside(spindle_deg);
        let centre = [x + beside[0], y + beside[1], z - self.length + self.radius];
        let touches = self.radius * self.radius;
        self.inserted
            && (self
                .solids
                .iter()
                .any(|solid| solid.distance_squared(centre) <= touches)
                || self
                    .rings
                    .iter()
                    .any(|ring| ring.distance_squared(centre) <= touches))
    }
}
