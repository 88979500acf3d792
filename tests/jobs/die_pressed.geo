// Half of the section of a plate of 40 by 4 on an anvil, and of a flat die of width 6 with edges of radius 0.5
// (die_pressed.yaml)
DefineConstant[ refine = 1 ];
Point(1) = {0, 0, 0};  Point(2) = {20, 0, 0};  Point(3) = {20, 4, 0};  Point(4) = {0, 4, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1:4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = Round(40*refine) + 1;
Transfinite Curve{2, 4} = Round(8*refine) + 1;
Transfinite Surface{1};
Recombine Surface{1};

r = 0.5;
h = 0.05;
Point(10) = {0, 4, 0};  Point(11) = {3 - r, 4, 0, h};  Point(12) = {3 - r, 4 + r, 0};  Point(13) = {3, 4 + r, 0, h};
Point(14) = {3, 8, 0};
Line(10) = {10, 11};  Circle(11) = {11, 12, 13};  Line(12) = {13, 14};

Physical Surface("plate") = {1};
Physical Curve("sym") = {4};
Physical Curve("bottom") = {1};
Physical Curve("top") = {3};
Physical Curve("die") = {10:12};
