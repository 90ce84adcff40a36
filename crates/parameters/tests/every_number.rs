//! Machine parameters by their numbers: each reaches the getter that is meant.
#![allow(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

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
    for (numbers, index) in (0..16).flat_map(|index| [(0, index), (1, index)]) {
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

/// Every number of the table, by the value that it is meant to change, whatever else follows from it.
fn each_reaches(model: ControlModel, context: &[&str], table: &str) {
    let mut list = ParameterList::reference(model);
    for assignment in context {
        list.assign(assignment).unwrap();
    }
    let before = said(&list);
    for row in table.lines() {
        let (number, value) = row.split_once(' ').unwrap();
        let (number, index) = match number.split_once('.') {
            Some((number, index)) => (number, Some(index.parse().unwrap())),
            None => (number, None),
        };
        let id = ParameterId {
            number: number.parse().unwrap(),
            index,
        };
        assert!(changes(&list, &before, id, value), "{model} {id}: {value} stays");
    }
}

/// TNC 151/155 [001:3144-3365]; axes 0 to 3 are X, Y, Z, IV. TNC 415 B [000:10100-10480].
#[test]
fn each_number_reaches_its_getter() {
    const OLD: &str = "\
0 axis.0.motion.rapid_mm_min
1 axis.1.motion.rapid_mm_min
2 axis.2.motion.rapid_mm_min
3 axis.3.motion.rapid_mm_min
4 axis.0.motion.manual_mm_min
5 axis.1.motion.manual_mm_min
6 axis.2.motion.manual_mm_min
7 axis.3.motion.manual_mm_min
8 axis.0.reference.feed_mm_min
9 axis.1.reference.feed_mm_min
10 axis.2.reference.feed_mm_min
11 axis.3.reference.feed_mm_min
12 axis.0.encoder.signal_period_um
13 axis.1.encoder.signal_period_um
14 axis.2.encoder.signal_period_um
15 axis.3.encoder.signal_period_um
16 axis.0.reference.negative
17 axis.1.reference.negative
18 axis.2.reference.negative
19 axis.3.reference.negative
20 axis.0.encoder.counts_negative
21 axis.1.encoder.counts_negative
22 axis.2.encoder.counts_negative
23 axis.3.encoder.counts_negative
24 axis.0.output.polarity_negative
25 axis.1.output.polarity_negative
26 axis.2.output.polarity_negative
27 axis.3.output.polarity_negative
28 axis.0.output.integral_factor
29 axis.1.output.integral_factor
30 axis.2.output.integral_factor
31 axis.3.output.integral_factor
32 axis.0.precontrol.kv
33 axis.1.precontrol.kv
34 axis.2.precontrol.kv
35 axis.3.precontrol.kv
36 axis.0.compensation.backlash_mm
37 axis.1.compensation.backlash_mm
38 axis.2.compensation.backlash_mm
39 axis.3.compensation.backlash_mm
40 axis.0.compensation.linear_mm_m
41 axis.1.compensation.linear_mm_m
42 axis.2.compensation.linear_mm_m
44 axis.0.travel.ranges_mm.0.1
45 axis.0.travel.ranges_mm.0.0
46 axis.1.travel.ranges_mm.0.1
47 axis.1.travel.ranges_mm.0.0
48 axis.2.travel.ranges_mm.0.1
49 axis.2.travel.ranges_mm.0.0
50 axis.3.travel.ranges_mm.0.1
51 axis.3.travel.ranges_mm.0.0
52 axis.0.output.rapid_volts
53 axis.0.precontrol.transient_m_min
54 axis.0.motion.acceleration_m_s2
55 radial_acceleration
56 axis.0.precontrol.monitoring_mm
57 axis.0.precontrol.emergency_mm
58 axis.0.monitoring.window_mm
59 axis.0.reference.place.0
60 axis.0.precontrol.in_automatic
61 operation.tools.call.what
62 spindle.output
63 spindle.codes.max
68 operation.keys_latched
70 spindle.jog_volts
72 axis.0.controlled
74 operation.overrides.feed_steps
76 axis.0.encoder.check_amplitude
78 spindle.gears.0.rated_rpm
79 spindle.gears.1.rated_rpm
80 spindle.gears.2.rated_rpm
81 spindle.gears.3.rated_rpm
82 spindle.gears.4.rated_rpm
83 spindle.gears.5.rated_rpm
84 spindle.gears.6.rated_rpm
85 spindle.gears.7.rated_rpm
86 spindle.gears.0.rated_volts
87 spindle.max_volts
88 spindle.override_percent.1
89 spindle.override_percent.0
90 axis.3.letter.0
91 corner_angle_deg
92 operation.english
93 pocket_overlap
94 counter.0
95 counter.1
96 counter.2
97 counter.3
98 counter.4
99 counter.5
100 counter.6
101 counter.7
102 counter.8
103 counter.9
104 counter.10
105 counter.11
106 counter.12
107 counter.13
108 counter.14
109 counter.15
110 timer.0
111 timer.1
112 timer.2
113 timer.3
114 timer.4
115 timer.5
116 timer.6
117 timer.7
118 timer.8
119 timer.9
123 timer.13
124 timer.14
125 timer.15
157 operation.tools.definition.what
159 axis.0.travel.lubrication_mm
160 axis.1.travel.lubrication_mm
161 axis.2.travel.lubrication_mm
162 axis.3.travel.lubrication_mm
163 axis.0.motion.plc_mm_min
164 axis.1.motion.plc_mm_min
165 axis.2.motion.plc_mm_min
166 axis.3.motion.plc_mm_min
168 spindle.ramps.normal_v_ms
169 axis.0.monitoring.standstill_mm
170 operation.station
171 operation.handwheel.kind
172 spindle.polarity
173 clearing.at_program_end
174 axis.0.lag.emergency_mm
175 axis.0.lag.monitoring_mm
176 axis.0.lag.kink_factor
177 axis.0.lag.kv
178 axis.1.lag.kv
179 axis.2.lag.kv
180 axis.3.lag.kv
181 axis.0.lag.kink_percent
182 spindle.tapping.override_percent.0
183 spindle.tapping.override_percent.1
184 spindle.min_volts
185 axis.0.monitoring.residual_voltage_s
186 axis.0.travel.m92_mm
187 axis.1.travel.m92_mm
188 axis.2.travel.m92_mm
189 axis.3.travel.m92_mm
190 spindle.zero_permitted
192 axis.3.monitoring.window_mm
193 timer.16
194 timer.17
195 timer.18
196 timer.19
197 timer.20
198 timer.21
199 timer.22
200 timer.23
201 timer.24
202 timer.25
203 timer.26
204 timer.27
205 timer.28
206 timer.29
207 timer.30
208 timer.31
213 scaled_axes
214 m.axes_wait
215 probe.feed_mm_min
216 probe.range_mm
234 axis.0.monitoring.movement_volts
235 probe.clearance_mm
236 graphics.third_angle
237 spindle.controlled
238 spindle.gears.0.kv
239 spindle.counts_negative
240 spindle.orientation.reference_deg
241 pocket.clear_out_first
242 axis.0.reference.kind
243 axis.1.reference.kind
244 axis.2.reference.kind
245 axis.3.reference.kind
246 spindle.orientation.window_deg
247 operation.handwheel.threshold
248 spindle.orientation.speed_rpm
251 probe.rapid_mm_min
252 axis.0.output.offset_interval_s
253 axis.1.encoder.input
254 axis.0.encoder.input
255 axis.0.encoder.input
256 axis.0.encoder.input
257 axis.0.encoder.input
258 spindle.orientation.jog_rpm";
    const NEW: &str = "\
410.3 axis.3.letter.0
110.0 axis.0.encoder.input
110.1 axis.1.encoder.input
120.0 axis.0.output.output
120.1 axis.1.output.output
850.1 axis.1.synchronization.master
912.0 axis.0.travel.ranges_mm.2.1
912.1 axis.1.travel.ranges_mm.2.1
921.0 axis.0.travel.ranges_mm.1.0
921.1 axis.1.travel.ranges_mm.1.0
922.0 axis.0.travel.ranges_mm.2.0
922.1 axis.1.travel.ranges_mm.2.0
950.0 axis.0.travel.m92_mm
950.1 axis.1.travel.m92_mm
960.0 axis.0.travel.machine_datum_mm
960.1 axis.1.travel.machine_datum_mm
1010.0 axis.0.motion.rapid_mm_min
1010.1 axis.1.motion.rapid_mm_min
1050.0 axis.0.output.rapid_volts
1050.1 axis.1.output.rapid_volts
1060.0 axis.0.motion.acceleration_m_s2
1060.1 axis.1.motion.acceleration_m_s2
1331.0 axis.0.reference.leaving_mm_min
1331.1 axis.1.reference.leaving_mm_min
1390 axis.0.precontrol.in_automatic
1391 axis.0.precontrol.in_manual
3210.0 spindle.gears.0.rated_volts
3210.1 spindle.gears.1.rated_volts
3310.0 spindle.override_percent.1
3310.1 spindle.override_percent.0
3410.3 spindle.ramps.rigid_v_ms
3510.0 spindle.gears.0.rated_rpm
3510.1 spindle.gears.1.rated_rpm
3515.0 spindle.gears.0.max_rpm
3515.1 spindle.gears.1.max_rpm
3520.0 spindle.orientation.jog_rpm
3520.1 spindle.orientation.speed_rpm
4131 plc.monitoring_input.0.active_high
4220.0 axis.0.motion.plc_mm_min
4220.1 axis.1.motion.plc_mm_min
4230.0 number.0.0
4230.1 number.0.1
4231.0 number.1.0
4231.1 number.1.1
4310.0 plc.words.0
4310.1 plc.words.1
4410 plc.analogue_inputs.0
6120 probe.feed_mm_min
6140 probe.clearance_mm
6150 probe.rapid_mm_min
7110.0 spindle.tapping.override_percent.0
7110.1 spindle.tapping.override_percent.1
7130 spindle.tapping.run_in_deg_min
7140 spindle.tapping.transient
7230 operation.english
7310 graphics.third_angle
7431 arc_tolerance_mm
7640 operation.handwheel.kind
7680 operation.keys_latched
810.3 axis.3.travel.modulo_deg";
    each_reaches(ControlModel::Tnc155, &[], OLD);
    // An error of linear measuring systems; axis IV is U.
    each_reaches(
        ControlModel::Tnc155,
        &["90=3"],
        "43 axis.3.compensation.linear_mm_m",
    );
    each_reaches(ControlModel::Tnc415b, &[], NEW);
    each_reaches(ControlModel::Tnc425, &[], "1900 axis.0.digital");
}
