// A block with a flat or wedge-shaped bottom on a plane, with a fluid that enters between them from the left.
DefineConstant[ n = {20, Name "faces of the bottom"}, s = {0, Name "slope of the bottom"}, solid = {0, Name "1: in space"} ];
Point(1) = {0, 5*s, 0};
Point(2) = {10, 5*s, 0};
Point(5) = {5, 0, 0};
Point(3) = {10, 4, 0};
Point(4) = {0, 4, 0};
Line(1) = {1, 5};
Line(5) = {5, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 5, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 5} = n/2 + 1;
Transfinite Curve {3} = n + 1;
Transfinite Curve {2, 4} = 3;
Transfinite Surface {1} = {1, 2, 3, 4};
Recombine Surface {1};
If (solid)
  out[] = Extrude {0, 0, 2} { Surface{1}; Layers{2}; Recombine; };
  Physical Volume("block") = {out[1]};
  Physical Surface("bottom") = {out[2], out[3]};
  Physical Surface("right") = {out[4]};
  Physical Surface("top") = {out[5]};
  Physical Surface("left") = {out[6]};
  Physical Surface("sides") = {1, out[0]};
  Physical Point("pin") = {1};
Else
  Physical Surface("block") = {1};
  Physical Curve("bottom") = {1, 5};
  Physical Curve("top") = {3};
  Physical Curve("left") = {4};
  Physical Curve("right") = {2};
  Physical Point("pin") = {1};
  Physical Point("ends") = {1, 2};
EndIf
