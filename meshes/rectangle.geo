// A rectangle from the origin, in the plane, with elements that grow away from its lower left corner.
DefineConstant[ width = {40, Name "along x"}, height = {40, Name "along y"}, n = {32, Name "elements along x"}, m = {32, Name "elements along y"},
  growth = {1, Name "of an element over the one before it, from the corner on"},
  floor = {0, Name "faces of a meshed floor, longer by a quarter at both ends; 0: none"} ];
Point(1) = {0, 0, 0};
Point(2) = {width, 0, 0};
Point(3) = {width, height, 0};
Point(4) = {0, height, 0};
For k In {1 : 4}
  Line(k) = {k, k % 4 + 1};
EndFor
Transfinite Curve{1, -3} = n + 1 Using Progression growth;
Transfinite Curve{2, -4} = m + 1 Using Progression growth;
Curve Loop(1) = {1 : 4};
Plane Surface(1) = {1};
Transfinite Surface{1};
Recombine Surface{1};
Physical Surface("plate") = {1};
Physical Curve("y_min") = {1};
Physical Curve("x_max") = {2};
Physical Curve("y_max") = {3};
Physical Curve("x_min") = {4};
If (floor)
  Point(11) = {-width / 4, 0, 0};
  Point(12) = {width * 5 / 4, 0, 0};
  Line(11) = {11, 12};
  Transfinite Curve{11} = floor + 1;
  Physical Curve("floor") = {11};
EndIf
