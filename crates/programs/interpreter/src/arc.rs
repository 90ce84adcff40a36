//! The geometry of arcs from what a block gives.

use bahn_parameters::MessageId;
use bahn_path::{Arc, Curve, Plane, Point2, Sense};

use crate::error::Fault;

/// Start and end must lie on the same circle within MP7431 [003:2801] [000:7012].
pub(crate) fn check_radii(
    centre: Point2,
    start: Point2,
    end: Point2,
    tolerance_mm: f64,
) -> Result<(), Fault> {
    let r0 = (start[0] - centre[0]).hypot(start[1] - centre[1]);
    let r1 = (end[0] - centre[0]).hypot(end[1] - centre[1]);
    // A billionth of slack: the tolerance itself is still accepted after rounding of the coordinates.
    if (r0 - r1).abs() <= tolerance_mm + 1e-9 && r0 > 0.0 {
        return Ok(());
    }
    let detail = if r0.is_nan() || r1.is_nan() {
        "the start of the arc has no position".to_owned()
    } else {
        format!("radius {r0:.4} mm at the start, {r1:.4} mm at the end")
    };
    Err(Fault::new(MessageId::CircleEndPosIncorrect, detail))
}

/// Arc with a given radius: R > 0 takes the smaller, R < 0 the larger one [003:2861-2879]. The centre is
/// M + s·h·n with the midpoint M, the left normal n of the chord and h = sqrt(R² - d²/4) (inferred).
pub(crate) fn with_radius(
    plane: Plane,
    start: Point2,
    end: Point2,
    radius: f64,
    sense: Sense,
) -> Result<Arc, Fault> {
    let chord = [end[0] - start[0], end[1] - start[1]];
    let d = chord[0].hypot(chord[1]);
    if d.is_nan() {
        return Err(Fault::new(
            MessageId::CircleEndPosIncorrect,
            "the start of the arc has no position",
        ));
    }
    if d == 0.0 {
        // A full circle needs two CR blocks [003:2853].
        return Err(Fault::new(
            MessageId::AngleReferenceMissing,
            "start and end point are the same",
        ));
    }
    // End points rounded to the input step may miss the diameter by a little.
    const ROUNDING_MM: f64 = 1e-3;
    if d > 2.0 * radius.abs() + ROUNDING_MM {
        let detail = format!("start and end are {d:.4} mm apart, more than twice the radius");
        return Err(Fault::new(MessageId::CircleEndPosIncorrect, detail));
    }
    let height = (radius * radius - d * d / 4.0).max(0.0).sqrt();
    let sign = sense.sign() * if radius > 0.0 { 1.0 } else { -1.0 };
    let normal = [-chord[1] / d, chord[0] / d];
    let middle = [0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])];
    let centre = [
        middle[0] + sign * height * normal[0],
        middle[1] + sign * height * normal[1],
    ];
    Ok(Arc {
        plane,
        centre,
        sweep_deg: bahn_path::sweep_deg(centre, start, end, sense),
    })
}

/// Arc that starts in direction `tangent`: signed radius r = |c|² / 2(t × c), r > 0 is DR+ (spec 6.6). When
/// the end lies straight ahead it is a straight line.
pub(crate) fn tangential(plane: Plane, start: Point2, tangent: Point2, end: Point2) -> Result<Curve, Fault> {
    let length = tangent[0].hypot(tangent[1]);
    let t = [tangent[0] / length, tangent[1] / length];
    let c = [end[0] - start[0], end[1] - start[1]];
    let square = c[0] * c[0] + c[1] * c[1];
    if square.is_nan() || square == 0.0 {
        return Err(Fault::new(
            MessageId::RoundingOffNotDefined,
            "the tangential arc has no end point of its own",
        ));
    }
    let cross = t[0] * c[1] - t[1] * c[0];
    let ahead = t[0] * c[0] + t[1] * c[1];
    const STRAIGHT: f64 = 1e-9;
    if cross.abs() <= STRAIGHT * square.sqrt() {
        return if ahead > 0.0 {
            Ok(Curve::Line)
        } else {
            Err(Fault::new(
                MessageId::RoundingOffNotDefined,
                "the end point lies straight after the start",
            ))
        };
    }
    let radius = square / (2.0 * cross);
    let centre = [start[0] - radius * t[1], start[1] + radius * t[0]];
    let sweep_deg = bahn_path::sweep_deg(centre, start, end, Sense::of_sweep(radius));
    Ok(Curve::Arc(Arc {
        plane,
        centre,
        sweep_deg,
    }))
}

/// Sweep from an angle to another in the given sense; equal angles are a full circle [003:3210].
pub(crate) fn sweep_to_angle(from_deg: f64, to_deg: f64, sense: Sense) -> f64 {
    const SAME_ANGLE_DEG: f64 = 1e-7;
    let turn = (sense.sign() * (to_deg - from_deg)).rem_euclid(360.0);
    let sweep = if !(SAME_ANGLE_DEG..=360.0 - SAME_ANGLE_DEG).contains(&turn) {
        360.0
    } else {
        turn
    };
    sense.sign() * sweep
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arc_of(curve: Curve) -> Arc {
        match curve {
            Curve::Arc(arc) => arc,
            other => panic!("{other:?} is no arc"),
        }
    }

    #[test]
    fn sign_of_the_radius_chooses_the_arc() {
        // From (40,40) to (60,40) with R 20: height sqrt(400 - 100) above or below the chord.
        let height = 300f64.sqrt();
        let cases = [
            (20.0, Sense::CounterClockwise, height),
            (20.0, Sense::Clockwise, -height),
            (-20.0, Sense::CounterClockwise, -height),
            (-20.0, Sense::Clockwise, height),
        ];
        for (radius, sense, above) in cases {
            let arc = with_radius(Plane::XY, [40.0, 40.0], [60.0, 40.0], radius, sense).unwrap();
            assert!((arc.centre[0] - 50.0).abs() < 1e-12 && (arc.centre[1] - 40.0 - above).abs() < 1e-12);
            // R > 0: central angle below 180 degrees, 2 asin(10/20) = 60; R < 0: the rest of the turn.
            let angle = if radius > 0.0 { 60.0 } else { 300.0 };
            assert!((arc.sweep_deg.abs() - angle).abs() < 1e-9);
            assert_eq!(Sense::of_sweep(arc.sweep_deg), sense);
        }
    }

    #[test]
    fn half_circle_has_its_centre_on_the_chord() {
        let arc = with_radius(Plane::XY, [0.0, 0.0], [100.0, 0.0], 50.0, Sense::Clockwise).unwrap();
        assert_eq!(arc.centre, [50.0, 0.0]);
        assert!((arc.sweep_deg + 180.0).abs() < 1e-9);
    }

    #[test]
    fn ends_too_far_apart_are_no_arc() {
        let fault = with_radius(Plane::XY, [0.0, 0.0], [100.0, 0.0], 49.0, Sense::Clockwise).unwrap_err();
        assert_eq!(
            fault,
            Fault {
                detail: fault.detail.clone(),
                ..MessageId::CircleEndPosIncorrect.into()
            }
        );
    }

    #[test]
    fn tangential_arc_by_the_chord() {
        // Line towards (1,1), then to (50,50) from (10,40): r = |c|² / 2(t × c) with c = (40,10),
        // t = (1,1)/√2: t × c = (10 - 40)/√2, so r = 1700 √2 / -60 = -40.07: clockwise.
        let t = [0.5f64.sqrt(), 0.5f64.sqrt()];
        let arc = arc_of(tangential(Plane::XY, [10.0, 40.0], t, [50.0, 50.0]).unwrap());
        let radius = 1700.0 * 2f64.sqrt() / 60.0;
        let centre = [10.0 + radius * t[1], 40.0 - radius * t[0]];
        assert!((arc.centre[0] - centre[0]).abs() < 1e-9 && (arc.centre[1] - centre[1]).abs() < 1e-9);
        assert!(arc.sweep_deg < 0.0);
    }

    #[test]
    fn tangential_arc_straight_ahead_is_a_line() {
        assert_eq!(
            tangential(Plane::XY, [0.0, 0.0], [1.0, 0.0], [5.0, 0.0]),
            Ok(Curve::Line)
        );
        assert!(tangential(Plane::XY, [0.0, 0.0], [1.0, 0.0], [-5.0, 0.0]).is_err());
    }

    #[test]
    fn sweep_to_an_equal_angle_is_a_full_circle() {
        assert_eq!(sweep_to_angle(270.0, -90.0, Sense::Clockwise), -360.0);
        assert_eq!(sweep_to_angle(10.0, 370.0 + 1e-9, Sense::CounterClockwise), 360.0);
        assert_eq!(sweep_to_angle(350.0, 10.0, Sense::CounterClockwise), 20.0);
        assert_eq!(sweep_to_angle(350.0, 10.0, Sense::Clockwise), -340.0);
    }
}
