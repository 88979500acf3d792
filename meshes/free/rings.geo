// The cross-sections of ring_in_ring.geo, meshed freely by triangles: rings of 10-20 and 20-30 mm with an interference.
SetFactory("OpenCASCADE"); // the built-in kernel would merge points that lie as near as the interference
DefineConstant[
  refine = {1, Name "divides all element sizes"}, interference = {0.0025, Name "by which the inner ring is too large"}
];
h = 4 / refine;
radius[] = {10, 20 + interference, 20, 30};
Point(1) = {0, 0, 0};
For i In {0 : 3}
  Point(10 + i) = {radius[i], 0, 0, h}; Point(20 + i) = {0, radius[i], 0, h};
  Circle(10 + i) = {10 + i, 1, 20 + i};
EndFor
For b In {0 : 1}
  Line(30 + b) = {10 + 2 * b, 11 + 2 * b}; Line(40 + b) = {20 + 2 * b, 21 + 2 * b};
  Curve Loop(1 + b) = {30 + b, 11 + 2 * b, -(40 + b), -(10 + 2 * b)}; Plane Surface(1 + b) = {1 + b};
EndFor
Physical Surface("inner") = {1}; Physical Surface("outer") = {2};
Physical Curve("inner_contact") = {11}; Physical Curve("outer_contact") = {12}; Physical Curve("rim") = {13};
Physical Curve("symmetry_x") = {40, 41}; Physical Curve("symmetry_y") = {30, 31};
