// A thin ring in the plane, its lowest and highest point on the y-axis. Lengths in mm.
DefineConstant[
  n_arc = {40, Name "elements around a quarter"}, n_wall = {2, Name "elements through the wall"},
  radius = {10, Name "of the outer side"}, wall = {0.4, Name "thickness"}
];
inner = radius - wall;
Point(1) = {0, 0, 0};
For q In {0:3}
  c = Cos(q * Pi / 2);
  s = Sin(q * Pi / 2);
  Point(10 + q) = {radius * c, radius * s, 0};
  Point(20 + q) = {inner * c, inner * s, 0};
  Line(30 + q) = {20 + q, 10 + q};
EndFor
For q In {0:3}
  next = (q + 1) % 4;
  Circle(10 + q) = {10 + q, 1, 10 + next};
  Circle(20 + q) = {20 + q, 1, 20 + next};
  Curve Loop(q + 1) = {30 + q, 10 + q, -(30 + next), -(20 + q)};
  Plane Surface(q + 1) = {q + 1};
EndFor
Transfinite Curve{10:13, 20:23} = n_arc + 1;
Transfinite Curve{30:33} = n_wall + 1;
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("ring") = {1:4};
Physical Curve("outer") = {10:13};
Physical Curve("inner") = {20:23};
Physical Curve("skin") = {10:13, 20:23};
