//! The worked accumulator tables of the manual's chapter on commands.

use crate::common::example;

#[test]
fn load() {
    example(
        "[000:12072-12091]",
        "I4=1 I5=0",
        "L I4 | LA=1 | 1
         A I5 | LA=0 | 0
         = O2 | LA=0 | 0",
        "O2=0",
    );
    example(
        "[000:12101-12119]",
        "B5=2Ah",
        "L K+54 | WA=36h
         A B5   | WA=22h | 2Ah
         = B8   | WA=22h | 22h",
        "B8=22h",
    );
}

#[test]
fn load_not() {
    example(
        "restored",
        "I4=0 I5=1",
        "LN I4 | LA=1 | 0
         A I5  | LA=1 | 1
         = O2  | LA=1 | 1",
        "O2=1",
    );
    example(
        "[000:12129-12147]",
        "B5=2Ah B6=B6h",
        "LN B6 | WA=00000049h
         A B5  | WA=08h | 2Ah
         = B8  | WA=08h | 08h",
        "B8=08h",
    );
}

#[test]
fn load_minus() {
    example(
        "[000:12165-12184]",
        "B5=15 B6=20",
        "L- B5 | WA=-15 | 15
         + B6  | WA=5   | 20
         = B8  | WA=5   | 5",
        "B8=5",
    );
}

#[test]
fn assign() {
    example(
        "[000:12241-12265]",
        "I4=1 I5=0 O2=1 O5=1",
        "L I4 | LA=1
         A I5 | LA=0
         = O2 | LA=0 | 0
         = O5 | LA=0 | 0",
        "O2=0 O5=0",
    );
    example(
        "[000:12275-12301]",
        "B5=2Ah",
        "L K+54 | WA=36h
         A B5   | WA=22h | 2Ah
         = B8   | WA=22h | 22h
         = B10  | WA=22h | 22h",
        "B8=22h B10=22h",
    );
    example(
        "[000:12275-12301] with the early assignment",
        "B5=2Ah",
        "L K+54 | WA=36h
         = B8   | WA=36h | 36h
         A B5   | WA=22h | 2Ah
         = B9   | WA=22h | 22h
         = B10  | WA=22h | 22h",
        "B8=36h B9=22h B10=22h",
    );
}

#[test]
fn assign_word_to_outputs() {
    // 36FFh: the low byte FFh goes to O5-O12, the high byte 36h, lowest bit first, to O13-O20.
    example(
        "[000:12342-12358]",
        "W8=36FFh",
        "L W8  | WA=36FFh | 36FFh
         W= O5 | WA=36FFh | 36FFh",
        "O5=1 O6=1 O7=1 O8=1 O9=1 O10=1 O11=1 O12=1 O13=0 O14=1 O15=1 O16=0 O17=1 O18=1 O19=0 O20=0",
    );
}

#[test]
fn set_and_reset() {
    example(
        "[000:12416-12442]",
        "I4=1 I5=0",
        "L I4   | LA=1
         O I5   | LA=1 | 0
         S O2   | LA=1 | 1
         S M500 | LA=1 | 1",
        "O2=1 M500=1",
    );
    example(
        "[000:12462-12486]",
        "I4=1 I5=0 O2=1 M500=1",
        "L I4   | LA=1
         O I5   | LA=1
         R O2   | LA=1 | 0
         R M500 | LA=1 | 0",
        "O2=0 M500=0",
    );
    example(
        "[000:12506-12530]",
        "I4=0 I5=0",
        "L I4    | LA=0
         O I5    | LA=0
         SN O2   | LA=0 | 1
         SN M500 | LA=0 | 1",
        "O2=1 M500=1",
    );
    example(
        "[000:12550-12570]",
        "I4=0 I5=0 O2=1 M500=1",
        "L I4    | LA=0
         O I5    | LA=0
         RN O2   | LA=0 | 0
         RN M500 | LA=0 | 0",
        "O2=0 M500=0",
    );
    example(
        "the other value of the accumulator changes nothing",
        "I4=1 O2=1",
        "L I4  | LA=1
         RN O2 | LA=1 | 1
         SN O3 | LA=1 | 0",
        "O2=1 O3=0",
    );
}

#[test]
fn word_gates() {
    example(
        "[000:12589-12616]",
        "B5=2Ah B6=36h",
        "L B6 | WA=36h | 36h
         A B5 | WA=22h | 2Ah
         = B8 | WA=22h | 22h",
        "B8=22h",
    );
    example(
        "[000:12673-12693]",
        "W4=36AAh W6=3C36h",
        "L W6  | WA=3C36h
         AN W4 | WA=0814h | 36AAh
         = W8  | WA=0814h | 0814h",
        "W8=0814h",
    );
    example(
        "[000:12709-12728]",
        "B5=2Ah B6=36h",
        "L B6 | WA=36h
         O B5 | WA=3Eh | 2Ah
         = W8 | WA=3Eh | 3Eh",
        "W8=003Eh",
    );
    example(
        "[000:12743-12759]",
        "B5=2Ah B6=36h",
        "L B6  | WA=36h
         XO B5 | WA=1Ch | 2Ah
         = W8  | WA=1Ch | 1Ch",
        "W8=001Ch",
    );
    // NOT(3C36h XOR 36AAh) = NOT(00000A9Ch) = FFFFF563h: all 32 bits are gated.
    example(
        "[000:12775-12794]",
        "W4=36AAh W6=3C36h",
        "L W6   | WA=3C36h
         XON W4 | WA=FFFFF563h | 36AAh
         = W8   | WA=FFFFF563h",
        "W8=F563h",
    );
}

#[test]
fn logic_gates() {
    example(
        "restored, of [000:12575]",
        "I4=1 I5=0",
        "L I4 | LA=1 | 1
         A I5 | LA=0 | 0
         = O2 | LA=0 | 0",
        "O2=0",
    );
    example(
        "[000:12639-12657]",
        "I4=1 I5=1",
        "L I4  | LA=1
         AN I5 | LA=0 | 1
         = O2  | LA=0",
        "O2=0",
    );
    example(
        "restored",
        "I4=1 I5=1",
        "L I4  | LA=1
         XO I5 | LA=0 | 1
         = O2",
        "O2=0",
    );
    example(
        "restored",
        "I4=0 M500=0",
        "L M500 | LA=0
         XON I4 | LA=1 | 0
         = O2",
        "O2=1",
    );
    // By name: OR NOT.
    example(
        "[000:11022]",
        "I4=0 I5=0",
        "L I4  | LA=0
         ON I5 | LA=1
         = O2",
        "O2=1",
    );
}

#[test]
fn a_gate_at_the_start_of_a_chain_loads() {
    example(
        "[000:12070]",
        "I4=0 I5=1 I6=0",
        "A I5   | LA=1
         = O1
         O I4   | LA=0
         = O2
         XO I5  | LA=1
         = O3
         AN I4  | LA=1
         = O4
         ON I5  | LA=0
         = O5
         XON I5 | LA=0
         = O6",
        "O1=1 O2=0 O3=1 O4=1 O5=0 O6=0",
    );
    // As in the Hirth example: a gate after a set command.
    example(
        "[000:8741-8747]",
        "M2=1 M2011=1 M3023=1",
        "L M5
         S M3022
         A M2    | LA=1
         A M2011 | LA=1
         R M3023 | LA=1 | 0",
        "M3023=0",
    );
}

#[test]
fn arithmetic() {
    example(
        "[000:12814-12838]",
        "W6=200",
        "L K100000 | WA=100000
         + W6      | WA=100200 | 200
         = D8      | WA=100200 | 100200",
        "D8=100200",
    );
    example(
        "[000:12854-12874]",
        "W6=200",
        "L K100000
         - W6 | WA=99800
         = D8",
        "D8=99800",
    );
    example(
        "[000:12890-12910]",
        "W6=20 M3168=1",
        "L K100
         x W6 | WA=2000
         = D8",
        "D8=2000 M3168=0",
    );
    example(
        "[000:12928-12950]",
        "W6=20 M3169=1",
        "L K100
         / W6 | WA=5
         = D8",
        "D8=5 M3169=0",
    );
    example(
        "[000:12968-12990]",
        "W6=50 M3170=1",
        "L W6
         MOD K15 | WA=5
         = D8",
        "D8=5 M3170=0",
    );
}

#[test]
fn arithmetic_at_its_limits() {
    example(
        "overflow and division by zero set their markers",
        "",
        "L K65536
         x K65536 | WA=0
         = D8
         L K7
         / K0     | WA=7
         = D12
         L K8
         MOD K0   | WA=8
         = D16
         L K-7
         / K2     | WA=-3
         = D20
         L K-7
         MOD K2   | WA=-1
         = D24
         L K2147483647
         + K1     | WA=80000000h
         = D28",
        "M3168=1 D12=7 D16=8 D20=-3 D24=-1",
    );
}

#[test]
fn increments() {
    example(
        "[000:12992-13046]",
        "B5=FFh W8=7FFFh",
        "L K5
         INC B5
         DEC W8
         INC W10
         INCW   | WA=6
         INCW   | WA=7
         DECW   | WA=6
         = D16
         INCX
         INCX
         DECX
         LX     | WA=1
         = D20",
        "B5=0 W8=7FFEh W10=1 D16=6 D20=1",
    );
}

#[test]
fn comparisons() {
    // 16000 against 15000.
    for (operator, result) in [("==", 0), ("<", 0), (">", 1), ("<=", 0), (">=", 1), ("<>", 1)] {
        example(
            "[000:13066-13162]",
            "D8=15000",
            &format!(
                "L K16000      | WA=16000
                 {operator} D8 | LA={result} WA=16000 | 15000
                 = M500        | LA={result} | {result}"
            ),
            &format!("M500={result}"),
        );
    }
}

#[test]
fn comparisons_are_as_wide_as_the_operand() {
    // 300 = 12Ch: its low byte is 2Ch = 44.
    example(
        "[000:13064]",
        "B8=44 W10=300",
        "L K300
         == B8  | LA=1
         = M500
         L K300
         == W10 | LA=1
         = M501
         L K300
         == K44 | LA=0
         = M502",
        "M500=1 M501=1 M502=0",
    );
}

#[test]
fn brackets() {
    example(
        "[000:13236-13263]",
        "M500=0 M501=1 I0=0 I1=1",
        "L M500 | LA=0 | 0
         O M501 | LA=1 | 1
         A[     | LA=1
         L I0   | LA=0 | 0
         O I1   | LA=1 | 1
         ]      | LA=1
         = O12  | LA=1 | 1",
        "O12=1",
    );
    example(
        "[000:13351-13358] without brackets",
        "D12=15000 D36=100",
        "L D12   | WA=15000
         + K1000 | WA=16000
         / D36   | WA=160 | 100
         = D100  | WA=160 | 160",
        "D100=160",
    );
    example(
        "[000:13360-13377]",
        "D12=15000 D36=100",
        "L D12   | WA=15000
         +[      | WA=15000
         L K1000 | WA=1000
         / D36   | WA=10
         ]       | WA=15010
         = D100  | WA=15010 | 15010",
        "D100=15010",
    );
    example(
        "restored, of [000:13453-13471]",
        "D12=15000 D36=10",
        "L D12   | WA=15000
         ==[
         L K1000 | WA=1000
         x D36   | WA=10000
         ]       | LA=0
         = O15   | LA=0",
        "O15=0",
    );
}

#[test]
fn brackets_keep_their_order() {
    example(
        "[000:13275-13443]",
        "",
        "L K100
         -[
         L K30
         ]      | WA=70
         = D0
         L K100
         /[
         L K7
         ]      | WA=14
         = D4
         L K100
         MOD[
         L K7
         ]      | WA=2
         = D8
         L K100
         <[
         L K101
         ]      | LA=1
         = M0
         L K12
         AN[
         L K10
         ]      | WA=4
         = D12
         L K1
         x[
         L K2
         x[
         L K3
         + K1
         ]      | WA=8
         ]      | WA=8
         = D16",
        "D0=70 D4=14 D8=2 M0=1 D12=4 D16=8",
    );
}

#[test]
fn shifts() {
    example(
        "[000:13491-13509]",
        "D8=3E80h",
        "L D8   | WA=3E80h
         << K+1 | WA=7D00h
         << K+1 | WA=FA00h
         << K+1 | WA=1F400h
         << K+1 | WA=3E800h
         = D12  | WA=3E800h | 3E800h
         L D8
         << K+4 | WA=3E800h
         = D16",
        "D12=3E800h D16=3E800h",
    );
    example(
        "[000:13525-13547]",
        "D8=3E80h",
        "L D8   | WA=3E80h
         >> K+1 | WA=1F40h
         >> K+1 | WA=0FA0h
         >> K+1 | WA=07D0h
         >> K+1 | WA=03E8h
         = D12",
        "D12=3E8h",
    );
    example(
        "arithmetic, count modulo 32 [000:13489][000:13523]",
        "",
        "L K-16
         >> K2  | WA=-4
         >> K33 | WA=-2
         >> K32 | WA=-1
         = D0
         L K1
         << K33 | WA=2
         << K32 | WA=0
         = D4",
        "D0=-1 D4=0",
    );
}

#[test]
fn bits() {
    example(
        "[000:13567-13586]",
        "D8=3E80h",
        "L D8   | WA=3E80h
         BS K+0 | WA=3E81h
         = D12  | WA=3E81h | 3E81h",
        "D12=3E81h",
    );
    example(
        "[000:13602-13621]",
        "D8=3E81h",
        "L D8   | WA=3E81h
         BC K+0 | WA=3E80h
         = D12",
        "D12=3E80h",
    );
    example(
        "[000:13637-13654]",
        "D8=3E81h",
        "L D8   | WA=3E81h
         BT K+0 | LA=1 WA=3E81h
         = O12  | LA=1 | 1",
        "O12=1",
    );
    example(
        "bit numbers modulo 32 [000:13565]",
        "",
        "L K0
         BS K31 | WA=80000000h
         BS K33 | WA=80000002h
         BC K63 | WA=2
         = D0",
        "D0=2",
    );
}

#[test]
fn consecutive_bits() {
    // M100-M107 = 00000101b, M107 is the sign.
    example(
        "[000:12186-12223][000:12303-12340]",
        "M100=1 M102=1 M215=1",
        "LB M100  | WA=5
         = D0
         LW M200  | WA=-32768
         = D4
         LD M200  | WA=8000h
         = D8
         L K$1234
         B= M300
         W= M400
         D= M500",
        "M302=1 M304=1 M305=1 M300=0 M308=0 M409=1 M412=1 M402=1 M509=1 M512=1 M516=0",
    );
}

#[test]
fn negated_assignments() {
    example(
        "[000:12360-12392]",
        "I4=1",
        "L I4
         =N M10 | LA=1 | 0
         L K5
         =N W8  | WA=5 | -6
         =- W10 | WA=5 | -5",
        "M10=0 W8=-6 W10=-5",
    );
}
