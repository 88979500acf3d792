// A disc of radius 10 and thickness 3 below a die with a round ridge of radius 1.5 that stands 0.8 out (disc_coined.yaml)
DefineConstant[ refine = 1 ];
Point(1) = {0, 0, 0};  Point(2) = {10, 0, 0};  Point(3) = {10, 3, 0};  Point(4) = {0, 3, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = Round(50*refine) + 1;
Transfinite Curve{2, 4} = Round(15*refine) + 1;
Transfinite Surface{1};
Recombine Surface{1};

h = 0.2/refine;
R = 1.5;
out = 0.8;
w = Sqrt(R*R - (R - out)*(R - out));
Point(10) = {0, 3 + out, 0, 2*h};  Point(11) = {5 - w, 3 + out, 0, h};  Point(12) = {5, 3 + R, 0};  Point(13) = {5, 3, 0, h};
Point(14) = {5 + w, 3 + out, 0, h};  Point(15) = {14, 3 + out, 0, 2*h};
Line(10) = {10, 11};  Circle(11) = {11, 12, 13};  Circle(12) = {13, 12, 14};  Line(13) = {14, 15};

Physical Surface("disc") = {1};
Physical Curve("bottom") = {1};
Physical Curve("top") = {3};
Physical Curve("die") = {10, 11, 12, 13};
