// The half of a block of punch.geo under a flat punch, meshed freely by triangles.
DefineConstant[ refine = {1, Name "divides all element sizes"}, edge = {0.5, Name "half of the punch's width"} ];
h = 0.25 / refine;
Point(1) = {0, 0, 0, h}; Point(2) = {1, 0, 0, h}; Point(3) = {1, 1, 0, h}; Point(4) = {edge, 1, 0, h}; Point(5) = {0, 1, 0, h};
For i In {1 : 5}
  Line(i) = {i, (i % 5) + 1};
EndFor
Curve Loop(1) = {1 : 5}; Plane Surface(1) = {1};
Physical Surface("block") = {1};
Physical Curve("floor") = {1}; Physical Curve("symmetry") = {5}; Physical Curve("punch") = {4};
