// An O-ring in a rectangular groove under a flat lid, the section of an axisymmetric joint. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"}, n = {10, Name "elements along a quarter of the ring"},
  d = {5, Name "diameter of the ring"}, radius = {40, Name "mean radius"}, width = {6.4, Name "width of the groove"},
  depth = {3.9, Name "depth of the groove"}
];
r = d / 2; q = 0.45 * r;
Point(1) = {radius, r, 0};
For k In {0:3}
  a = Pi / 4 + k * Pi / 2;
  Point(10 + k) = {radius + r * Cos(a), r + r * Sin(a), 0};
  Point(20 + k) = {radius + q * Cos(a), r + q * Sin(a), 0};
EndFor
For k In {0:3}
  Circle(10 + k) = {10 + k, 1, 10 + (k + 1) % 4}; Line(20 + k) = {20 + k, 20 + (k + 1) % 4}; Line(30 + k) = {20 + k, 10 + k};
EndFor
For k In {0:3}
  Curve Loop(10 + k) = {30 + k, 10 + k, -(30 + (k + 1) % 4), -(20 + k)}; Plane Surface(10 + k) = {10 + k};
EndFor
Curve Loop(20) = {20:23}; Plane Surface(20) = {20};
Transfinite Curve{10:13, 20:23} = Round(n * refine) + 1;
Transfinite Curve{30:33} = Round(0.6 * n * refine) + 1;
Transfinite Surface{:};
Recombine Surface{:};
Point(101) = {radius - width / 2 - 2, depth, 0}; Point(102) = {radius - width / 2, depth, 0};
Point(103) = {radius - width / 2, 0, 0}; Point(104) = {radius + width / 2, 0, 0};
Point(105) = {radius + width / 2, depth, 0}; Point(106) = {radius + width / 2 + 2, depth, 0};
For k In {1:5}
  Line(100 + k) = {100 + k, 101 + k};
EndFor
Transfinite Curve{101:105} = 9;
Point(111) = {radius - width / 2 - 2, d, 0}; Point(112) = {radius + width / 2 + 2, d, 0};
Line(111) = {112, 111};
Transfinite Curve{111} = 17;
Physical Surface("ring") = {10:13, 20};
Physical Curve("groove") = {101:105};
Physical Curve("lid") = {111};
