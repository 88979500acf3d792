// A bar of radius 5 and length 20 above a funnel of 45 degrees that narrows to radius 4 (bar_in_funnel.yaml)
Point(1) = {0, 0, 0};  Point(2) = {5, 0, 0};  Point(3) = {5, 20, 0};  Point(4) = {0, 20, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = 9;
Transfinite Curve{2, 4} = 25;
Transfinite Surface{1};
Recombine Surface{1};

Point(10) = {9, 1, 0, 0.5};  Point(11) = {4, -4, 0, 0.5};  Point(12) = {4, -10, 0, 0.5};
Line(10) = {10, 11};  Line(11) = {11, 12};

Physical Surface("bar") = {1};
Physical Curve("skin") = {1, 2};
Physical Curve("axis") = {4};
Physical Curve("top") = {3};
Physical Curve("funnel") = {10, 11};
