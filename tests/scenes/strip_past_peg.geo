// A strip in the way of a peg. Lengths in mm.
Point(1) = {0, 0, 0}; Point(2) = {20, 0, 0}; Point(3) = {20, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = 21; Transfinite Curve{2, 4} = 3; Transfinite Surface{1}; Recombine Surface{1};
Point(10) = {21.5, 8, 0}; Point(11) = {23.5, 8, 0}; Point(12) = {21.5, 10, 0}; Point(13) = {19.5, 8, 0};
Point(14) = {21.5, 6, 0};
Circle(10) = {11, 10, 12}; Circle(11) = {12, 10, 13}; Circle(12) = {13, 10, 14}; Circle(13) = {14, 10, 11};
Transfinite Curve{10 : 13} = 13;
Physical Surface("strip") = {1};
Physical Curve("root") = {4}; Physical Curve("skin") = {1, 2, 3}; Physical Curve("peg") = {10 : 13};
