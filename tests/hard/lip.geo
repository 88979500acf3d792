// A rubber ring of radii 10 and 13, 4 high, above a chamfer of a bore of radius 12.6
Point(1) = {10, 0, 0}; Point(2) = {13, 0, 0}; Point(3) = {13, 4, 0}; Point(4) = {10, 4, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = 9; Transfinite Curve{2, 4} = 11; Transfinite Surface{1}; Recombine Surface{1};
Point(11) = {12.6, -12, 0, 1}; Point(12) = {12.6, -1.5, 0, 1}; Point(13) = {13.4, -0.1, 0, 1};
Line(11) = {11, 12}; Line(12) = {12, 13};
Physical Surface("seal") = {1};
Physical Curve("skin") = {1, 2}; Physical Curve("inside") = {4}; Physical Curve("bore") = {11, 12};
