// A rubber strip that lies between two rollers. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.8 / refine;
Point(1) = {0, -2, 0, h};
Point(2) = {60, -2, 0, h};
Point(3) = {60, 2, 0, h};
Point(4) = {0, 2, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1 : 4};
Plane Surface(1) = {1};
Physical Surface("strip") = {1};
Physical Curve("lower") = {1};
Physical Curve("right") = {2};
Physical Curve("upper") = {3};
