// A sheet 30 x 1.5 on a die with the edge radius 2 (flange_wiped.yaml)
DefineConstant[ refine = 1 ];
t = 1.5;
Point(1) = {-15, 0, 0};  Point(2) = {15, 0, 0};  Point(3) = {15, t, 0};  Point(4) = {-15, t, 0};
Point(5) = {-4, t, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 5};  Line(5) = {5, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 5, 4};
Plane Surface(1) = {1};
Transfinite Curve{1} = Round(60*refine) + 1;
Transfinite Curve{3} = Round(38*refine) + 1;
Transfinite Curve{5} = Round(60*refine) - Round(38*refine) + 1;
Transfinite Curve{2, 4} = Round(3*refine) + 1;
Transfinite Surface{1} = {1, 2, 3, 4};
Recombine Surface{1};
h = 0.4/refine;
// die: flat, round edge, wall
Point(10) = {-17, 0, 0, 2};  Point(11) = {-2, 0, 0, h};  Point(12) = {-2, -2, 0};  Point(13) = {0, -2, 0, h};
Point(14) = {0, -20, 0, 2};
Line(10) = {10, 11};  Circle(11) = {11, 12, 13};  Line(12) = {13, 14};
// punch: wall beside the die's at a distance of 1.6, round edge of radius 3
c = 1.6;
Point(20) = {c, 20, 0, 2};  Point(21) = {c, t + 3, 0, h};  Point(22) = {c + 3, t + 3, 0};
Point(23) = {c + 3, t, 0, h};  Point(24) = {18, t, 0, 2};
Line(20) = {20, 21};  Circle(21) = {21, 22, 23};  Line(22) = {23, 24};
Physical Surface("sheet") = {1};
Physical Curve("bottom") = {1};
Physical Curve("top") = {3};
Physical Curve("pressed") = {5};
Physical Curve("die") = {10, 11, 12};
Physical Curve("punch") = {20, 21, 22};
