// A wedge-shaped shoe between a rail and a slope above it. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 1 / refine;     // element size
a = 20 * Pi / 180;  // of the slope
Point(1) = {0, -6, 0, h};
Point(2) = {60, -6, 0, h};
Point(3) = {60, 0, 0, h};
Point(4) = {0, 0, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = 60*refine + 1;
Transfinite Curve{2, 4} = 6*refine + 1;
Transfinite Surface{1};
Recombine Surface{1};
Point(11) = {20, 0, 0, h};
Point(12) = {40, 0, 0, h};
Point(13) = {40, 5, 0, h};
Point(14) = {20, 5 + 20*Tan(a), 0, h};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14};
Plane Surface(2) = {2};
Transfinite Curve{11, 13} = 20*refine + 1;
Transfinite Curve{12, 14} = 8*refine + 1;
Transfinite Surface{2};
Recombine Surface{2};
Physical Surface("rail") = {1};
Physical Surface("shoe") = {2};
Physical Curve("rail_bottom") = {1};
Physical Curve("rail_top") = {3};
Physical Curve("shoe_sole") = {11};
Physical Curve("shoe_slope") = {13};
Physical Curve("shoe_back") = {14};
