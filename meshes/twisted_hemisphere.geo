// A hollow hemisphere with its pole down on the upper face of a cube, z = 0, which it touches. Its rim is at z = radius.
DefineConstant[
  radius = {1, Name "outer radius of the hemisphere"}, inner = {2 / 3, Name "inner radius"},
  edge = {2, Name "edge of the cube"},
  n = {4, Name "elements along each edge of the pole's patch"}, n_side = {3, Name "elements from there to the rim"},
  n_wall = {2, Name "elements through the wall"},
  m = {6, Name "elements along the cube"}, m_depth = {4, Name "elements over its height"},
  growth = {1.6, Name "size of the cube's last elements over that of the first ones, downwards"}
];
Point(1) = {0, 0, radius};
For s In {0 : 1}
  r = s ? inner : radius;
  For k In {0 : 3}
    a = Pi / 4 + k * Pi / 2;
    polar = 0.75 * Pi / 4 * 1.2; // of the patch's corners, from the pole
    Point(10 + 100 * s + k) = {r * Sin(polar) * Cos(a), r * Sin(polar) * Sin(a), radius - r * Cos(polar)};
    Point(20 + 100 * s + k) = {r * Cos(a), r * Sin(a), radius};
  EndFor
  For k In {0 : 3}
    j = (k + 1) % 4;
    Circle(10 + 100 * s + k) = {10 + 100 * s + k, 1, 10 + 100 * s + j};
    Circle(20 + 100 * s + k) = {20 + 100 * s + k, 1, 20 + 100 * s + j};
    Circle(30 + 100 * s + k) = {10 + 100 * s + k, 1, 20 + 100 * s + k};
    Transfinite Curve{10 + 100 * s + k, 20 + 100 * s + k} = n + 1;
    Transfinite Curve{30 + 100 * s + k} = n_side + 1;
  EndFor
  Curve Loop(1 + 100 * s) = {10 + 100 * s, 11 + 100 * s, 12 + 100 * s, 13 + 100 * s};
  Surface(1 + 100 * s) = {1 + 100 * s} In Sphere{1};
  For k In {0 : 3}
    j = (k + 1) % 4;
    Curve Loop(2 + 100 * s + k) = {30 + 100 * s + k, 20 + 100 * s + k, -(30 + 100 * s + j), -(10 + 100 * s + k)};
    Surface(2 + 100 * s + k) = {2 + 100 * s + k} In Sphere{1};
  EndFor
EndFor
For k In {0 : 3}
  Line(210 + k) = {10 + k, 110 + k};
  Line(220 + k) = {20 + k, 120 + k};
  Transfinite Curve{210 + k, 220 + k} = n_wall + 1;
EndFor
For k In {0 : 3}
  j = (k + 1) % 4;
  Curve Loop(210 + k) = {10 + k, 210 + j, -(110 + k), -(210 + k)};
  Surface(210 + k) = {210 + k};
  Curve Loop(220 + k) = {20 + k, 220 + j, -(120 + k), -(220 + k)};
  Plane Surface(220 + k) = {220 + k};
  Curve Loop(230 + k) = {30 + k, 220 + k, -(130 + k), -(210 + k)};
  Plane Surface(230 + k) = {230 + k};
EndFor
Surface Loop(1) = {1, 101, 210, 211, 212, 213};
Volume(1) = {1};
For k In {0 : 3}
  j = (k + 1) % 4;
  Surface Loop(2 + k) = {2 + k, 102 + k, 210 + k, 220 + k, 230 + k, 230 + j};
  Volume(2 + k) = {2 + k};
EndFor
Transfinite Surface{1 : 5, 101 : 105, 210 : 213, 220 : 223, 230 : 233};
Recombine Surface{1 : 5, 101 : 105, 210 : 213, 220 : 223, 230 : 233};
Transfinite Volume{1 : 5};

For k In {0 : 3}
  a = Pi / 4 + k * Pi / 2;
  Point(300 + k) = {edge * Sqrt(2) / 2 * Cos(a), edge * Sqrt(2) / 2 * Sin(a), 0};
  Point(310 + k) = {edge * Sqrt(2) / 2 * Cos(a), edge * Sqrt(2) / 2 * Sin(a), -edge};
EndFor
For k In {0 : 3}
  j = (k + 1) % 4;
  Line(300 + k) = {300 + k, 300 + j};
  Line(310 + k) = {310 + k, 310 + j};
  Line(320 + k) = {300 + k, 310 + k};
  Transfinite Curve{300 + k, 310 + k} = m + 1;
  Transfinite Curve{320 + k} = m_depth + 1 Using Progression growth^(1 / (m_depth - 1));
EndFor
Curve Loop(300) = {300, 301, 302, 303};
Plane Surface(300) = {300};
Curve Loop(310) = {310, 311, 312, 313};
Plane Surface(310) = {310};
For k In {0 : 3}
  j = (k + 1) % 4;
  Curve Loop(320 + k) = {300 + k, 320 + j, -(310 + k), -(320 + k)};
  Plane Surface(320 + k) = {320 + k};
EndFor
Surface Loop(300) = {300, 310, 320, 321, 322, 323};
Volume(300) = {300};
Transfinite Surface{300, 310, 320 : 323};
Recombine Surface{300, 310, 320 : 323};
Transfinite Volume{300};

Physical Volume("shell") = {1 : 5};
Physical Volume("cube") = {300};
Physical Surface("shell_skin") = {1 : 5};
Physical Surface("rim") = {220 : 223};
Physical Surface("cube_top") = {300};
Physical Surface("cube_bottom") = {310};
