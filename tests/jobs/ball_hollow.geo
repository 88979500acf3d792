// The shell of a hollow ball, a quarter of its meridian plane, x the radius. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  radius = {33, Name "outer radius"}, wall = {4, Name "thickness of the wall"}
];
Point(1) = {0, 0, 0}; Point(2) = {radius, 0, 0}; Point(3) = {radius - wall, 0, 0};
Point(4) = {0, radius, 0}; Point(5) = {0, radius - wall, 0};
Circle(1) = {2, 1, 4}; Line(2) = {4, 5}; Circle(3) = {5, 1, 3}; Line(4) = {3, 2};
Transfinite Curve{1, 3} = Round(40 * refine) + 1;
Transfinite Curve{2, 4} = Round(3 * refine) + 1;
Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
Transfinite Surface{1}; Recombine Surface{1};
Physical Surface("shell") = {1};
Physical Curve("outer") = {1}; Physical Curve("inner") = {3};
Physical Curve("axis") = {2}; Physical Curve("equator") = {4};
