// A thick cylinder for tests: a quarter of its cross-section (plane strain), that section extruded (solid) or its meridian (axisymmetric).
DefineConstant[
  form = {0, Name "0: cross-section, 1: solid slice, 2: meridian (x = r, y = z)"},
  r_in = {1, Name "inner radius"}, r_out = {2, Name "outer radius"}, len = {0.5, Name "length of slice and meridian"},
  n_arc = {6, Name "elements around the quarter"}, n_wall = {3, Name "elements through the wall"}, n_len = {1, Name "elements along the length"},
  simplex = {0, Name "1: triangles or tetrahedra"}
];
n_side = (form == 2) ? n_len : n_arc;
If (form == 2)
  Point(2) = {r_in, 0, 0};
  Point(3) = {r_out, 0, 0};
  Point(4) = {r_out, len, 0};
  Point(5) = {r_in, len, 0};
  Line(2) = {3, 4};
  Line(4) = {5, 2};
Else
  Point(1) = {0, 0, 0};
  Point(2) = {r_in, 0, 0};
  Point(3) = {r_out, 0, 0};
  Point(4) = {0, r_out, 0};
  Point(5) = {0, r_in, 0};
  Circle(2) = {3, 1, 4};
  Circle(4) = {5, 1, 2};
EndIf
Line(1) = {2, 3};
Line(3) = {4, 5};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = n_wall + 1;
Transfinite Curve{2, 4} = n_side + 1;
Transfinite Surface{1};
If (!simplex)
  Recombine Surface{1};
EndIf

If (form == 1)
  If (simplex)
    out[] = Extrude{0, 0, len}{ Surface{1}; Layers{n_len}; };
  Else
    out[] = Extrude{0, 0, len}{ Surface{1}; Layers{n_len}; Recombine; };
  EndIf
  Physical Volume("ring") = {out[1]};
  Physical Surface("symmetry_y") = {out[2]};
  Physical Surface("outer") = {out[3]};
  Physical Surface("symmetry_x") = {out[4]};
  Physical Surface("inner") = {out[5]};
  Physical Surface("end_low") = {1};
  Physical Surface("end_high") = {out[0]};
Else
  Physical Surface("ring") = {1};
  Physical Curve("outer") = {2};
  Physical Curve("inner") = {4};
  If (form == 2)
    Physical Curve("end_low") = {1};
    Physical Curve("end_high") = {3};
  Else
    Physical Curve("symmetry_y") = {1};
    Physical Curve("symmetry_x") = {3};
  EndIf
EndIf
