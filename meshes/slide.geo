// A deformable block on a meshed rigid obstacle that it is pressed on and slides over. Lengths in mm.
// The obstacle is a surface without volume; its normal points towards the block.
DefineConstant[
  cylinder = {0, Name "0: a flat, y = 0; 1: a cylinder along z that touches the block's lower face at x = 0"},
  n_x = {4, Name "elements along the block"}, n_y = {2, Name "elements over its height"}, n_z = {2, Name "elements along z"},
  n_facets = {44, Name "facets along the flat: 1 mm each by default"},
  radius = {20, Name "radius of the cylinder"},
  facet = {3, Name "angle of a cylinder facet in degrees"},
  overlap = {0, Name "by how much the cylinder reaches into the block"},
  n_obstacle_z = {3, Name "facets along z"},
  jitter = {0, Name "largest move of a node of the cylinder, in facets along each direction"}
];
width = 4; height = 2; depth = 2;
Point(1) = {-width / 2, 0, 0};
Point(2) = {width / 2, 0, 0};
Point(3) = {width / 2, height, 0};
Point(4) = {-width / 2, height, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = n_x + 1;
Transfinite Curve{2, 4} = n_y + 1;
Transfinite Surface{1};
Recombine Surface{1};
block[] = Extrude{0, 0, depth}{ Surface{1}; Layers{n_z}; Recombine; };

// Half a unit beyond the block on both sides along z, so that no slave node meets the surface's free edge.
If (cylinder && jitter) // every node is a point of its own
  n = Round(360 / facet);
  obstacle[] = {};
  For k In {0 : n_obstacle_z}
    For i In {0 : n - 1}
      s = 1000 + k * n + i;
      x = 43758.5453 * Sin(12.9898 * s); // the digits behind the point serve as random numbers
      y = 43758.5453 * Sin(78.233 * s);
      a = 2 * Pi * (i + jitter * (2 * (x - Floor(x)) - 1)) / n;
      move = (k == 0 || k == n_obstacle_z) ? 0 : jitter * (2 * (y - Floor(y)) - 1);
      Point(s) = {radius * Cos(a), overlap + radius * (Sin(a) - 1), -0.5 + (depth + 1) * (k + move) / n_obstacle_z};
    EndFor
  EndFor
  count = n * (n_obstacle_z + 1);
  For k In {0 : n_obstacle_z}
    For i In {0 : n - 1}
      s = 1000 + k * n + i;
      Line(s) = {s, 1000 + k * n + (i + 1) % n};
      Transfinite Curve{s} = 2;
      If (k < n_obstacle_z)
        Line(s + count) = {s, s + n};
        Transfinite Curve{s + count} = 2;
      EndIf
    EndFor
  EndFor
  For k In {0 : n_obstacle_z - 1}
    For i In {0 : n - 1}
      s = 1000 + k * n + i;
      Curve Loop(s) = {s, 1000 + k * n + (i + 1) % n + count, -(s + n), -(s + count)};
      Surface(s) = {s};
      Transfinite Surface{s};
      Recombine Surface{s};
      obstacle[] += {s};
    EndFor
  EndFor
ElseIf (cylinder)
  Point(110) = {0, overlap - radius, -0.5};
  For i In {0 : 3}
    Point(111 + i) = {radius * Cos(i * Pi / 2), overlap + radius * (Sin(i * Pi / 2) - 1), -0.5};
  EndFor
  For i In {0 : 3}
    Circle(111 + i) = {111 + i, 110, 111 + (i + 1) % 4};
    Transfinite Curve{111 + i} = Round(90 / facet) + 1;
  EndFor
  For i In {0 : 3}
    out[] = Extrude{0, 0, depth + 1}{ Curve{111 + i}; Layers{n_obstacle_z}; Recombine; };
    obstacle[i] = out[1];
  EndFor
Else
  Point(111) = {-width, 0, -0.5};
  Point(112) = {-width + 44, 0, -0.5};
  Line(111) = {112, 111}; // this way round the surface looks upwards
  Transfinite Curve{111} = n_facets + 1;
  out[] = Extrude{0, 0, depth + 1}{ Curve{111}; Layers{n_obstacle_z}; Recombine; };
  obstacle[] = {out[1]};
EndIf

Physical Volume("block") = {block[1]};
Physical Surface("block_bottom") = {block[2]};
Physical Surface("block_top") = {block[4]};
Physical Surface("symmetry_z") = {1, block[0]};
Physical Surface("obstacle") = {obstacle[]};
