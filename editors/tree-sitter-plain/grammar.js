// HEIDENHAIN plain language: one block a line, or several lines that ~ joins. Words are told apart, what they mean is left
// to the language server. Of tokens of one length the one that stands first in the rules counts.

/** A word in capitals or small letters; blanks in it are any. */
const word = (text) =>
  token(new RegExp(
    text
      .split('')
      .map((c) => (/[a-z]/i.test(c) ? `[${c.toLowerCase()}${c.toUpperCase()}]` : c === ' ' ? '[ \\t]+' : `\\${c}`))
      .join(''),
  ))

module.exports = grammar({
  name: 'tnc_plain',

  extras: () => [/[ \t\r\f\u0000]/, /~[ \t\r]*\n/],

  rules: {
    source_file: ($) => seq(repeat(seq(optional($.block), $._end)), optional($.block)),

    _end: () => /\n/,

    block: ($) => choice(
      seq(optional($._place), $._body, optional($.comment)),
      seq(optional($._place), $.comment),
      $.block_number,
    ),

    // The / stands before or behind the number.
    _place: ($) => choice($.block_number, $.skip, seq($.block_number, $.skip), seq($.skip, $.block_number)),
    block_number: () => /[nN]?[0-9]+/,
    skip: () => '/',
    comment: () => token(seq(';', /[^\n]*/)),

    _body: ($) => choice(
      $.begin, $.end, $.blank, $.tool_definition, $.tool_call, $.label, $.call_label, $.call_program,
      $.cycle_definition, $.cycle_call, $.probe, $.function, $.assignment, $.stop, $.path, $.words_only, $.section,
      $.later,
    ),

    begin: ($) => seq(word('BEGIN PGM'), optional($.name)),
    end: ($) => seq(word('END PGM'), optional($.name)),
    blank: ($) => seq(word('BLK FORM'), repeat($._word)),
    tool_definition: ($) => seq(word('TOOL DEF'), repeat($._word)),
    tool_call: ($) => seq(word('TOOL CALL'), repeat($._word)),
    label: ($) => seq(word('LBL'), optional(word('SET')), $._label),
    call_label: ($) => seq(word('CALL LBL'), $._label, optional($.repetitions)),
    call_program: ($) => seq(word('CALL PGM'), $.name),
    cycle_definition: ($) => seq(word('CYCL DEF'), $.number, repeat($._word)),
    cycle_call: ($) => seq(word('CYCL CALL'), repeat($._word)),
    probe: ($) => seq(word('TCH PROBE'), $.number, repeat($._word)),
    function: ($) => seq(
      /[fF][nN][ \t]*[0-9]+[ \t]*:?/,
      repeat(choice($._word, $.goto)),
    ),
    goto: ($) => seq(word('GOTO'), word('LBL'), $._label),
    assignment: ($) => seq($.parameter, '=', repeat($._word)),
    stop: ($) => seq(word('STOP'), repeat($._word)),
    path: ($) => seq($.path_function, repeat($._word)),
    // A paraxial block, or words without a path function: M functions, R0 FMAX M99.
    words_only: ($) => seq(choice($.paraxial, $.m_function, $.compensation, $.feed, $.speed), repeat($._word)),
    // What later controls have begins with a word of its own: PLANE SPATIAL, FUNCTION TCPM, SEL TABLE, FPOL.
    later: ($) => seq(alias($.text, $.later_function), repeat($._word)),
    paraxial: ($) => seq(alias($._paraxial_axis, $.axis), $._value),
    section: () => token(seq('*', /[^\n]*/)),

    path_function: () => choice(
      word('L'), word('C'), word('CR'), word('CT'), word('LP'), word('CP'), word('CTP'), word('LN'), word('CC'),
      word('RND'), word('CHF'), /[aA][pP][pP][rR][ \t]+[pP]?[lLcC][cC]?[nNtT]?/, /[dD][eE][pP][ \t]+[pP]?[lLcC][cC]?[nNtT]?/,
    ),

    repetitions: ($) => seq(word('REP'), optional(seq($._value, optional(seq('/', $._value))))),

    _word: ($) => choice(
      $.coordinate, $.compensation, $.feed, $.speed, $.m_function, $.direction, $.polar, $.length,
      $._value, $.string, $.operator, $.keyword, $.text,
    ),

    coordinate: ($) => prec.right(seq($.axis, optional($._value))),
    axis: () => /[iI]?[xyzuvwabcXYZUVWABC]|[iI][vV]/,
    _paraxial_axis: () => /[iI]?[xyzuvwabXYZUVWAB]|[iI][cCvV]/,
    compensation: () => /[rR][0lLrR+-]/,
    feed: ($) => prec.right(seq(choice(/[fF][ \t]*[mM][aA][xX]/, /[fF]/), optional($._value))),
    speed: ($) => prec.right(seq(/[sS]/, optional($._value))),
    m_function: () => /[mM][0-9]+/,
    direction: () => /[dD][rR][+-]/,
    polar: ($) => seq(/[iI]?[pP][rRaA]/, $._value),
    length: ($) => prec.right(seq(/[lLrR]|[dD][lLrR]|[nNtT][xyzXYZ]/, optional($._value))),

    _value: ($) => choice($.number, $.parameter),
    number: () => /[+-]?([0-9]+([.,][0-9]*)?|[.,][0-9]+)/,
    parameter: () => /[+-]?[qQ][lLrRsS]?[0-9]+/,
    _label: ($) => choice($.label_number, $.string, $.parameter),
    label_number: () => /[0-9]+/,
    string: () => /"[^"\n]*"/,
    operator: () => /[-+*\/=()^:#.]/,
    keyword: () => choice(
      word('IF'), word('EQU'), word('NE'), word('GT'), word('LT'), word('DIV'), word('SQRT'), word('SIN'), word('COS'),
      word('LEN'), word('ANG'), word('ERROR'), word('PRINT'), word('PLC'), word('LABEL'),
    ),
    text: () => /[^ \t\r\n\f;~0-9+\-*\/=()^:#.][^ \t\r\n\f;~0-9+\-*\/=()^#]*/,
    name: () => /[^ \t\r\n\f;~][^\n;~]*/,
  },
})
