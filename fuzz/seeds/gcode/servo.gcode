(pen up is M3 S300)
(pen down is M3 S700)
G21
G90
M3 S300
(pen 2: red 0.3)
M0
G0 X1 Y2
M3 S700
G4 P.15
G1 X3 F600
M3 S300
