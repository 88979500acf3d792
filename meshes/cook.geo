// Cook's membrane: a tapered panel, 48 long, 44 high where it is held and 16 where it is loaded. As a solid it is a slice.
DefineConstant[
  n = {8, Name "elements along each side"}, simplex = {0, Name "1: triangles or tetrahedra"},
  layers = {0, Name "elements across the slice; 0: plane"}, thick = {4, Name "thickness of the slice"},
  grade = {1, Name "elements are smaller towards the upper side and both ends, there by about this factor"}
];
q = (n > 1) ? grade^(1 / (n - 1)) : 1;
Point(1) = {0, 0, 0};
Point(2) = {48, 44, 0};
Point(3) = {48, 60, 0};
Point(4) = {0, 44, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = n + 1 Using Bump 1 / grade;
Transfinite Curve{2} = n + 1 Using Progression 1 / q;
Transfinite Curve{4} = n + 1 Using Progression q;
Transfinite Surface{1};
If (!simplex)
  Recombine Surface{1};
EndIf

If (layers)
  If (simplex)
    out[] = Extrude{0, 0, thick}{ Surface{1}; Layers{layers}; };
  Else
    out[] = Extrude{0, 0, thick}{ Surface{1}; Layers{layers}; Recombine; };
  EndIf
  Physical Volume("panel") = {out[1]};
  Physical Surface("held") = {out[5]};
  Physical Surface("loaded") = {out[3]};
  Physical Surface("faces") = {1, out[0]};
Else
  Physical Surface("panel") = {1};
  Physical Curve("held") = {4};
  Physical Curve("loaded") = {2};
EndIf
