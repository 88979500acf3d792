// A quarter of a rubber ring of round section, in space; its axis is z. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  cord = {1.5, Name "radius of the section"}, mean = {6, Name "mean radius of the ring"}
];
n = Round(3 * refine); // elements along a quarter of the section
q = 0.45 * cord; // half the diagonal of the square in the section's middle
c = Sqrt(0.5);
Point(1) = {mean, 0, 0};
For i In {0 : 3}
  sx = (i == 0 || i == 3) ? 1 : -1;
  sz = (i < 2) ? 1 : -1;
  Point(2 + i) = {mean + cord * c * sx, 0, cord * c * sz};
  Point(6 + i) = {mean + q * sx, 0, q * sz};
EndFor
For i In {0 : 3}
  Circle(1 + i) = {2 + i, 1, 2 + (i + 1) % 4};
  Line(5 + i) = {6 + i, 6 + (i + 1) % 4};
  Line(9 + i) = {6 + i, 2 + i};
EndFor
For i In {0 : 3}
  Curve Loop(1 + i) = {9 + i, 1 + i, -(9 + (i + 1) % 4), -(5 + i)};
  Plane Surface(1 + i) = {1 + i};
EndFor
Curve Loop(5) = {5 : 8};
Plane Surface(5) = {5};
Transfinite Curve{1 : 8} = n + 1;
Transfinite Curve{9 : 12} = Ceil(0.6 * n) + 1;
Transfinite Surface{1 : 5};
Recombine Surface{1 : 5};
skin[] = {};
ring[] = {};
ends[] = {};
For s In {1 : 5}
  e[] = Extrude{{0, 0, 1}, {0, 0, 0}, Pi / 2}{ Surface{s}; Layers{3 * n}; Recombine; };
  ends[] += {e[0]};
  ring[] += {e[1]};
  If (s < 5)
    skin[] += {e[3]};
  EndIf
EndFor

Physical Volume("ring") = {ring[]};
Physical Surface("skin") = {skin[]};
Physical Surface("start") = {1 : 5};
Physical Surface("end") = {ends[]};
