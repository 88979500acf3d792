// Two blocks on each other in the plane, 1 long, whose meshes do not match at y = 0. The interface's nodes are points of their own, so that they
// can be moved: one column of elements stands on each face.
DefineConstant[
  n_lower = {12, Name "faces of the lower block"}, n_upper = {15, Name "of the upper block"}, height = {0.3, Name "of each block"},
  n_height = {4, Name "elements over the height"}, jitter = {0, Name "largest move of an interface node, in face sizes"}, seed = {1, Name "of the moves"}
];
n[] = {n_lower, n_upper};
For b In {0 : 1}
  o = 1000 * (b + 1);
  side = b ? 1 : -1;
  m = n[b];
  For k In {0 : m}
    x = 43758.5453 * Sin(12.9898 * (o + k + 7 * seed)); // the digits behind the point serve as random numbers
    move = (k == 0 || k == m) ? 0 : jitter * (2 * (x - Floor(x)) - 1);
    Point(o + k) = {(k + move) / m, 0, 0};
    Point(o + 300 + k) = {k / m, side * height, 0};
    Line(o + 600 + k) = {o + k, o + 300 + k};
    Transfinite Curve{o + 600 + k} = n_height + 1;
  EndFor
  body~{b}[] = {};
  touching~{b}[] = {};
  far~{b}[] = {};
  For k In {0 : m - 1}
    Line(o + k) = {o + k, o + k + 1};
    Line(o + 300 + k) = {o + 300 + k, o + 301 + k};
    Transfinite Curve{o + k, o + 300 + k} = 2;
    Curve Loop(o + k) = {o + k, o + 601 + k, -(o + 300 + k), -(o + 600 + k)};
    Plane Surface(o + k) = {side * (o + k)};
    body~{b}[] += {o + k};
    touching~{b}[] += {o + k};
    far~{b}[] += {o + 300 + k};
  EndFor
EndFor
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("lower") = {body_0[]};
Physical Surface("upper") = {body_1[]};
Physical Curve("lower_top") = {touching_0[]};
Physical Curve("upper_bottom") = {touching_1[]};
Physical Curve("lower_bottom") = {far_0[]};
Physical Curve("upper_top") = {far_1[]};
Physical Curve("wall_x_low") = {1600, 2600};
Physical Curve("wall_x_high") = {1600 + n_lower, 2600 + n_upper};
