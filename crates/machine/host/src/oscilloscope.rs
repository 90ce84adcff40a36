//! The oscilloscope of the control: four curves in a memory of 4096 samples, and what triggers it [000:18638-18794].
//!
//! Decision: START of `--oscilloscope` is the start of the program, without one the end of the reference run; with a
//! pre-trigger of 100 % the trigger stands after the last sample

use std::fmt;
use std::str::FromStr;

use bahn_tnc::{ServoSampler, ServoSignal, ServoView};

/// Samples in the memory of a channel [000:18748].
pub const SAMPLES: usize = 4096;
/// Channels that record at the same time [000:18640].
pub const CHANNELS: usize = 4;
/// The shortest and the longest time between two samples, µs [000:18748].
pub const SAMPLE_TIME_US: std::ops::RangeInclusive<u32> = 600..=6000;

/// What a channel records: `X.diff`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Curve {
    /// Letter of the axis.
    pub axis: char,
    /// Signal of the axis that is recorded.
    pub signal: ServoSignal,
}

impl fmt::Display for Curve {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.axis, self.signal)
    }
}

impl FromStr for Curve {
    type Err = String;

    fn from_str(text: &str) -> Result<Curve, String> {
        let parts = text.trim().split_once('.').and_then(|(axis, signal)| {
            let mut letters = axis.chars();
            Some((letters.next()?, letters.next(), signal))
        });
        match parts {
            Some((axis, None, signal)) if axis.is_ascii_uppercase() => Ok(Curve {
                axis,
                signal: signal.parse()?,
            }),
            _ => Err(format!("`{text}` is no channel; one is written X.v-nominal")),
        }
    }
}

/// TRIGGER with its threshold and slope [000:18703-18726].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Trigger {
    /// `free`: FREE RUN, ended by hand, here by `oscilloscope stop` or the end of the run; the memory holds what came last.
    #[default]
    FreeRun,
    /// `single`: SINGLE SHOT, one memory from START on.
    SingleShot,
    /// `X.diff>50`, `X.u<-200`: CHANNEL, when the curve passes the threshold upwards (slope +) or downwards (slope -). Units
    /// are those of the manual: mm/min, mm, mV, and for trailing errors µm.
    Channel {
        /// The curve; it is one of the channels.
        curve: Curve,
        /// In the unit of the curve: mm for trailing errors.
        threshold: f64,
        /// The curve crosses the threshold upwards; otherwise downwards.
        rising: bool,
    },
}

impl FromStr for Trigger {
    type Err = String;

    fn from_str(text: &str) -> Result<Trigger, String> {
        match text.trim() {
            "free" => return Ok(Trigger::FreeRun),
            "single" => return Ok(Trigger::SingleShot),
            _ => {}
        }
        let wrong = || {
            format!("`{text}` is no trigger: free, single, or a channel with its threshold as X.v-actual>500")
        };
        let at = text.find(['>', '<']).ok_or_else(wrong)?;
        let (curve, rest) = text.split_at(at);
        let curve: Curve = curve.parse()?;
        let threshold = rest.get(1..).and_then(|value| value.trim().parse::<f64>().ok());
        let threshold = threshold.filter(|value| value.is_finite()).ok_or_else(wrong)?;
        let unit = if curve.signal == ServoSignal::Lag {
            1e-3
        } else {
            1.0
        };
        Ok(Trigger::Channel {
            curve,
            threshold: threshold * unit,
            rising: rest.starts_with('>'),
        })
    }
}

/// What is recorded, how fast, and what ends the recording.
#[derive(Clone, Debug, PartialEq)]
pub struct OscilloscopeSetup {
    /// Channels 1 to 4.
    pub channels: Vec<Curve>,
    /// SAMPLE TIME, µs: a multiple of the servo step of the control.
    pub sample_us: u32,
    /// TRIGGER with threshold and slope: what ends the recording.
    pub trigger: Trigger,
    /// PRE-TRIGGER: so much of the memory lies before the trigger, 0, 25, 50, 75 or 100 %.
    pub pre_trigger_percent: u8,
}

/// The oscilloscope: it looks at every servo step and allocates in none.
#[derive(Clone, Debug)]
pub struct Oscilloscope {
    setup: OscilloscopeSetup,
    /// Samples in a ring: a new one takes the place of the oldest.
    memory: Vec<[f64; CHANNELS]>,
    /// Samples that were taken; the next one goes to the place of this number.
    taken: u64,
    last_us: u64,
    due_us: u64,
    started: bool,
    /// Number of the sample at which it was triggered.
    triggered: Option<u64>,
    before: Option<f64>,
    complete: bool,
}

/// What the memory holds.
#[derive(Clone, Debug, PartialEq)]
pub struct OscilloscopeRecord {
    /// What the channels recorded, in the order of the values of a sample.
    pub channels: Vec<Curve>,
    /// Time between two samples, µs.
    pub sample_us: u32,
    /// Time of the first sample since power-on, µs.
    pub from_us: u64,
    /// The values of the channels, oldest first.
    pub samples: Vec<[f64; CHANNELS]>,
    /// The sample of the trigger; after the last one with a pre-trigger of 100 %.
    pub trigger: Option<usize>,
}

impl Oscilloscope {
    /// Ready for START.
    ///
    /// # Errors
    /// What of the setup cannot be.
    pub fn new(setup: OscilloscopeSetup) -> Result<Oscilloscope, String> {
        if setup.channels.is_empty() || setup.channels.len() > CHANNELS {
            return Err(format!("the oscilloscope has 1 to {CHANNELS} channels"));
        }
        if !SAMPLE_TIME_US.contains(&setup.sample_us) {
            return Err("the sample time is 0.6 to 6 ms".to_owned());
        }
        if !matches!(setup.pre_trigger_percent, 0 | 25 | 50 | 75 | 100) {
            return Err("the pre-trigger is 0, 25, 50, 75 or 100 %".to_owned());
        }
        if let Trigger::Channel { curve, .. } = setup.trigger
            && !setup.channels.contains(&curve)
        {
            return Err(format!("the trigger {curve} is none of the channels"));
        }
        Ok(Oscilloscope {
            setup,
            memory: vec![[0.0; CHANNELS]; SAMPLES],
            taken: 0,
            last_us: 0,
            due_us: 0,
            started: false,
            triggered: None,
            before: None,
            complete: false,
        })
    }

    /// START; once it records, it goes on.
    pub fn start(&mut self) {
        self.started = true;
    }

    /// START after a STOP: what was in the memory goes.
    pub fn start_anew(&mut self) {
        (self.taken, self.due_us) = (0, 0);
        (self.triggered, self.before, self.complete) = (None, None, false);
        self.started = true;
    }

    /// STOP: the memory stays as it is [000:18776].
    pub fn stop(&mut self) {
        self.started = false;
    }

    /// The memory is full, and nothing more is recorded.
    pub fn is_complete(&self) -> bool {
        self.complete
    }

    /// Samples of the memory that lie before the trigger.
    fn before_trigger(&self) -> u64 {
        SAMPLES as u64 * u64::from(self.setup.pre_trigger_percent) / 100
    }

    /// The number of the first sample that counts.
    fn first(&self) -> u64 {
        let oldest = self.taken.saturating_sub(SAMPLES as u64);
        let wanted = self
            .triggered
            .map(|triggered| triggered.saturating_sub(self.before_trigger()));
        oldest.max(wanted.unwrap_or(0))
    }

    /// How many samples are in the memory.
    pub fn filled(&self) -> usize {
        self.taken.saturating_sub(self.first()) as usize
    }

    /// What is in the memory now.
    pub fn record(&self) -> OscilloscopeRecord {
        let first = self.first();
        let place = |number: u64| {
            self.memory
                .get(number as usize % SAMPLES)
                .copied()
                .unwrap_or_default()
        };
        OscilloscopeRecord {
            channels: self.setup.channels.clone(),
            sample_us: self.setup.sample_us,
            from_us: self.last_us - (self.taken.saturating_sub(first + 1)) * u64::from(self.setup.sample_us),
            samples: (first..self.taken).map(place).collect(),
            trigger: self.triggered.map(|triggered| (triggered - first) as usize),
        }
    }

    /// Whether the sample that is taken now triggers.
    fn triggers(&mut self, sample: &[f64; CHANNELS]) -> bool {
        match self.setup.trigger {
            Trigger::FreeRun => false,
            Trigger::SingleShot => true,
            Trigger::Channel {
                curve,
                threshold,
                rising,
            } => {
                let channel = self.setup.channels.iter().position(|own| *own == curve);
                let Some(now) = channel.and_then(|channel| sample.get(channel)).copied() else {
                    return false;
                };
                let before = self.before.replace(now);
                before.is_some_and(|before| match rising {
                    true => before <= threshold && now > threshold,
                    false => before >= threshold && now < threshold,
                })
            }
        }
    }
}

impl ServoSampler for Oscilloscope {
    fn sample(&mut self, time_us: u64, axes: &ServoView<'_>) {
        if !self.started || self.complete || time_us < self.due_us {
            return;
        }
        self.due_us = time_us + u64::from(self.setup.sample_us);
        let mut sample = [0.0; CHANNELS];
        for (value, curve) in sample.iter_mut().zip(&self.setup.channels) {
            *value = axes.value(curve.axis, curve.signal);
        }
        if self.triggered.is_none() && self.triggers(&sample) {
            self.triggered = Some(self.taken);
        }
        if let Some(triggered) = self.triggered {
            // So many samples follow the trigger; with 100 % none, and it stands after the last one.
            let after = SAMPLES as u64 - self.before_trigger();
            if self.taken >= triggered + after {
                self.complete = true;
                return;
            }
        }
        if let Some(place) = self.memory.get_mut(self.taken as usize % SAMPLES) {
            *place = sample;
        }
        self.taken += 1;
        self.last_us = time_us;
    }
}

impl OscilloscopeRecord {
    /// The time of a sample from the trigger on, or from the first sample without one, s: T1 of the cursor.
    pub fn time_s(&self, sample: usize) -> f64 {
        let steps = sample as f64 - self.trigger.unwrap_or(0) as f64;
        steps * f64::from(self.sample_us) * 1e-6
    }

    /// What the cursors show of a channel: time and value at the first, and the differences to the second.
    pub fn cursors(&self, channel: usize, first: usize, second: usize) -> Option<[(f64, f64); 2]> {
        let value = |sample: usize| self.samples.get(sample)?.get(channel).copied();
        let (a, b) = (value(first)?, value(second)?);
        let (t1, t2) = (self.time_s(first), self.time_s(second));
        Some([(t1, a), (t2 - t1, b - a)])
    }

    /// As a table, which `bahn scope` draws: time since power-on, the channels, and `trigger` where it was.
    pub fn csv(&self) -> String {
        use std::fmt::Write as _;
        let mut text = String::from("time [s]");
        // Writing to a string cannot fail.
        for curve in &self.channels {
            let _ = write!(text, ",{curve} [{}]", curve.signal.unit());
        }
        text.push_str(",event\n");
        for (number, sample) in self.samples.iter().enumerate() {
            let time_us = self.from_us + number as u64 * u64::from(self.sample_us);
            let _ = write!(text, "{:.4}", time_us as f64 * 1e-6);
            for (value, curve) in sample.iter().zip(&self.channels) {
                let places = match curve.signal.unit() {
                    "mm" => 6,
                    "mV" => 2,
                    _ => 3,
                };
                let _ = write!(text, ",{value:.places$}");
            }
            text.push_str(if self.trigger == Some(number) {
                ",trigger\n"
            } else {
                ",\n"
            });
        }
        text
    }
}
