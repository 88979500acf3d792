// Meridian of a half ball whose lowest point is the origin; elements grow with the distance from it.
DefineConstant[
  h = {3e-4, Name "size of elements at the lowest point, of the radius"}, growth = {0.06, Name "of the size with the distance"},
  quads = {0, Name "1: quadrilaterals"}
];
Point(1) = {0, 0, 0};
Point(2) = {0, 1, 0};
Point(3) = {1, 1, 0};
Circle(1) = {1, 2, 3};
Line(2) = {3, 2};
Line(3) = {2, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};
Field[1] = MathEval;
Field[1].F = Sprintf("%g + %g * Sqrt(x^2 + y^2)", h, growth);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
If (quads)
  Recombine Surface{1};
EndIf
Physical Surface("ball") = {1};
Physical Curve("skin") = {1};
Physical Curve("base") = {2};
Physical Curve("axis") = {3};
