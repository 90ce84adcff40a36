//! A scan allocates nothing: it runs in the cycle of the control.

mod common;

use common::{Bench, lines};

#[test]
fn scans_do_not_allocate() {
    // Everything that needs room: strings, stacks, calls, brackets, indices, jobs, structures, error markers.
    let mut bench = Bench::new(&lines(
        "L S\"COOLANT\" | + S0 | = S1 | OVWR S2 | L S#E12 | = S3 | L S1 | < S#D4000 | = M1 | L S1^X | = S0[X]
         PS B0 | PS W2 | L W4 | PSW | PLW | = D8 | PL D12 | PL B16 | PS M1 | PL M2
         CM 1 | CASE B20 | CM 1 | CM 1 | ENDC
         L K+3 | =X | L M5[X] | = M6[X] | L W4[X] | + D4[X] | = B30[X]
         L W30 | +[ | L K+4 | x[ | L W32 | - K+1 | ] | ] | = W34
         PS B10 | CM 9010 | PL B11
         RPLY B40 | == K+0 | IFT | SUBM 9 | = B40 | ENDI
         PS K-12345 | PS K-3 | PS K+2 | CM 9050 | PS K+2 | CM 9052 | PL D200 | PL D204
         PS K+2540 | PS K+14 | PS K+2 | PS K+6 | PS K+2 | CM 9051 | PS K+2 | PS K+3 | CM 9070 | PL D208
         PS K+0 | PS K+2 | PS K+8 | CM 9053 | PS K+2 | PS K+60 | CM 9054 | PS K+3 | CM 9071 | PL D212
         PS K+80 | PS K+2 | CM 9041 | PS K+4 | CM 9122 | PL B70
         L I1 | IFT | CAN B40 | ENDI | EM
         LBL 1 | CM 2 | EM | LBL 2 | INC W30 | EM
         LBL 9 | REPEAT | CM 1 | L S0 | = S2 | RPLY B40 | = B41 | L M70 | UNTILT | EM",
    ));
    bench.set("MP10=%11111 MP60=%10000 S0=\"PUMP\" W30=5");
    for cycle in 0..20 {
        bench.set(&format!("I1={}", u8::from(cycle % 5 == 0)));
        let counted = allocation_counter::measure(|| {
            assert_eq!(bench.scan().err(), None);
        });
        assert_eq!(counted.count_total, 0, "cycle {cycle}");
    }
    bench.expect("B41=1 D200=-12345 D204=-3 M3171=0");
}
