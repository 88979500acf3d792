// Two whole rings of radii 10 - 20 and 20 - 30 with an interference, for friction: the inner one is turned in the outer one.
// The interface's nodes are points of their own, so that they can be moved: one block through the wall stands on each face.
DefineConstant[
  n_inner = {96, Name "elements around the inner ring"}, n_outer = {120, Name "elements around the outer ring"},
  n_wall = {6, Name "elements through each ring"}, interference = {0.0025, Name "by which the inner ring is too large"},
  jitter = {0, Name "largest move of an interface node, in face sizes"}, seed = {1, Name "of the moves"}
];
radius[] = {10, 20 + interference, 20, 30};
n[] = {n_inner, n_outer};
Point(1) = {0, 0, 0};
For side In {0 : 3}
  m = n[Floor(side / 2)];
  o = 1000 * (side + 1);
  For k In {0 : m - 1}
    x = 43758.5453 * Sin(12.9898 * (o + k + 7 * seed)); // the digits behind the point serve as random numbers
    move = (side == 1 || side == 2) ? jitter * (2 * (x - Floor(x)) - 1) : 0;
    angle = (k + move) * 2 * Pi / m;
    Point(o + k) = {radius[side] * Cos(angle), radius[side] * Sin(angle), 0};
  EndFor
  around~{side}[] = {};
  For k In {0 : m - 1}
    Circle(o + k) = {o + k, 1, o + (k + 1) % m};
    Transfinite Curve{o + k} = 2;
    around~{side}[] += {o + k};
  EndFor
EndFor
For b In {0 : 1}
  o = 2000 * b + 1000;
  m = n[b];
  body~{b}[] = {};
  For k In {0 : m - 1}
    Line(o + 500 + k) = {o + k, o + 1000 + k};
    Transfinite Curve{o + 500 + k} = n_wall + 1;
  EndFor
  For k In {0 : m - 1}
    Curve Loop(o + k) = {o + k, o + 500 + (k + 1) % m, -(o + 1000 + k), -(o + 500 + k)};
    Surface(o + k) = {o + k};
    body~{b}[] += {o + k};
  EndFor
EndFor
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("inner") = {body_0[]};
Physical Surface("outer") = {body_1[]};
Physical Curve("bore") = {around_0[]};
Physical Curve("inner_contact") = {around_1[]};
Physical Curve("outer_contact") = {around_2[]};
Physical Curve("rim") = {around_3[]};
