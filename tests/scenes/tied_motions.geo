// Two whole half cylinders crossed at right angles, or a block whose lower side is a little round. Unstructured meshes.
DefineConstant[
  kind = {0, Name "0: crossed cylinders, 1: block"}, fine = {0.33, Name "element size where they touch"}
];
SetFactory("OpenCASCADE");
If (kind == 0)
  R = 10; L = 6; gap = 0.01; e = 1e-3;
  Cylinder(1) = {-L, R, 0, 2 * L, 0, 0, R};
  Cylinder(2) = {0, -R - gap, -L, 0, 0, 2 * L, R};
  Box(3) = {-2 * L, R, -2 * R, 4 * L, 2 * R, 4 * R};
  Box(4) = {-2 * R, -3 * R - gap, -2 * L, 4 * R, 2 * R, 4 * L};
  BooleanDifference(5) = { Volume{1}; Delete; }{ Volume{3}; Delete; };
  BooleanDifference(6) = { Volume{2}; Delete; }{ Volume{4}; Delete; };
  // the element size grows with the distance from the point where they touch
  Field[1] = MathEval;
  Field[1].F = Sprintf("%g + 0.2 * (sqrt(x*x + y*y + z*z) - 1.2 + abs(sqrt(x*x + y*y + z*z) - 1.2))", fine);
  Background Field = 1;
  Mesh.MeshSizeMax = 4;
  Mesh.MeshSizeExtendFromBoundary = 0;
  Mesh.MeshSizeFromPoints = 0;
  upper() = Surface In BoundingBox{-L - e, -e, -R - e, L + e, R + e, R + e};
  lower() = Surface In BoundingBox{-R - e, -R - gap - e, -L - e, R + e, -gap + e, L + e};
  flat() = Surface In BoundingBox{-L - e, R - e, -R - e, L + e, R + e, R + e};
  base() = Surface In BoundingBox{-R - e, -R - gap - e, -L - e, R + e, -R - gap + e, L + e};
  right() = Surface In BoundingBox{L - e, -e, -R - e, L + e, R + e, R + e};
  left() = Surface In BoundingBox{-L - e, -e, -R - e, -L + e, R + e, R + e};
  front() = Surface In BoundingBox{-R - e, -R - gap - e, L - e, R + e, -gap + e, L + e};
  back() = Surface In BoundingBox{-R - e, -R - gap - e, -L - e, R + e, -gap + e, -L + e};
  upper() -= {flat(), right(), left()};
  lower() -= {base(), front(), back()};
  Physical Volume("body") = {5};
  Physical Volume("holder") = {6};
  Physical Surface("skin") = {upper()};
  Physical Surface("seat") = {lower()};
  Physical Surface("top") = {flat()};
  Physical Surface("base") = {base()};
Else
  sag = 0.01;
  r = (1 + sag * sag) / (2 * sag);
  Point(1) = {-1, sag, 0, fine};
  Point(2) = {1, sag, 0, fine};
  Point(3) = {1, 1, 0, fine};
  Point(4) = {-1, 1, 0, fine};
  Point(5) = {0, r, 0, fine};
  Circle(1) = {1, 5, 2};
  Line(2) = {2, 3};
  Line(3) = {3, 4};
  Line(4) = {4, 1};
  Curve Loop(1) = {1, 2, 3, 4};
  Plane Surface(1) = {1};
  Physical Surface("body") = {1};
  Physical Curve("skin") = {1};
  Physical Curve("top") = {3};
EndIf
