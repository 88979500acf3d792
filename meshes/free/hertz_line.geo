// The bodies of hertz_line.geo, meshed freely by triangles. Lengths in mm.
SetFactory("OpenCASCADE"); // the built-in kernel would merge the two bodies' coincident points
DefineConstant[
  refine = {1, Name "divides all element sizes"}, near = {1, Name "divides those at the first touch besides"}, radius = {50, Name "radius of the cylinder"},
  size = {200, Name "width and height of the whole block"}
];
h = 10 / refine;
Point(1) = {0, 0, 0, h / near}; Point(2) = {radius, radius, 0, h}; Point(3) = {0, radius, 0, h};
Circle(1) = {1, 3, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1 : 3}; Plane Surface(1) = {1};
Point(11) = {0, 0, 0, h / near}; Point(12) = {0, -size, 0, h}; Point(13) = {size / 2, -size, 0, h}; Point(14) = {size / 2, 0, 0, h};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(11) = {11 : 14}; Plane Surface(11) = {11};
Physical Surface("cylinder") = {1}; Physical Surface("block") = {11};
Physical Curve("cylinder_sole") = {1}; Physical Curve("cylinder_cut") = {2};
Physical Curve("block_top") = {14}; Physical Curve("block_bottom") = {12};
Physical Curve("symmetry_x") = {3, 11};
