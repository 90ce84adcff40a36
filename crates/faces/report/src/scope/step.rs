//! The step response of an axis: what its loop makes of the start of a movement.

use serde::Serialize;

use super::table::Table;
use crate::record::tidy;

/// An axis stands below this share of its greatest nominal speed.
const STANDS: f64 = 0.01;
/// It has its speed above this share.
const CONSTANT: f64 = 0.98;

/// What a start from standstill says of the loop.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepResponse {
    pub axis: String,
    /// When the nominal position begins to move, s.
    pub start_s: f64,
    /// The speed that it reaches, mm/min.
    pub speed_mm_min: f64,
    /// Speed by lag while it is constant, (m/min)/mm; none where there is no lag (feed pre-control).
    pub kv: Option<f64>,
    /// Time by which the actual position is behind at constant speed, ms.
    pub delay_ms: f64,
    /// From the first nominal to the first actual movement, ms.
    pub reaction_ms: f64,
    /// From a tenth to nine tenths of the speed, ms.
    pub rise_ms: f64,
    /// How far the speed goes beyond, % of it.
    pub overshoot_percent: f64,
}

/// Measures the first start from standstill that reaches a constant speed.
///
/// # Errors
/// In words, when signals are missing or the axis does not start.
pub fn response(table: &Table, axis: &str) -> Result<StepResponse, String> {
    let find = |kind: &str| {
        let name = format!("{axis}.{kind}");
        table.trace(&name).ok_or_else(|| {
            format!("the step response needs {axis}.nominal and {axis}.actual in the recording")
        })
    };
    let (nominal, actual) = (find("nominal")?, find("actual")?);
    let wanted = speeds(&table.times, &nominal.values);
    let got = speeds(&table.times, &actual.values);
    let top = wanted.iter().fold(0.0_f64, |top, speed| top.max(speed.abs()));
    let none = || format!("{axis} does not start from standstill in the time shown");
    if top < 1e-6 {
        return Err(none());
    }
    let at = |index: usize| wanted.get(index).copied().unwrap_or(0.0).abs();
    let start = (1..wanted.len())
        .find(|&n| at(n - 1) < STANDS * top && at(n) >= STANDS * top)
        .ok_or_else(none)?;
    // The end of this movement, and what it reaches.
    let end = (start..wanted.len())
        .find(|&n| at(n) < STANDS * top)
        .unwrap_or(wanted.len());
    let reached = (start..end).fold(0.0_f64, |reached, n| reached.max(at(n)));
    let constant: Vec<usize> = (start..end).filter(|&n| at(n) >= CONSTANT * reached).collect();
    // The lag needs time to build up: the last third of the constant speed.
    let settled = constant.get(constant.len() * 2 / 3..).unwrap_or_default();
    let lag = |n: usize| -> Option<f64> {
        let lag = nominal.values.get(n)? - actual.values.get(n)?;
        Some(lag * wanted.get(n)?.signum())
    };
    let lags: Vec<f64> = settled.iter().filter_map(|&n| lag(n)).collect();
    let mean_lag = lags.iter().sum::<f64>() / lags.len().max(1) as f64;
    let speed = settled.iter().map(|&n| at(n)).sum::<f64>() / settled.len().max(1) as f64;
    let time = |n: usize| table.times.get(n).copied().unwrap_or(0.0);
    let actual_at = |n: usize| got.get(n).copied().unwrap_or(0.0).abs();
    let passes = |share: f64| (start.saturating_sub(1)..got.len()).find(|&n| actual_at(n) >= share * speed);
    let span = |from: Option<usize>, to: Option<usize>| {
        from.zip(to)
            .map_or(0.0, |(from, to)| (time(to) - time(from)) * 1000.0)
    };
    let fastest = (start..end).fold(0.0_f64, |fastest, n| fastest.max(actual_at(n)));
    Ok(StepResponse {
        axis: axis.to_owned(),
        start_s: tidy(time(start)),
        speed_mm_min: tidy(speed * 60.0),
        // A lag below a thousandth of a second's way is none that the encoder could tell.
        kv: (mean_lag > 1e-3 * speed).then(|| tidy(speed * 60.0 / 1000.0 / mean_lag)),
        delay_ms: tidy(mean_lag / speed * 1000.0),
        reaction_ms: tidy(span(Some(start), passes(STANDS))),
        rise_ms: tidy(span(passes(0.1), passes(0.9))),
        overshoot_percent: tidy(((fastest / speed - 1.0) * 100.0).max(0.0)),
    })
}

/// Speed at each sample from its neighbours, mm/s.
fn speeds(times: &[f64], values: &[f64]) -> Vec<f64> {
    let last = times.len().saturating_sub(1);
    (0..times.len())
        .map(|n| {
            let (before, after) = (n.saturating_sub(1), (n + 1).min(last));
            let difference = |of: &[f64]| Some(of.get(after)? - of.get(before)?);
            let way = difference(values).unwrap_or(0.0);
            let time = difference(times).unwrap_or(0.0);
            if time > 0.0 { way / time } else { 0.0 }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::table::{Kind, Trace};
    use super::*;

    /// A position loop of first order with kv 2 (m/min)/mm, 33.3 1/s: at 3 m/min the lag is 1.5 mm, the
    /// delay 30 ms; its speed rises from 10 to 90 % in ln 9 / 33.3 s = 65.9 ms, without overshoot.
    #[test]
    fn of_a_loop_of_first_order() {
        const DT: f64 = 0.0005;
        let gain = 2.0 * 1000.0 / 60.0;
        let (mut nominal, mut actual) = (vec![0.0; 100], vec![0.0; 100]);
        let mut at = 0.0;
        for n in 0..2000 {
            let wanted = 50.0 * DT * f64::from(n);
            nominal.push(wanted);
            actual.push(at);
            at += (wanted - at) * gain * DT;
        }
        let trace = |name: &str, values: Vec<f64>| Trace {
            name: name.into(),
            unit: "mm".into(),
            kind: Kind::Analogue,
            values,
        };
        let table = Table {
            times: (0..nominal.len()).map(|n| n as f64 * DT).collect(),
            traces: vec![trace("X.nominal", nominal), trace("X.actual", actual)],
            ..Table::default()
        };
        let step = response(&table, "X").unwrap();
        assert!((step.start_s - 0.05).abs() < 0.0011, "{step:?}");
        assert!((step.speed_mm_min - 3000.0).abs() < 1.0, "{step:?}");
        assert!((step.kv.unwrap() - 2.0).abs() < 0.01, "{step:?}");
        assert!((step.delay_ms - 30.0).abs() < 0.1, "{step:?}");
        assert!(
            (step.rise_ms - 9.0_f64.ln() / gain * 1000.0).abs() < 2.0,
            "{step:?}"
        );
        assert!(step.overshoot_percent < 0.1, "{step:?}");
        assert!(response(&table, "Y").unwrap_err().contains("Y.nominal"));
    }
}
