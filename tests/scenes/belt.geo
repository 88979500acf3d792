// A belt over half a drum of radius 10, for friction: its inside lies on the drum.
DefineConstant[ n = {48, Name "elements along the belt"}, thick = {0.1, Name "thickness"}, n_thick = {1, Name "elements through it"},
  drum = {0, Name "faces of a meshed drum over those of the belt, in number on the same length; 0: none"} ];
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
If (drum)
  For k In {0 : 3}
    a = (k + 0.5) * Pi / 2;
    Point(100 + k) = {r * Cos(a), r * Sin(a), 0};
  EndFor
  For k In {0 : 3}
    Circle(100 + k) = {100 + k, 1, 100 + (k + 1) % 4};
  EndFor
  Transfinite Curve{100 : 103} = Ceil(drum * n / 2) + 1;
  Physical Curve("drum") = {100 : 103};
EndIf
