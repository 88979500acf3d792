// Cook's membrane: a tapered panel, 48 long, 44 high where it is held and 16 where it is loaded.
DefineConstant[n = {8, Name "elements along each side"}, tri = {0, Name "1 for triangles"}];
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
Transfinite Curve{1 : 4} = n + 1;
Transfinite Surface{1};
If (!tri)
  Recombine Surface{1};
EndIf

Physical Surface("panel") = {1};
Physical Curve("held") = {4};
Physical Curve("loaded") = {2};
