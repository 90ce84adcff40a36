{ Portal 900: two heads on one beam.

  The beam stands over a long table. Both heads run along it in X, each with a cross slide Y and a ram Z. The slide of the
  first head is driven on both sides of the beam, so its X has a slave. Below the second head stands the rotary table C.
  Each head has a channel and a spindle of its own.

  physical axis 1  X   first head     channel 1
                2  -   its slave      channel 1, without name
                3  Y   first head     channel 1
                4  Z   first head     channel 1
                5  X   second head    channel 2
                6  Y   second head    channel 2
                7  Z   second head    channel 2
                8  C   rotary table   channel 2
                9  -   spindle 1      channel 1, without name
               10  -   spindle 2      channel 2, without name
               11  -   handwheel      an encoder without drive

  Statuses: $2....... is kept in the FLASH, $.3 has three decimals, $......1. follows the unit, $..0n.... is closed by lock n. }

; ------------------------------------------------------------------ system
q2: 2 $20000001                   ; channels
q3: 40000 $20000001               ; system parameters

; What the channels do together, network 1: a bit for each channel.
q903: $00000003 $30000001         ; both change their mode
q904: $00000003 $30000001         ; the stop key of one stops both
q905: $00000003 $30000001         ; the abort of one aborts both
q908: $00030303 $30000001         ; both show all messages but those for display
q909: $00000303 $30000001         ; both show those of the PLC

; ------------------------------------------------------------------ channel 1: the first head
q101: 1 $20000001
q102: 10000 $20000001             ; user block 1: P0 and what follows
q103: 3000 $20000001              ; P0 to P2999; P7000 to P9999 lie after them
q104: 18000 $20000001             ; user block 2: P20000 and what follows
q105: 2000 $20000001              ; P20000 to P21999
; Axes: key, physical axis, extension, letter. An axis without letter has no position display.
q110: $01010058 $30000001         ; X
q111: $02030059 $30000001         ; Y
q112: $0304005A $30000001         ; Z
q113: $00020000 $30000001         ; the slave of X
q114: $00090000 $30000001         ; the spindle
q142: 1 $20000001                 ; S is spindle block 1
q152: $00030201 $30000001         ; G17: X Y, Z stands on it
q153: $00020103 $30000001         ; G18: Z X
q154: $00010302 $30000001         ; G19: Y Z
q157: 0 $20000001                 ; the change to HAND acknowledges messages
q158: 0 $20000001                 ; M0 to M199 are those of the system
q159: 3 $20000001                 ; decimals of positions
; Zero points: two work areas, the sum and two shifts of each, five axes, G53 to G59 and G154 to G159.
q170: 20000 $20000001             ; 390 parameters: P20000 to P20389
q171: 2 $20000001
q172: 2 $20000001
q173: 5 $20000001
q174: 1 $20000001
; Tools: 16 records of 20 parameters.
q175: 20500 $20000001             ; 320 parameters: P20500 to P20819
q176: 16 $20000001
q177: 0 $20000001
q178: 20 $20000001
q179: 16 $20000001                ; places in the magazine

; ------------------------------------------------------------------ channel 2: the second head
q201: 2 $20000001
q202: 20000 $20000001             ; user block 1: P0 and what follows
q203: 3000 $20000001              ; P0 to P2999; P7000 to P9999 lie after them
q204: 28000 $20000001             ; user block 2: P20000 and what follows
q205: 2000 $20000001              ; P20000 to P21999
; Axes: key, physical axis, extension, letter. An axis without letter has no position display.
q210: $0B050058 $30000001         ; X
q211: $0C060059 $30000001         ; Y
q212: $0D07005A $30000001         ; Z
q213: $0E080043 $30000001         ; C
q214: $000A0000 $30000001         ; the spindle
q242: 2 $20000001                 ; S is spindle block 2
q252: $00030201 $30000001         ; G17: X Y, Z stands on it
q253: $00020103 $30000001         ; G18: Z X
q254: $00010302 $30000001         ; G19: Y Z
q257: 0 $20000001                 ; the change to HAND acknowledges messages
q258: 0 $20000001                 ; M0 to M199 are those of the system
q259: 3 $20000001                 ; decimals of positions
; Zero points: two work areas, the sum and two shifts of each, five axes, G53 to G59 and G154 to G159.
q270: 20000 $20000001             ; 390 parameters: P20000 to P20389
q271: 2 $20000001
q272: 2 $20000001
q273: 5 $20000001
q274: 1 $20000001
; Tools: 16 records of 20 parameters.
q275: 20500 $20000001             ; 320 parameters: P20500 to P20819
q276: 16 $20000001
q277: 0 $20000001
q278: 20 $20000001
q279: 16 $20000001                ; places in the magazine

; ------------------------------------------------------------------ M functions of the system
; A byte for each, M(4n + 3) first. 0 before, 1 after the path, 2 with stop, 3 the look-ahead waits, 4 branches, 5 also in the
; simulation of a restart, 6 calls a cycle.
P11050: $250E0E0E $30000001       ; M3 spindle clockwise; M2, M1, M0
P11051: $010D2625 $30000001       ; M7 mist; M6 tool change; M5 spindle stop; M4 counter-clockwise
P11052: $05052221 $30000001       ; M11 release C, M10 clamp C; M9 coolant off; M8 on
P11053: $00252500 $30000001       ; M14, M13 spindle with coolant
P11054: $0500000D $30000001       ; M19 oriented stop; M16 tool data alone
P11057: $000E0000 $30000001       ; M30 end
P11065: $00000010 $30000001       ; M60 branches when the probe has touched: M60.300
P11066: $000D0000 $30000001       ; M66 the tool is changed, in cycle Z6
P11070: $00000505 $30000001       ; M81, M80 beam: leave the shared part, ask for it
P11075: $00000040 $30000001       ; M100 calls cycle Z100, which cleans the spindle nose

; ------------------------------------------------------------------ keys and locks
; Byte 1 parameter locks, byte 3 programs and cycles, byte 4 editing: values, statuses, axes, zero points, tools.
P11010: $00000000 $30000001       ; key 1 locks nothing: it lets the start run through
P11011: $06000001 $30000001       ; key 2: lock 1, statuses, axes
P11012: $00030000 $30000001       ; key 3: programs and cycles
P11013: $18000000 $30000001       ; key 4: zero points and tools
P11018: $3F03000F $30000001       ; the software switch: everything

; ------------------------------------------------------------------ system data
P11179: 0 $20000001               ; block check characters are optional
P11270: 0 $20000001               ; events are recorded
P11271: $00000115 $30000001       ; channel 1: PLC, marked parameters, M functions, blocks
P11272: $00000115 $30000001       ; channel 2: likewise
P11279: -- $00000000              ; an entry for the event buffer
P11300: 10000 $20000001           ; increments for each mm of the path
P11301: 2 $20000001               ; position control every 2 ms
P11302: 4 $20000001
P11305: 0 $20000001               ; axes are numbered through
P11308: 0 $20000001               ; metric

; Overrides: 1 for the path, 2 for spindles. Per cent from a table of 27 positions.
P11312: 0 $20000001               ; override 1, path: least
P11313: 120 $20000001             ; most
P11317: 50 $20000001              ; override 2, spindles: least
P11318: 120 $20000001             ; most
P11370: 27 $20000001              ; positions
P11371: 0 $20000001
P11372: 1 $20000001
P11373: 2 $20000001
P11374: 5 $20000001
P11375: 10 $20000001
P11376: 15 $20000001
P11377: 20 $20000001
P11378: 25 $20000001
P11379: 30 $20000001
P11380: 35 $20000001
P11381: 40 $20000001
P11382: 45 $20000001
P11383: 50 $20000001
P11384: 55 $20000001
P11385: 60 $20000001
P11386: 65 $20000001
P11387: 70 $20000001
P11388: 75 $20000001
P11389: 80 $20000001
P11390: 85 $20000001
P11391: 90 $20000001
P11392: 95 $20000001
P11393: 100 $20000001
P11394: 105 $20000001
P11395: 110 $20000001
P11396: 115 $20000001
P11397: 120 $20000001

; Handwheel: the encoder of physical axis 11; what it moves is chosen at the panel.
P11400: 11 $20000001
P11401: 1 $20000001               ; X of the first head to begin with
P11402: 0 $20000001               ; not active
P11403: 100 $20000001             ; INC/mm
P11407: 1 $20000001               ; multipliers
P11408: 10 $20000001
P11409: 100 $20000001

; Coupling 1: the slave of X goes where X goes.
P11480: 1 $20000001               ; master
P11481: 2 $20000001               ; slave
P11482: $00000101 $30000001       ; machine coordinates, rigid
P11483: 0 $20000001               ; with correction
P11484: 0.05 $23000001            ; permitted error, mm
P11485: 200 $20000001             ; for so long, ms
P11486: 5 $20000001               ; P share, 1/s
P11487: 500 $20000001             ; I share, ms
P11490: 0 $23000011               ; synchronous where both are 0
P11491: 0 $23000011
P11492: 1 $20000001               ; 1:1
P11493: 1 $20000001

; Spindle 1: physical axis 9.
P11640: 9 $20000001
P11641: 0 $20000001               ; G96 takes the position that follows
P11642: 100 $23000011
P11643: 1000 $20000001            ; G96 in m/min
P11644: 400000 $20000001          ; most for G96, mm/min
P11645: 12000 $20000001           ; most for G97, rpm
P11646: 0 $20000001               ; G97 in rpm
P11647: 97 $20000001              ; G97 at the start
P11652: 0 $23000001               ; oriented stop, degrees
P11653: 5 $20000001               ; reached within 5 %

; Spindle 2: physical axis 10.
P11660: 10 $20000001
P11661: 0 $20000001               ; G96 takes the position that follows
P11662: 100 $23000011
P11663: 1000 $20000001            ; G96 in m/min
P11664: 400000 $20000001          ; most for G96, mm/min
P11665: 8000 $20000001            ; most for G97, rpm
P11666: 0 $20000001               ; G97 in rpm
P11667: 97 $20000001              ; G97 at the start
P11672: 0 $23000001               ; oriented stop, degrees
P11673: 5 $20000001               ; reached within 5 %

; ------------------------------------------------------------------ axes
; A physical axis has 200 parameters: q2000 is the first of axis 1, q2200 that of axis 2. Machine data are closed by lock 1.

; axis 1: X of the first head
q2000: 1 $20010001                ; connected
q2001: 0 $20010001                ; linear
q2003: $00000101 $30010001        ; slot 1, axis 1 on it
q2004: 24000 $20010001            ; mm/min
q2008: 400 $20010001              ; ms to full speed
q2010: 1 $20010001                ; sine
q2012: 1000 $20010001             ; INC for each mm, quadrupled
q2013: 1 $20010001
q2014: $00000000 $30010001
q2015: $01000000 $30010001        ; it knows its position at power-on: P12152
q2016: 0.01 $23010001             ; exact stop, mm
q2017: 0.08 $23010001             ; coarse
q2018: 3000 $20010001             ; standstill within, ms
q2020: 20 $21010001               ; Kv, 1/s
q2022: 10000 $20010001            ; drift, ms
q2024: 50 $20010001               ; lag: so much above nominal, %
q2025: 100 $20010001              ; for so long, ms
q2027: 9.5 $21010001              ; V at full speed
q2030: 2050 $23010011             ; software limits
q2031: -50 $23010011
q2040: 0 $23010011                ; reference point
q2044: $00010101 $30010001        ; both directions, switch and zero pulse
q2050: 60 $20010001               ; speed pre-control, %
q2052: 0.012 $23010001            ; backlash, mm
q2053: 20 $20010001               ; within, ms
; The second head (q2950 is its machine position) before the first one: within 400 mm, within 250 mm.
q2100: 0 $20010001                ; q parameters
q2101: -2150 $20010001            ; from its own machine position
q2102: 2950 $20010001             ; to that of the second head
q2103: 400 $23010011              ; range 1: warned
q2104: 250 $23010011              ; range 2: the second head stops, P8891
q2119: 6000 $20000001             ; handwheel
q2121: 6000 $20000001             ; relative
q2122: 12000 $20000001            ; absolute

; axis 2: the slave of X
q2200: 1 $20010001                ; connected
q2201: 0 $20010001                ; linear
q2203: $00000102 $30010001        ; slot 1, axis 2 on it
q2204: 24000 $20010001            ; mm/min
q2208: 400 $20010001              ; ms to full speed
q2210: 1 $20010001                ; sine
q2212: 1000 $20010001             ; INC for each mm, quadrupled
q2213: 1 $20010001
q2214: $00000001 $30010001        ; counts the other way
q2215: $01000000 $30010001        ; it knows its position at power-on: P12152
q2216: 0.01 $23010001             ; exact stop, mm
q2217: 0.08 $23010001             ; coarse
q2218: 3000 $20010001             ; standstill within, ms
q2220: 20 $21010001               ; Kv, 1/s
q2222: 10000 $20010001            ; drift, ms
q2224: 50 $20010001               ; lag: so much above nominal, %
q2225: 100 $20010001              ; for so long, ms
q2227: 9.5 $21010001              ; V at full speed
q2230: 2055 $23010011             ; software limits
q2231: -55 $23010011
q2240: 0 $23010011                ; reference point
q2244: $00010101 $30010001        ; both directions, switch and zero pulse
q2250: 60 $20010001               ; speed pre-control, %
q2319: 6000 $20000001             ; handwheel
q2321: 6000 $20000001             ; relative
q2322: 12000 $20000001            ; absolute

; axis 3: Y of the first head
q2400: 1 $20010001                ; connected
q2401: 0 $20010001                ; linear
q2403: $00000103 $30010001        ; slot 1, axis 3 on it
q2404: 18000 $20010001            ; mm/min
q2408: 300 $20010001              ; ms to full speed
q2410: 1 $20010001                ; sine
q2412: 1000 $20010001             ; INC for each mm, quadrupled
q2413: 1 $20010001
q2414: $00000000 $30010001
q2415: $01000000 $30010001        ; it knows its position at power-on: P12152
q2416: 0.01 $23010001             ; exact stop, mm
q2417: 0.08 $23010001             ; coarse
q2418: 3000 $20010001             ; standstill within, ms
q2420: 25 $21010001               ; Kv, 1/s
q2422: 10000 $20010001            ; drift, ms
q2424: 50 $20010001               ; lag: so much above nominal, %
q2425: 100 $20010001              ; for so long, ms
q2427: 9.5 $21010001              ; V at full speed
q2430: 605 $23010011              ; software limits
q2431: -605 $23010011
q2440: 0 $23010011                ; reference point
q2444: $00010101 $30010001        ; both directions, switch and zero pulse
q2450: 60 $20010001               ; speed pre-control, %
q2452: 0.008 $23010001            ; backlash, mm
q2453: 20 $20010001               ; within, ms
q2519: 6000 $20000001             ; handwheel
q2521: 4500 $20000001             ; relative
q2522: 9000 $20000001             ; absolute

; axis 4: Z of the first head
q2600: 1 $20010001                ; connected
q2601: 0 $20010001                ; linear
q2603: $00000104 $30010001        ; slot 1, axis 4 on it
q2604: 12000 $20010001            ; mm/min
q2608: 250 $20010001              ; ms to full speed
q2610: 1 $20010001                ; sine
q2612: 2000 $20010001             ; INC for each mm, quadrupled
q2613: 1 $20010001
q2614: $00000000 $30010001
q2615: $01000000 $30010001        ; it knows its position at power-on: P12152
q2616: 0.01 $23010001             ; exact stop, mm
q2617: 0.08 $23010001             ; coarse
q2618: 3000 $20010001             ; standstill within, ms
q2620: 25 $21010001               ; Kv, 1/s
q2622: 10000 $20010001            ; drift, ms
q2624: 50 $20010001               ; lag: so much above nominal, %
q2625: 100 $20010001              ; for so long, ms
q2627: 9.5 $21010001              ; V at full speed
q2630: 5 $23010011                ; software limits
q2631: -705 $23010011
q2640: 0 $23010011                ; reference point
q2644: $00010101 $30010001        ; both directions, switch and zero pulse
q2650: 60 $20010001               ; speed pre-control, %
q2652: 0.006 $23010001            ; backlash, mm
q2653: 20 $20010001               ; within, ms
q2719: 6000 $20000001             ; handwheel
q2721: 3000 $20000001             ; relative
q2722: 6000 $20000001             ; absolute

; axis 5: X of the second head
q2800: 1 $20010001                ; connected
q2801: 0 $20010001                ; linear
q2803: $00000201 $30010001        ; slot 2, axis 1 on it
q2804: 24000 $20010001            ; mm/min
q2808: 350 $20010001              ; ms to full speed
q2810: 1 $20010001                ; sine
q2812: 1000 $20010001             ; INC for each mm, quadrupled
q2813: 1 $20010001
q2814: $00000000 $30010001
q2815: $01000000 $30010001        ; it knows its position at power-on: P12152
q2816: 0.01 $23010001             ; exact stop, mm
q2817: 0.08 $23010001             ; coarse
q2818: 3000 $20010001             ; standstill within, ms
q2820: 20 $21010001               ; Kv, 1/s
q2822: 10000 $20010001            ; drift, ms
q2824: 50 $20010001               ; lag: so much above nominal, %
q2825: 100 $20010001              ; for so long, ms
q2827: 9.5 $21010001              ; V at full speed
q2830: 3050 $23010011             ; software limits
q2831: 950 $23010011
q2840: 0 $23010011                ; reference point
q2844: $00010101 $30010001        ; both directions, switch and zero pulse
q2850: 60 $20010001               ; speed pre-control, %
q2852: 0.012 $23010001            ; backlash, mm
q2853: 20 $20010001               ; within, ms
; The first head (q2150) seen from the second one: the same ranges the other way.
q2900: 0 $20010001                ; q parameters
q2901: -2150 $20010001            ; from its own machine position
q2902: 2150 $20010001             ; to that of the first head
q2903: -400 $23010011             ; range 1
q2904: -250 $23010011             ; range 2
q2952: 2600 $23000011             ; where it stands at the first power-on
q2919: 6000 $20000001             ; handwheel
q2921: 6000 $20000001             ; relative
q2922: 12000 $20000001            ; absolute

; axis 6: Y of the second head
q3000: 1 $20010001                ; connected
q3001: 0 $20010001                ; linear
q3003: $00000202 $30010001        ; slot 2, axis 2 on it
q3004: 18000 $20010001            ; mm/min
q3008: 300 $20010001              ; ms to full speed
q3010: 1 $20010001                ; sine
q3012: 1000 $20010001             ; INC for each mm, quadrupled
q3013: 1 $20010001
q3014: $00000000 $30010001
q3015: $01000000 $30010001        ; it knows its position at power-on: P12152
q3016: 0.01 $23010001             ; exact stop, mm
q3017: 0.08 $23010001             ; coarse
q3018: 3000 $20010001             ; standstill within, ms
q3020: 25 $21010001               ; Kv, 1/s
q3022: 10000 $20010001            ; drift, ms
q3024: 50 $20010001               ; lag: so much above nominal, %
q3025: 100 $20010001              ; for so long, ms
q3027: 9.5 $21010001              ; V at full speed
q3030: 605 $23010011              ; software limits
q3031: -605 $23010011
q3040: 0 $23010011                ; reference point
q3044: $00010101 $30010001        ; both directions, switch and zero pulse
q3050: 60 $20010001               ; speed pre-control, %
q3052: 0.009 $23010001            ; backlash, mm
q3053: 20 $20010001               ; within, ms
q3119: 6000 $20000001             ; handwheel
q3121: 4500 $20000001             ; relative
q3122: 9000 $20000001             ; absolute

; axis 7: Z of the second head
q3200: 1 $20010001                ; connected
q3201: 0 $20010001                ; linear
q3203: $00000203 $30010001        ; slot 2, axis 3 on it
q3204: 12000 $20010001            ; mm/min
q3208: 250 $20010001              ; ms to full speed
q3210: 1 $20010001                ; sine
q3212: 2000 $20010001             ; INC for each mm, quadrupled
q3213: 1 $20010001
q3214: $00000000 $30010001
q3215: $01000000 $30010001        ; it knows its position at power-on: P12152
q3216: 0.01 $23010001             ; exact stop, mm
q3217: 0.08 $23010001             ; coarse
q3218: 3000 $20010001             ; standstill within, ms
q3220: 25 $21010001               ; Kv, 1/s
q3222: 10000 $20010001            ; drift, ms
q3224: 50 $20010001               ; lag: so much above nominal, %
q3225: 100 $20010001              ; for so long, ms
q3227: 9.5 $21010001              ; V at full speed
q3230: 5 $23010011                ; software limits
q3231: -505 $23010011
q3240: 0 $23010011                ; reference point
q3244: $00010101 $30010001        ; both directions, switch and zero pulse
q3250: 60 $20010001               ; speed pre-control, %
q3252: 0.006 $23010001            ; backlash, mm
q3253: 20 $20010001               ; within, ms
q3319: 6000 $20000001             ; handwheel
q3321: 3000 $20000001             ; relative
q3322: 6000 $20000001             ; absolute

; axis 8: C, the rotary table
q3400: 1 $20010001                ; connected
q3401: 2 $20010001                ; rotary, the shortest way
q3403: $00000204 $30010001        ; slot 2, axis 4 on it
q3404: 7200 $20010001             ; degree/min
q3408: 300 $20010001              ; ms to full speed
q3410: 0 $20010001                ; linear
q3412: 1000 $20010001             ; INC for each degree, quadrupled
q3413: 1 $20010001
q3414: $00000000 $30010001
q3415: $01000000 $30010001        ; it knows its position at power-on: P12152
q3416: 0.02 $23010001             ; exact stop, degree
q3417: 0.16 $23010001             ; coarse
q3418: 3000 $20010001             ; standstill within, ms
q3420: 15 $21010001               ; Kv, 1/s
q3422: 10000 $20010001            ; drift, ms
q3424: 50 $20010001               ; lag: so much above nominal, %
q3425: 100 $20010001              ; for so long, ms
q3427: 9.5 $21010001              ; V at full speed
q3440: 0 $23010001                ; reference point
q3444: $00010101 $30010001        ; both directions, switch and zero pulse
q3450: 0 $20010001                ; speed pre-control, %
q3441: 360 $23010001              ; one turn
q3519: 1800 $20000001             ; handwheel
q3521: 1800 $20000001             ; relative
q3522: 3600 $20000001             ; absolute

; axis 9: spindle 1
q3600: 1 $20010001                ; connected
q3601: 1 $20010001                ; rotary
q3603: $00000301 $30010001        ; slot 3, axis 1 on it
q3604: 4320000 $20010001          ; degree/min
q3608: 1500 $20010001             ; ms to full speed
q3610: 0 $20010001                ; linear
q3612: 100 $20010001              ; INC for each degree, quadrupled
q3613: 1 $20010001
q3614: $00000000 $30010001
q3615: $01000000 $30010001        ; it knows its position at power-on: P12152
q3616: 0.5 $23010001              ; exact stop, degree
q3617: 2 $23010001                ; coarse
q3618: 3000 $20010001             ; standstill within, ms
q3620: 10 $21010001               ; Kv, 1/s
q3622: 10000 $20010001            ; drift, ms
q3624: 50 $20010001               ; lag: so much above nominal, %
q3625: 100 $20010001              ; for so long, ms
q3627: 9.5 $21010001              ; V at full speed
q3641: 360 $23010001              ; one turn
q3724: 4320000 $20010001          ; degree/min
q3729: 2 $20010001                ; override 2

; axis 10: spindle 2
q3800: 1 $20010001                ; connected
q3801: 1 $20010001                ; rotary
q3803: $00000302 $30010001        ; slot 3, axis 2 on it
q3804: 2880000 $20010001          ; degree/min
q3808: 1500 $20010001             ; ms to full speed
q3810: 0 $20010001                ; linear
q3812: 100 $20010001              ; INC for each degree, quadrupled
q3813: 1 $20010001
q3814: $00000000 $30010001
q3815: $01000000 $30010001        ; it knows its position at power-on: P12152
q3816: 0.5 $23010001              ; exact stop, degree
q3817: 2 $23010001                ; coarse
q3818: 3000 $20010001             ; standstill within, ms
q3820: 10 $21010001               ; Kv, 1/s
q3822: 10000 $20010001            ; drift, ms
q3824: 50 $20010001               ; lag: so much above nominal, %
q3825: 100 $20010001              ; for so long, ms
q3827: 9.5 $21010001              ; V at full speed
q3841: 360 $23010001              ; one turn
q3924: 2880000 $20010001          ; degree/min
q3929: 2 $20010001                ; override 2

q10: 99                           ; the descriptors are active: lines of channel 2 may follow

; ------------------------------------------------------------------ channel 1
K1:P8800: 1000 $20000001          ; the program that starts
K1:P8555: 1 $20000001             ; work area
K1:P8830: 54 $20000001            ; programs start with G54
K1:P8510: $00020002 $30000001     ; in AUTO: lock 2, cycles
K1:P8754: 10000 $20000011         ; most by hand, mm/min
K1:P8755: 2000 $20000011          ; by hand
K1:P8763: 10 $23000001            ; steps by hand, mm
K1:P8764: 1 $23000001
K1:P8765: 0.1 $23000001
K1:P8766: 0.01 $23000001
K1:P8767: 0.001 $23000001
K1:P8806: $00010000 $30000001     ; drill cycles act at each block until G80
K1:P8820: 9001 $20000001          ; emergency program 1: away from the other head
K1:P8821: 0 $20000001
K1:P8843: 0.005 $23000001         ; radius error of circles, mm
K1:P8845: 100 $20000001           ; corners above it get a block between
K1:P8851: 1 $20000001             ; slower before corners
K1:P8852: 0.01 $23000001          ; deviation of circles, mm
K1:P8858: 1 $20000001             ; G0 does not wait for the lag
K1:P8865: 1 $20000001             ; overrides
K1:P8866: 1 $20000001
K1:P8867: 1 $20000001
; M functions of the channel
K1:P8300: $00000005 $30000001     ; M200 air for the first head
; A parameter that programs and PLC share, closed in AUTO; one that is recorded.
K1:P500: 0 $23020201              ; parts so far
K1:P600: 0 $20008001              ; step of the job
; Zero points: the sum, then what it is composed of.
; area 1, G54
K1:P20005: 250 $23000011          ; sum
K1:P20006: 120 $23000011
K1:P20007: -310.5 $23000011
K1:P20070: 250 $23000011          ; fixture
K1:P20071: 120 $23000011
K1:P20072: -310.5 $23000011
; area 1, G55
K1:P20010: 1150 $23000011         ; sum
K1:P20011: 120 $23000011
K1:P20012: -310.5 $23000011
K1:P20075: 1150 $23000011         ; fixture
K1:P20076: 120 $23000011
K1:P20077: -310.5 $23000011
; area 2, G54
K1:P20200: 262.5 $23000011        ; sum
K1:P20201: 116 $23000011
K1:P20202: -310.5 $23000011
K1:P20265: 250 $23000011          ; fixture
K1:P20266: 120 $23000011
K1:P20267: -310.5 $23000011
K1:P20330: 12.5 $23000011         ; part
K1:P20331: -4 $23000011
; area 2, G55
K1:P20205: 1162.5 $23000011       ; sum
K1:P20206: 116 $23000011
K1:P20207: -310.5 $23000011
K1:P20270: 1150 $23000011         ; fixture
K1:P20271: 120 $23000011
K1:P20272: -310.5 $23000011
K1:P20335: 12.5 $23000011         ; part
K1:P20336: -4 $23000011
; Tools: group, number, place, radius, length.
K1:P20500: 1 $20000001            ; T1
K1:P20501: 101 $20000001
K1:P20502: 1 $20000001
K1:P20510: 10 $23000011
K1:P20511: 120.5 $23000011
K1:P20520: 2 $20000001            ; T2
K1:P20521: 102 $20000001
K1:P20522: 2 $20000001
K1:P20530: 8 $23000011
K1:P20531: 105.25 $23000011
K1:P20540: 3 $20000001            ; T3
K1:P20541: 103 $20000001
K1:P20542: 3 $20000001
K1:P20550: 6 $23000011
K1:P20551: 98 $23000011
K1:P20560: 4 $20000001            ; T4
K1:P20561: 104 $20000001
K1:P20562: 4 $20000001
K1:P20570: 5 $23000011
K1:P20571: 112.75 $23000011
K1:P20580: 5 $20000001            ; T5
K1:P20581: 105 $20000001
K1:P20582: 5 $20000001
K1:P20590: 4.25 $23000011
K1:P20591: 101 $23000011
K1:P20600: 6 $20000001            ; T6
K1:P20601: 106 $20000001
K1:P20602: 6 $20000001
K1:P20610: 3 $23000011
K1:P20611: 95.5 $23000011

; ------------------------------------------------------------------ channel 2
K2:P8800: 2000 $20000001          ; the program that starts
K2:P8555: 1 $20000001             ; work area
K2:P8830: 54 $20000001            ; programs start with G54
K2:P8510: $00020002 $30000001     ; in AUTO: lock 2, cycles
K2:P8754: 10000 $20000011         ; most by hand, mm/min
K2:P8755: 2000 $20000011          ; by hand
K2:P8763: 10 $23000001            ; steps by hand, mm
K2:P8764: 1 $23000001
K2:P8765: 0.1 $23000001
K2:P8766: 0.01 $23000001
K2:P8767: 0.001 $23000001
K2:P8806: $00010000 $30000001     ; drill cycles act at each block until G80
K2:P8820: 9002 $20000001          ; emergency program 1: away from the other head
K2:P8821: 0 $20000001
K2:P8843: 0.005 $23000001         ; radius error of circles, mm
K2:P8845: 100 $20000001           ; corners above it get a block between
K2:P8851: 1 $20000001             ; slower before corners
K2:P8852: 0.01 $23000001          ; deviation of circles, mm
K2:P8858: 1 $20000001             ; G0 does not wait for the lag
K2:P8865: 1 $20000001             ; overrides
K2:P8866: 1 $20000001
K2:P8867: 1 $20000001
; M functions of the channel
K2:P8308: $00400000 $30000001     ; M234 calls cycle Z234, which turns the table over
; A parameter that programs and PLC share, closed in AUTO; one that is recorded.
K2:P500: 0 $23020201              ; parts so far
K2:P600: 0 $20008001              ; step of the job
; Zero points: the sum, then what it is composed of.
; area 1, G54
K2:P20005: 1600 $23000011         ; sum
K2:P20006: 80 $23000011
K2:P20007: -280 $23000011
K2:P20008: 0 $23000001
K2:P20070: 1600 $23000011         ; fixture
K2:P20071: 80 $23000011
K2:P20072: -280 $23000011
K2:P20073: 0 $23000001
; area 1, G55
K2:P20010: 2300 $23000011         ; sum
K2:P20011: 80 $23000011
K2:P20012: -280.25 $23000011
K2:P20013: 45 $23000001
K2:P20075: 2300 $23000011         ; fixture
K2:P20076: 80 $23000011
K2:P20077: -280.25 $23000011
K2:P20078: 45 $23000001
; area 2, G54
K2:P20200: 1612.5 $23000011       ; sum
K2:P20201: 76 $23000011
K2:P20202: -280 $23000011
K2:P20203: 0 $23000001
K2:P20265: 1600 $23000011         ; fixture
K2:P20266: 80 $23000011
K2:P20267: -280 $23000011
K2:P20268: 0 $23000001
K2:P20330: 12.5 $23000011         ; part
K2:P20331: -4 $23000011
; area 2, G55
K2:P20205: 2312.5 $23000011       ; sum
K2:P20206: 76 $23000011
K2:P20207: -280.25 $23000011
K2:P20208: 45 $23000001
K2:P20270: 2300 $23000011         ; fixture
K2:P20271: 80 $23000011
K2:P20272: -280.25 $23000011
K2:P20273: 45 $23000001
K2:P20335: 12.5 $23000011         ; part
K2:P20336: -4 $23000011
; Tools: group, number, place, radius, length.
K2:P20500: 11 $20000001           ; T11
K2:P20501: 211 $20000001
K2:P20502: 1 $20000001
K2:P20510: 12.5 $23000011
K2:P20511: 130 $23000011
K2:P20520: 12 $20000001           ; T12
K2:P20521: 212 $20000001
K2:P20522: 2 $20000001
K2:P20530: 8 $23000011
K2:P20531: 110.5 $23000011
K2:P20540: 13 $20000001           ; T13
K2:P20541: 213 $20000001
K2:P20542: 3 $20000001
K2:P20550: 5 $23000011
K2:P20551: 104 $23000011
K2:P20560: 14 $20000001           ; T14
K2:P20561: 214 $20000001
K2:P20562: 4 $20000001
K2:P20570: 2.5 $23000011
K2:P20571: 88.125 $23000011

; Positions of the axes have three decimals and go to the panel at each write.
q2150: -- $03004010
q2350: -- $03004010
q2550: -- $03004010
q2750: -- $03004010
q2950: -- $03004010
q3150: -- $03004010
q3350: -- $03004010
q3550: -- $03004000
q3750: -- $03004000
q3950: -- $03004000
