// A bumper of foam with three folds, the half of its section at radii above 0; axisymmetric. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"}, n_len = {60, Name "elements along the length"},
  n_wall = {6, Name "elements through the wall"}, length = {76, Name "of the bumper"}, bore = {20, Name "diameter"}
];
folds = 3;
n = 12 * folds;     // pieces of the splines
For i In {0:n}
  y = length * i / n;
  wave = (1 - Cos(2 * Pi * folds * i / n)) / 2;  // 0 at necks and at the ends, 1 at folds
  Point(100 + i) = {bore / 2 + 4 * wave, y, 0};
  Point(300 + i) = {bore / 2 + 7.5 + 6 * wave, y, 0};
EndFor
Spline(1) = {100:100 + n};
Spline(2) = {300:300 + n};
Line(3) = {100, 300};
Line(4) = {100 + n, 300 + n};
Curve Loop(1) = {3, 2, -4, -1};
Plane Surface(1) = {1};
Transfinite Curve{1, 2} = Round(n_len * refine) + 1;
Transfinite Curve{3, 4} = Round(n_wall * refine) + 1;
Transfinite Surface{1};
Recombine Surface{1};
Physical Surface("bumper") = {1};
Physical Curve("inner") = {1};
Physical Curve("skin") = {1, 2};
Physical Curve("outer") = {2};
Physical Curve("bottom") = {3};
Physical Curve("top") = {4};
