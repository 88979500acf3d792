// A wedge on a slope of the same inclination, in the plane. Lengths in any unit.
DefineConstant[
  length = {4, Name "of the wedge"}, height = {2, Name "of its top over the lower end of the slope's part under it"}, rise = {0.1, Name "of the slope"},
  n = {16, Name "elements along the wedge"}, base = {1, Name "1: with the slope as a block of its own"}, n_base = {40, Name "elements along it"}
];
Point(1) = {0, 0, 0};
Point(2) = {length, rise * length, 0};
Point(3) = {length, height, 0};
Point(4) = {0, height, 0};
For k In {1 : 4}
  Line(k) = {k, k % 4 + 1};
EndFor
Transfinite Curve{1, 3} = n + 1;
Transfinite Curve{2, 4} = n / 2 + 1;
Curve Loop(1) = {1 : 4};
Plane Surface(1) = {1};
Physical Surface("wedge") = {1};
Physical Curve("sole") = {1};
Physical Curve("pushed") = {4};
If (base)
  Point(11) = {-length, -height, 0};
  Point(12) = {2 * length, -height, 0};
  Point(13) = {2 * length, 2 * rise * length, 0};
  Point(14) = {-length, -rise * length, 0};
  For k In {1 : 4}
    Line(10 + k) = {10 + k, 11 + k % 4};
  EndFor
  Transfinite Curve{11, 13} = n_base + 1;
  Transfinite Curve{12, 14} = n / 2 + 1;
  Curve Loop(11) = {11 : 14};
  Plane Surface(11) = {11};
  Physical Surface("base") = {11};
  Physical Curve("slope") = {13};
  Physical Curve("bottom") = {11};
EndIf
Transfinite Surface{:};
Recombine Surface{:};
