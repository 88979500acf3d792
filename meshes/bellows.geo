// A bellows with three folds of sharp corners between two rings, the half of its section beyond the axis. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"}, n_flank = {10, Name "elements along a flank"},
  n_wall = {3, Name "elements through the wall"}, folds = {3, Name "folds"}, pitch = {8, Name "length of a fold"},
  depth = {6, Name "depth of a fold"}, wall = {1.5, Name "thickness along the radius"}, inner = {10, Name "inner radius"},
  ring = {2, Name "height of the rings"}
];
w = wall;
n = 2 * folds;
For i In {0:n}
  x = inner + ((i % 2) ? depth : 0);
  Point(100 + i) = {x, i * pitch / 2, 0};
  Point(200 + i) = {x + w, i * pitch / 2, 0};
  Line(500 + i) = {100 + i, 200 + i};
EndFor
For i In {0:n-1}
  Line(300 + i) = {100 + i, 101 + i};
  Line(400 + i) = {200 + i, 201 + i};
  Curve Loop(1 + i) = {500 + i, 400 + i, -(501 + i), -(300 + i)};
  Plane Surface(1 + i) = {1 + i};
EndFor
For e In {0:1}
  y = e ? n * pitch / 2 : 0; s = e ? 1 : -1; k = e ? n : 0; p = 600 + 20 * e;
  Point(p + 1) = {inner, y + s * ring, 0}; Point(p + 2) = {inner + w, y + s * ring, 0};
  Point(p + 3) = {inner + w + depth, y + s * ring, 0}; Point(p + 4) = {inner + w + depth, y, 0};
  Line(p + 1) = {100 + k, p + 1}; Line(p + 2) = {p + 1, p + 2}; Line(p + 3) = {p + 2, p + 3};
  Line(p + 4) = {p + 3, p + 4}; Line(p + 5) = {p + 4, 200 + k}; Line(p + 6) = {p + 2, 200 + k};
  Curve Loop(p + 1) = {500 + k, -(p + 6), -(p + 2), -(p + 1)}; Plane Surface(p + 1) = {p + 1};
  Curve Loop(p + 2) = {p + 6, -(p + 5), -(p + 4), -(p + 3)}; Plane Surface(p + 2) = {p + 2};
  Transfinite Curve{p + 2} = Round(n_wall * refine) + 1;
  Transfinite Curve{p + 3, p + 5} = Round(n_flank * refine) + 1;
  Transfinite Curve{p + 1, p + 4, p + 6} = Round(n_wall * refine) + 1;
EndFor
Transfinite Curve{300:300+n-1, 400:400+n-1} = Round(n_flank * refine) + 1;
Transfinite Curve{500:500+n} = Round(n_wall * refine) + 1;
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("bellows") = {1:n, 601, 602, 621, 622};
Physical Curve("inner") = {300:300+n-1};
Physical Curve("outer") = {400:400+n-1, 605, 625};
Physical Curve("bottom") = {602, 603};
Physical Curve("top") = {622, 623};
