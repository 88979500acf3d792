// A block whose lower side is inclined, in the plane: for friction on an inclined plane through the origin.
DefineConstant[ length = {40, Name "along the plane"}, height = {20, Name "across it"}, angle = {30, Name "of the plane, degrees"}, n = {16, Name "elements along it"},
  bed = {0, Name "faces of a meshed plane under it, twice as long; 0: none"} ];
c = Cos(angle * Pi / 180);
s = Sin(angle * Pi / 180);
x[] = {0, length, length, 0};
y[] = {0, 0, height, height};
For k In {0 : 3}
  Point(k + 1) = {c * x[k] - s * y[k], s * x[k] + c * y[k], 0};
EndFor
For k In {1 : 4}
  Line(k) = {k, k % 4 + 1};
EndFor
Transfinite Curve{1, 3} = n + 1;
Transfinite Curve{2, 4} = n / 2 + 1;
Curve Loop(1) = {1 : 4};
Plane Surface(1) = {1};
Transfinite Surface{1};
Recombine Surface{1};
Physical Surface("pad") = {1};
Physical Curve("sole") = {1};
Physical Curve("front") = {2};
Physical Curve("top") = {3};
Physical Curve("back") = {4};
If (bed)
  For k In {0 : 1}
    x = (k ? 1.5 : -0.5) * length;
    Point(11 + k) = {c * x, s * x, 0};
  EndFor
  Line(11) = {11, 12};
  Transfinite Curve{11} = bed + 1;
  Physical Curve("bed") = {11};
EndIf
