// Two whole rings of radii 10 - 20 and 20 - 30 with an interference, for friction: the inner one is turned in the outer one.
DefineConstant[
  n_inner = {96, Name "elements around the inner ring"}, n_outer = {120, Name "elements around the outer ring"},
  n_wall = {6, Name "elements through each ring"}, interference = {0.0025, Name "by which the inner ring is too large"}
];
radius[] = {10, 20 + interference, 20, 30};
n[] = {n_inner, n_outer};
Point(1) = {0, 0, 0};
For side In {0 : 3}
  o = 100 * (side + 1);
  For k In {0 : 3}
    Point(o + k) = {radius[side] * Cos(k * Pi / 2), radius[side] * Sin(k * Pi / 2), 0};
  EndFor
  For k In {0 : 3}
    Circle(o + k) = {o + k, 1, o + (k + 1) % 4};
    Transfinite Curve{o + k} = n[Floor(side / 2)] / 4 + 1;
  EndFor
EndFor
For b In {0 : 1}
  o = 200 * b + 100;
  body~{b}[] = {};
  For k In {0 : 3}
    Line(o + 50 + k) = {o + k, o + 100 + k};
    Transfinite Curve{o + 50 + k} = n_wall + 1;
  EndFor
  For k In {0 : 3}
    Curve Loop(o + k) = {o + k, o + 50 + (k + 1) % 4, -(o + 100 + k), -(o + 50 + k)};
    Surface(o + k) = {o + k};
    body~{b}[] += {o + k};
  EndFor
EndFor
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("inner") = {body_0[]};
Physical Surface("outer") = {body_1[]};
Physical Curve("bore") = {100 : 103};
Physical Curve("inner_contact") = {200 : 203};
Physical Curve("outer_contact") = {300 : 303};
Physical Curve("rim") = {400 : 403};
