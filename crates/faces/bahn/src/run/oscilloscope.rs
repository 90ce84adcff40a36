//! The oscilloscope of the control beside a run [000:18638-18794].

use std::path::PathBuf;

use bahn_host::oscilloscope::{CHANNELS, Curve, OscilloscopeSetup, Trigger};
use bahn_report::run::Scoped;
use bahn_tnc::{Control, ServoSignal};
use clap::{Args, ValueHint};

use crate::UsageError;

/// What the oscilloscope records.
#[derive(Args, Debug)]
#[command(next_help_heading = "Oscilloscope")]
pub struct OscilloscopeOptions {
    /// Write the memory of the control's oscilloscope, 4096 samples of up to four channels in servo steps; START is the
    /// start of the program, without one the end of the reference run; a script that has entered `code 688379` says
    /// `oscilloscope start` and `oscilloscope stop`. `bahn scope` draws it.
    #[arg(long, value_name = "OUT.csv", value_hint = ValueHint::FilePath)]
    pub oscilloscope: Option<PathBuf>,
    /// What the channels record: v-actual, v-nominal, s-actual, s-nominal, diff, u of each axis, with digital speed
    /// controller n-actual, n-nominal, n-int; as X.v-nominal. Those of X without it.
    #[arg(
        long,
        value_name = "CHANNEL,..",
        value_delimiter = ',',
        requires = "oscilloscope"
    )]
    pub channels: Vec<Curve>,
    /// Time between two samples, ms: 0.6 to 6, a multiple of the servo step.
    #[arg(long, value_name = "MS", requires = "oscilloscope")]
    pub sample_time: Option<f64>,
    /// free: the memory holds what came last; single: one memory from the start; or a channel that passes a threshold
    /// upwards or downwards, as X.v-actual>500 (mm/min, mm, mV; diff in µm).
    #[arg(
        long,
        value_name = "TRIGGER",
        default_value = "single",
        requires = "oscilloscope"
    )]
    pub trigger: Trigger,
    /// Part of the memory before the trigger, %: 0, 25, 50, 75 or 100.
    #[arg(long, value_name = "PERCENT", default_value_t = 0, requires = "oscilloscope")]
    pub pre_trigger: u8,
}

/// The oscilloscope that is asked for.
pub(super) fn scoped(options: &OscilloscopeOptions, control: &Control) -> Result<Option<Scoped>, UsageError> {
    let Some(path) = &options.oscilloscope else {
        return Ok(None);
    };
    if !control.model().has_oscilloscope() {
        return Err(UsageError::new(format!(
            "--oscilloscope: the {} has none; tnc407, tnc415b and tnc425 have",
            control.model()
        )));
    }
    let step_us = control.model().timing().step_us();
    let sample_us = options
        .sample_time
        .map_or(step_us, |ms| (ms * 1000.0).round().clamp(0.0, 1e9) as u32);
    if !sample_us.is_multiple_of(step_us) {
        return Err(UsageError::new(format!(
            "--sample-time: a servo step of the {} is {} ms; the time is a multiple of it",
            control.model(),
            f64::from(step_us) * 1e-3
        )));
    }
    let channels = match options.channels.is_empty() {
        true => usual(control),
        false => options.channels.clone(),
    };
    let view = control.servo_view();
    for curve in &channels {
        let known: Vec<char> = control.axis_letters().collect();
        if !known.contains(&curve.axis) {
            let known: Vec<String> = known.iter().map(char::to_string).collect();
            return Err(UsageError::new(format!(
                "--channels {curve}: the machine has no axis {}; there are {}",
                curve.axis,
                known.join(", ")
            )));
        }
        if curve.signal.is_digital() && !view.is_digital(curve.axis) {
            return Err(UsageError::new(format!(
                "--channels {curve}: {} has no digital speed controller (MP1900)",
                curve.axis
            )));
        }
    }
    let setup = OscilloscopeSetup {
        channels,
        sample_us,
        trigger: options.trigger,
        pre_trigger_percent: options.pre_trigger,
    };
    Scoped::new(path, setup).map(Some).map_err(UsageError::from)
}

/// Feeds, trailing error and voltage of the first axis.
fn usual(control: &Control) -> Vec<Curve> {
    let signals: [ServoSignal; CHANNELS] = [
        ServoSignal::NominalFeed,
        ServoSignal::ActualFeed,
        ServoSignal::Lag,
        ServoSignal::Voltage,
    ];
    let axis = control.axis_letters().next().unwrap_or('X');
    signals.map(|signal| Curve { axis, signal }).into()
}
