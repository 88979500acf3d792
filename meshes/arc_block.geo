// A quarter of a hollow cylinder standing on a block, x = 0 their plane of symmetry (or axis), for tests of contact edges in plane strain and
// axisymmetric. Elements near the contact are r * 15 degrees / n_contact long.
DefineConstant[
  r = {10, Name "outer radius"}, wall = {5, Name "wall of the cylinder"},
  width = {12, Name "half width of the block"}, height = {8, Name "height of the block"},
  n_contact = {24, Name "elements along the finely meshed 15 degrees at the foot"}, n_arc = {12, Name "elements along the other 75 degrees"},
  n_wall = {10, Name "elements through the wall and over the block's height"}, n_side = {10, Name "elements along the block beyond the fine part"}
];
fine = r * Sin(Pi / 12);
Point(1) = {0, r, 0};
For i In {0 : 2}
  a = (i == 0) ? -Pi / 2 : (i == 1) ? -5 * Pi / 12 : 0;
  Point(10 + i) = {r * Cos(a), r + r * Sin(a), 0};
  Point(20 + i) = {(r - wall) * Cos(a), r + (r - wall) * Sin(a), 0};
  x = (i == 0) ? 0 : (i == 1) ? fine : width;
  Point(30 + i) = {x, -height, 0};
  Point(40 + i) = {x, 0, 0};
  Line(10 + i) = {10 + i, 20 + i};
  Line(40 + i) = {40 + i, 30 + i};
EndFor
For i In {0 : 1}
  Circle(20 + i) = {10 + i, 1, 11 + i};
  Circle(30 + i) = {20 + i, 1, 21 + i};
  Line(50 + i) = {30 + i, 31 + i};
  Line(60 + i) = {40 + i, 41 + i};
  Curve Loop(1 + i) = {20 + i, 11 + i, -(30 + i), -(10 + i)};
  Curve Loop(3 + i) = {50 + i, -(41 + i), -(60 + i), 40 + i};
EndFor
For i In {1 : 4}
  Plane Surface(i) = {i};
EndFor
Transfinite Curve{20, 30, 50, 60} = n_contact + 1;
Transfinite Curve{21, 31} = n_arc + 1 Using Progression 1.25;
Transfinite Curve{51, 61} = n_side + 1 Using Progression 1.3;
Transfinite Curve{10 : 12, 40 : 42} = n_wall + 1 Using Progression 1.3;
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("arc") = {1, 2};
Physical Surface("block") = {3, 4};
Physical Curve("arc_foot") = {20};
Physical Curve("arc_cut") = {12};
Physical Curve("block_top") = {60, 61};
Physical Curve("block_bottom") = {50, 51};
Physical Curve("symmetry_x") = {10, 40};
