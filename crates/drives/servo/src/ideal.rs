//! The shortest plant.

use crate::plant::{Commands, ENCODERS, Encoder, INPUTS, Measured, OperatorInputs, Plant, Step};

/// Axes that stand where they are told to: no drive, no mass, no play. The axis at output 1 has its encoder at X1, and so
/// on; the circuit "control is ready" closes and opens at once. What a PLC program waits for is set by hand.
///
/// An axis with an [`IdealDrive`] follows its voltage instead, so that it has the lag that its loop leaves it.
///
/// It shows what a plant must do, and is a machine for programs in which only the path counts.
///
/// ```
/// use bahn_servo::{AxisCommand, Commands, IdealAxes, Measured, Plant, Step};
/// let (mut plant, mut commands, mut measured) = (IdealAxes::default(), Commands::default(), Measured::default());
/// plant.marks[0] = Some(700);
/// commands.axes[0] = AxisCommand { enabled: true, position_steps: Some(1000.0), ..AxisCommand::default() };
/// plant.exchange(Step { from_us: 0, length_us: 600 }, &commands, &mut measured);
/// assert_eq!((measured.encoders[0].count, measured.encoders[0].mark), (1000, Some(700)));
/// ```
#[derive(Clone, Debug)]
pub struct IdealAxes {
    /// The count of the reference mark of each encoder.
    pub marks: [Option<i64>; ENCODERS],
    /// The PLC inputs by their numbers.
    pub inputs: [bool; INPUTS],
    /// Override potentiometers and handwheel.
    pub operator: OperatorInputs,
    /// The drives of axes that follow their voltage, by the number of their encoder; the others follow their position.
    pub drives: [Option<IdealDrive>; ENCODERS],
    /// The part of a counting step that an encoder does not count yet.
    parts: [f64; ENCODERS],
    counts: [i64; ENCODERS],
    ready: bool,
}

/// A drive that turns its voltage into speed at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdealDrive {
    /// The nominal value output that it is connected to, from 0.
    pub output: usize,
    /// Counting steps of the encoder in a second, for each volt.
    pub steps_s_volt: f64,
    /// It does not move any more, whatever its voltage.
    pub is_dead: bool,
}

impl Default for IdealAxes {
    fn default() -> IdealAxes {
        IdealAxes {
            marks: [None; ENCODERS],
            inputs: [false; INPUTS],
            operator: OperatorInputs {
                feed_override_percent: 100.0,
                spindle_override_percent: 100.0,
                ..OperatorInputs::default()
            },
            drives: [None; ENCODERS],
            parts: [0.0; ENCODERS],
            counts: [0; ENCODERS],
            ready: false,
        }
    }
}

impl IdealAxes {
    /// These axes in the place of those of a plant, which keeps its contacts and what the operator has in his hands: a
    /// programming station, which has no machine.
    pub fn over<'a>(&'a mut self, plant: &'a mut dyn Plant) -> impl Plant + use<'a> {
        OverPlant { ideal: self, plant }
    }

    /// Where its encoders and its circuit are now.
    fn tell(&self, measured: &mut Measured) {
        for (encoder, count) in measured.encoders.iter_mut().zip(self.counts) {
            *encoder = Encoder {
                count,
                ..Encoder::default()
            };
        }
        (measured.control_ready, measured.control_ready_changed_at) = (self.ready, None);
    }

    /// Turns an encoder by hand by so many steps.
    pub fn turn(&mut self, encoder: usize, steps: i64) {
        if let Some(count) = self.counts.get_mut(encoder) {
            *count += steps;
        }
    }

    /// The way that the drive of an encoder makes in a step, whole steps.
    fn driven(&mut self, encoder: usize, commands: &Commands, step: Step) -> Option<i64> {
        let drive = (*self.drives.get(encoder)?)?;
        let volts = commands
            .axes
            .get(drive.output)
            .map_or(0.0, |command| command.volts);
        let part = self.parts.get_mut(encoder)?;
        if !drive.is_dead {
            *part += volts * drive.steps_s_volt * f64::from(step.length_us) * 1e-6;
        }
        let whole = part.round();
        *part -= whole;
        Some(whole as i64)
    }

    /// Where an encoder stands, steps since power-on.
    pub fn count(&self, encoder: usize) -> i64 {
        self.counts.get(encoder).copied().unwrap_or(0)
    }
}

/// A plant whose axes are ideal ones.
struct OverPlant<'a> {
    ideal: &'a mut IdealAxes,
    plant: &'a mut dyn Plant,
}

impl Plant for OverPlant<'_> {
    fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured) {
        let outputs = Commands {
            outputs: commands.outputs,
            reads_inputs: commands.reads_inputs,
            ..Commands::default()
        };
        self.plant.exchange(step, &outputs, measured);
        (self.ideal.inputs, self.ideal.operator) = (measured.inputs, measured.operator);
        // What the plant measures of its own axes is not told.
        self.ideal.tell(measured);
        self.ideal.exchange(step, commands, measured);
    }
}

impl Plant for IdealAxes {
    fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured) {
        measured.inputs = self.inputs;
        measured.operator = self.operator;
        if step.length_us == 0 {
            return;
        }
        let ways: [Option<i64>; ENCODERS] =
            std::array::from_fn(|encoder| self.driven(encoder, commands, step));
        let places = self.counts.iter_mut().zip(&self.marks).zip(ways);
        for (((count, mark), way), (command, encoder)) in
            places.zip(commands.axes.iter().zip(&mut measured.encoders))
        {
            let from = *count;
            if let Some(way) = way {
                *count += way;
            } else if let Some(position) = command.position_steps.filter(|_| command.enabled) {
                *count = position.round() as i64;
            }
            let passed = from.min(*count)..from.max(*count);
            *encoder = Encoder {
                count: *count,
                mark: mark.filter(|mark| passed.contains(mark)),
                ..Encoder::default()
            };
        }
        measured.control_ready_changed_at = (self.ready != commands.control_ready).then_some(0);
        self.ready = commands.control_ready;
        measured.control_ready = self.ready;
    }
}
