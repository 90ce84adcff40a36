//! The worked tables of the manual's chapters on data stack, strings and index register.

use crate::common::example;

#[test]
fn the_data_stack() {
    // The word accumulator is saved over a module that needs it.
    example(
        "[000:13774-13786]",
        "D0=1A443E18h",
        "L D0  | WA=1A443E18h
         PSW   | WA=1A443E18h
         CM 15
         PLW   | WA=1A443E18h
         = D8
         EM
         LBL 15
         L K7  | WA=7
         = D4",
        "D4=7 D8=1A443E18h",
    );
    example(
        "last in, first out [000:13658-13772]",
        "B0=-3 M7=1 I3=1",
        "PS B0
         PS M7
         PS K+4
         PL W10  || 4
         PL M8   || 1
         PL D12  || -3
         L I3
         PSL
         LN I3   | LA=0
         = M9
         PLL     | LA=1
         = M11
         INCX
         PSX
         INCX
         PLX
         LX      | WA=1
         = D16",
        "W10=4 M8=1 D12=-3 M11=1 D16=1",
    );
}

#[test]
fn strings() {
    example(
        "[000:14156-14170]",
        "S0=\"OIL\" S1=\"NO COOLANT\"",
        "L S\"HYDRAULICS\" | SA=\"HYDRAULICS\"
         + S0             | SA=\"HYDRAULICSOIL\" | OIL
         OVWR S1          | SA=\"HYDRAULICSOIL\" | HYDRAULICSOIL",
        "S1=\"HYDRAULICSOIL\"",
    );
    example(
        "a shorter text leaves the tail [000:14137-14154]",
        "S1=\"XYZ\" S2=\"XYZ\"",
        "L S\"AB\"
         OVWR S1
         = S2",
        "S1=\"ABZ\" S2=\"AB\"",
    );
    for (operator, result) in [("<", 1), ("<=", 1), ("<>", 1), ("==", 0), (">", 0), (">=", 0)] {
        example(
            "[000:14286-14297]",
            "S0=\"SPINDLE 2\"",
            &format!("L S\"SPINDLE 1\"\n{operator} S0 | LA={result}\n= M0"),
            &format!("M0={result}"),
        );
    }
    example(
        "the longer string is greater, references compare by line [000:14178-14184]",
        "",
        "L S\"AA\"
         > S\"A\"    | LA=1
         = M0
         L S#D4000
         > S#D999    | LA=1
         = M1
         L S#E10     | SA=\"\u{1a}E010\"
         = S0",
        "M0=1 M1=1 S0=\"\u{1a}E010\"",
    );
}

#[test]
fn index_register() {
    example(
        "[000:14022-14034]",
        "B103=7 W10=-2 D12=3 M8=1 S1=\"TWO\" S0=\"OIL\"",
        "L K3
         =X
         L B100[X]  | WA=7
         = D20
         L W4[X]    | WA=-2
         = D24
         L D0[X]    | WA=3
         = D28
         L M5[X]    | LA=1
         = M500
         DECX
         DECX
         L S0[X]    | SA=\"TWO\"
         = S2
         L S0^X     | SA=\"IL\"
         = S3",
        "D20=7 D24=-2 D28=3 M500=1 S2=\"TWO\" S3=\"IL\"",
    );
}
