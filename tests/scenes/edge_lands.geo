// A block 10 x 10 that stands on its edge, on a foot 30 x 8 (edge_lands.yaml)
DefineConstant[
  n = {10, Name "faces along a side of the block"}
];
s = 10 * Sqrt(0.5);
Point(1) = {0, 0, 0};
Point(2) = {s, s, 0};
Point(3) = {0, 2 * s, 0};
Point(4) = {-s, s, 0};
Point(11) = {-15, -8, 0};
Point(12) = {15, -8, 0};
Point(13) = {15, 0, 0};
Point(14) = {-15, 0, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Line(11) = {11, 12};  Line(12) = {12, 13};  Line(13) = {13, 14};  Line(14) = {14, 11};
Curve Loop(1) = {1 : 4};
Plane Surface(1) = {1};
Curve Loop(2) = {11 : 14};
Plane Surface(2) = {2};
Transfinite Curve{1 : 4} = n + 1;
Transfinite Curve{11, 13} = 3 * n + 1;
Transfinite Curve{12, 14} = Round(0.8 * n) + 1;
Transfinite Surface{1, 2};
Recombine Surface{1, 2};
Physical Surface("block") = {1};
Physical Surface("foot") = {2};
Physical Curve("skin") = {1, 4};
Physical Curve("back") = {2, 3};
Physical Curve("top") = {13};
Physical Curve("bottom") = {11};
