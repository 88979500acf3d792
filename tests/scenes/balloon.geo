// Half of the upper half of a hollow ball: inner radius A, outer radius B; axisymmetric
DefineConstant[A = {10, Name "inner radius"}, B = {11, Name "outer radius"}];
Point(1) = {0, 0, 0};
Point(2) = {A, 0, 0}; Point(3) = {B, 0, 0}; Point(4) = {0, B, 0}; Point(5) = {0, A, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = 3; Transfinite Curve{2, 4} = 13; Transfinite Surface{1}; Recombine Surface{1};
Physical Surface("ball") = {1};
Physical Curve("equator") = {1}; Physical Curve("axis") = {3}; Physical Curve("bore") = {4};
