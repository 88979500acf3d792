// Half of the section of a disc of radius 10 and thickness 2 in a collar, below a die with a ring of relief (coin.yaml)
DefineConstant[ refine = 1 ];
Point(1) = {0, 0, 0};  Point(2) = {10, 0, 0};  Point(3) = {10, 2, 0};  Point(4) = {0, 2, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = Round(40*refine) + 1;
Transfinite Curve{2, 4} = Round(8*refine) + 1;
Transfinite Surface{1};
Recombine Surface{1};

h = 0.15/refine;
Point(10) = {0, 2, 0, h};  Point(11) = {4, 2, 0, h};  Point(12) = {4.5, 2.25, 0, h};  Point(13) = {6, 2.25, 0, h};
Point(14) = {6.5, 2, 0, h};  Point(15) = {12, 2, 0, h};
Line(10) = {10, 11};  Line(11) = {11, 12};  Line(12) = {12, 13};  Line(13) = {13, 14};  Line(14) = {14, 15};

Physical Surface("disc") = {1};
Physical Curve("axis") = {4};
Physical Curve("bottom") = {1};
Physical Curve("rim") = {2};
Physical Curve("top") = {3};
Point(20) = {10.1, -1, 0, h};  Point(21) = {10.1, 3, 0, h};
Line(20) = {20, 21};
Physical Curve("collar") = {20};
Physical Curve("die") = {10, 11, 12, 13, 14};
