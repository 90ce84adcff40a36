//! Machine parameters by their numbers: each reaches the getter that is meant.

use std::collections::BTreeMap;

use bahn_parameters::{ControlModel, Definition, ParameterId, ParameterList};

/// Everything that the getters say of a list, by where it stands: `axis.0.motion.rapid_mm_min`.
fn said(list: &ParameterList) -> BTreeMap<String, String> {
    let mut said = BTreeMap::new();
    for index in 0..5 {
        let axis = format!("{:#?}", list.axis_parameters(index));
        take(&mut said, &format!("axis.{index}"), &axis);
    }
    for (name, value) in [
        ("spindle", format!("{:#?}", list.spindle_parameters())),
        ("operation", format!("{:#?}", list.operation_parameters())),
        ("plc", format!("{:#?}", list.plc_parameters())),
        ("graphics", format!("{:#?}", list.graphics())),
        ("probe", format!("{:#?}", list.probe())),
        ("digitizing", format!("{:#?}", list.digitizing())),
        ("clearing", format!("{:#?}", list.program_end_clearing())),
        ("scaled_axes", format!("{:?}", list.scaled_axes())),
        ("m", format!("{:#?}", list.m_functions())),
        ("pocket", format!("{:#?}", list.contour_pocket())),
        ("tapping", format!("{:#?}", list.tapping())),
        ("pocket_overlap", format!("{:?}", list.pocket_overlap())),
        ("arc_tolerance_mm", format!("{:?}", list.arc_tolerance_mm())),
        ("corner_angle_deg", format!("{:?}", list.corner_angle_deg())),
        (
            "radial_acceleration",
            format!("{:?}", list.radial_acceleration_m_s2()),
        ),
    ] {
        take(&mut said, name, &value);
    }
    for timer in 0..48 {
        said.insert(format!("timer.{timer}"), list.timer_preset(timer).to_string());
    }
    for counter in 0..32 {
        said.insert(
            format!("counter.{counter}"),
            list.counter_preset(counter).to_string(),
        );
    }
    for (numbers, index) in (0..32).flat_map(|index| [(0, index), (1, index)]) {
        said.insert(
            format!("number.{numbers}.{index}"),
            format!("{:?}", list.plc_number(numbers, index)),
        );
    }
    said
}

/// Takes what `{:#?}` prints, a line for each value.
fn take(said: &mut BTreeMap<String, String>, name: &str, printed: &str) {
    let mut path = vec![name.to_owned()];
    let mut counts: Vec<usize> = Vec::new();
    for line in printed.lines() {
        let depth = (line.len() - line.trim_start().len()) / 4;
        path.truncate(depth.max(1));
        counts.resize(depth + 1, 0);
        let text = line.trim().trim_end_matches(',');
        if matches!(text, "}" | "]" | ")") {
            continue;
        }
        let count = counts.last().copied().unwrap_or_default();
        if let Some(last) = counts.last_mut() {
            *last += 1;
        }
        let (field, value) = match text.split_once(": ") {
            Some((field, value)) => (field.to_owned(), value),
            None => (count.to_string(), text),
        };
        if depth > 0 {
            path.push(field);
        }
        said.insert(path.join("."), value.to_owned());
    }
}

/// Whether another value of the parameter changes what the list says at a place.
fn changes(list: &ParameterList, before: &BTreeMap<String, String>, id: ParameterId, path: &str) -> bool {
    let definition = Definition::named(list.model(), id).unwrap();
    let index = definition.id.index.unwrap_or(0);
    let now = list.get(id.number, index).unwrap();
    let others = [
        definition.max,
        definition.min,
        now + 1.0,
        now - 1.0,
        now * 2.0,
        1.0,
        2.0,
        3.0,
    ];
    others.into_iter().any(|value| {
        let mut other = list.clone();
        other.set(id.number, index, value).is_ok() && before.get(path) != said(&other).get(path)
    })
}

/// What `*` stands for in a title: an axis, or a number.
fn index_of(text: &str) -> Option<usize> {
    let axes = [&["X"][..], &["Y"], &["Z"], &["IV", "4th"], &["5th"]];
    let axis = axes.iter().position(|names| names.contains(&text));
    axis.or_else(|| text.parse().ok())
}

/// The place that a row means for a parameter: `*` is the same axis or number in title and place, `#` one less.
fn meant(row: (&str, &str), title: &str) -> Option<String> {
    let (pattern, path) = row;
    let Some((before, after)) = pattern.split_once('*') else {
        return (pattern == title).then(|| path.to_owned());
    };
    let index = index_of(title.strip_prefix(before)?.strip_suffix(after)?)?;
    let one_less = index.checked_sub(1).map(|index| index.to_string());
    Some(
        path.replace('*', &index.to_string())
            .replace('#', &one_less.unwrap_or_default()),
    )
}

/// Every parameter that a title of the table names changes the value that is meant, whatever else follows from it.
fn each_reaches(model: ControlModel, context: &[&str], table: &str) {
    let mut list = ParameterList::reference(model);
    for assignment in context {
        list.assign(assignment).unwrap();
    }
    let before = said(&list);
    for row in table.lines() {
        let row = row.split_once(" | ").unwrap();
        let mut found = 0;
        for definition in Definition::all(model) {
            let separator = if definition.axis.is_empty() { "" } else { ", " };
            let title = format!("{}{separator}{}", definition.name, definition.axis);
            let number = definition.id.to_string();
            let Some(path) = meant(row, &title).or_else(|| meant(row, &number)) else {
                continue;
            };
            found += 1;
            assert!(
                changes(&list, &before, definition.id, &path),
                "{model} {number}: {path} stays"
            );
        }
        assert!(found > 0, "{model}: no parameter is called {}", row.0);
    }
}

/// TNC 151/155 [001:3144-3365]; axes 0 to 3 are X, Y, Z, IV. TNC 415 B [000:10100-10480].
///
/// The titles are those of the lists' data, which were read from the manual apart from the getters. So a getter that
/// takes the number of another parameter or axis fails, unless the data have the same error. What a title means is
/// said here by hand; that the value arrives unchanged, in its unit, other tests prove.
#[test]
#[expect(clippy::too_many_lines, reason = "two tables")]
fn each_number_reaches_its_getter() {
    const OLD: &str = "\
Rapid traverse * | axis.*.motion.rapid_mm_min
Manual (jog) feed * | axis.*.motion.manual_mm_min
Speed for reference point approach * | axis.*.reference.feed_mm_min
Encoder signal evaluation * | axis.*.encoder.signal_period_um
Traverse direction for reference approach * | axis.*.reference.direction
Counting direction * | axis.*.encoder.counts_negative
Polarity of nominal value voltage * | axis.*.output.polarity_negative
Integral factor * | axis.*.output.integral_factor
Factor for difference value (square-root characteristic) * | axis.*.precontrol.kv
Backlash compensation * | axis.*.compensation.backlash_mm
Linear error compensation * | axis.*.compensation.linear_mm_m
Software limit switch *+ | axis.*.travel.ranges_mm.0.1
Software limit switch *- | axis.*.travel.ranges_mm.0.0
Analogue voltage at rapid traverse | axis.0.output.rapid_volts
Approach speed 1 um before nominal position (square-root characteristic) | axis.0.precontrol.transient_m_min
Oscillation (transient) behaviour when accelerating (square-root characteristic) | axis.0.precontrol.damping
Acceleration | axis.0.motion.acceleration_m_s2
Circular (radial) acceleration | radial_acceleration
Position supervision, erasable (square-root characteristic) | axis.0.precontrol.monitoring_mm
Position supervision, EMERGENCY STOP (square-root characteristic) | axis.0.precontrol.emergency_mm
Positioning window X, Y, Z | axis.0.monitoring.window_mm
Axis sequence for reference point approach | axis.0.reference.place.0
Speed pre-control / ramp characteristic | axis.0.precontrol_in_automatic
Output of tool numbers (TOOL CALL) | operation.tools.call.what
Output of spindle speed | spindle.output
Limitation of RPM code | spindle.codes.max
Memory function for axis direction buttons | operation.keys_latched
Spindle voltage during gear change (oscillation) | spindle.settings.jog_volts
Inhibited axes (not servo controlled) | axis.0.controlled
Override functions | operation.overrides.feed_steps
Display and transducer supervision | axis.0.encoder.check_amplitude
Maximum spindle speed gear * (S-override 100 %) | spindle.settings.gears.#.rated_rpm
Maximum spindle speed gear 5 (S-override 100 %) / comparator speed of gear 1 | spindle.settings.gears.4.rated_rpm
Maximum spindle speed gear 6 (S-override 100 %) / comparator speed of gear 2 | spindle.settings.gears.5.rated_rpm
Maximum spindle speed gear 7 (S-override 100 %) / comparator speed of gear 3 | spindle.settings.gears.6.rated_rpm
Maximum spindle speed gear 8 (S-override 100 %) / comparator speed of gear 4 | spindle.settings.gears.7.rated_rpm
S analogue voltage at S-override 100 % | spindle.settings.gears.0.rated_volts
S analogue voltage at maximum output (absolute limit) | spindle.settings.max_volts
S-override maximum | spindle.settings.override_percent.1
S-override minimum | spindle.settings.override_percent.0
Axis IV designation | axis.3.letter.0
Corner angle for constant contouring speed (external corners) | corner_angle_deg
Decimal character, dialogue language, switch-on test | operation.english
Overlap factor for pocket milling | pocket_overlap
PLC: preset for counter * | counter.*
PLC: timer * | timer.*
PLC: timer 13: standard PLC program timer (meaning not stated) | timer.13
PLC: timer 14: gear change: spindle voltage MP70 polarity time (first direction, inferred) | timer.14
PLC: timer 15: gear change: spindle voltage MP70 polarity time (second direction, inferred) | timer.15
Output of next tool number (TOOL DEF) | operation.tools.definition.what
Automatic lubrication after traverse in * | axis.*.travel.lubrication_mm
Feed rate for PLC positioning (MP126-156) * | axis.*.motion.plc_mm_min
Ramp gradient of S analogue output | spindle.settings.ramps.normal_v_ms
Standstill supervision | axis.0.monitoring.standstill_mm
Programming station | operation.station
Handwheel and touch probe | operation.handwheel.kind
Polarity of S analogue voltage | spindle.settings.polarity
Cancel status display with M02, M30, program end | clearing.at_program_end
Lag supervision, linear characteristic: EMERGENCY STOP | axis.0.lag.emergency_mm
Lag supervision, linear characteristic: erasable | axis.0.lag.monitoring_mm
Multiplication factor for Kv beyond the kink | axis.0.lag.kink_factor
Kv factor * | axis.*.lag.kv
Characteristic kink point | axis.0.lag.kink_percent
Tapping: minimum feed override | spindle.tapping.override_percent.0
Tapping: maximum feed override | spindle.tapping.override_percent.1
Minimum voltage for S analogue output | spindle.settings.min_volts
Delay before residual nominal voltage is cut off with POSITIONING ERROR | axis.0.monitoring.residual_voltage_s
M92 tool change position * | axis.*.travel.m92_mm
Programming S = 0 | spindle.settings.zero_permitted
Positioning window axis * | axis.*.monitoring.window_mm
SCALING cycle | scaled_axes
M06 stop, M89, axis standstill | m.axes_wait
Touch probe: probing feed | probe.feed_mm_min
Touch probe: measuring distance | probe.range_mm
Movement supervision | axis.0.monitoring.movement_volts
Touch probe: safety distance before the point (automatic probing) | probe.clearance_mm
Graphics projection, coordinate system rotation | graphics.third_angle
Axis V | spindle.controlled
Kv factor axis V | spindle.settings.gears.0.kv
Counting direction axis V | spindle.settings.counts_negative
Position value at the reference mark, axis V | spindle.settings.orientation.reference_deg
Variable contour pocket | pocket.clear_out_first
Spacing of distance-coded reference marks * | axis.*.reference.kind
Positioning window axis V | spindle.settings.orientation.window_deg
Handwheel hysteresis | operation.handwheel.threshold
Spindle speed for orientation | spindle.settings.orientation.speed_rpm
Touch probe: rapid traverse | probe.rapid_mm_min
Cycle time of automatic offset adjustment | axis.0.offset_interval_s
Transducer input X assigned to | axis.1.wiring.input
Transducer input Y assigned to | axis.0.wiring.input
Transducer input Z assigned to | axis.0.wiring.input
Transducer input IV assigned to | axis.0.wiring.input
Transducer input V assigned to | axis.0.wiring.input
Spindle speed for orientation without encoder | spindle.settings.orientation.jog_rpm";
    const NEW: &str = "\
Axis designation, * axis | axis.*.letter.0
Measuring-system input assigned to axis, * axis | axis.*.wiring.input
Nominal-value output assigned to axis, * axis | axis.*.wiring.output
Synchronized axes: master of this axis, * axis | axis.*.synchronization.master
Software limit switch + , traverse range 3, *+ | axis.*.travel.ranges_mm.2.1
Software limit switch - , traverse range 2, *- | axis.*.travel.ranges_mm.1.0
Software limit switch - , traverse range 3, *- | axis.*.travel.ranges_mm.2.0
Position used as datum by M92, * axis | axis.*.travel.m92_mm
Machine datum (distance to scale datum), * axis | axis.*.travel.machine_datum_mm
Rapid traverse, * axis | axis.*.motion.rapid_mm_min
Analogue voltage for rapid traverse, * axis | axis.*.output.rapid_volts
Acceleration, * axis | axis.*.motion.acceleration_m_s2
Signal period of measuring system, * axis | axis.*.encoder.signal_period_um
Backlash compensation, * axis | axis.*.compensation.backlash_mm
Reversal-spike compensation in circular interpolation: height, * axis | axis.*.compensation.reversal_mm.0
As MP711, active after M105, * axis | axis.*.compensation.reversal_mm.1
Reversal-spike compensation: amount per control-loop cycle, * axis | axis.*.compensation.reversal_step_mm.0
As MP712, active after M105, * axis | axis.*.compensation.reversal_step_mm.1
Linear axis-error compensation, X axis | axis.0.compensation.linear_mm_m
Linear axis-error compensation, Y axis | axis.1.compensation.linear_mm_m
Software limit switch + , traverse range 1, *+ | axis.*.travel.ranges_mm.0.1
Software limit switch + , traverse range 2, *+ | axis.*.travel.ranges_mm.1.1
Software limit switch - , traverse range 1, *- | axis.*.travel.ranges_mm.0.0
Manual feed, * axis | axis.*.motion.manual_mm_min
Positioning window, * axis | axis.*.monitoring.window_mm
Integral factor (standstill offset correction), * axis | axis.*.output.integral_factor
Standstill monitoring, * axis | axis.*.monitoring.standstill_mm
Movement monitoring: voltage threshold, * axis | axis.*.monitoring.movement_volts
Feed rate for traversing reference marks, * axis | axis.*.reference.feed_mm_min
Type of reference-mark approach, * axis | axis.*.reference.kind
Position monitoring with feed precontrol, cancellable, * axis | axis.*.precontrol.monitoring_mm
Position monitoring with feed precontrol, EMERGENCY STOP, * axis | axis.*.precontrol.emergency_mm
Damping factor for transient response when accelerating | axis.0.precontrol.damping
kv factor with feed precontrol, * axis | axis.*.precontrol.kv
kv factor with feed precontrol, active after M105, * axis | axis.*.precontrol.kv_m105
Stiction compensation factor, * axis | axis.*.compensation.stiction_us
Stiction compensation limit, * axis | axis.*.compensation.stiction_limit_steps
Feed-rate limit for stiction compensation, * axis | axis.*.compensation.stiction_feed_mm_min
Position monitoring with servo lag, cancellable, * axis | axis.*.lag.monitoring_mm
Position monitoring with servo lag, EMERGENCY STOP, * axis | axis.*.lag.emergency_mm
kv factor with servo lag, * axis | axis.*.lag.kv
kv factor with servo lag, active after M105, * axis | axis.*.lag.kv_m105
Multiplication factor for kv above kink point, * axis | axis.*.lag.kink_factor
Kink point (% of rapid traverse), * axis | axis.*.lag.kink_percent
Path-dependent lubrication distance, * axis | axis.*.travel.lubrication_mm
Feed rate for leaving reference end position (rotary encoder, MP1350=2), * axis | axis.*.reference.leaving_mm_min
Feed precontrol in MDI, single block, full sequence | axis.0.precontrol_in_automatic
Feed precontrol in Manual and Handwheel | axis.0.precontrol_in_manual
S-analogue voltage at rated speed, gear range * | spindle.settings.gears.#.rated_volts
Upper limit of spindle override | spindle.settings.override_percent.1
Lower limit of spindle override | spindle.settings.override_percent.0
Spindle ramp for rigid tapping | spindle.settings.ramps.rigid_v_ms
Rated spindle speed, gear range * | spindle.settings.gears.#.rated_rpm
Maximum spindle speed, gear range * | spindle.settings.gears.#.max_rpm
Spindle speed activated by M2501 | spindle.settings.orientation.jog_rpm
Spindle speed for orientation | spindle.settings.orientation.speed_rpm
Activation level of input from MP4130 | plc.monitoring_input.0.active_high
Number for PLC and feed rate for return to contour, W960; X axis | axis.0.motion.plc_mm_min
Number for PLC and feed rate for return to contour, W962; Y axis | axis.1.motion.plc_mm_min
MP4230.* | number.0.*
MP4231.* | number.1.*
MP4310.* | plc.words.*
Activate analogue inputs | plc.analogue_inputs.0
Probing feed rate, triggering probe | probe.feed_mm_min
Setup clearance over measuring point | probe.clearance_mm
Rapid traverse in probing cycle, triggering probe | probe.rapid_mm_min
Triggering or measuring probe | digitizing.measuring
Oscillations per second in normal direction | digitizing.oscillations_hz
Traverse for lubricating probe axis at end of line | digitizing.lubrication_mm
Time after which probe axis must be lubricated | digitizing.lubrication_min
Feed rate in normal direction | digitizing.normal_mm_min
Maximum stylus deflection | digitizing.deflection_mm
M90 in NC blocks of digitized data | digitizing.m90
Rounding of decimal places in digitized data | digitizing.step_mm
Minimum feed override when tapping | spindle.tapping.override_percent.0
Maximum feed override when tapping | spindle.tapping.override_percent.1
Spindle run-in characteristic (rigid tapping, like MP1520) | spindle.settings.lead.run_in_deg_min
Transient response of spindle on acceleration | spindle.settings.lead.transient
Dialogue language | operation.english
Graphics display | graphics.third_angle
Arc end-point tolerance | arc_tolerance_mm
Handwheel | operation.handwheel.kind
Multi-function parameter | operation.keys_latched
Display mode / modulo value of rotary and PLC auxiliary axes, 4th axis | axis.3.travel.modulo";
    // MP43 corrects linear measuring systems only: axis IV is U.
    each_reaches(ControlModel::Tnc155, &["90=3"], OLD);
    each_reaches(ControlModel::Tnc415b, &[], NEW);
    each_reaches(ControlModel::Tnc425, &[], "MP1900 | axis.0.digital");
}
