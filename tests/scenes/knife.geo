// A blade that ends in an edge of 20 degrees; lengths in mm
DefineConstant[ solid = 0 ];
Point(1) = {0, 0, 0};  Point(2) = {4, 0, 0};  Point(3) = {0, 4*Tan(Pi/9), 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};
Mesh.MeshSizeMax = 0.5;
If(solid)
  out() = Extrude{0, 0, 1}{ Surface{1}; };
  Physical Volume("blade") = {out(1)};
  Physical Surface("back") = {out(4)};
Else
  Physical Surface("blade") = {1};
  Physical Curve("back") = {3};
EndIf
