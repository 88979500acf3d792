// Half of a strip of sheet, 40 x 1.2, over a groove of half width 4.6 whose shoulders have the radius 1.5 (bead_pressed.yaml)
DefineConstant[ refine = 1 ];
t = 1.2;
Point(1) = {0, 0, 0};  Point(2) = {20, 0, 0};  Point(3) = {20, t, 0};  Point(4) = {0, t, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = Round(60*refine) + 1;
Transfinite Curve{2, 4} = Round(4*refine) + 1;
Transfinite Surface{1};
Recombine Surface{1};

h = 0.3/refine;
c = 4.6;
r = 1.5;
Point(10) = {25, 0, 0, 2};  Point(11) = {c + r, 0, 0, h};  Point(12) = {c + r, -r, 0};  Point(13) = {c, -r, 0, h};
Point(14) = {c, -8, 0, 1};
Line(10) = {10, 11};  Circle(11) = {11, 12, 13};  Line(12) = {13, 14};

Physical Surface("strip") = {1};
Physical Curve("bottom") = {1};
Physical Curve("top") = {3};
Physical Curve("middle") = {4};
Physical Curve("die") = {10, 11, 12};
