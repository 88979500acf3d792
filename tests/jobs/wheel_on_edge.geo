// A rubber tyre on a steel hub above the edge of a steel block; plane. The hub is not drawn: it is the inner skin of the
// tyre. The block's edge is rounded. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  hub = {25, Name "radius"}, radius = {50, Name "of the wheel"}, edge = {1.5, Name "radius of the block's edge"}
];
fine = 0.6 / refine;
coarse = 6 / refine;
Point(1) = {0, radius, 0, coarse};
For i In {0 : 1}
  r = i ? radius : hub;
  For j In {0 : 3} // from the right to the top, the left and the lowest point
    Point(10 + 10 * i + j) = {r * Cos(j * Pi / 2), radius + r * Sin(j * Pi / 2), 0, (j < 3) ? coarse : (i ? fine : 3 * fine)};
  EndFor
  For j In {0 : 3}
    Circle(10 + 10 * i + j) = {10 + 10 * i + j, 1, 10 + 10 * i + (j + 1) % 4};
  EndFor
  Curve Loop(1 + i) = {10 + 10 * i : 13 + 10 * i};
EndFor
Plane Surface(1) = {2, 1};

Point(30) = {0, -25, 0, coarse};
Point(31) = {40, -25, 0, coarse};
Point(32) = {40, 0, 0, coarse};
Point(33) = {edge, 0, 0, edge / 4 / refine};
Point(34) = {edge, -edge, 0, 1};
Point(35) = {0, -edge, 0, edge / 4 / refine};
Line(30) = {30, 31};
Line(31) = {31, 32};
Line(32) = {32, 33};
Circle(33) = {33, 34, 35};
Line(34) = {35, 30};
Curve Loop(3) = {30 : 34};
Plane Surface(2) = {3};

Physical Surface("tyre") = {1};
Physical Surface("block") = {2};
Physical Curve("tread") = {20 : 23};
Physical Curve("hub") = {10 : 13};
Physical Curve("block_skin") = {32, 33, 34};
Physical Curve("block_bottom") = {30};
