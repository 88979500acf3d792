// Half of the meridian of a round bar, whose radius falls to 0.982 of it in the middle plane y = 0. Millimetres.
DefineConstant[
  r = {6.413, Name "radius"}, l = {26.667, Name "half length"}, part = {0.982, Name "radius in the middle, of r"},
  nr = {8, Name "elements along the radius"}, nl = {24, Name "elements along the length"},
  progression = {1.08, Name "ratio of neighbouring lengths"}, simplex = {0, Name "1: triangles"}
];
Point(1) = {0, 0, 0};
Point(2) = {part * r, 0, 0};
Point(3) = {r, l, 0};
Point(4) = {0, l, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {1, 4};
Curve Loop(1) = {1, 2, 3, -4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = nr + 1;
Transfinite Curve{2, 4} = nl + 1 Using Progression progression;
Transfinite Surface{1};
If (!simplex)
  Recombine Surface{1};
EndIf
Physical Surface("bar") = {1};
Physical Curve("middle") = {1};
Physical Curve("end") = {3};
Physical Curve("axis") = {4};
