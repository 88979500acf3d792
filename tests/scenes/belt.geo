// A belt over half a drum of radius 10, for friction: its inside lies on the drum.
DefineConstant[ n = {48, Name "elements along the belt"}, thick = {0.1, Name "thickness"}, n_thick = {1, Name "elements through it"} ];
r = 10;
Point(1) = {0, 0, 0};
For k In {0 : 1}
  Point(10 + k) = {r + k * thick, 0, 0};
  Point(20 + k) = {0, r + k * thick, 0};
  Point(30 + k) = {-r - k * thick, 0, 0};
  Circle(10 + k) = {10 + k, 1, 20 + k};
  Circle(20 + k) = {20 + k, 1, 30 + k};
  Transfinite Curve{10 + k, 20 + k} = n / 2 + 1;
EndFor
Line(1) = {10, 11};
Line(2) = {20, 21};
Line(3) = {30, 31};
Transfinite Curve{1, 2, 3} = n_thick + 1;
Curve Loop(1) = {1, 11, -2, -10};
Curve Loop(2) = {2, 21, -3, -20};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("belt") = {1, 2};
Physical Curve("inside") = {10, 20};
Physical Curve("end_low") = {1};
Physical Curve("end_high") = {3};
