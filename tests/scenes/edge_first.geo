// A square block of side 10, turned by 30 degrees, with its lowest edge above a plate (edge_first.yaml)
DefineConstant[ refine = 1 ];
w = 10;
c = w*Cos(Pi/6);
s = w*Sin(Pi/6);
Point(1) = {0, 0, 0};  Point(2) = {c, s, 0};  Point(3) = {c - s, s + c, 0};  Point(4) = {-s, c, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1:4} = 8*refine + 1;
Transfinite Surface{1};
Recombine Surface{1};

Point(10) = {-20, -0.05, 0, 2};  Point(11) = {20, -0.05, 0, 2};
Line(10) = {10, 11};

Physical Surface("block") = {1};
Physical Curve("skin") = {1, 2, 4};
Physical Curve("top") = {3};
Physical Curve("plate") = {10};
