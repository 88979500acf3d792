// Meridian of a half ball whose lowest point is the origin; elements grow with the distance from it. On request there
// is a plate below it, whose elements are half as large.
DefineConstant[
  h = {3e-4, Name "size of elements at the lowest point, of the radius"},
  growth = {0.06, Name "of the size with the distance"},
  near = {2, Name "distance from which on the size grows faster"},
  far = {0, Name "growth from there on, 0: the same"},
  quads = {0, Name "1: quadrilaterals"},
  plate = {0, Name "radius and height of a plate below the ball, 0: none"}
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
If (far > 0)
  Field[1].F = Sprintf("%g + %g * Sqrt(x^2 + y^2) + %g * (Sqrt(x^2 + y^2) - %g + Abs(Sqrt(x^2 + y^2) - %g))", h, growth,
                       (far - growth) / 2, near, near);
EndIf
If (plate > 0)
  Point(11) = {0, -plate, 0};
  Point(12) = {plate, -plate, 0};
  Point(13) = {plate, 0, 0};
  Point(14) = {0, 0, 0};
  Line(11) = {11, 12};
  Line(12) = {12, 13};
  Line(13) = {13, 14};
  Line(14) = {14, 11};
  Curve Loop(2) = {11, 12, 13, 14};
  Plane Surface(2) = {2};
  Field[2] = MathEval;
  Field[2].F = Sprintf("%g + %g * Sqrt(x^2 + y^2)", h / 2, growth / 2);
  Field[3] = Restrict;
  Field[3].InField = 1;
  Field[3].SurfacesList = {1};
  Field[3].CurvesList = {1, 2, 3};
  Field[4] = Restrict;
  Field[4].InField = 2;
  Field[4].SurfacesList = {2};
  Field[4].CurvesList = {11, 12, 13, 14};
  Field[5] = Min;
  Field[5].FieldsList = {3, 4};
  Background Field = 5;
Else
  Background Field = 1;
EndIf
Mesh.MeshSizeExtendFromBoundary = 0;
If (quads)
  Recombine Surface{1};
EndIf
Physical Surface("ball") = {1};
Physical Curve("skin") = {1};
Physical Curve("base") = {2};
Physical Curve("axis") = {3};
If (plate > 0)
  Physical Surface("plate") = {2};
  Physical Curve("plate_base") = {11};
  Physical Curve("plate_side") = {12};
  Physical Curve("plate_top") = {13};
  Physical Curve("plate_axis") = {14};
EndIf
