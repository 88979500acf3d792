// A rivet of radius 2 in a hole, of which 3 stand out; axisymmetric (rivet.yaml)
DefineConstant[ refine = 1 ];
Point(1) = {0, -4, 0};  Point(2) = {2, -4, 0};  Point(3) = {2, 3, 0};  Point(4) = {0, 3, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = Round(12*refine) + 1;
Transfinite Curve{2, 4} = Round(42*refine) + 1;
Transfinite Surface{1};
Recombine Surface{1};
h = 0.1/refine;
Point(10) = {2.1, -5, 0, h};  Point(11) = {2.1, -0.3, 0, h};  Point(12) = {2.4, -0.3, 0};  Point(13) = {2.4, 0, 0, h};  Point(14) = {8, 0, 0, 1};
Line(10) = {14, 13};  Circle(11) = {13, 12, 11};  Line(12) = {11, 10};
Physical Surface("rivet") = {1};
Physical Curve("foot") = {1};
Physical Curve("side") = {2};
Physical Curve("top") = {3};
Physical Curve("axis") = {4};
Physical Curve("plate") = {10, 11, 12};
