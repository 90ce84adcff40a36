//! The course of a scan: line by line, or level by level [003:6633-6766].

use bahn_path::{Axis, ScanFault, ScanJob, ScanPattern, ScanPoint};

use super::follow::Follower;
use super::stylus::{Felt, Followed, Tracking, Wish};

/// A line or level is reached within this, mm.
const THERE_MM: f64 = 1e-3;
/// Clearance height and starting point are reached within this, mm: the axes may still lag (inferred).
const HOME_MM: f64 = 1e-3;
/// Part of the point interval within which an orbit is closed [003:6754].
const CLOSED: f64 = 0.25;
/// Points before an orbit may be closed.
const ORBIT_MIN: u32 = 4;

/// A cycle of a course: how to move, and a point of the surface; or the end, with a fault or without.
type Step = Result<(Wish, Option<ScanPoint>), Option<ScanFault>>;

#[derive(Clone, Copy, Debug)]
enum Stage {
    /// Down to a level, in free air.
    Plunge,
    /// Along a direction until the stylus touches.
    Approach,
    /// The stylus follows the surface.
    Follow,
    /// The end of a line is reached: up until free, then straight down.
    Rise,
    /// Lubrication of the axis of the probe: up to a height.
    Lubricate {
        height: f64,
    },
    Down,
    /// Off the model, to the next level.
    Leave,
    Level,
    /// Back to where the scan began: axis by axis of the plane, then to clearance height.
    Home,
}

/// The course of a scan; the module describes it.
#[derive(Clone, Debug)]
pub(super) struct Course {
    stage: Stage,
    /// Axis and sign of the line that is scanned, and where it ends; of levels the approach.
    line: (usize, f64, f64),
    /// Meander: it goes to the next line, and the sign of the line before.
    shifts: bool,
    sign: f64,
    /// Contour lines: height of the level, first point of it, points and time since.
    level: f64,
    first: ScanPoint,
    since: (u32, f64),
    lubricated_s: f64,
    /// Lines scanned to their end, or levels orbited.
    ended: u32,
}

fn unit(axis: usize, sign: f64) -> ScanPoint {
    std::array::from_fn(|k| if k == axis { sign } else { 0.0 })
}

fn place(axis: Axis) -> usize {
    axis.index().min(2)
}

impl Course {
    pub fn new(job: &ScanJob) -> Course {
        let up = job.tool_place();
        let (stage, line) = match job.pattern {
            ScanPattern::Meander { line } => (Stage::Approach, (place(line), 1.0, job.max[place(line)])),
            ScanPattern::ContourLines { approach, .. } => {
                (Stage::Plunge, (place(approach.0), approach.1, 0.0))
            }
        };
        Course {
            stage,
            line,
            shifts: false,
            sign: 1.0,
            level: if job.spacing_mm < 0.0 {
                job.max[up]
            } else {
                job.min[up]
            },
            first: [0.0; 3],
            since: (0, 0.0),
            lubricated_s: 0.0,
            ended: 0,
        }
    }

    /// Lines scanned to their end, or levels orbited.
    pub fn ended(&self) -> u32 {
        self.ended
    }

    pub fn cycle(&mut self, follower: &mut Follower, job: &ScanJob, felt: &Felt) -> Step {
        let up = job.tool_place();
        self.since.1 += felt.time_s;
        self.lubricated_s += felt.time_s;
        let probing = job.rules.probing_mm_min / 60.0;
        match self.stage {
            Stage::Plunge => self.plunge(job, felt),
            Stage::Approach | Stage::Down => {
                let touched = felt.touch.or(felt.deflected.then_some(felt.at));
                let towards = match (job.pattern, self.stage) {
                    (ScanPattern::ContourLines { approach, .. }, Stage::Approach) => {
                        unit(place(approach.0), approach.1)
                    }
                    _ => unit(up, -1.0),
                };
                if let Some(touch) = touched {
                    return self.arrive(touch, follower, job);
                }
                self.within(job, felt)?;
                Ok((Wish::along(towards, probing), None))
            }
            Stage::Follow => self.follow(follower, job, felt),
            Stage::Rise => {
                if !felt.deflected {
                    self.stage = Stage::Down;
                    let due = self.lubricated_s >= job.rules.lubrication_min * 60.0;
                    if job.rules.lubrication_mm > 0.0 && due && !self.shifts {
                        self.lubricated_s = 0.0;
                        let height = (felt.at[up] + job.rules.lubrication_mm).min(job.clearance_mm);
                        self.stage = Stage::Lubricate { height };
                    }
                }
                Ok((Wish::along(unit(up, 1.0), probing), None))
            }
            Stage::Lubricate { height } => {
                if felt.at[up] >= height - THERE_MM {
                    self.stage = Stage::Down;
                }
                let mut wish = Wish::along(unit(up, 1.0), job.rules.rapid_mm_min / 60.0);
                wish.end = Some((up, 1.0, height));
                Ok((wish, None))
            }
            Stage::Home => self.home(job, felt),
            Stage::Leave => {
                let (axis, sign, _) = self.line;
                let off = (self.first[axis] - felt.at[axis]) * sign;
                if !felt.deflected && off >= job.travel_mm {
                    self.stage = Stage::Level;
                    return Ok((Wish::stand(), None));
                }
                self.within(job, felt)?;
                Ok((Wish::along(unit(axis, -sign), probing), None))
            }
            Stage::Level => {
                if felt.deflected {
                    // The model is wider there: farther off.
                    self.first = felt.at;
                    self.stage = Stage::Leave;
                    return Ok((Wish::stand(), None));
                }
                let distance = self.level - felt.at[up];
                if distance.abs() <= THERE_MM {
                    self.stage = Stage::Approach;
                }
                let mut wish = Wish::along(unit(up, distance.signum()), probing);
                wish.end = Some((up, distance.signum(), self.level));
                Ok((wish, None))
            }
        }
    }

    /// Contour lines end at the starting point, both cycles at clearance height.
    fn home(&mut self, job: &ScanJob, felt: &Felt) -> Step {
        let up = job.tool_place();
        let begin = job.begin();
        let approach = self.line.0;
        let order = match job.pattern {
            ScanPattern::Meander { .. } => [up, up, up],
            ScanPattern::ContourLines { .. } => [approach, 3 - up - approach, up],
        };
        // The program goes on from the nominal position.
        let is_missing = |axis: &usize| {
            felt.nominal[*axis] != begin[*axis] || (begin[*axis] - felt.at[*axis]).abs() > HOME_MM
        };
        let missing = order.into_iter().find(is_missing);
        let Some(axis) = missing else { return Err(None) };
        let sign = (begin[axis] - felt.nominal[axis]).signum();
        let mut wish = Wish::along(unit(axis, sign), job.rules.rapid_mm_min / 60.0);
        wish.end = Some((axis, sign, begin[axis]));
        Ok((wish, None))
    }

    /// Down to the first level.
    fn plunge(&mut self, job: &ScanJob, felt: &Felt) -> Step {
        let up = job.tool_place();
        if felt.deflected {
            return Err(Some(ScanFault::Inaccessible));
        }
        if (felt.at[up] - self.level).abs() <= THERE_MM {
            self.stage = Stage::Approach;
        }
        let mut wish = Wish::along(unit(up, -1.0), job.rules.rapid_mm_min / 60.0);
        wish.end = Some((up, -1.0, self.level));
        Ok((wish, None))
    }

    /// The stylus touched where a line or level begins.
    fn arrive(&mut self, touch: ScanPoint, follower: &mut Follower, job: &ScanJob) -> Step {
        let up = job.tool_place();
        let first = matches!(self.stage, Stage::Approach);
        self.stage = Stage::Follow;
        match job.pattern {
            ScanPattern::Meander { line } => {
                if !first && !self.next_line(touch, place(line), job) {
                    self.stage = Stage::Home;
                    return Ok((Wish::stand(), Some(touch)));
                }
                let tracking = Tracking {
                    along: unit(self.line.0, self.line.1),
                    off: unit(up, 1.0),
                };
                follower.begin(tracking, touch);
            }
            ScanPattern::ContourLines {
                approach, direction, ..
            } => {
                self.first = touch;
                self.since = (0, 0.0);
                let tracking = Tracking {
                    along: unit(place(direction.0), direction.1),
                    off: unit(place(approach.0), -approach.1),
                };
                follower.begin(tracking, touch);
            }
        }
        Ok((Wish::stand(), Some(touch)))
    }

    /// A line of the meander has ended: to the next one, or along it. `false` when there is none.
    fn next_line(&mut self, at: ScanPoint, line: usize, job: &ScanJob) -> bool {
        let other = 3 - line - job.tool_place();
        if self.shifts {
            self.shifts = false;
            self.sign = -self.sign;
            let end = if self.sign > 0.0 {
                job.max[line]
            } else {
                job.min[line]
            };
            self.line = (line, self.sign, end);
            return true;
        }
        if at[other] >= job.max[other] - THERE_MM {
            return false;
        }
        self.shifts = true;
        let end = (at[other] + job.spacing_mm.abs()).min(job.max[other]);
        self.line = (other, 1.0, end);
        true
    }

    fn follow(&mut self, follower: &mut Follower, job: &ScanJob, felt: &Felt) -> Step {
        let (axis, sign, end) = self.line;
        let is_at_end = |at: &ScanPoint| (at[axis] - end) * sign >= -THERE_MM;
        let meander = matches!(job.pattern, ScanPattern::Meander { .. });
        follower.bar(meander && is_at_end(&felt.nominal));
        let followed = follower.cycle(felt);
        match (job.pattern, followed) {
            (_, Followed::Stuck) => Err(Some(ScanFault::CannotRetract)),
            (ScanPattern::Meander { .. }, followed) => {
                // A triggering probe touches at the end of the line: what is within a point interval of it is scanned, too.
                let touches = matches!(followed, Followed::Touched(..)) || job.rules.measuring.is_some();
                if is_at_end(&felt.at) && touches {
                    self.stage = Stage::Rise;
                    self.ended += u32::from(!self.shifts);
                    // A stylus that is deflected touches beside the end of the line.
                    let tip = std::array::from_fn(|k| felt.at[k] + felt.deflection[k]);
                    let point = (job.rules.measuring.is_some() && felt.deflected).then_some(tip);
                    let mut wish = Wish::stand();
                    wish.end = Some((axis, sign, end));
                    return Ok((wish, point));
                }
                Ok(match followed {
                    Followed::Moves(mut wish) => {
                        wish.end = Some((axis, sign, end));
                        (wish, None)
                    }
                    Followed::Touched(point, mut wish) => {
                        wish.end = Some((axis, sign, end));
                        (wish, Some(point))
                    }
                    Followed::Stuck => (Wish::stand(), None),
                })
            }
            (ScanPattern::ContourLines { time_limit_s, .. }, Followed::Touched(point, wish)) => {
                self.since.0 += 1;
                let (points, time) = self.since;
                if time_limit_s > 0.0 && time > time_limit_s {
                    return Err(Some(ScanFault::TimeLimit));
                }
                if points >= ORBIT_MIN && self.is_closed(point, job) {
                    self.next_level(job);
                    return Ok((Wish::stand(), Some(point)));
                }
                follower.cap_mm = self.cap(follower, job);
                Ok((wish, Some(point)))
            }
            (_, Followed::Moves(wish)) => {
                self.within(job, felt)?;
                Ok((wish, None))
            }
        }
    }

    /// The orbit has come back to its first point: within a quarter of the point interval [003:6754], with a measuring
    /// probe within the window of MP6390 [000:7930].
    fn is_closed(&self, point: ScanPoint, job: &ScanJob) -> bool {
        let off: ScanPoint = std::array::from_fn(|k| point[k] - self.first[k]);
        match &job.rules.measuring {
            Some(rules) => off.iter().all(|part| part.abs() <= rules.window_mm),
            None => {
                let square: f64 = off.iter().map(|part| part * part).sum();
                square.sqrt() <= CLOSED * job.interval_mm
            }
        }
    }

    /// How far the stylus may go along: no farther than to the first point of the level, so that it comes back to it.
    fn cap(&self, follower: &Follower, job: &ScanJob) -> f64 {
        let offset: ScanPoint = std::array::from_fn(|k| self.first[k] - follower.last()[k]);
        let direction = follower.direction();
        let ahead: f64 = offset.iter().zip(direction).map(|(a, b)| a * b).sum();
        let square: f64 = offset.iter().map(|part| part * part).sum();
        let beside = (square - ahead * ahead).max(0.0).sqrt();
        let near = ahead > 0.0 && ahead <= 1.25 * job.interval_mm && beside <= job.interval_mm / 2.0;
        if near && self.since.0 + 1 >= ORBIT_MIN {
            ahead.min(job.interval_mm)
        } else {
            job.interval_mm
        }
    }

    /// The level is orbited: on to the next one, or the range is done.
    fn next_level(&mut self, job: &ScanJob) {
        let up = job.tool_place();
        self.ended += 1;
        self.level += job.spacing_mm;
        if self.level > job.max[up] + THERE_MM || self.level < job.min[up] - THERE_MM {
            self.stage = Stage::Home;
            return;
        }
        self.stage = Stage::Leave;
    }

    /// The stylus must stay within the range in the plane.
    fn within(&self, job: &ScanJob, felt: &Felt) -> Result<(), Option<ScanFault>> {
        if matches!(job.pattern, ScanPattern::Meander { .. }) {
            return Ok(());
        }
        let up = job.tool_place();
        let out = (0..3).any(|k| k != up && (felt.at[k] < job.min[k] || felt.at[k] > job.max[k]));
        let fault = match self.stage {
            Stage::Approach => ScanFault::Inaccessible,
            _ => ScanFault::RangeExceeded,
        };
        if out { Err(Some(fault)) } else { Ok(()) }
    }
}
