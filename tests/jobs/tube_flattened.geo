// A rubber tube, the half of its cross-section beyond x = 0. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"}, n_arc = {24, Name "elements around a quarter"},
  n_wall = {3, Name "elements through the wall"}, r_out = {10, Name "outer radius"}, wall = {2, Name "thickness"}
];
r_in = r_out - wall;
Point(1) = {0, 0, 0};
Point(2) = {0, -r_out, 0};
Point(3) = {r_out, 0, 0};
Point(4) = {0, r_out, 0};
Point(5) = {0, r_in, 0};
Point(6) = {r_in, 0, 0};
Point(7) = {0, -r_in, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 6};
Circle(5) = {6, 1, 7};
Line(6) = {7, 2};
Line(7) = {3, 6};
Curve Loop(1) = {1, 7, 5, 6};
Curve Loop(2) = {2, 3, 4, -7};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Curve{1, 2, 4, 5} = Round(n_arc * refine) + 1;
Transfinite Curve{3, 6, 7} = Round(n_wall * refine) + 1;
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("tube") = {1, 2};
Physical Curve("outer") = {1, 2};
Physical Curve("inner") = {4, 5};
Physical Curve("skin") = {1, 2, 4, 5};
Physical Curve("middle") = {3, 6};
