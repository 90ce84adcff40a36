//! A touch probe in the spindle and the solids that it can touch.

use std::sync::Arc;

use crate::reader::Section;

/// So much force deflects the stylus of a TM 110 by 1 mm, N [000:7919].
const NEWTON_PER_MM: f64 = 4.0;

/// A solid on the table that is more than boxes and rings: whoever has the workpiece gives it to the machine.
pub trait Solid: Send + Sync + std::fmt::Debug {
    /// Whether the ball with its end at a position of the axes X, Y and Z, mm, touches it.
    fn touches(&self, end: [f64; 3]) -> bool;

    /// How far the ball is pushed out of it there, mm.
    fn deflection(&self, end: [f64; 3]) -> [f64; 3];
}

/// A box in positions of the axes X, Y and Z; it is turned about the edge at its least X and Y.
#[derive(Clone, Copy, Debug)]
struct Cuboid {
    min: [f64; 3],
    max: [f64; 3],
    /// Sine and cosine of the angle.
    turned: Option<[f64; 2]>,
}

impl Cuboid {
    /// How far a ball is pushed out of it, mm: off its nearest face, never down.
    fn pushes(&self, [x, y, z]: [f64; 3], radius: f64) -> [f64; 3] {
        let [sin, cos] = self.turned.unwrap_or([0.0, 1.0]);
        let [left, front, _] = self.min;
        let (dx, dy) = (x - left, y - front);
        let at = [left + dx * cos + dy * sin, front - dx * sin + dy * cos, z];
        let off: [f64; 3] = std::array::from_fn(|k| at[k] - at[k].clamp(self.min[k], self.max[k]));
        let outside = off.iter().map(|part| part * part).sum::<f64>().sqrt();
        let pushed = if outside > radius {
            [0.0; 3]
        } else if outside > 0.0 {
            off.map(|part| part / outside * (radius - outside))
        } else {
            let faces = [
                (0, self.min[0] - at[0]),
                (0, self.max[0] - at[0]),
                (1, self.min[1] - at[1]),
                (1, self.max[1] - at[1]),
                (2, self.max[2] - at[2]),
            ];
            let nearest = faces.into_iter().min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
            let (axis, distance) = nearest.unwrap_or((2, 0.0));
            let sign = if distance < 0.0 { -1.0 } else { 1.0 };
            std::array::from_fn(|k| if k == axis { distance + sign * radius } else { 0.0 })
        };
        let [x, y, z] = pushed;
        [x * cos - y * sin, x * sin + y * cos, z]
    }

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
    /// How far a ball is pushed out of it, mm: off its nearest face, never down.
    fn pushes(&self, [x, y, z]: [f64; 3], radius: f64) -> [f64; 3] {
        let (dx, dy) = (x - self.centre[0], y - self.centre[1]);
        let from_centre = dx.hypot(dy);
        let outwards = if from_centre > 0.0 {
            [dx / from_centre, dy / from_centre]
        } else {
            [1.0, 0.0]
        };
        let ([inner, outer], [low, high]) = (self.radii, self.z);
        let beside = from_centre - from_centre.clamp(inner, outer);
        let above = z - z.clamp(low, high);
        let outside = beside.hypot(above);
        let (along, up) = if outside > radius {
            (0.0, 0.0)
        } else if outside > 0.0 {
            let part = (radius - outside) / outside;
            (beside * part, above * part)
        } else {
            let (out, lift) = (outer - from_centre, high - z);
            let inwards = if inner > 0.0 {
                from_centre - inner
            } else {
                f64::INFINITY
            };
            if lift <= out.min(inwards) {
                (0.0, lift + radius)
            } else if out <= inwards {
                (out + radius, 0.0)
            } else {
                (-inwards - radius, 0.0)
            }
        };
        [outwards[0] * along, outwards[1] * along, up]
    }

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
    solids: Vec<Cuboid>,
    rings: Vec<Ring>,
    workpiece: Option<Arc<dyn Solid>>,
    /// A measuring probe, TM 110: the axis of the machine, from 1, along which each of its own lies, negative when it
    /// counts the other way.
    mounting: Option<[f64; 3]>,
    pub inserted: bool,
    /// The tool number as which it is put into the spindle, and the tool that was there last.
    as_tool: Option<u32>,
    held: u32,
    pub ready: bool,
    pub battery_low: bool,
    /// It says that it is deflected whatever it touches.
    pub early: bool,
    /// What a hand pushes the stylus with along the axes X, Y, Z, N.
    pushed: [f64; 3],
}

impl Probe {
    /// The touch probe as the section `[probe]` of the machine file describes it.
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
            Cuboid {
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
            workpiece: None,
            mounting: measuring(&section),
            length: section.needed_number("length", 0.0..=1000.0),
            radius: section.needed_number("radius", 0.0..=100.0),
            inserted_at_deg: 0.0,
            offset: section.numbers("offset").unwrap_or_default(),
            inserted: section.flag("inserted").unwrap_or(false),
            as_tool: section.number("tool", 1.0..=32_767.0).map(|number| number as u32),
            held: 0,
            ready: true,
            battery_low: false,
            early: false,
            pushed: [0.0; 3],
        };
        section.finish();
        probe
    }

    /// Puts it into the spindle at an angle, degrees, or takes it out.
    pub fn insert(&mut self, inserted: bool, spindle_deg: f64) {
        self.inserted = inserted;
        self.inserted_at_deg = spindle_deg;
    }

    /// How far the spindle has turned since it was put in, degrees; `None` while it is out.
    pub fn turned_deg(&self, spindle_deg: f64) -> Option<f64> {
        self.inserted
            .then(|| (spindle_deg - self.inserted_at_deg).rem_euclid(360.0))
    }

    /// A hand pushes the stylus along an axis with a force, N.
    pub fn push(&mut self, axis: char, force: f64) {
        for (letter, pushed) in ['X', 'Y', 'Z'].into_iter().zip(&mut self.pushed) {
            if letter == axis {
                *pushed = force;
            }
        }
    }

    /// No hand pushes the stylus.
    pub fn let_go(&mut self) {
        self.pushed = [0.0; 3];
    }

    /// A tool is in the spindle at an angle, degrees: the probe comes and goes as the tool whose number it has.
    pub fn is_held(&mut self, tool: u32, spindle_deg: f64) {
        let before = std::mem::replace(&mut self.held, tool);
        let is_probe = |tool| self.as_tool == Some(tool);
        let changes = before != tool && (is_probe(before) || is_probe(tool));
        // One that is there already, as after power-off, stays as it was put in.
        if changes && is_probe(tool) != self.inserted {
            self.insert(is_probe(tool), spindle_deg);
        }
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

    /// The radius of the ball, mm.
    pub fn radius_mm(&self) -> f64 {
        self.radius
    }

    /// What lies on the table beside boxes and rings.
    pub fn put(&mut self, workpiece: Option<Arc<dyn Solid>>) {
        self.workpiece = workpiece;
    }

    /// The end of the ball with the axes X, Y, Z at a position and the spindle at an angle, degrees.
    fn end(&self, [x, y, z]: [f64; 3], spindle_deg: f64) -> [f64; 3] {
        let beside = self.beside(spindle_deg);
        [x + beside[0], y + beside[1], z - self.length]
    }

    /// Whether a hand pushes the stylus, or the ball touches a solid with the axes X, Y, Z at a position and the spindle at an
    /// angle, degrees.
    pub fn deflected(&self, axes: [f64; 3], spindle_deg: f64) -> bool {
        if !self.inserted {
            return false;
        }
        if self.pushed != [0.0; 3] {
            return true;
        }
        let [x, y, z] = self.end(axes, spindle_deg);
        let centre = [x, y, z + self.radius];
        let touches = self.radius * self.radius;
        self.solids
            .iter()
            .any(|solid| solid.distance_squared(centre) <= touches)
            || self
                .rings
                .iter()
                .any(|ring| ring.distance_squared(centre) <= touches)
            || self
                .workpiece
                .as_ref()
                .is_some_and(|solid| solid.touches([x, y, z]))
    }

    /// How far a measuring probe is deflected along its own axes, mm. Boxes and rings deflect it as the workpiece does, a hand
    /// beside them.
    pub fn deflection(&self, axes: [f64; 3], spindle_deg: f64) -> [f64; 3] {
        let Some(mounting) = self.mounting.filter(|_| self.inserted) else {
            return [0.0; 3];
        };
        let end = self.end(axes, spindle_deg);
        let centre = [end[0], end[1], end[2] + self.radius];
        let mut pushed = [0.0; 3];
        let boxes = self.solids.iter().map(|solid| solid.pushes(centre, self.radius));
        let rings = self.rings.iter().map(|ring| ring.pushes(centre, self.radius));
        let workpiece = self.workpiece.iter().map(|solid| solid.deflection(end));
        for other in boxes.chain(rings).chain(workpiece) {
            let length = |of: &[f64; 3]| of.iter().map(|part| part * part).sum::<f64>();
            if length(&other) > length(&pushed) {
                pushed = other;
            }
        }
        for (pushed, force) in pushed.iter_mut().zip(self.pushed) {
            *pushed += force / NEWTON_PER_MM;
        }
        mounting.map(|axis| {
            let along = pushed.get(axis.abs() as usize - 1).copied().unwrap_or(0.0);
            along * axis.signum()
        })
    }
}

/// `measuring` and `mounting` of a TM 110.
fn measuring(section: &Section) -> Option<[f64; 3]> {
    let mounting = section.numbers::<3>("mounting");
    let fits = |mounting: &[f64; 3]| {
        let mut axes = mounting.map(f64::abs);
        axes.sort_by(f64::total_cmp);
        axes == [1.0, 2.0, 3.0]
    };
    if mounting.is_some_and(|mounting| !fits(&mounting)) {
        section.fault("mounting names the axes 1, 2 and 3 once each".to_owned());
        return None;
    }
    match section.flag("measuring").unwrap_or(false) {
        true => Some(mounting.unwrap_or([1.0, 2.0, 3.0])),
        false => None,
    }
}
