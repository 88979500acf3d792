// Two nested disc springs between flat plates: axisymmetric, x is the radius. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
Ri = 10; Ro = 20; t = 1; h = 1; clearance = 0.005;
zs[] = {0, t + clearance};
For i In {0:1}
  p = 100 * (i + 1);
  Point(p) = {Ri, zs[i] + h, 0};
  Point(p + 1) = {Ro, zs[i], 0};
  Point(p + 2) = {Ro, zs[i] + t, 0};
  Point(p + 3) = {Ri, zs[i] + h + t, 0};
  For k In {0:3}
    Line(p + k) = {p + k, p + (k + 1) % 4};
  EndFor
  Curve Loop(p) = {p, p + 1, p + 2, p + 3};
  Plane Surface(p) = {p};
  Transfinite Curve{p, p + 2} = 20 * refine + 1;
  Transfinite Curve{p + 1, p + 3} = 3 * refine + 1;
  Transfinite Surface{p};
  Recombine Surface{p};
EndFor
top = 2 * t + clearance + h + 0.005;
Point(1) = {5, 0, 0};
Point(2) = {25, 0, 0};
Point(3) = {5, top, 0};
Point(4) = {25, top, 0};
Line(1) = {1, 2};
Line(2) = {4, 3};
Transfinite Curve{1, 2} = 8;

Physical Surface("lower") = {100};
Physical Surface("upper") = {200};
Physical Curve("floor") = {1};
Physical Curve("lid") = {2};
