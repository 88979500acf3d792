// Section of a cushion tyre over the rounded edge of a kerb, plane strain. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
width = 80;          // tyre
height = 30;
shoulder = 10;       // rounding of the tread's ends
crown = 150;         // radius of the tread
edge = 12;           // x of the kerb's side face; the tyre's middle is at 0
r = 8;               // rounding of the kerb's edge
fine = 1.2 / refine;
coarse = 4 / refine;
hw = width / 2;
// the tread is an arc about (0, crown) from -a to a; the shoulders touch it and the side faces
a = Asin((hw - shoulder) / (crown - shoulder));
cs = crown - (crown - shoulder) * Cos(a);     // y of the shoulders' centres
Point(1) = {0, crown, 0};
Point(2) = {-crown * Sin(a), crown - crown * Cos(a), 0, fine};
Point(3) = {0, 0, 0, fine};
Point(4) = {crown * Sin(a), crown - crown * Cos(a), 0, fine};
Point(5) = {hw - shoulder, cs, 0};
Point(6) = {hw, cs, 0, 2 * fine};
Point(7) = {hw, height, 0, coarse};
Point(8) = {-hw, height, 0, coarse};
Point(9) = {-hw, cs, 0, 2 * fine};
Point(10) = {-hw + shoulder, cs, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 5, 6};
Line(4) = {6, 7};
Line(5) = {7, 8};
Line(6) = {8, 9};
Circle(7) = {9, 10, 2};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7};
Plane Surface(1) = {1};

// kerb: its top at y = 0, to the left of x = edge
Point(21) = {-60, 0, 0, coarse};
Point(22) = {-60, -40, 0, 2 * coarse};
Point(23) = {edge, -40, 0, 2 * coarse};
Point(24) = {edge, -r, 0, fine};
Point(25) = {edge - r, -r, 0};
Point(26) = {edge - r, 0, 0, fine};
Line(21) = {21, 22};
Line(22) = {22, 23};
Line(23) = {23, 24};
Circle(24) = {24, 25, 26};
Line(25) = {26, 21};
Curve Loop(2) = {21, 22, 23, 24, 25};
Plane Surface(2) = {2};

Physical Surface("tyre") = {1};
Physical Surface("kerb") = {2};
Physical Curve("tyre_skin") = {6, 7, 1, 2, 3, 4};    // both side faces too
Physical Curve("rim") = {5};
Physical Curve("kerb_skin") = {25, 24, 23};
Physical Curve("ground") = {22};
