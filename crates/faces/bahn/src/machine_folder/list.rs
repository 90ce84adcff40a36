//! `bahn machine list`: what a script can speak of.

use bahn_host::{Expectation, Machine900};
use bahn_machine::Event;

use super::load;
use super::options::ListOptions;
use crate::diagnostics;
use crate::{Outcome, UsageError, console};
use bahn_report::machine_names900;
use bahn_text::printable;

/// Commands of the control, a line each.
const COMMANDS: &str = "\
mode manual|handwheel|mdi|single|full|reference
ce                                  clears a message
stop                                internal stop of an interrupted run
select PROGRAM                      the program that runs
goto N                              the run starts at this block
mdi BLOCK                           a block for MDI; \\n separates several
m N                                 an M function in manual operation, output with NC start
s RPM                               a spindle speed, likewise
datum AXIS VALUE                    the actual position becomes this value
probe length HEIGHT                 calibrates the effective length on a face at this height; NC start probes
probe radius R                      effective radius and centre offset in a ring gauge of this radius
probe turn                          turns the probe by 180 degrees for the centre offset
probe rotation                      basic rotation over two points of a side
probe surface|circle                datum in an axis, at the centre of a circle
probe corner [reuse]                datum in a corner; reuse takes over the side of the basic rotation
probe direction X+|all              what the next NC start probes; all four directions from within
probe datum AXIS VALUE              what was probed becomes this value
probe angle DEGREES                 rotation angle: the basic rotation, and nominal angle of the next side
probe end                           leaves the function
tool-life TOOL MIN                  current life of a tool (CUR.TIME), minutes
q N VALUE                           a Q parameter, between runs or while one is interrupted
axis-limit AXIS RANGE LEAST MOST    AXIS LIMIT of a traverse range 1 to 3, from machine zero
axis-limit AXIS RANGE off           without it
table T LINE COLUMN VALUE           a cell of the tool table, with D a datum table, with P the pocket table: it counts at once
jog MM                              jog increment
output step FEED, output ramp       what direction keys put out on axes with digital speed controller
oscilloscope start|stop             recording of --oscilloscope by hand, after `code 688379`
handwheel AXIS FACTOR               axis of the handwheel, interpolation factor 0 to 10
pnt on|off                          the axes follow the stylus of a measuring probe in MDI
axis-key AXIS                       an axis key of the keyboard in the modes by hand: the axis is highlighted, M2096 ff.
3d-rot [run] on [B+30], 3d-rot [run] off   the plane of the swivel axes, by hand or for program run; several angles: B+30 C+10
screen EDITING MACHINE WINDOWS FILE UNITS   items 2 to 5 and 17 of module 9035
manual-operation                    axes may be moved while a run is interrupted
restore-position                    back to the contour with NC start
restore-at N                        block scan to block N
code N                              a code number
key CODE                            what W516 calls: a key by its code 58 to 127; 0 INTERNAL STOP, 256 M, 512 S, 768 TOUCH
                                    PROBE, 1024 PASS OVER REFERENCE, 1280 RESTORE POSITION; a letter * 256 + 80
test PROGRAM                        TEST RUN beside what the machine does
test-run stop, test-run stop N      interrupts it, at once or at block N
test-run go-on                      it goes on, as after STOP and M0
test-run q N VALUE                  a Q parameter of an interrupted test
end-test                            breaks it off
offset adjust|off                   answers to code number 75368
rs232 ready on|off                  the other side of a data interface is there; so `rs422`
rs232 received \"TEXT\"               a text for the PLC has come; `faulty`: it cannot be read, `etx`: no more is wanted
rs232 sent|not-sent                 what became of a text of the PLC
rs232 baud N, rs232 taken on|off    rate of the mode that the operator chose; his transfer has the line
lsv2 connected|disconnected|taken   a host is there; it has taken a message of the PLC
lsv2 message N|\"TEXT\"               a message of the host to the PLC
2: COMMAND                          a command to the second channel
M100=1, W6=$10, S0=\"TEXT\"           operands, as in the table of the PLC menu; inputs are the machine's
MP4110.2=4                          a machine parameter of the running control, with what its change needs
power on|off                        the supply of the control
";

/// What can be recorded, a line each.
const SIGNALS: &str = "\
X.actual X.nominal                  position in machine coordinates, mm or degrees
X.displayed                         as it is displayed: from the workpiece datum, with the tool length
X.ref                               as REF shows it, rotary axes within their modulo value
X.table                             where the table stands in truth, from the zero point of the plant
X.lag X.distance                    servo lag, distance to go in the block
X.n-actual X.n-nominal X.n-int      speeds of a digital speed controller (TNC 425, MP1900), their difference
X.probed                            what the probe menu shows as datum; NaN before
probe.length probe.radius           calibrated, mm
probe.angle probe.touches           basic rotation, degrees; touches of the function that is chosen
probe.circle                        radius of the circle that was probed, mm
X.speed X.nominal-speed             mm/min
X.volts output.1 .. output.S        V: of the axis, at each analogue output
X.force                             of the motor, N or Nm
path.speed path.distance path.block speed, way to the end of the element, number of the block
S.rpm S.volts S.angle               the spindle; angle since power-on with all turns
mode run tool                       W272; 0 idle 1 running 2 interrupted 3 stopped 4 block-end; in the spindle
magazine.pocket magazine.angle      pocket at the change position; how far the arm has turned, degrees
magazine.shuttle magazine.gripper   tool in the shuttle, in the gripper beside it (0 none)
magazine.gripper2 magazine.spindle  tool in the gripper at the spindle, in the spindle
Q5                                  a Q parameter at the block that is executed
X41/34 X42/4                        control is ready, and its acknowledgement
M2045 I4 O2 T48 C0 B8 W260 D356     as the PLC sees it; the column event tells of `M100 pulse` inside a scan
";

/// Prints the names of a machine.
pub(super) fn command(options: &ListOptions) -> Result<Outcome, UsageError> {
    if Machine900::is_meant(&options.folder) {
        return Ok(match Machine900::load(&options.folder)? {
            Ok(machine) => {
                console::print(&machine_names900(&machine))?;
                Outcome::Fine
            }
            Err(faults) => {
                diagnostics::print_faults(&faults);
                Outcome::ProgramError
            }
        });
    }
    let machine = match load(&options.folder)? {
        Ok(machine) => machine,
        Err(faults) => {
            diagnostics::print_faults(&faults);
            return Ok(Outcome::ProgramError);
        }
    };
    let plant = machine.simulated()?;
    let axes: Vec<String> = plant.axes().map(|axis| axis.letter.to_string()).collect();
    let things: Vec<&str> = plant.devices().map(|device| device.name).collect();
    let row = |name: &str, items: Vec<&str>| format!("{name:<10}{}\n", items.join(" "));
    let mut text = format!(
        "{}, {}\n\n",
        printable(&machine.folder.name),
        machine.parameters.model()
    );
    for (number, channel) in (2..).zip(&machine.channels) {
        let axes = channel.axes.iter().enumerate().filter_map(|(index, id)| {
            let letter = channel
                .parameters
                .axis_parameters(u8::try_from(index).ok()?)
                .letter?;
            Some(format!("{number}:{} (axis {})", letter.letter(), (*id)?.number()))
        });
        let axes: Vec<String> = axes.collect();
        text += &row(
            &format!("channel {number}"),
            axes.iter().map(String::as_str).collect(),
        );
    }
    text += &row("axes", axes.iter().map(String::as_str).collect());
    text += &row("keys", plant.keys().collect());
    text += &row("lamps", plant.lamps().collect());
    text += &row("things", things);
    text += &format!("\nEvents:\n{}", Event::HELP);
    text += &format!("\nCommands:\n{COMMANDS}");
    text += &format!("\nSignals, for --signals and expectations:\n{SIGNALS}");
    text += &format!("\nExpectations, and the end:\n{}end\n", Expectation::HELP);
    console::print(&text)?;
    Ok(Outcome::Fine)
}

#[cfg(test)]
mod tests {
    use bahn_host::Action;

    use super::*;

    /// What stands for the words in capitals of the list.
    const EXAMPLES: [(&str, &str); 26] = [
        ("EDITING", "1"),
        ("MACHINE", "2"),
        ("WINDOWS", "0"),
        ("FILE", "3"),
        ("UNITS", "0"),
        ("PROGRAM", "1.H"),
        ("BLOCK", "L X+1"),
        ("RPM", "100"),
        ("AXIS", "X"),
        ("VALUE", "5"),
        ("HEIGHT", "0"),
        ("DEGREES", "5"),
        ("FACTOR", "3"),
        ("FEED", "240"),
        ("CODE", "107"),
        ("MIN", "2"),
        ("COMMAND", "mode full"),
        ("MM", "1"),
        ("N", "5"),
        ("R", "20"),
        ("TOOL", "3"),
        ("RANGE", "1"),
        ("LEAST", "-10"),
        ("MOST", "10"),
        ("LINE", "1"),
        ("COLUMN", "L"),
    ];

    /// The commands that a form stands for: `probe surface|circle` are two.
    fn given(form: &str) -> Vec<String> {
        let mut commands = vec![String::new()];
        for word in form.split(' ') {
            let word = word.trim_matches(['[', ']']);
            let choices = word.split('|').map(|choice| {
                let example = EXAMPLES.iter().find(|(of, _)| *of == choice);
                example.map_or(choice, |(_, example)| example)
            });
            let choices: Vec<&str> = choices.collect();
            let longer = |command: String| {
                choices
                    .clone()
                    .into_iter()
                    .map(move |word| format!("{command} {word}"))
            };
            commands = commands.into_iter().flat_map(longer).collect();
        }
        commands
    }

    /// Each command can be given as the list says, also where an event of the machine begins with the same word, and a
    /// log reads it again.
    #[test]
    fn every_command_of_the_list_can_be_given() {
        let own = |line: &&str| !line.contains('=') && !line.starts_with(' ');
        let forms = COMMANDS.lines().filter(own);
        let forms = forms.map(|line| line.split("  ").next().unwrap_or(line));
        let commands: Vec<String> = forms
            .flat_map(|forms| forms.split(", "))
            .flat_map(given)
            .collect();
        assert!(commands.len() > 40, "{commands:?}");
        for command in commands {
            match Action::parse(command.trim()) {
                Ok(action @ Action::Command(..)) => {
                    let written = action.to_string();
                    assert_eq!(Action::parse(&written), Ok(action), "{written}");
                }
                other => unreachable!("{command}: {other:?}"),
            }
        }
    }
}
