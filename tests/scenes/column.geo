// A slender column along x, clamped at both ends, between two walls that it does not reach.
SetFactory("OpenCASCADE");
DefineConstant[ n = {60, Name "elements along it"} ];
L = 100; h = 1; gap = 4;
Rectangle(1) = {0, -h/2, 0, L, h};
Transfinite Curve{1, 3} = n + 1; Transfinite Curve{2, 4} = 3;
Transfinite Surface{1}; Recombine Surface{1};
Point(100) = {-5, -gap, 0}; Point(101) = {L + 5, -gap, 0}; Line(100) = {100, 101};
Point(102) = {-5, gap, 0}; Point(103) = {L + 5, gap, 0}; Line(101) = {103, 102};
Transfinite Curve{100, 101} = 12;
Physical Surface("column") = {1};
Physical Curve("left") = {4}; Physical Curve("right") = {2};
Physical Curve("floor") = {100}; Physical Curve("roof") = {101};
