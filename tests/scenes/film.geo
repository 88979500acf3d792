// A needle over a thin film whose ends are held. Lengths in mm.
DefineConstant[
  n = {10, Name "elements along the film"}, thickness = {0.1, Name "of the film"},
  tip = {0.3, Name "place of the needle"},
  gap = {0.1, Name "between film and needle"}, width = {0.4, Name "of the needle's head"}
];
Point(1) = {-5, -thickness, 0};
Point(2) = {5, -thickness, 0};
Point(3) = {5, 0, 0};
Point(4) = {-5, 0, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1:4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = n + 1;
Transfinite Curve{2, 4} = 2;
Transfinite Surface{1};
Recombine Surface{1};
Point(11) = {tip, gap, 0, 0.2};
Point(12) = {tip + width / 2, gap + 1.4, 0, 0.3};
Point(13) = {tip - width / 2, gap + 1.4, 0, 0.3};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 11};
Curve Loop(11) = {11:13};
Plane Surface(11) = {11};
Physical Surface("film") = {1};
Physical Curve("ends") = {2, 4};
Physical Curve("top") = {3};
Physical Surface("needle") = {11};
Physical Curve("head") = {12};
Physical Curve("flanks") = {11, 13};
