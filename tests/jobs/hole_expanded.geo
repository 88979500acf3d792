// A disc of sheet with a hole of radius 5, rim at 45, thickness 2, over a cone of 60 degrees (hole_expanded.yaml)
DefineConstant[ refine = 1 ];
Point(1) = {5, 0, 0};  Point(2) = {45, 0, 0};  Point(3) = {45, 2, 0};  Point(4) = {5, 2, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = Round(90*refine) + 1;
Transfinite Curve{2, 4} = Round(6*refine) + 1;
Transfinite Surface{1};
Recombine Surface{1};

h = 0.4/1.5/refine;
Point(10) = {0, -1, 0, 1};  Point(11) = {4.6, -1, 0, h};  Point(12) = {24.6, -35.64, 0, 1};
Line(10) = {12, 11};  Line(11) = {11, 10};

Physical Surface("sheet") = {1};
Physical Curve("low") = {1, 4};
Physical Curve("rim") = {2};
Physical Curve("cone") = {10, 11};
