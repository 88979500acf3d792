// Three rubber rings that lie on each other between two plates. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"}, n_arc = {32, Name "elements around a ring"},
  n_wall = {3, Name "elements through the wall"}, r_out = {10, Name "outer radius"}, wall = {2.5, Name "thickness"}
];
r_in = r_out - wall;
For i In {0:2}
  p = 100 * i; y = r_out + i * 2 * r_out;
  Point(p + 1) = {0, y, 0};
  For k In {0:3}
    c = Cos(k * Pi / 2); s = Sin(k * Pi / 2);
    Point(p + 10 + k) = {r_out * c, y + r_out * s, 0}; Point(p + 20 + k) = {r_in * c, y + r_in * s, 0};
  EndFor
  For k In {0:3}
    Circle(p + 10 + k) = {p + 10 + k, p + 1, p + 10 + (k + 1) % 4};
    Circle(p + 20 + k) = {p + 20 + k, p + 1, p + 20 + (k + 1) % 4};
    Line(p + 30 + k) = {p + 10 + k, p + 20 + k};
  EndFor
  For k In {0:3}
    Curve Loop(p + k + 1) = {p + 10 + k, p + 30 + (k + 1) % 4, -(p + 20 + k), -(p + 30 + k)};
    Plane Surface(p + k + 1) = {p + k + 1};
  EndFor
  Transfinite Curve{p + 10 : p + 13, p + 20 : p + 23} = Round(n_arc * refine / 4) + 1;
  Transfinite Curve{p + 30 : p + 33} = Round(n_wall * refine) + 1;
EndFor
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("low") = {1:4};
Physical Surface("middle") = {101:104};
Physical Surface("high") = {201:204};
Physical Curve("low_skin") = {10:13};
Physical Curve("middle_skin") = {110:113};
Physical Curve("high_skin") = {210:213};
