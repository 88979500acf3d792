// A strip that is wound to an Archimedean spiral, in the plane. Lengths in mm.
DefineConstant[
  inner = {4, Name "radius of the inner side at the start"}, pitch = {2, Name "pitch of the spiral"},
  wall = {0.6, Name "thickness"}, turns = {3, Name "number of turns"},
  n_turn = {32, Name "elements along a turn"}, n_wall = {2, Name "elements through the wall"}
];
halves = 2 * turns;
For i In {0:24 * turns}
  angle = 2 * Pi * i / 24;
  r = inner + pitch * i / 24;
  Point(1000 + i) = {r * Cos(angle), r * Sin(angle), 0};
  Point(3000 + i) = {(r + wall) * Cos(angle), (r + wall) * Sin(angle), 0};
EndFor
For q In {0:halves}
  Line(90 + q) = {1000 + 12 * q, 3000 + 12 * q};
  Transfinite Curve{90 + q} = n_wall + 1;
EndFor
For q In {0:halves - 1}
  Spline(10 + q) = {1000 + 12 * q:1012 + 12 * q};
  Spline(50 + q) = {3000 + 12 * q:3012 + 12 * q};
  Transfinite Curve{10 + q, 50 + q} = n_turn / 2 + 1;
  Curve Loop(q + 1) = {90 + q, 50 + q, -(91 + q), -(10 + q)};
  Plane Surface(q + 1) = {q + 1};
EndFor
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("spring") = {1:halves};
Physical Curve("shaft") = {90};
Physical Curve("end") = {90 + halves};
