// The end of a copper pipe, bore 20 and wall 1, on a cone of 60 degrees with a pilot in the bore (pipe_flared.yaml)
DefineConstant[ refine = 1 ];
Point(1) = {10, 0, 0};  Point(2) = {11, 0, 0};  Point(3) = {11, 30, 0};  Point(4) = {10, 30, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = Round(3*refine) + 1;
Transfinite Curve{2, 4} = Round(45*refine) + 1;
Transfinite Surface{1};
Recombine Surface{1};

h = 0.5/refine;
Point(10) = {9.8, 8, 0, 2*h};  Point(11) = {9.8, -0.3464, 0, h};  Point(12) = {24, -24.94, 0, 2*h};
Line(10) = {10, 11};  Line(11) = {11, 12};

Physical Surface("pipe") = {1};
Physical Curve("inside") = {1, 4};
Physical Curve("top") = {3};
Physical Curve("cone") = {10, 11};
