//! How long a servo step takes.

use bahn_parameters::{ControlModel, ParameterList};
use bahn_servo::{Axis, Encoder, Method, Rotation, Spindle, Way};
use divan::{Bencher, black_box, counter::ItemsCount};

fn main() {
    divan::main();
}

/// Contour cycles of a pass.
const CYCLES: u32 = 1000;

/// Measuring, fine interpolation, position loop and monitoring of one axis, 0.6 ms steps; an item is a step.
#[divan::bench(args = [Method::Lag, Method::Precontrol])]
fn axis_step(bencher: Bencher, method: Method) {
    let model = ControlModel::Tnc415b;
    let mut list = ParameterList::reference(model);
    let errors = list.read(b"710.0 : 0\n720.0 : 0");
    assert!(errors.is_empty());
    let settings = list.axis_parameters(0).settings();
    let timing = model.timing();
    bencher
        .counter(ItemsCount::new(CYCLES * timing.steps()))
        .with_inputs(|| {
            let mut axis = Axis::new(settings, timing);
            axis.measure(Encoder::default());
            axis.close();
            axis.set_method(method);
            axis
        })
        .bench_values(|mut axis| {
            let mut encoder = Encoder::default();
            let mut nominal = 0.0;
            for cycle in 0..CYCLES {
                // There and back at about 3 m/min, slower at the ends.
                nominal += 0.15 * f64::from(cycle % 500).min(50.0) / 50.0;
                axis.command(black_box(nominal));
                for _ in 0..timing.steps() {
                    axis.measure(black_box(encoder));
                    let volts = axis.step();
                    encoder.count += (volts * 850.0) as i64;
                }
            }
            assert_eq!(axis.fault(), None);
            axis
        });
}

/// Ramp, orientation and position loop of the spindle; an item is a servo step.
#[divan::bench]
fn spindle_step(bencher: Bencher) {
    let model = ControlModel::Tnc415b;
    let settings = ParameterList::reference(model).spindle_parameters().settings;
    let timing = model.timing();
    let steps = CYCLES * timing.steps();
    bencher
        .counter(ItemsCount::new(steps))
        .with_inputs(|| {
            let mut spindle = Spindle::new(settings, timing);
            spindle.set_speed(1000.0, 0);
            spindle.rotate(Rotation::M3);
            spindle
        })
        .bench_values(|mut spindle| {
            let mut encoder = Encoder::default();
            for step in 0..steps {
                if step == steps / 2 {
                    spindle.orient(90.0, 0.0, Way::Shortest);
                }
                encoder.mark = (step == 500).then_some(encoder.count);
                spindle.measure(black_box(encoder));
                encoder.count += (spindle.step() * 3000.0) as i64;
            }
            spindle
        });
}
