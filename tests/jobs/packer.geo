// A packer: a rubber sleeve between a rigid mandrel and a rigid casing, pressed by a ring at its upper end; axisymmetric,
// x the radius. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
fine = 1.6 / refine;
Point(1) = {30.2, 0, 0}; Point(2) = {42, 0, 0}; Point(3) = {44, 2, 0}; Point(4) = {44, 58, 0}; Point(5) = {42, 60, 0}; Point(6) = {30.2, 60, 0};
Point(7) = {42, 2, 0}; Point(8) = {42, 58, 0};
Line(1) = {1, 2}; Circle(2) = {2, 7, 3}; Line(3) = {3, 4}; Circle(4) = {4, 8, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Curve Loop(1) = {1 : 6}; Plane Surface(1) = {1};
MeshSize{:} = fine;
Point(11) = {30, -20, 0}; Point(12) = {30, 80, 0}; Line(11) = {11, 12};
Point(13) = {47, -20, 0}; Point(14) = {47, 80, 0}; Line(12) = {13, 14};
Physical Surface("sleeve") = {1};
Physical Curve("skin") = {2, 3, 4}; Physical Curve("bore") = {6}; Physical Curve("low") = {1}; Physical Curve("high") = {5};
Physical Curve("mandrel") = {11}; Physical Curve("casing") = {12};
