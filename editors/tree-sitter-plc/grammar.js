// The instruction list of the PLC: one instruction a line. Of tokens of one length the one that stands first counts.

/** A command in capitals or small letters. */
const command = (text) =>
  token(new RegExp(text.split('').map((c) => (/[a-z]/i.test(c) ? `[${c.toLowerCase()}${c}]` : `[${c}]`)).join('')))

const commands = (text) => choice(...text.split(' ').map(command))

module.exports = grammar({
  name: 'tnc_plc',

  extras: () => [/[ \t\r\f\u0000]/],

  rules: {
    source_file: ($) => seq(repeat(seq(optional($._line), $._end)), optional($._line)),

    _end: () => /\n/,
    _line: ($) => choice(seq($._instruction, optional($.comment)), $.comment),
    comment: () => token(seq(';', /[^\n]*/)),

    _instruction: ($) => choice($.label, $.field, $.jump, $.link, $.constant_line, $.structure, $.instruction),

    label: ($) => seq(alias(command('LBL'), $.command), $.name),
    field: ($) => seq(alias(command('KFIELD'), $.command), $.name),
    jump: ($) => seq(alias(commands('JP JPT JPF CM CMT CMF SUBM'), $.command), $.name),
    link: ($) => choice(
      seq(alias(commands('GLOBAL EXTERN'), $.command), $.name),
      seq(alias(command('USES'), $.command), alias(/[^ \t\r\n;]+/, $.file)),
    ),
    constant_line: ($) => $.constant,
    structure: ($) => choice(
      alias(commands('IFT IFF ELSE ENDI REPEAT UNTILT UNTILF WHILET WHILEF ENDW ENDC ENDK EM EMT EMF'), $.command),
      seq(alias(command('CASE'), $.command), $.operand),
    ),
    instruction: ($) => prec.right(seq(
      choice($.command, $.bracket),
      optional(choice($.operand, $.constant, $.string, $.constants, $.name)),
    )),

    bracket: () => choice(/([aAoOxX+\-\/]|[aAoO][nN]|[xX][oO][nN]?|[mM][oO][dD]|==|<>|<=|>=|<|>)[ \t]*\[/, ']'),
    command: () => choice(
      ...'L LN L- LB LW LD LX = B= W= D= =N =- =X S R SN RN A AN O ON XO XON + - X / MOD INC INCW INCX DEC DECW DECX'
        .split(' ').map(command),
      ...'== < > <= >= <> << >> BS BC BT PS PL PSL PSW PSX PLL PLW PLX OVWR RPLY CAN U UN'.split(' ').map(command),
    ),

    operand: () => token(seq(/[miotcbwdMIOTCBWD][ \t]?[0-9]+/, optional(/[ \t]?\[[ \t]?[xX][ \t]?\]/))),
    constant: () => /[kK][ \t]*[+-]?[ \t]*(\$[0-9a-fA-F]+|[0-9]+)/,
    constants: ($) => seq(/[kK][fF]/, $.name, optional(/\[[xX]\]/)),
    string: () => choice(
      /[sS][ \t]?"[^"\n]*"/,
      /[sS][ \t]?#[eEdD][ \t]?[0-9]+(\[[xX]\])?/,
      /[sS][ \t]?[0-9](\^[xX]|\[[xX]\])?/,
    ),
    name: () => /[A-Za-z0-9_.\u00c0-\u024f]+/,
  },
})
