// A thin bar on its bed, for friction: its left end is free, its right end is pulled.
DefineConstant[ length = {16, Name "length"}, height = {0.1, Name "height"}, n = {160, Name "elements along"},
  bed = {0, Name "faces of a meshed bed, longer by 1 at both ends; 0: none"} ];
Point(1) = {0, 0, 0};
Point(2) = {length, 0, 0};
Point(3) = {length, height, 0};
Point(4) = {0, height, 0};
For k In {1 : 4}
  Line(k) = {k, k % 4 + 1};
EndFor
Transfinite Curve{1, 3} = n + 1;
Transfinite Curve{2, 4} = 2;
Curve Loop(1) = {1 : 4};
Plane Surface(1) = {1};
Transfinite Surface{1};
Recombine Surface{1};
Physical Surface("bar") = {1};
Physical Curve("bottom") = {1};
Physical Curve("right") = {2};
Physical Curve("top") = {3};
If (bed)
  Point(11) = {-1, 0, 0};
  Point(12) = {length + 1, 0, 0};
  Line(11) = {11, 12};
  Transfinite Curve{11} = bed + 1;
  Physical Curve("bed") = {11};
EndIf
