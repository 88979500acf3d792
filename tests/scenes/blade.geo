// A block under the edge of a rigid blade, at the middle of the block or in the half of it; lengths in mm
DefineConstant[ n = {10, Name "elements along a unit"}, angle = {30, Name "half of the blade's angle"}, x = 0.03, half = 0,
                ring = {0, Name "radius of the ring's middle; 0: a plane block, or a cone on the axis"} ];
left = half ? 0 : -1.5; right = 1.5; r = ring;
Point(1) = {r + left, -1, 0}; Point(2) = {r + right, -1, 0}; Point(3) = {r + right, 0, 0}; Point(4) = {r + left, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Transfinite Curve{1, 3} = Round(n * (right - left)) + 1; Transfinite Curve{2, 4} = n + 1;
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Transfinite Surface{1}; Recombine Surface{1};
e = half ? r : r + x; t = Tan(angle * Pi / 180);
Point(11) = {e, 0.01, 0}; Point(12) = {e + t, 1.01, 0}; Point(13) = {e - t, 1.01, 0};
Line(11) = {11, 12}; Line(12) = {13, 11};
Transfinite Curve{11, 12} = 4;
Physical Surface("block") = {1}; Physical Curve("bottom") = {1}; Physical Curve("top") = {3}; Physical Curve("left") = {4};
If(half)
  Physical Curve("blade") = {11};
Else
  Physical Curve("blade") = {11, 12};
EndIf
