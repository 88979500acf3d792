// A beam, clamped at its left end, on the edge of a wedge of 60 degrees; lengths in mm
DefineConstant[ n = {80, Name "elements along the beam"}, half = 30, x = 7.87, rigid = 0, solid = 0, w = 1, edge = 0.15 ];
Point(1) = {0, 0, 0}; Point(2) = {10, 0, 0}; Point(3) = {10, 0.5, 0}; Point(4) = {0, 0.5, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Transfinite Curve{1, 3} = n + 1; Transfinite Curve{2, 4} = 3;
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Transfinite Surface{1}; Recombine Surface{1};
t = Tan(half*Pi/180);
Point(11) = {x, 0, 0}; Point(12) = {x - t, -1, 0}; Point(13) = {x + t, -1, 0};
Line(11) = {12, 11}; Line(12) = {11, 13}; Line(13) = {13, 12};
If(rigid)
Transfinite Curve{11, 12} = 4;
Else
Curve Loop(2) = {11, 12, 13}; Plane Surface(2) = {2}; MeshSize{11} = edge; MeshSize{12, 13} = 0.4;
EndIf
If(!solid)
Physical Surface("beam") = {1};
Physical Curve("clamp") = {4}; Physical Curve("bottom") = {1}; Physical Curve("flanks") = {11, 12};
If(!rigid)
Physical Surface("knife") = {2}; Physical Curve("base") = {13};
EndIf
Else
a() = Extrude{0, 0, w}{ Surface{1}; Layers{2}; Recombine; };
Physical Volume("beam") = {a(1)}; Physical Surface("clamp") = {a(5)}; Physical Surface("bottom") = {a(2)};
If(rigid)
b() = Extrude{0, 0, w}{ Curve{11, 12}; Layers{3}; };
Physical Surface("flanks") = {b(1), b(5)};
Else
b() = Extrude{0, 0, w}{ Surface{2}; Layers{3}; };
Physical Volume("knife") = {b(1)}; Physical Surface("flanks") = {b(2), b(3)}; Physical Surface("base") = {b(4)};
EndIf
EndIf
