// Three loose plates that lie on each other, with meshes that do not match. Lengths in mm.
SetFactory("OpenCASCADE");
DefineConstant[
  solid = {0, Name "0: in the plane, 1: in space"}, n = {5, Name "elements along the lowest plate"},
  length = {20, Name "length and width"}, height = {2, Name "height of a plate"}
];
For i In {0:2}
  If (solid)
    Box(i + 1) = {0, 0, i * height, length, length, height};
  Else
    Rectangle(i + 1) = {0, i * height, 0, length, height};
  EndIf
EndFor
For i In {0:2}
  If (solid)
    f() = Abs(Boundary{Volume{i + 1};});
  Else
    f() = {i + 1};
  EndIf
  e() = Unique(Abs(Boundary{Surface{f()};}));
  For k In {0:#e() - 1}
    b() = BoundingBox Curve{e(k)};
    Transfinite Curve{e(k)} = (b(3 + 1 + solid) - b(1 + solid) > height / 2) ? 3 : n + i + 1;
  EndFor
  Transfinite Surface{f()};
  Recombine Surface{f()};
  If (solid)
    Transfinite Volume{i + 1};
  EndIf
EndFor
If (solid)
  Physical Volume("low") = {1};
  Physical Volume("middle") = {2};
  Physical Volume("top") = {3};
  Physical Surface("base") = {5};
  Physical Surface("low_up") = {6};
  Physical Surface("middle_down") = {11};
  Physical Surface("middle_up") = {12};
  Physical Surface("top_down") = {17};
  Physical Surface("load") = {18};
Else
  Physical Surface("low") = {1};
  Physical Surface("middle") = {2};
  Physical Surface("top") = {3};
  Physical Curve("base") = {1};
  Physical Curve("low_up") = {3};
  Physical Curve("middle_down") = {5};
  Physical Curve("middle_up") = {7};
  Physical Curve("top_down") = {9};
  Physical Curve("load") = {11};
EndIf
