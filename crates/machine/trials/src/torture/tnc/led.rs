//! Where the machine leads the path, and no curve says how far: a probe goes to what it touches, and a thread as far as
//! its spindle turns.
//!
//! What is led stays where it was undisturbed, and beyond that no farther than it takes to stop there; a stylus that digitizes
//! may be anywhere in its RANGE up to the clearance height, and where it looks for the surface at an outside corner beside it by
//! P.P.INT [000:7803-7825]. Where an axis has moved that its encoder hides from the control, stuck or wrong, the stylus is not where
//! the control takes it to be, and what it is to touch may not be there: it goes on to the end of its way, which MP6130 sets.
//! What a probe has felt
//! elsewhere than undisturbed moves what the program does after it by as much: no shipped program makes more of a touch.

use std::collections::HashMap;

use bahn_machine::Machine;
use bahn_path::{Axis, BlockRef, PerAxis, Position, ScanJob};
use bahn_tnc::{AxisWatch, ChannelView, Digitized, Signal};

use super::axes::Moment;

/// Q parameters that a program computes with.
const NUMBERS: u16 = 120;
/// Contour cycles at full speed that a stop takes beside its ramp.
const STOP_CYCLES: f64 = 3.0;
/// Contour cycles that a thread is behind its spindle at most: in one its angle is measured, in the next one it is led.
const THREAD_CYCLES: f64 = 2.0;
/// An axis that is so far from where its encoder says is somewhere else, mm or degrees: more than play and elasticity.
const HIDDEN: f64 = 0.1;
/// Steps of the spindle's encoder, mm of a thread.
const ROUNDING_MM: f64 = 1e-3;

/// Where a block was led undisturbed, and what the numbers of the program were after it.
#[derive(Clone, Debug)]
struct Stretch {
    least: Position,
    greatest: Position,
    /// How far it would have been led if it had touched nothing.
    farthest: [Position; 2],
    /// Where the tables are beside what their encoders say, mm or degrees.
    beside: PerAxis<f64>,
    /// How fast each axis was, mm/s.
    fastest: PerAxis<f64>,
    numbers: Vec<f64>,
}

/// What leads the path of a channel in its undisturbed run.
#[derive(Clone, Debug)]
pub(super) struct Led {
    stretches: HashMap<BlockRef, Stretch>,
    /// Digitizing jobs by their block.
    scans: HashMap<BlockRef, ScanJob>,
    /// How fast the axes of a thread are at most, mm/s.
    threads: HashMap<BlockRef, PerAxis<f64>>,
    open: Option<BlockRef>,
    /// Axes that the handwheel may lead beside the path (M118), and how far, mm or degrees.
    wheels: PerAxis<f64>,
}

impl Default for Led {
    fn default() -> Led {
        Led {
            stretches: HashMap::new(),
            scans: HashMap::new(),
            threads: HashMap::new(),
            open: None,
            wheels: PerAxis::splat(0.0),
        }
    }
}

impl Led {
    /// A cycle of the undisturbed run.
    pub fn learn(&mut self, channel: &ChannelView, plant: &Machine) {
        let Some(element) = channel.element() else {
            return;
        };
        for watch in channel.watch() {
            self.wheels[watch.axis] = self.wheels[watch.axis].max(watch.superimposable);
        }
        let block = element.block;
        if element.thread().is_some() {
            let fastest = self.threads.entry(block);
            grow(fastest.or_insert_with(|| PerAxis::splat(0.0)), channel);
        }
        if let Some(Digitized::Begins(job)) = channel.digitized().what {
            self.scans.insert(block, job);
        }
        if channel.is_led_by_probe() {
            let place = place(channel);
            let new = || Stretch {
                least: place,
                greatest: place,
                farthest: [place; 2],
                beside: beside(channel, plant),
                fastest: PerAxis::splat(0.0),
                numbers: Vec::new(),
            };
            let stretch = self.stretches.entry(block).or_insert_with(new);
            for axis in Axis::ALL {
                stretch.least[axis] = stretch.least[axis].min(place[axis]);
                stretch.greatest[axis] = stretch.greatest[axis].max(place[axis]);
                let [least, greatest] = &mut stretch.farthest;
                for end in channel.probing_way().into_iter().flatten() {
                    least[axis] = least[axis].min(end[axis]);
                    greatest[axis] = greatest[axis].max(end[axis]);
                }
            }
            grow(&mut stretch.fastest, channel);
            self.open = Some(block);
        } else if let Some(led) = self.open.filter(|led| *led != block) {
            if let Some(stretch) = self.stretches.get_mut(&led) {
                stretch.numbers = numbers(channel);
            }
            self.open = None;
        }
    }

    /// Axes that the handwheel may lead beside the path, and how far, mm or degrees.
    pub fn wheels(&self) -> impl Iterator<Item = (Axis, f64)> + use<'_> {
        let all = Axis::ALL.into_iter().map(|axis| (axis, self.wheels[axis]));
        all.filter(|(_, range)| *range > 0.0)
    }

    /// How fast the axes are in a block that is led, mm/s.
    fn fastest(&self, block: BlockRef) -> PerAxis<f64> {
        let probed = self.stretches.get(&block).map(|stretch| stretch.fastest);
        let threaded = self.threads.get(&block).copied();
        probed.or(threaded).unwrap_or(PerAxis::splat(0.0))
    }

    /// A place is where the block was led, or no farther beside that than it reaches.
    fn holds(&self, block: BlockRef, place: &Position, leading: &Leading, tolerance: f64) -> bool {
        let scan = self.scans.get(&block);
        let stretch = self.stretches.get(&block);
        scan.is_some_and(|job| is_scanned(job, place, &leading.reach))
            || stretch.is_some_and(|stretch| {
                let [least, greatest] = match leading.hidden {
                    true => &stretch.farthest,
                    false => &[stretch.least, stretch.greatest],
                };
                Axis::ALL.into_iter().all(|axis| {
                    let beside = (least[axis] - place[axis]).max(place[axis] - greatest[axis]);
                    // What was never programmed is NaN.
                    beside.is_nan() || beside <= leading.reach[axis] + tolerance
                })
            })
    }
}

/// How far the tables are beside what their encoders say, mm or degrees.
fn beside(channel: &ChannelView, plant: &Machine) -> PerAxis<f64> {
    let mut beside = PerAxis::splat(0.0);
    for watch in channel.watch() {
        if let Some(axis) = plant.axes().find(|axis| axis.output == watch.output) {
            beside[watch.axis] = axis.position - watch.actual;
        }
    }
    beside
}

/// Where the axes are commanded that a path may move; what the PLC or a master moves is of no path.
pub(super) fn place(channel: &ChannelView) -> Position {
    let mut place = channel.commanded();
    for watch in channel.watch().filter(|watch| !watch.free) {
        place[watch.axis] = f64::NAN;
    }
    place
}

/// A place is in the RANGE of what is digitized, below its clearance height, or beyond that by the interval of its points, and as
/// far as it takes to stop.
fn is_scanned(job: &ScanJob, place: &Position, reach: &PerAxis<f64>) -> bool {
    let up = job.tool_place();
    [Axis::X, Axis::Y, Axis::Z]
        .into_iter()
        .enumerate()
        .all(|(k, axis)| {
            let top = if k == up { job.clearance_mm } else { job.max[k] };
            let most = reach[axis] + job.interval_mm;
            let tip = place[axis] + job.beside[k];
            tip >= job.min[k] - most && tip <= top + most
        })
}

fn length(of: &PerAxis<f64>) -> f64 {
    let squares = [Axis::X, Axis::Y, Axis::Z].map(|axis| of[axis] * of[axis]);
    squares.iter().sum::<f64>().sqrt()
}

/// The greatest speeds of the axes, mm/s.
fn grow(fastest: &mut PerAxis<f64>, channel: &ChannelView) {
    for watch in channel.watch().filter(|watch| watch.free) {
        fastest[watch.axis] = fastest[watch.axis].max(watch.speed_mm_s.abs());
    }
}

fn numbers(channel: &ChannelView) -> Vec<f64> {
    (0..NUMBERS).map(|number| channel.q_value(number)).collect()
}

/// How a disturbed run is led.
#[derive(Clone, Debug)]
pub(super) struct Leading {
    block: Option<BlockRef>,
    /// The last block that a probe has led.
    led: Option<BlockRef>,
    /// How fast each axis was in this block at most, mm/s.
    fastest: PerAxis<f64>,
    /// How far an axis may be beside where it was led, mm or degrees.
    reach: PerAxis<f64>,
    /// A table is somewhere else than its encoder says.
    hidden: bool,
    /// What its touches move the program by, mm.
    pub moved: f64,
    thread: Option<Thread>,
}

impl Default for Leading {
    fn default() -> Leading {
        Leading {
            block: None,
            led: None,
            fastest: PerAxis::splat(0.0),
            reach: PerAxis::splat(0.0),
            hidden: false,
            moved: 0.0,
            thread: None,
        }
    }
}

/// A thread that is being cut: where its tool and its spindle were when they were coupled.
#[derive(Clone, Copy, Debug)]
struct Thread {
    sequence: u64,
    from: Position,
    turned_deg: f64,
}

impl Leading {
    /// A cycle of the disturbed run.
    pub fn cycle(&mut self, channel: &ChannelView, plant: &Machine, undisturbed: &Led, moment: &Moment) {
        let Some(block) = channel.element().map(|element| element.block) else {
            return;
        };
        if self.block.replace(block) != Some(block) {
            self.fastest = undisturbed.fastest(block);
            if let Some(stretch) = self.led.take().and_then(|led| undisturbed.stretches.get(&led)) {
                let now = numbers(channel);
                let differences = stretch
                    .numbers
                    .iter()
                    .zip(now)
                    .map(|(one, other)| (one - other).abs());
                self.moved = differences.fold(self.moved, f64::max);
            }
        }
        if channel.is_led_by_probe() {
            self.led = Some(block);
            self.hidden = undisturbed.stretches.get(&block).is_some_and(|stretch| {
                let now = beside(channel, plant);
                let hidden = |axis: Axis| (now[axis] - stretch.beside[axis]).abs() > HIDDEN;
                channel.watch().any(|watch| hidden(watch.axis))
            });
        }
        grow(&mut self.fastest, channel);
        for watch in channel.watch().filter(|watch| watch.free) {
            let fastest = self.fastest[watch.axis];
            self.reach[watch.axis] = fastest * fastest / (2.0 * watch.acceleration_mm_s2)
                + STOP_CYCLES * fastest * moment.cycle_s
                + watch.lag.abs();
        }
    }

    /// A place where no curve is, is one to which the probe was led.
    pub fn holds(&self, undisturbed: &Led, block: BlockRef, place: &Position, tolerance: f64) -> bool {
        undisturbed.holds(block, place, self, tolerance)
    }

    /// So far a thread may go on beyond its ends, mm: until its spindle stands.
    pub fn reach_mm(&self) -> f64 {
        length(&self.reach)
    }

    /// In a thread the tool has gone the pitch for each turn of the spindle; how far it is from that, and how far it may be.
    pub fn out_of_step(&mut self, channel: &ChannelView, moment: &Moment) -> Option<(f64, f64)> {
        let place = channel.commanded();
        let turned_deg = channel.observe(&Signal::SpindleAngle);
        // What brings tool and spindle apart couples them anew as they are then.
        let follows =
            |watch: AxisWatch| watch.closed && !watch.halted && watch.beside == 0.0 && watch.fault.is_none();
        // Axes that were taken over beside the thread are led back to it first; meanwhile it does not go on.
        let coupled = channel.follows_spindle() && !channel.restores() && channel.watch().all(follows);
        let element = channel.element().filter(|_| coupled);
        let Some((element, thread)) = element.and_then(|element| Some((element, element.thread()?))) else {
            self.thread = None;
            return None;
        };
        let new = Thread {
            sequence: element.sequence,
            from: place,
            turned_deg,
        };
        let begun = self.thread.filter(|thread| thread.sequence == element.sequence);
        let begun = self.thread.insert(begun.unwrap_or(new));
        let ways = [Axis::X, Axis::Y, Axis::Z].map(|axis| place[axis] - begun.from[axis]);
        let way = ways
            .iter()
            .filter(|way| way.is_finite())
            .map(|way| way * way)
            .sum::<f64>()
            .sqrt();
        let turned = (turned_deg - begun.turned_deg).abs() / 360.0;
        let off = (way - thread.pitch_mm * turned).abs();
        // A spindle that runs away is faster than the axis that comes after it.
        let turns_mm_s = channel.observe(&Signal::SpindleRpm).abs() / 60.0 * thread.pitch_mm;
        let fastest = length(&self.fastest).max(turns_mm_s);
        Some((off, THREAD_CYCLES * fastest * moment.cycle_s + ROUNDING_MM))
    }
}
