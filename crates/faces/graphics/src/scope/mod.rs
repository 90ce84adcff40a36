//! The oscilloscope of the control on the screen [000:18638-18794]: what is recorded, and how it is looked at. `curves` are
//! what is to be seen of it, drawn by whoever wants it.

mod curves;
mod recorded;

use bahn_host::oscilloscope::{
    CHANNELS, Curve, Oscilloscope, OscilloscopeRecord, OscilloscopeSetup, SAMPLE_TIME_US, SAMPLES, Trigger,
};
use bahn_screen::{GraphicsLine, GraphicsView};
use bahn_tnc::{Control, OscilloscopeKeys, ServoSampler, ServoSignal};

pub(crate) use curves::ScopeColours;
pub use curves::{Curves, Lane, Sight, name as signal_name};

use recorded::FEWEST;
pub use recorded::Recorded;

/// Between two pictures while it records, µs (inferred).
const EVERY_US: u64 = 200_000;

/// What a channel shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Content {
    /// OFF: nothing is recorded or shown.
    #[default]
    Off,
    /// This signal of the axis is recorded.
    Signal(ServoSignal),
    /// SAVED: what was recorded stays to be compared with; it is not shown while another recording is on its way.
    Saved,
}

/// One of the channels of the oscilloscope.
#[derive(Clone, Debug, Default)]
pub struct Channel {
    /// Letter of its axis.
    pub axis: char,
    /// Signal to record, or what else it shows.
    pub content: Content,
    /// What was recorded of it last.
    pub curve: Option<Recorded>,
}

/// TRIGGER: what begins the recording.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TriggerOn {
    /// FREE RUN: it records until STOP.
    #[default]
    FreeRun,
    /// SINGLE SHOT: it records one fill of the memory.
    SingleShot,
    /// A channel passes the threshold.
    Channel(usize),
}

/// What is to be recorded, as it stands in the main display [000:18682-18699].
#[derive(Clone, Debug)]
pub struct ScopeSetup {
    /// OUTPUT STEP, not RAMP.
    pub step: bool,
    /// NOML. FEED RATE of the step, mm/min.
    pub feed_mm_min: f64,
    /// Time between two samples, µs.
    pub sample_us: u32,
    /// The channels in their order.
    pub channels: [Channel; CHANNELS],
    /// What it waits for.
    pub trigger: TriggerOn,
    /// In the unit of the channel; µm for trailing errors [000:18717-18725].
    pub threshold: f64,
    /// The threshold is passed upwards.
    pub rising: bool,
    /// Part of the memory before the trigger, %.
    pub pre_trigger_percent: u8,
}

/// The oscilloscope of a station; it stays as it is while other pages are shown.
pub struct Scope {
    /// What is to be recorded.
    pub setup: ScopeSetup,
    /// How the operator looks at the curves.
    pub sight: Sight,
    recorder: Option<Oscilloscope>,
    records: bool,
    /// How often START had been pressed when it began.
    starts: u32,
    serial: u64,
    shown_us: u64,
    trigger: Option<usize>,
    sample_us: u32,
}

impl Scope {
    /// That of a control that was switched on: the values of the start screen [000:18682-18694].
    pub fn new(control: &Control) -> Scope {
        let axis = control.axis_letters().next().unwrap_or('X');
        let channel = Channel {
            axis,
            ..Channel::default()
        };
        let step_us = control.model().timing().step_us();
        let sample_us = step_us.max(*SAMPLE_TIME_US.start());
        Scope {
            setup: ScopeSetup {
                step: false,
                feed_mm_min: 0.0,
                sample_us,
                channels: std::array::from_fn(|_| channel.clone()),
                trigger: TriggerOn::FreeRun,
                threshold: 0.0,
                rising: true,
                pre_trigger_percent: 0,
            },
            sight: Sight::default(),
            recorder: None,
            records: false,
            starts: 0,
            serial: 0,
            shown_us: 0,
            trigger: None,
            sample_us,
        }
    }

    /// Another picture is wanted.
    pub fn changed(&mut self) {
        self.serial += 1;
    }

    /// Something is to be recorded: START can be pressed.
    pub fn can_record(&self) -> bool {
        self.setup.to_record().is_some()
    }

    /// START was pressed, and the recording has not ended yet.
    pub fn records(&self) -> bool {
        self.records
    }

    /// The memory is full.
    pub fn is_complete(&self) -> bool {
        self.recorder.as_ref().is_some_and(Oscilloscope::is_complete)
    }

    /// Who looks at the servo steps of the next cycle; START and STOP count from here on.
    pub fn sampler(&mut self, keys: OscilloscopeKeys) -> Option<&mut dyn ServoSampler> {
        if keys.records && (!self.records || keys.starts != self.starts) {
            self.begin(keys.starts);
        } else if self.records && !keys.records {
            self.end();
        }
        let records = self.records;
        let recorder = self.recorder.as_mut().filter(|_| records)?;
        Some(recorder)
    }

    fn begin(&mut self, starts: u32) {
        self.records = true;
        self.starts = starts;
        let setup = self.setup.to_record();
        self.sample_us = self.setup.sample_us;
        self.recorder = setup.and_then(|setup| Oscilloscope::new(setup).ok());
        if let Some(recorder) = &mut self.recorder {
            recorder.start();
        }
        self.sight.whole();
        self.changed();
    }

    /// STOP: the channels keep what was recorded.
    fn end(&mut self) {
        self.records = false;
        let Some(mut recorder) = self.recorder.take() else {
            return;
        };
        recorder.stop();
        self.keep(&recorder.record());
        self.changed();
    }

    fn keep(&mut self, record: &OscilloscopeRecord) {
        self.trigger = record.trigger;
        let channels = self.setup.channels.iter_mut();
        let recorded = channels.filter(|channel| matches!(channel.content, Content::Signal(_)));
        for (place, channel) in recorded.enumerate() {
            channel.curve = curve_of(record, place);
        }
    }

    /// The machine was brought to another moment, or switched off.
    pub fn break_off(&mut self) {
        self.end();
        self.starts = 0;
    }

    /// Once in every contour cycle.
    pub fn cycle(&mut self, now_us: u64) {
        if self.records && now_us.abs_diff(self.shown_us) >= EVERY_US {
            self.shown_us = now_us;
            self.changed();
        }
    }

    /// What the screen says of it.
    pub fn line(&self) -> GraphicsLine {
        let filled = self.recorder.as_ref().map(Oscilloscope::filled);
        GraphicsLine {
            view: GraphicsView::Oscilloscope,
            running: self.records,
            progress: filled.unwrap_or(0) as f64 / SAMPLES as f64,
            machining_time_s: None,
            magn: 1,
            azimuth_deg: 0.0,
            sections: [0.5; 2],
            serial: self.serial,
        }
    }

    /// The curves as they are now.
    pub fn curves(&self) -> Curves {
        let live = self.recorder.as_ref().map(Oscilloscope::record);
        let mut place = 0;
        let lanes = self
            .setup
            .channels
            .iter()
            .enumerate()
            .filter_map(|(number, channel)| {
                let shown = match (&channel.content, &live) {
                    (Content::Signal(_), Some(live)) => {
                        place += 1;
                        curve_of(live, place - 1)
                    }
                    (Content::Off, _) | (Content::Saved, Some(_)) => None,
                    (_, None) => channel.curve.clone(),
                };
                Some(Lane {
                    number,
                    recorded: shown?,
                    zoom: self.sight.zoom[number],
                    inverted: self.sight.inverted[number],
                })
            });
        Curves {
            lanes: lanes.collect(),
            sample_us: self.sample_us,
            trigger: live.as_ref().map_or(self.trigger, |live| live.trigger),
            sight: self.sight.clone(),
        }
    }
}

fn curve_of(record: &OscilloscopeRecord, place: usize) -> Option<Recorded> {
    Some(Recorded {
        curve: *record.channels.get(place)?,
        samples: record
            .samples
            .iter()
            .map(|sample| sample.get(place).copied().unwrap_or_default())
            .collect(),
    })
}

impl ScopeSetup {
    /// As the recorder takes it; `None` while all channels are OFF, or the one that triggers is.
    fn to_record(&self) -> Option<OscilloscopeSetup> {
        let curve = |channel: &Channel| match channel.content {
            Content::Signal(signal) => Some(Curve {
                axis: channel.axis,
                signal,
            }),
            _ => None,
        };
        let channels: Vec<Curve> = self.channels.iter().filter_map(curve).collect();
        let trigger = match self.trigger {
            TriggerOn::FreeRun => Trigger::FreeRun,
            TriggerOn::SingleShot => Trigger::SingleShot,
            TriggerOn::Channel(number) => {
                let curve = self.channels.get(number).and_then(curve)?;
                // Thresholds of trailing errors are entered in µm.
                let unit = if curve.signal == ServoSignal::Lag {
                    1e-3
                } else {
                    1.0
                };
                Trigger::Channel {
                    curve,
                    threshold: self.threshold * unit,
                    rising: self.rising,
                }
            }
        };
        (!channels.is_empty()).then_some(OscilloscopeSetup {
            channels,
            sample_us: self.sample_us,
            trigger,
            pre_trigger_percent: self.pre_trigger_percent,
        })
    }
}
