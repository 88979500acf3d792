// An L-shaped bracket of square arms, 2 long and 1 wide, meshed freely by triangles: the inner corner is sharp.
DefineConstant[
  refine = {1, Name "divides all element sizes"}, near = {1, Name "divides those at the inner corner besides"}
];
h = 0.4 / refine;
Point(1) = {0, 0, 0, h}; Point(2) = {2, 0, 0, h}; Point(3) = {2, 1, 0, h}; Point(4) = {1, 1, 0, h / near}; Point(5) = {1, 2, 0, h}; Point(6) = {0, 2, 0, h};
For i In {1 : 6}
  Line(i) = {i, (i % 6) + 1};
EndFor
Curve Loop(1) = {1 : 6}; Plane Surface(1) = {1};
Physical Surface("bracket") = {1};
Physical Curve("foot") = {5}; Physical Curve("end") = {2};
