// A round plate of sheet, 1 thick, with a hole of radius 8, and a die with a round shoulder (hole_flanged.yaml)
DefineConstant[ refine = 1 ];
Point(1) = {8, 0, 0};  Point(2) = {40, 0, 0};  Point(3) = {40, 1, 0};  Point(4) = {8, 1, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = Round(64*refine) + 1;
Transfinite Curve{2, 4} = Round(3*refine) + 1;
Transfinite Surface{1};
Recombine Surface{1};

h = 0.6/refine;
Point(10) = {45, 0, 0, 2};  Point(11) = {21.5, 0, 0, h};  Point(12) = {21.5, -4, 0};  Point(13) = {17.5, -4, 0, h};
Point(14) = {17.5, -20, 0, 1};
Line(10) = {10, 11};  Circle(11) = {11, 12, 13};  Line(12) = {13, 14};

Physical Surface("sheet") = {1};
Physical Curve("bottom") = {1};
Physical Curve("top") = {3, 4};
Physical Curve("rim") = {2};
Physical Curve("die") = {10, 11, 12};
