// Half of a block, 1 long and 1 high, under a flat punch that covers its top as far as `edge`; as a solid a slice.
DefineConstant[
  n = {4, Name "elements under the punch"}, simplex = {0, Name "1: triangles or tetrahedra"},
  layers = {0, Name "elements across the slice; 0: plane"}, thick = {0.125, Name "thickness of the slice"},
  edge = {0.5, Name "half of the punch's width"},
  grade = {1, Name "elements are smaller towards the edge of the punch and the corners, there by about this factor"}
];
q = (n > 1) ? grade^(1 / (n - 1)) : 1;
Point(1) = {0, 0, 0};
Point(2) = {edge, 0, 0};
Point(3) = {1, 0, 0};
Point(4) = {1, 1, 0};
Point(5) = {edge, 1, 0};
Point(6) = {0, 1, 0};
For i In {1 : 6}
  Line(i) = {i, (i % 6) + 1};
EndFor
Line(7) = {2, 5};
Curve Loop(1) = {1, 7, 5, 6};
Curve Loop(2) = {2, 3, 4, -7};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Curve{5} = n + 1 Using Progression q;
Transfinite Curve{1} = n + 1 Using Progression 1 / q;
Transfinite Curve{2, 4} = n + 1 Using Bump 1 / grade;
Transfinite Curve{3, 6, 7} = 2 * n + 1 Using Bump 1 / grade;
Transfinite Surface{1, 2};
If (!simplex)
  Recombine Surface{1, 2};
EndIf

If (layers)
  If (simplex)
    left[] = Extrude{0, 0, thick}{ Surface{1}; Layers{layers}; };
    right[] = Extrude{0, 0, thick}{ Surface{2}; Layers{layers}; };
  Else
    left[] = Extrude{0, 0, thick}{ Surface{1}; Layers{layers}; Recombine; };
    right[] = Extrude{0, 0, thick}{ Surface{2}; Layers{layers}; Recombine; };
  EndIf
  Physical Volume("block") = {left[1], right[1]};
  Physical Surface("floor") = {left[2], right[2]};
  Physical Surface("symmetry") = {left[5]};
  Physical Surface("punch") = {left[4]};
  Physical Surface("faces") = {1, 2, left[0], right[0]};
Else
  Physical Surface("block") = {1, 2};
  Physical Curve("floor") = {1, 2};
  Physical Curve("symmetry") = {6};
  Physical Curve("punch") = {5};
EndIf
