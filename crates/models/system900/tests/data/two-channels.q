{ Two heads on one beam: channel 1 has X, Y and Z, channel 2 has Y, Z and the table C.
  A small file to begin with; what is not here is cleared. }

q2: 2            ; channels
q3: 40000        ; system parameters

; channel 1
q101: 1
q102: 10000      ; user block 1: P0
q103: 5000
q104: 18000      ; user block 2: P20000
q105: 2000
q110: $01010058  ; X, physical axis 1, key 1
q111: $02020059  ; Y
q112: $0303005A  ; Z
q142: 1          ; S is spindle block 1
q152: $030201    ; G17
q170: 20000      ; zero points
q171: 2          ; two work areas
q172: 1          ; with one shift each
q173: 3
q175: 21000      ; tools
q176: 4
q177: 1
q178: 20

; channel 2
q201: 2
q202: 20000
q203: 2000
q204: 25000
q205: 500
q210: $42040359  ; Y3, physical axis 4, key 66
q211: $0005005A  ; Z
q212: $00060043  ; C
q252: $000201
q258: 1          ; M functions of its own

; axes
q2004: 12000 $00000003
q2020: 1.5
q2027: 9.5

; spindle 1 on physical axis 6
P11640: 6
P11051: $10050601 $10000001  ; M4 before, M5 after with stop, M6 before with stop, M7 branches

q10: 99          ; from here on the lines of channel 2 may follow

K1:P20000: 100.25 $23000001
K1:P20021: 100.25 $23000001
P21000: 1
P21010: 4.975 $03000001
P21011: 112.5 $03000001
K2:P8308: $00400000 $10000001  ; M234 calls cycle Z234
K2:P7000: 0 $03000001
K1:P1000: 7 $20020401
