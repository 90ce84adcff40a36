//! The worked examples of the manual's chapters on PLC functions: what NC and machine do stands in the test.

use crate::common::{Bench, lines};
use bahn_parameters::PerPlcAxis;
use bahn_plc::{CoordinateKind, PlcAxisCommand, StatusChange};

#[test]
fn two_numbers_come_with_fn19() {
    // FN19:PLC =+20.25/+100 in a program in mm [000:11614-11655]: 1/10 000 mm.
    let mut bench = Bench::new(&lines(
        "LN M2149 | R M2611 | L M2149 | CMT 199 | EM
         LBL 199
         L D280 | = D120 | L D284 | = D124
         L M2149 | S M2611 | EM",
    ));
    bench.set("D280=202500 D284=1000000 M2149=1");
    bench.scans(1);
    bench.expect("D120=202500 D124=1000000 M2150=0 M2611=1");
    bench.set("M2149=0");
    bench.scans(1);
    bench.expect("M2611=0");
}

#[test]
fn m70_positions_the_z_axis() {
    // Decoded M70 is M1970; position and feed rate from MP4210.2 and MP4220.2 [000:4055-4087].
    let mut bench = Bench::new(&lines(
        "L M0 | ON M0 | S M2496 | S M2719
         L M1970 | A M2045 | AN M4 | CMT 110 | S M2706 | S M4
         L M1970 | A M2045 | AN M2706 | S M2482
         LN M2045 | R M2482 | R M4 | EM
         LBL 110
         L D776 | = D536 | L W964 | = W564 | EM",
    ));
    bench.set("MP4210.2=-12.5 MP4220.2=500");
    bench.scans(1);
    bench.expect("M2496=1 M2719=1 M2706=0 D536=0");
    bench.set("M1970=1 M2045=1");
    bench.scans(3);
    bench.expect("D536=-125000 W564=500 M2706=1 M4=1 M2482=0");
    // In position: the NC resets the strobe.
    bench.set("M2706=0");
    bench.scans(1);
    bench.expect("M2706=0 M2482=1");
    bench.set("M2045=0 M1970=0");
    bench.scans(1);
    bench.expect("M2482=0 M4=0");
}

#[test]
fn a_tool_magazine_is_a_plc_axis() {
    // 360 degrees, 25 tools, pocket 4: 3 600 000 / 24 x 3 = 450 000 [000:4118-4240].
    let mut bench = Bench::new(&lines(
        "LN M599 | S M599
         L M2185 | O M2180 | S M544
         L M544 | O M2047 | CMT 40
         LBL 11 | EM
         LBL 40
         L M544 | CMT 41 | L M544 | CMT 42
         L M2047 | JPF 11
         PS K+4 | CM 9122 | PL B236
         L B236 | BT K+2 | JPT 11
         L D232 | /[ | L W230 | - K+1 | ] | X[ | L W262 | - K+1 | ] | = D168
         PS K+4 | PS D168 | PS D768 | PS K+0 | CM 9120
         L M599 | S M2484 | EM
         LBL 41
         RPLY B238 | <> K+0 | JPT 11 | SUBM 45 | = B238 | EM
         LBL 45
         PS K+810 | PS K+4 | CM 9032 | PL D232
         PS K+7261 | PS K+0 | CM 9032 | PL W230 | EM
         LBL 42
         PS K+4 | PS D772 | PS K+0 | CM 9123
         L M599 | R M544 | EM",
    ));
    bench.set("MP10=%11111 MP60=%10000 MP810.4=360 MP7261=25 MP4210.0=0.2 MP4210.1=0.05");
    bench.scans(1);
    // The feed rates are the numbers of D768 and D772; the parameters were read by the submit job.
    bench.expect("D232=3600000 W230=25 M544=0");
    bench.nc.end_scan();
    let reference = PlcAxisCommand::TraverseReferenceMarks {
        feed: 500.0,
        negative: false,
    };
    assert_eq!(bench.nc.axes[4].command, Some(reference));
    bench.set("W262=4 M2047=1");
    bench.scans(1);
    bench.expect("B236=5 D168=0 M2484=0");
    bench.nc.axes[4].arrive();
    bench.scans(1);
    bench.expect("B236=3 D168=450000 M2484=1");
    bench.nc.end_scan();
    let start = PlcAxisCommand::Start {
        target: 45.0,
        incremental: false,
        feed: 2000.0,
    };
    assert_eq!(bench.nc.axes[4].command, Some(start));
}

#[test]
fn m03_is_evaluated_in_a_table() {
    // The M code in W260 chooses the module [000:7206-7247].
    let mut bench = Bench::new(&lines(
        "LN M1 | S M1
         L M2045 | RN M2482 | CMT 77 | EM
         LBL 77
         CASE W260 | CM0 | CM0 | CM0 | CM 3 | ENDC | EM
         LBL 0 | EM
         LBL 3
         L M1 | S M2485 | R M2486 | R M2487 | S O10
         L I10 | S M2482 | EM",
    ));
    bench.set("W260=3 M2045=1");
    bench.scans(1);
    bench.expect("M2485=1 O10=1 M2482=0");
    bench.set("I10=1");
    bench.scans(1);
    bench.expect("M2482=1");
    bench.set("M2045=0 I10=0");
    bench.scans(1);
    bench.expect("M2482=0 O10=1");
}

#[test]
fn keys_are_pressed_one_after_the_other() {
    // L X pos Y pos Z pos END in positioning with manual entry [000:7442-7535].
    let keys = [
        (130, 60),
        (131, 109),
        (132, 100),
        (133, 108),
        (134, 107),
        (135, 119),
    ];
    let mut program = lines(
        "CASE W272 | CM 9 | CM 9 | CM 9 | CM 3 | ENDC | EM
         LBL 9 | EM
         LBL 3
         L M10 | SN M2896 | L M2182 | CMT 31 | EM
         LBL 31
         L M10 | R M2896 | SN M10
         CASE B200 | CM 130 | CM 131 | CM 132 | CM 133 | CM 132 | CM 134 | CM 132 | CM 135 | CM 141 | ENDC | EM
         LBL 136
         L M2813 | JPT 137
         L B200 | + K+1 | = B200
         L W102 | = W516
         LN M2813 | S M2813 | EM
         LBL 137 | EM
         LBL 141
         L M2813 | JPT 137
         L K+0 | = B200
         L M10 | R M10 | R M2182 | EM",
    );
    for (label, key) in keys {
        program += &lines(&format!("LBL {label} | L K{key} | = W102 | CM 136 | EM"));
    }
    let mut bench = Bench::new(&program);
    bench.set("W272=3");
    bench.scans(2);
    bench.expect("M2896=1 M2813=0");
    bench.set("M2182=1");
    let mut pressed = Vec::new();
    for _ in 0..30 {
        bench.scans(1);
        // The NC takes a key every other cycle.
        if bench.get("M2813") == 1 {
            pressed.push(bench.get("W516"));
            bench.scans(1);
            bench.set("M2813=0");
        }
    }
    assert_eq!(pressed, [60, 109, 100, 108, 100, 107, 100, 119]);
    bench.expect("B200=0 M10=0 M2182=0 M2813=0 M2896=1");
}

#[test]
fn m19_and_m20_orient_the_spindle() {
    // M19 to the angle of the cycle (bit 31 alone), M20 to that of MP4210.47 [000:5952-6043].
    let mut bench = Bench::new(&lines(
        "LN M1 | S M1
         LN M2045 | R M12 | R M2482
         L M1919 | A M2045 | AN M12 | CMT 180 | S M12
         L M1920 | A M2045 | AN M12 | CMT 181 | S M12
         L M1919 | O M1920 | A M2045 | A M2007 | AN M2712 | S M2482 | EM
         LBL 180
         L K+0 | BS K+31 | = D592 | L M1 | S M2712 | EM
         LBL 181
         L D956 | = D592 | L M1 | S M2712 | EM",
    ));
    bench.set("MP4210.47=90 M1919=1 M2045=1");
    bench.scans(2);
    bench.expect("D592=80000000h M2712=1 M12=1 M2482=0");
    bench.set("M2712=0 M2007=1");
    bench.scans(1);
    bench.expect("M2712=0 M2482=1");
    bench.set("M2045=0 M1919=0");
    bench.scans(1);
    bench.expect("M2482=0");
    bench.set("M2045=1 M1920=1 M2007=0");
    bench.scans(1);
    bench.expect("D592=900000 M2712=1 M2482=0");
}

#[test]
fn m20_shifts_the_datum() {
    // MP4210.32 (D896) with M20, MP4210.33 (D900) with M21 [000:8940-8992].
    let shift = "L K0 | = D532 | = D536 | = D540 | = D544 | L M10 | S M2716 | EM";
    let mut bench = Bench::new(&lines(&format!(
        "LN M2045 | S M10
         L M1920 | A M2045 | A M10 | CMT 200 | R M10
         L M1921 | A M2045 | A M10 | CMT 201 | R M10
         L M1920 | O M1921 | A M2045 | AN M2716 | S M2482
         LN M2045 | R M2482 | EM
         LBL 200 | L D896 | = D528 | {shift}
         LBL 201 | L D900 | = D528 | {shift}"
    )));
    bench.set("MP4210.32=20 MP4210.33=0 D532=7");
    bench.scans(1);
    bench.set("M1920=1 M2045=1");
    bench.scans(3);
    bench.expect("D528=200000 D532=0 M2716=1 M10=0 M2482=0");
    bench.set("M2716=0");
    bench.scans(1);
    bench.expect("M2716=0 M2482=1");
    bench.set("M1920=0 M2045=0");
    bench.scans(1);
    bench.set("M1921=1 M2045=1");
    bench.scans(1);
    bench.expect("D528=0 M2716=1 M2482=0");
}

/// The step switch of the handwheel: I160-I167, the chosen position is 0 [000:8387-8447].
#[test]
fn a_step_switch_chooses_the_interpolation_factor() {
    let program = lines(
        "LN M30 | SUBM 1 | = B20 | S M30 | EM
         LBL 1
         L K0 | = B3
         LB I160 | = B1 | == K0 | JPT 103
         LN B1 | = B2 | == K0 | JPT 103
         LBL 100
         L B2 | BT B3 | JPT 101
         L B3 | + K+1 | = B3 | JP 100
         LBL 101
         PS K+7670 | PS K+0 | CM 9032 | PL B4
         L B3 | + B4 | = B5 | <= K+10 | JPT 102
         L K+10 | = B5
         LBL 102
         PS K+5 | PS B5 | CM 9036 | PL B6
         L B6 | > K0 | JPT 103 | EM
         LBL 103 | LN M31 | S M31 | EM",
    );
    let factor = |inputs: u32| {
        let mut bench = Bench::new(&program);
        bench.set("MP7640=5 MP7641=1 MP7670.0=5");
        (0..8).for_each(|bit| bench.set(&format!("I{}={}", 160 + bit, inputs >> bit & 1)));
        bench.scans(1);
        bench
    };
    let bench = factor(0b1111_0111);
    bench.expect("B1=F7h B2=8 B3=3 B4=5 B5=8 B6=0 M31=0");
    for (position, expected) in [5, 6, 7, 8, 9, 10, 10, 10].into_iter().enumerate() {
        let bench = factor(!(1 << position) & 0xff);
        let all = StatusChange::Subdivision {
            axis: None,
            factor: expected,
        };
        assert_eq!(bench.nc.status_changes, [all], "position {}", position + 1);
    }
    // No input or all of them are a fault of the switch.
    factor(0).expect("M31=1 B5=0");
    factor(0xff).expect("M31=1 B5=0");
}

/// The rotary table with Hirth coupling: 4th axis, grid in D28 [000:8594-8906].
mod hirth {
    use super::*;

    /// Grid of 5 degrees; the main program calls a module.
    fn bench(module: u16) -> Bench {
        let mut bench = Bench::new(&lines(&format!(
            "LN M1 | S M1 | CM {module} | EM
             LBL 330
             PS K+8 | PS K+3 | CM 9041
             PS K+0 | PS K+2 | CM 9041
             L D12 | + D20 | = D44
             L D44 | PSW | < K+0 | CMT 331 | PLW | / D28 | x D28 | = D36
             L D36 | + D28 | = D40
             L M2163 | = M3 | EM
             LBL 331 | PLW | - D28 | PSW | EM
             LBL 340
             CM 330 | CM 350 | PLW | = D540 | L W966 | = W566 | L M1 | S M2707 | EM
             LBL 350
             LN M2208 | JPT 351
             L D44 | - D36 | PSW | CM 390
             L D44 | - D40 | PSW | CM 390
             PLW | = D0 | PLW | > D0 | JPT 353 | JPF 354
             LBL 351
             L M3 | XO M2209 | JPF 353 | JPT 354 | EM
             LBL 353 | PS D40 | EM
             LBL 354 | PS D36 | EM
             LBL 370
             PS K+0 | PS K+4 | CM 9041 | PS D12
             PS K+8 | PS K+3 | CM 9041
             PS K+0 | PS K+2 | CM 9041
             PLW | + D12 | + D20 | MOD D28 | PSW | CM 390 | PLW | = D0
             L D28 | - D0 | = D4
             L D4 | <= D0 | JPT 371 | L D0 | = D4
             LBL 371
             L D4 | > D780 | = M4 | EM
             LBL 390
             PLW | PSW | BT K+31 | JPF 391 | PLW | X K-1 | PSW | EM
             LBL 391 | EM"
        )));
        bench.set("D28=50000 MP4210.3=0.01 MP4220.3=1000");
        bench
    }

    /// Places the 4th axis, degrees.
    fn place(bench: &mut Bench, kind: CoordinateKind, degrees: f64) {
        bench
            .nc
            .coordinates
            .insert(kind, PerPlcAxis([0.0, 0.0, 0.0, degrees, 0.0]));
    }

    #[test]
    fn the_neighbouring_grid_points() {
        // Nominal position = actual position + trailing error; the left point lies below it.
        for (actual, lag, left, right) in [
            (17.2, 0.1, 150_000, 200_000),
            (-17.2, -0.1, -200_000, -150_000),
            (0.4, 0.0, 0, 50_000),
            (-0.4, 0.0, -50_000, 0),
        ] {
            let mut bench = bench(330);
            place(&mut bench, CoordinateKind::Reference, actual);
            place(&mut bench, CoordinateKind::TrailingError, lag);
            bench.scans(1);
            bench.expect(&format!("D36={left} D40={right}"));
        }
    }

    #[test]
    fn positioning_on_the_nearest_point() {
        // MP4310.1 bit 0: the nearest one; else the direction of traverse, turned over by bit 1.
        for (actual, parameter, negative, target) in [
            (17.2, 1, 0, 150_000),
            (18.2, 1, 0, 200_000),
            (-17.2, 1, 0, -150_000),
            (-18.2, 1, 0, -200_000),
            (17.2, 0, 0, 200_000),
            (17.2, 0, 1, 150_000),
            (17.2, 2, 1, 200_000),
        ] {
            let mut bench = bench(340);
            place(&mut bench, CoordinateKind::Reference, actual);
            bench.set(&format!("MP4310.1={parameter} M2163={negative}"));
            bench.scans(1);
            bench.expect(&format!("D540={target} W566=1000 M2707=1"));
        }
    }

    #[test]
    fn a_nominal_position_off_the_grid_is_found() {
        // Actual position + distance to go + trailing error; up to 0.01 degrees beside the grid are right.
        for (actual, distance, off) in [
            (12.0, 3.0, 0),
            (12.0, 1.0, 1),
            (12.0, 2.995, 0),
            (12.0, 3.005, 0),
            (-12.0, -3.0, 0),
            (-12.0, -0.5, 1),
        ] {
            let mut bench = bench(370);
            place(&mut bench, CoordinateKind::Reference, actual);
            place(&mut bench, CoordinateKind::DistanceToGo, distance);
            bench.scans(1);
            bench.expect(&format!("M4={off}"));
        }
    }
}
