//! PNT in POSITIONING WITH MDI: the axes go where the stylus of a measuring probe is pushed, so that it shows whether the
//! probe counts as the axes do (MP6320) [000:7907].
//!
//! Decision: PNT moves X, Y and Z with MP6360, as far as MP6310 deflected or farther, in proportion before; the
//! manual names no feed, and these are those of a scan. Below 0.1 mm, the least MP6310, the stylus leads nothing.
//! What stops axes ends PNT, NC start does nothing meanwhile, M2502 does not stop it (also `tnc/src/manual.rs`)

use bahn_parameters::MessageId;
use bahn_parameters::machining::MeasuringProbe;
use bahn_path::deflection_along_axes;
use bahn_servo::Probe as Touch;

/// A stylus that is deflected less leads nothing, mm: the least depth with which MP6310 lets a scan press [000:7934] (inferred).
const REST_MM: f64 = 0.1;

/// The stylus leads the axes.
#[derive(Clone, Copy, Debug)]
pub struct StylusLead {
    probe: MeasuringProbe,
}

impl StylusLead {
    /// That of a measuring probe.
    pub fn of(probe: MeasuringProbe) -> StylusLead {
        StylusLead { probe }
    }

    /// How fast the axes X, Y and Z of the machine are led, mm/min: at the probing feed MP6360 where the stylus is deflected as
    /// far as a scan presses it (MP6310) or farther, in proportion before (inferred).
    ///
    /// # Errors
    /// The message that ends it.
    pub fn feeds_mm_min(&self, stylus: &Touch) -> Result<[f64; 3], MessageId> {
        let probe = &self.probe;
        if !stylus.ready {
            return Err(MessageId::ProbeSystemNotReady);
        }
        let along = deflection_along_axes(&stylus.deflection_mm, probe.axes, probe.reversed);
        let depth = along.iter().map(|part| part * part).sum::<f64>().sqrt();
        if depth > probe.limit_mm {
            return Err(MessageId::StylusDeflectionExceedsMax);
        }
        if depth < REST_MM {
            return Ok([0.0; 3]);
        }
        let feed = probe.feed_mm_min * (depth / probe.depth_mm).min(1.0);
        Ok(along.map(|part| part / depth * feed))
    }
}
