// A hose, the half of its cross-section beyond x = 0, meshed freely by quadrilaterals. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"}, r_out = {4.8, Name "outer radius"}, r_in = {3.2, Name "inner radius"},
  size = {0.3, Name "element size"}
];
h = size / refine;
Point(1) = {0, 0, 0, h};
Point(2) = {0, -r_out, 0, h};
Point(3) = {r_out, 0, 0, h};
Point(4) = {0, r_out, 0, h};
Point(5) = {0, r_in, 0, h};
Point(6) = {r_in, 0, 0, h};
Point(7) = {0, -r_in, 0, h};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 6};
Circle(5) = {6, 1, 7};
Line(6) = {7, 2};
Curve Loop(1) = {1:6};
Plane Surface(1) = {1};
Recombine Surface{1};
Physical Surface("hose") = {1};
Physical Curve("outside") = {1, 2};
Physical Curve("inside") = {4, 5};
Physical Curve("middle") = {3, 6};
