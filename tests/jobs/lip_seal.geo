// A radial lip seal on a shaft, axisymmetric: x = r, y = z along the shaft. Lip, membrane and the ring that is bonded
// to the metal case; the lip is drawn as moulded, so that it lies in the shaft. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  shaft = {20, Name "radius of the shaft"}, tip = {19.5, Name "radius at which the sides of the lip meet"},
  air = {25, Name "angle of the lip's air side to the shaft"}, oil = {45, Name "angle of its oil side"},
  round = {0.25, Name "radius of the lip's edge"}
];
fine = 0.06 / refine;
middle = 0.35 / refine;
coarse = 1 / refine;
a = air * Pi / 180;
b = oil * Pi / 180;
half = (Pi - a - b) / 2; // angle between a side and the bisector of the lip
d = round / Tan(half);
n = Sqrt((Sin(a) + Sin(b))^2 + (Cos(b) - Cos(a))^2);
Point(1) = {tip + d * Sin(b), d * Cos(b), 0, fine}; // where the rounding ends
Point(2) = {tip + round / Sin(half) * (Sin(a) + Sin(b)) / n, round / Sin(half) * (Cos(b) - Cos(a)) / n, 0, fine};
Point(3) = {tip + d * Sin(a), -d * Cos(a), 0, fine};
Point(4) = {tip + 4 * Tan(a), -4, 0, middle};
Point(5) = {22.5, -9, 0, coarse};
Point(6) = {30, -9, 0, coarse};
Point(7) = {30, -7, 0, coarse};
Point(8) = {24, -7, 0, middle};
Point(9) = {22.8, -3.5, 0, middle};
Point(10) = {23.6, -1.5, 0, middle};
Point(11) = {23.6, 2.5, 0, middle};
Point(12) = {tip + 2.5 * Tan(b), 2.5, 0, middle};
Circle(1) = {1, 2, 3};
Line(3) = {3, 4};
For i In {4 : 11}
  Line(i) = {i, i + 1};
EndFor
Line(12) = {12, 1};
Curve Loop(1) = {1, 3 : 12};
Plane Surface(1) = {1};

Point(20) = {shaft / 2, -11, 0, 4 * coarse};
Point(21) = {shaft, -11, 0, coarse};
Point(22) = {shaft, 8, 0, coarse};
Point(23) = {shaft / 2, 8, 0, 4 * coarse};
Point(24) = {shaft, 0, 0, 2 * fine};
Line(20) = {20, 21};
Line(21) = {21, 24};
Line(22) = {24, 22};
Line(23) = {22, 23};
Line(24) = {23, 20};
Curve Loop(2) = {20 : 24};
Plane Surface(2) = {2};

Physical Surface("seal") = {1};
Physical Surface("shaft") = {2};
Physical Curve("lip") = {12, 1, 3};
Physical Curve("garter") = {10};
Physical Curve("case") = {5, 6};
Physical Curve("shaft_skin") = {21, 22};
Physical Curve("shaft_end") = {20};
