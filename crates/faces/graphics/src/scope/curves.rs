//! The curves of the oscilloscope, drawn by whoever wants them: a grid, the window of the memory that is looked at, the
//! cursors and what they say.

use bahn_host::oscilloscope::{CHANNELS, SAMPLES};
use bahn_path::Direction;
use bahn_picture::{Anchor, Colour, Image};
use bahn_tnc::ServoSignal;

use super::{FEWEST, Recorded};

/// Divisions of the grid, along time and up (inferred).
const ACROSS: usize = 10;
const UP: usize = 8;
/// A curve at its optimal resolution takes so many of them (inferred).
const USED: f64 = 7.0;
/// Steps of a scale in a decade.
const STEPS: [f64; 3] = [1.0, 2.0, 5.0];
/// Decades of a scale that are told apart.
const DECADES: std::ops::RangeInclusive<i32> = -6..=8;

/// How the operator looks at the curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Sight {
    /// The channel that soft keys act on.
    pub selected: usize,
    /// Steps of each scale coarser than the optimal one.
    pub zoom: [i32; CHANNELS],
    /// Channels that are shown upside down.
    pub inverted: [bool; CHANNELS],
    /// The window of the memory: its first sample.
    pub from: usize,
    /// How many samples it has.
    pub count: usize,
    /// The cursors, as samples; the last one that is there moves.
    pub cursors: [Option<usize>; 2],
}

/// A channel that is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Lane {
    /// Its number, from 0.
    pub number: usize,
    /// Signal and samples that it shows.
    pub recorded: Recorded,
    /// Steps of its scale coarser than the optimal one.
    pub zoom: i32,
    /// It is shown upside down.
    pub inverted: bool,
}

/// What is to be seen.
#[derive(Clone, Debug)]
pub struct Curves {
    /// The channels that are shown.
    pub lanes: Vec<Lane>,
    /// Time between two samples, µs.
    pub sample_us: u32,
    /// The sample of the trigger event.
    pub trigger: Option<usize>,
    /// How the operator looks at them.
    pub sight: Sight,
}

/// Background, grid, other channels, cursors and text, the selected channel: MP7361.0 to .4 [000:18662-18670].
pub(crate) type ScopeColours = [Colour; 5];

impl Default for Sight {
    fn default() -> Sight {
        Sight {
            selected: 0,
            zoom: [0; CHANNELS],
            inverted: [false; CHANNELS],
            from: 0,
            count: SAMPLES,
            cursors: [None; 2],
        }
    }
}

impl Sight {
    /// The whole memory, without cursors.
    pub fn whole(&mut self) {
        (self.from, self.count, self.cursors) = (0, SAMPLES, [None; 2]);
    }

    /// Horizontal zoom: 4096 samples down to 64, about the cursor or the middle.
    pub fn stretch(&mut self, closer: bool) {
        let count = if closer { self.count / 2 } else { self.count * 2 };
        let count = count.clamp(FEWEST, SAMPLES);
        let middle = self.moving().unwrap_or(self.from + self.count / 2);
        self.from = middle.saturating_sub(count / 2).min(SAMPLES - count);
        self.count = count;
    }

    /// The cursor that moves.
    fn moving(&self) -> Option<usize> {
        self.cursors[1].or(self.cursors[0])
    }

    /// Moves the cursor, without one the window, by a share of the window.
    pub fn go(&mut self, direction: Direction) {
        let cursor = match &mut self.cursors {
            [_, Some(second)] => Some(second),
            [first, None] => first.as_mut(),
        };
        let step = |by: usize, from: usize, last: usize| match direction {
            Direction::Plus => (from + by).min(last),
            Direction::Minus => from.saturating_sub(by),
        };
        match cursor {
            Some(cursor) => {
                *cursor = step((self.count / 128).max(1), *cursor, SAMPLES - 1);
                // The window goes along with it.
                let at = *cursor;
                self.from = self.from.min(at).max((at + 1).saturating_sub(self.count));
            }
            None => self.from = step(self.count / 8, self.from, SAMPLES - self.count),
        }
    }

    /// CURSOR: there, or not; the second one only beside the first.
    pub fn cursor(&mut self) {
        self.cursors = match self.cursors[0] {
            Some(_) => [None; 2],
            None => [Some(self.from + self.count / 2), None],
        };
    }

    /// CURSOR 1/2: the second cursor comes where the first one is, or goes.
    pub fn second_cursor(&mut self) {
        self.cursors[1] = match self.cursors[1] {
            Some(_) => None,
            None => self.cursors[0],
        };
    }
}

/// The name of a signal on the screen [000:18646-18654].
pub fn name(signal: ServoSignal) -> &'static str {
    match signal {
        ServoSignal::ActualFeed => "V ACTUAL",
        ServoSignal::NominalFeed => "V NOMINAL",
        ServoSignal::ActualPosition => "S ACTUAL",
        ServoSignal::NominalPosition => "S NOMINAL",
        ServoSignal::Lag => "D DIFF",
        ServoSignal::ActualSpeed => "N ACTUAL",
        ServoSignal::NominalSpeed => "N NOMINAL",
        ServoSignal::SpeedDifference => "N INT",
        ServoSignal::Voltage => "U ANALOGUE",
    }
}

/// Round values of a division, ascending.
fn scales() -> Vec<f64> {
    DECADES
        .flat_map(|decade| STEPS.map(|step| step * 10_f64.powi(decade)))
        .collect()
}

/// The finest scale at which all of a range is in the picture.
fn optimal(scales: &[f64], range: f64) -> i32 {
    let place = scales.iter().position(|step| range / step <= USED);
    place.unwrap_or(scales.len() - 1) as i32
}

impl Lane {
    /// The value of a division, and the value in the middle of the picture.
    pub fn scale(&self) -> (f64, f64) {
        let (min, max) = self.range();
        let scales = scales();
        let place = optimal(&scales, max - min) + self.zoom;
        let place = place.clamp(0, scales.len() as i32 - 1) as usize;
        let step = scales.get(place).copied().unwrap_or(1.0);
        (step, (0.5 * (min + max) / step).round() * step)
    }

    /// The zoom so many scales coarser, or finer when negative; `None` where there are no more.
    pub fn zoomed(&self, scales_by: i32) -> Option<i32> {
        let (min, max) = self.range();
        let scales = scales();
        let zoom = self.zoom + scales_by;
        let place = optimal(&scales, max - min) + zoom;
        (0..scales.len() as i32).contains(&place).then_some(zoom)
    }

    fn range(&self) -> (f64, f64) {
        let samples = self.recorded.samples.iter().copied();
        let finite = samples.filter(|value| value.is_finite());
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let (min, max) = finite.fold(none, |(min, max), value| (min.min(value), max.max(value)));
        if min <= max { (min, max) } else { (0.0, 0.0) }
    }

    /// `CH 1  X V ACTUAL  500 mm/min`.
    pub fn title(&self) -> String {
        let Recorded { curve, .. } = &self.recorded;
        let (step, _) = self.scale();
        let inverted = if self.inverted { "  INV" } else { "" };
        format!(
            "CH {}  {} {}  {step} {}{inverted}",
            self.number + 1,
            curve.axis,
            name(curve.signal),
            curve.signal.unit()
        )
    }
}

impl Curves {
    /// Time of a sample from the trigger on, s.
    pub fn time_s(&self, sample: usize) -> f64 {
        (sample as f64 - self.trigger.unwrap_or(0) as f64) * f64::from(self.sample_us) * 1e-6
    }

    /// What the cursors say: T1 with the value of the selected channel, T2 as the difference to it [000:18776-18780].
    pub fn cursors(&self) -> Vec<String> {
        let lane = self.lanes.iter().find(|lane| lane.number == self.sight.selected);
        let value = |sample: usize| lane.and_then(|lane| lane.recorded.samples.get(sample).copied());
        let unit = lane.map_or("", |lane| lane.recorded.curve.signal.unit());
        let said = |name: &str, time_s: f64, value: Option<f64>| {
            let value = value.map(|value| format!("  {value:.4} {unit}"));
            format!("{name} {:.1} MS{}", time_s * 1e3, value.unwrap_or_default())
        };
        let [first, second] = self.sight.cursors;
        let mut lines = Vec::new();
        if let Some(first) = first {
            lines.push(said("T1", self.time_s(first), value(first)));
            if let Some(second) = second {
                let off = value(second).zip(value(first)).map(|(b, a)| b - a);
                lines.push(said("T2", self.time_s(second) - self.time_s(first), off));
            }
        }
        lines
    }

    /// How long a division of the screen is, s.
    pub fn time_of_division_s(&self) -> f64 {
        self.sight.count as f64 / ACROSS as f64 * f64::from(self.sample_us) * 1e-6
    }

    /// Draws them in so many pixels.
    pub fn draw(&self, width: u32, height: u32, colours: &ScopeColours) -> Image {
        let [background, grid, others, text, selected] = *colours;
        let mut image = Image::new(width, height, background);
        let (w, h) = (f64::from(width), f64::from(height));
        let size = (h / 26.0).max(9.0);
        let rows = CHANNELS as f64;
        let (left, right) = (0.5 * size, w - 0.5 * size);
        let (top, bottom) = (1.6 * size * rows, h - 3.2 * size);
        let (dx, dy) = ((right - left) / ACROSS as f64, (bottom - top) / UP as f64);
        for k in 0..=ACROSS {
            let x = left + k as f64 * dx;
            image.line(
                [x, top],
                [x, bottom],
                if k == ACROSS / 2 { 1.6 } else { 0.6 },
                grid,
            );
        }
        for k in 0..=UP {
            let y = top + k as f64 * dy;
            image.line([left, y], [right, y], if k == UP / 2 { 1.6 } else { 0.6 }, grid);
        }
        let Sight { from, count, .. } = self.sight;
        let x = |sample: usize| left + (sample as f64 - from as f64) / (count - 1) as f64 * (right - left);
        // The selected one on top.
        let is_selected = |lane: &&Lane| lane.number == self.sight.selected;
        let below = self.lanes.iter().filter(|lane| !is_selected(lane));
        for lane in below.chain(self.lanes.iter().filter(is_selected)) {
            let colour = if is_selected(&lane) { selected } else { others };
            let (step, middle) = lane.scale();
            let sign = if lane.inverted { 1.0 } else { -1.0 };
            let y = |value: f64| {
                let off = sign * (value - middle) / step * dy;
                (0.5 * (top + bottom) + off).clamp(top, bottom)
            };
            let seen = lane.recorded.samples.iter().enumerate().skip(from).take(count);
            let points: Vec<[f64; 2]> = seen.map(|(sample, value)| [x(sample), y(*value)]).collect();
            for pair in points.windows(2) {
                if let [a, b] = pair {
                    image.line(*a, *b, 1.4, colour);
                }
            }
            let row = size * (0.9 + 1.5 * lane.number as f64);
            image.text([left, row], Anchor::Left, size, colour, &lane.title());
        }
        let marks = self.sight.cursors.into_iter().flatten().map(|at| (at, text));
        let trigger = self.trigger.map(|at| (at, grid));
        for (at, colour) in marks.chain(trigger) {
            if (from..from + count).contains(&at) {
                image.line([x(at), top], [x(at), bottom], 1.6, colour);
            }
        }
        self.foot(&mut image, [left, right, bottom, size], colours);
        image
    }

    /// Time of a division, cursors, and the bar that says which part of the memory is seen.
    fn foot(&self, image: &mut Image, [left, right, bottom, size]: [f64; 4], colours: &ScopeColours) {
        let [_, grid, _, text, _] = *colours;
        let mut said = vec![format!("{:.1} MS", self.time_of_division_s() * 1e3)];
        said.extend(self.cursors());
        image.text(
            [left, bottom + 1.0 * size],
            Anchor::Left,
            size,
            text,
            &said.join("   "),
        );
        let place = |sample: usize| left + sample as f64 / SAMPLES as f64 * (right - left);
        let y = bottom + 2.2 * size;
        let Sight { from, count, .. } = self.sight;
        image.rectangle([left, y], [right, y + 0.4 * size], grid);
        image.rectangle([place(from), y], [place(from + count), y + 0.4 * size], text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bahn_host::oscilloscope::Curve;

    fn lane(samples: Vec<f64>) -> Lane {
        let curve = Curve {
            axis: 'X',
            signal: ServoSignal::ActualFeed,
        };
        Lane {
            number: 0,
            recorded: Recorded { curve, samples },
            zoom: 0,
            inverted: false,
        }
    }

    /// A scale is 1, 2 or 5 times a power of ten, the finest with which the curve fits.
    #[test]
    fn scales_are_round() {
        for (max, expected) in [(7.0, 1.0), (7.1, 2.0), (14.1, 5.0), (3000.0, 500.0), (0.0, 1e-6)] {
            let (step, middle) = lane(vec![0.0, max]).scale();
            assert!((step / expected - 1.0).abs() < 1e-9, "{max}: {step}");
            // Nothing is outside the picture.
            assert!(
                (max - middle).abs() <= UP as f64 / 2.0 * step + 1e-9,
                "{max}: {middle}"
            );
        }
        let mut coarser = lane(vec![0.0, 7.0]);
        coarser.zoom = 2;
        assert!((coarser.scale().0 - 5.0).abs() < 1e-9);
        // There is an end on both sides.
        for (by, last) in [(1, scales().len() as i32 - 1), (-1, 0)] {
            while let Some(zoom) = coarser.zoomed(by) {
                coarser.zoom = zoom;
            }
            assert!((coarser.scale().0 / scales()[last as usize] - 1.0).abs() < 1e-9);
        }
    }

    /// From 4096 samples down to 64 and back; the cursor is never out of sight, nor the window out of the memory.
    #[test]
    fn the_window_stays_in_the_memory() {
        let mut sight = Sight::default();
        for _ in 0..10 {
            sight.stretch(true);
        }
        assert_eq!(sight.count, FEWEST);
        for _ in 0..10_000 {
            sight.go(Direction::Plus);
        }
        assert_eq!(sight.from, SAMPLES - FEWEST);
        sight.cursor();
        for _ in 0..10_000 {
            sight.go(Direction::Minus);
            let at = sight.cursors[0].unwrap();
            assert!((sight.from..sight.from + sight.count).contains(&at));
        }
        assert_eq!((sight.cursors, sight.from), ([Some(0), None], 0));
        sight.second_cursor();
        sight.go(Direction::Plus);
        assert_eq!(sight.cursors, [Some(0), Some(1)]);
        for _ in 0..10 {
            sight.stretch(false);
        }
        assert_eq!((sight.from, sight.count), (0, SAMPLES));
    }

    /// A step of 4 V in the middle of the memory: T1 and T2 say where and how high it is.
    #[test]
    fn cursors_say_time_and_value() {
        let samples: Vec<f64> = (0..SAMPLES).map(|k| if k < 2048 { 1.0 } else { 5.0 }).collect();
        let mut curves = Curves {
            lanes: vec![lane(samples)],
            sample_us: 600,
            trigger: Some(1024),
            sight: Sight::default(),
        };
        curves.sight.cursors = [Some(1024), Some(3024)];
        assert_eq!(
            curves.cursors(),
            ["T1 0.0 MS  1.0000 mm/min", "T2 1200.0 MS  4.0000 mm/min"]
        );
        assert!((curves.time_of_division_s() - 4096.0 * 6e-5).abs() < 1e-12);
    }

    /// MP7361.0 to .4: ground, grid, other channels, cursors and text, the selected channel.
    #[test]
    fn curves_have_the_colours_of_mp7361() {
        let wave = |factor: f64| (0..SAMPLES).map(|k| (k as f64 * factor).sin()).collect();
        let mut other = lane(wave(0.01));
        other.number = 1;
        let mut curves = Curves {
            lanes: vec![lane(wave(0.004)), other],
            sample_us: 600,
            trigger: None,
            sight: Sight::default(),
        };
        curves.sight.cursors[0] = Some(2000);
        let colours = [[1, 2, 3], [40, 0, 0], [0, 90, 0], [0, 0, 200], [250, 250, 0]];
        let image = curves.draw(640, 480, &colours);
        let count = |colour: Colour| image.pixels().iter().filter(|pixel| **pixel == colour).count();
        let [ground, grid, others, text, selected] = colours.map(count);
        assert!(ground > 640 * 480 / 2, "{ground}");
        assert!(
            grid.min(others).min(selected) > 200 && text > 200,
            "{grid} {others} {text} {selected}"
        );
        // Another channel is selected: the colours change places.
        curves.sight.selected = 1;
        let image = curves.draw(640, 480, &colours);
        let count = |colour: Colour| image.pixels().iter().filter(|pixel| **pixel == colour).count();
        assert!((count(colours[4]) as f64 - others as f64).abs() < 0.5 * others as f64);
    }
}
