// Half of a C-shaped clip with round tips, symmetric about x = 0, open upwards. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  inner = {10, Name "inner radius"}, outer = {12, Name "outer radius"}, open = {50, Name "degrees of the tips above the horizontal"}
];
a = open * Pi / 180; m = (inner + outer) / 2; r = (outer - inner) / 2;
Point(1) = {0, 0, 0};
Point(2) = {0, -inner, 0}; Point(3) = {0, -outer, 0}; Point(4) = {inner, 0, 0}; Point(5) = {outer, 0, 0};
Point(6) = {inner * Cos(a), inner * Sin(a), 0}; Point(7) = {outer * Cos(a), outer * Sin(a), 0};
Point(8) = {m * Cos(a), m * Sin(a), 0}; Point(9) = {m * Cos(a) - r * Sin(a), m * Sin(a) + r * Cos(a), 0};
Circle(1) = {2, 1, 4}; Circle(2) = {4, 1, 6}; Circle(3) = {6, 8, 9}; Circle(4) = {9, 8, 7};
Circle(5) = {7, 1, 5}; Circle(6) = {5, 1, 3}; Line(7) = {3, 2};
Curve Loop(1) = {1 : 7}; Plane Surface(1) = {1};
MeshSize{:} = 0.4 / refine;
Physical Surface("clip") = {1};
Physical Curve("inside") = {1 : 4}; Physical Curve("foot") = {7};
