// A pin in a lug with clearance, a quarter of it: symmetric about x = 0 and about z = 0. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
D = 20;             // hole
clearance = 0.1;    // on the diameter
W = 44;             // width of the lug
T = 10;             // thickness
P = 18;             // length of the pin, which stands out of the lug on both sides
tail = 36;          // from the hole's centre to the clamp
r = D / 2;
rp = (D - clearance) / 2;
fine = 1.4 / refine;         // where pin and lug may touch: lug
fine_pin = 1.2 / refine;     // pin
mid = 3 / refine;
coarse = 6 / refine;

// lug: half of a head of width W, a strip below
Point(1) = {0, r, 0, fine};
Point(2) = {0, W / 2, 0, coarse};
Point(3) = {W / 2, 0, 0, coarse};
Point(4) = {W / 2, -tail, 0, coarse};
Point(5) = {0, -tail, 0, coarse};
Point(6) = {0, -r, 0, mid};
Point(7) = {r, 0, 0, mid};
Point(8) = {0, 0, 0};
Point(9) = {r * Sin(Pi / 4), r * Cos(Pi / 4), 0, fine};
Line(1) = {1, 2};
Circle(2) = {2, 8, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Circle(6) = {6, 8, 7};
Circle(7) = {7, 8, 9};
Circle(8) = {9, 8, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7, 8};
Plane Surface(1) = {1};

// pin: half of a disc; it stands in the middle of the hole, so that the clearance is all around
Point(21) = {0, rp, 0, fine_pin};
Point(22) = {0, -rp, 0, mid};
Point(23) = {rp, 0, 0, mid};
Point(24) = {rp * Sin(Pi / 4), rp * Cos(Pi / 4), 0, fine_pin};
Line(21) = {22, 21};
Circle(22) = {21, 8, 24};
Circle(23) = {24, 8, 23};
Circle(24) = {23, 8, 22};
Curve Loop(2) = {21, 22, 23, 24};
Plane Surface(2) = {2};
lug[] = Extrude{0, 0, T / 2}{ Surface{1}; };
pin[] = Extrude{0, 0, T / 2}{ Surface{2}; };
out[] = Extrude{0, 0, (P - T) / 2}{ Surface{pin[0]}; };

Physical Volume("lug") = {lug[1]};
Physical Volume("pin") = {pin[1], out[1]};
Physical Surface("bore") = {lug[7], lug[8], lug[9]};
Physical Surface("clamp") = {lug[5]};
Physical Surface("pin_skin") = {pin[3], pin[4], pin[5]};
Physical Surface("pin_end") = {out[0]};
Physical Surface("symmetry_x") = {lug[2], lug[6], pin[2], out[2]};
Physical Surface("symmetry_z") = {1, 2};
