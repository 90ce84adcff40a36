//! How far the axes leave the contour: the distance of the actual position from the nominal path.
//!
//! The lag along the path is no error of the contour. So the actual position is compared with the nearest
//! point of the path that was commanded, not with the nominal position of the moment.

use std::collections::VecDeque;

use bahn_path::BlockRef;
use bahn_tnc::{AxisFollowing, ChannelView, Signal};

use super::cause::{Cause, Moment};

/// Contour cycles that are remembered; the lag of the slowest axis is far shorter.
const POINTS: usize = 2048;
/// Contour cycles before the nearest point that are kept: an axis that sticks breaks away late *(inferred)*.
const BEFORE: usize = 256;
/// Contour cycles over which the speed along the path is compared *(inferred)*.
const SPEEDS: usize = 32;

/// The largest values of an axis.
#[derive(Clone, Debug)]
pub(super) struct AxisExtremes {
    pub letter: char,
    /// Largest lag, mm or degrees, and in which block.
    pub max_lag: f64,
    pub lag_block: Option<BlockRef>,
    /// Largest distance from the contour in this axis, mm; rotary axes have none.
    pub max_deviation: f64,
    pub deviation_block: Option<BlockRef>,
    linear: Option<usize>,
}

impl AxisExtremes {
    /// It takes part in the contour.
    pub fn is_linear(&self) -> bool {
        self.linear.is_some()
    }
}

/// Follows the axes while a program runs.
pub(super) struct Deviation {
    pub axes: Vec<AxisExtremes>,
    linear: Vec<char>,
    /// The nominal path, the oldest point first.
    path: VecDeque<[f64; 3]>,
    /// How many points of it the axes have passed.
    passed: usize,
    /// Speeds along the path of the last cycles, mm/min.
    speeds: VecDeque<f64>,
    /// Largest distance from the contour in space, mm.
    pub max_mm: f64,
    /// Why it arose, and in which block.
    pub cause: Option<(Cause, Option<BlockRef>)>,
}

impl Deviation {
    pub fn new(channel: ChannelView) -> Deviation {
        // Three linear axes span the contour; others run beside it.
        let linear: Vec<char> = channel
            .axis_letters()
            .filter(|letter| matches!(letter, 'X' | 'Y' | 'Z'))
            .collect();
        let mut deviation = Deviation {
            axes: Vec::new(),
            linear,
            path: VecDeque::with_capacity(POINTS),
            passed: 0,
            speeds: VecDeque::with_capacity(SPEEDS),
            max_mm: 0.0,
            cause: None,
        };
        for letter in channel.axis_letters() {
            deviation.meet(letter);
        }
        deviation
    }

    /// What is known of an axis, which may come from another channel.
    fn meet(&mut self, letter: char) -> &mut AxisExtremes {
        let known = self.axes.iter().position(|axis| axis.letter == letter);
        let place = known.unwrap_or(self.axes.len());
        if known.is_none() {
            self.axes.push(AxisExtremes {
                letter,
                max_lag: 0.0,
                lag_block: None,
                max_deviation: 0.0,
                deviation_block: None,
                linear: self.linear.iter().position(|own| *own == letter),
            });
        }
        &mut self.axes[place]
    }

    /// Looks at the lag of an axis. Its place among those that span the contour.
    fn look(&mut self, following: &AxisFollowing, block: Option<BlockRef>) -> Option<usize> {
        let axis = self.meet(following.axis.letter());
        let lag = following.lag.abs();
        if lag > axis.max_lag {
            (axis.max_lag, axis.lag_block) = (lag, block);
        }
        axis.linear
    }

    /// Takes a contour cycle of a running program. `contour` says that it is machined, not positioned.
    pub fn cycle(&mut self, channel: ChannelView, contour: bool) {
        let block = channel.element().map(|element| element.block);
        let (mut nominal, mut actual, mut speed) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for following in channel.followings() {
            let linear = self.look(&following, block);
            for (point, value) in [
                (&mut nominal, following.nominal),
                (&mut actual, following.actual),
                (&mut speed, following.nominal_speed),
            ] {
                if let Some(own) = linear.and_then(|place| point.get_mut(place)) {
                    *own = value;
                }
            }
        }
        if self.path.back() != Some(&nominal) {
            if self.path.len() == POINTS {
                self.path.pop_front();
                self.passed = self.passed.saturating_sub(1);
            }
            self.path.push_back(nominal);
        }
        if self.speeds.len() == SPEEDS {
            self.speeds.pop_front();
        }
        let path_speed = channel.observe(&Signal::PathSpeed);
        self.speeds.push_back(path_speed);
        let Some(across) = self.nearest(actual) else {
            return;
        };
        if !contour {
            return;
        }
        if length(across) > self.max_mm {
            self.max_mm = length(across);
            let moment = Moment {
                letters: &self.linear,
                path: self.path.make_contiguous(),
                nearest: self.passed,
                across,
                lag: difference(nominal, actual),
                speed,
                path_speed: [self.speeds.front().copied().unwrap_or(path_speed), path_speed],
            };
            self.cause = Some((moment.cause(), block));
        }
        for axis in &mut self.axes {
            let Some(value) = axis.linear.and_then(|place| across.get(place)) else {
                continue;
            };
            if value.abs() > axis.max_deviation {
                (axis.max_deviation, axis.deviation_block) = (value.abs(), block);
            }
        }
    }

    /// Forgets the path: a new one begins.
    pub fn restart(&mut self) {
        self.path.clear();
        self.passed = 0;
        self.speeds.clear();
    }

    /// The way from the nearest point of the path to a position. What lies before that point is not looked at
    /// again: an axis does not run back.
    fn nearest(&mut self, actual: [f64; 3]) -> Option<[f64; 3]> {
        let mut from = *self.path.get(self.passed)?;
        let mut best = difference(actual, from);
        let (mut least, mut at) = (length(best), self.passed);
        for (index, to) in (self.passed..).zip(self.path.range(self.passed + 1..)) {
            let across = from_segment(actual, from, *to);
            let far = length(across);
            if far < least {
                (best, least, at) = (across, far, index);
            }
            from = *to;
        }
        let forgotten = at.saturating_sub(BEFORE);
        self.path.drain(..forgotten);
        self.passed = at - forgotten;
        Some(best)
    }
}

/// The way from the nearest point of a segment to a position.
fn from_segment(position: [f64; 3], from: [f64; 3], to: [f64; 3]) -> [f64; 3] {
    let way = difference(to, from);
    let after = difference(position, from);
    let square = product(way, way);
    let along = if square > 0.0 {
        (product(after, way) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    difference(after, way.map(|value| along * value))
}

fn difference([a, b, c]: [f64; 3], [d, e, f]: [f64; 3]) -> [f64; 3] {
    [a - d, b - e, c - f]
}

fn product([a, b, c]: [f64; 3], [d, e, f]: [f64; 3]) -> f64 {
    a * d + b * e + c * f
}

fn length(vector: [f64; 3]) -> f64 {
    product(vector, vector).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn deviation(path: &[[f64; 3]]) -> Deviation {
        Deviation {
            axes: Vec::new(),
            linear: vec!['X', 'Y', 'Z'],
            path: path.iter().copied().collect(),
            passed: 0,
            speeds: VecDeque::new(),
            max_mm: 0.0,
            cause: None,
        }
    }

    /// 2 mm behind on a straight line is lag, no deviation; 0.1 mm beside it is.
    #[test]
    fn lag_is_no_deviation() {
        let mut on_line = deviation(&[[0.0; 3], [5.0, 0.0, 0.0], [10.0, 0.0, 0.0]]);
        assert_eq!(on_line.nearest([8.0, 0.1, 0.0]), Some([0.0, 0.1, 0.0]));
        assert_eq!(on_line.passed, 1, "the first segment is passed");
        assert_eq!(
            on_line.nearest([1.0, 0.0, 0.0]),
            Some([-4.0, 0.0, 0.0]),
            "and not looked at again"
        );
    }

    /// A corner that is cut: the nearest points are on both legs.
    #[test]
    fn a_cut_corner_is_a_deviation() {
        let mut corner = deviation(&[[0.0; 3], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0]]);
        assert_eq!(corner.nearest([9.5, 0.5, 0.0]), Some([0.0, 0.5, 0.0]));
    }

    #[test]
    fn what_stands_still_overshoots_its_last_point() {
        let mut still = deviation(&[[10.0, 0.0, 0.0]]);
        assert_eq!(still.nearest([10.0, 0.0, -0.25]), Some([0.0, 0.0, -0.25]));
        assert_eq!(deviation(&[]).nearest([0.0; 3]), None);
    }
}
