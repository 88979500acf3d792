// Two blocks of base 1 x 1 on top of each other whose meshes do not match at the flat interface y = 0, for the contact patch test in 3D. Each is
// n_height of its own elements high. The interface's nodes are points of their own, so that they can be moved within the plane: one column of
// bricks stands on each face, or tetrahedra fill the block behind the faces' triangles.
DefineConstant[
  n_lower = {12, Name "faces along a side of the interface, lower block"}, n_upper = {15, Name "the same, upper block"},
  n_height = {3, Name "elements over the height of each block"},
  jitter = {0, Name "largest move of an interface node, in face sizes along each direction"}, seed = {1, Name "of the moves"},
  lower = {0, Name "0: bricks, 1: tetrahedra on squares cut in two, 2: tetrahedra on triangles as gmsh makes them (no jitter)"},
  upper = {0, Name "the same, upper block"}
];
n_faces[] = {n_lower, n_upper};
form[] = {lower, upper};
For side In {0 : 3}
  wall~{side}[] = {}; // x = 0, x = 1, z = 0, z = 1
EndFor
For b In {0 : 1}
  n = n_faces[b];
  height = n_height / n;
  count = (n + 1)^2;
  o = 100000 * (b + 1); // a tag is o + kind * count + place
  body~{b}[] = {};
  contact~{b}[] = {};
  far~{b}[] = {};
  bricks = (form[b] == 0);
  step = (form[b] == 2) ? n : 1; // from one point of the geometry to the next
  For k In {0 : n : step}
    For i In {0 : n : step}
      s = o + k * (n + 1) + i;
      x = 43758.5453 * Sin(12.9898 * (s + 7 * seed)); // the digits behind the point serve as random numbers
      z = 43758.5453 * Sin(78.233 * (s + 7 * seed));
      moved_x = (i == 0 || i == n) ? i / n : (i + jitter * (2 * (x - Floor(x)) - 1)) / n;
      moved_z = (k == 0 || k == n) ? k / n : (k + jitter * (2 * (z - Floor(z)) - 1)) / n;
      Point(s) = {moved_x, 0, moved_z, 1 / n};
      If (bricks || ((i == 0 || i == n) && (k == 0 || k == n)))
        Point(s + count) = {i / n, (b ? 1 : -1) * height, k / n, 1 / n};
        Line(s) = {s, s + count}; // kind 0: away from the interface
        Transfinite Curve{s} = n_height + 1;
      EndIf
    EndFor
  EndFor
  For level In {0 : bricks ? 1 : 0} // kinds 1, 2: along x, on the interface and on the far side; 3, 4: along z
    For k In {0 : n : step}
      For i In {0 : n - step : step}
        s = o + k * (n + 1) + i + level * count;
        Line(s + count) = {s, s + step};
        s = o + i * (n + 1) + k + level * count;
        Line(s + 3 * count) = {s, s + step * (n + 1)};
        Transfinite Curve{o + k * (n + 1) + i + (1 + level) * count, o + i * (n + 1) + k + (3 + level) * count} = step + 1;
      EndFor
    EndFor
    For k In {0 : n - step : step}
      For i In {0 : n - step : step}
        s = o + k * (n + 1) + i;
        x = s + (1 + level) * count;
        z = s + (3 + level) * count;
        Curve Loop(x) = {x, z + step, -(x + step * (n + 1)), -z};
        Surface(s + level * count) = {x}; // kinds 0, 1: of the interface and the far side
        If (level == 0)
          contact~{b}[] += {s};
        Else
          far~{b}[] += {s + count};
        EndIf
      EndFor
    EndFor
  EndFor
  If (bricks)
    For k In {0 : n}
      For i In {0 : n - 1}
        s = o + k * (n + 1) + i;
        Curve Loop(s + 5 * count) = {s, s + 2 * count, -(s + 1), -(s + count)};
        Surface(s + 2 * count) = {s + 5 * count}; // kind 2: standing, along x; twisted where nodes are moved
        r = o + i * (n + 1) + k;
        Curve Loop(r + 6 * count) = {r, r + 4 * count, -(r + n + 1), -(r + 3 * count)};
        Surface(r + 3 * count) = {r + 6 * count}; // kind 3: standing, along z
        If (k == 0)
          wall_2[] += {s + 2 * count};
          wall_0[] += {r + 3 * count};
        ElseIf (k == n)
          wall_3[] += {s + 2 * count};
          wall_1[] += {r + 3 * count};
        EndIf
      EndFor
    EndFor
    For k In {0 : n - 1}
      For i In {0 : n - 1}
        s = o + k * (n + 1) + i;
        Surface Loop(s) = {s, s + count, s + 2 * count, s + 2 * count + n + 1, s + 3 * count, s + 3 * count + 1};
        Volume(s) = {s};
        body~{b}[] += {s};
        Transfinite Surface{s, s + count, s + 2 * count, s + 2 * count + n + 1, s + 3 * count, s + 3 * count + 1};
        Recombine Surface{s, s + count, s + 2 * count, s + 2 * count + n + 1, s + 3 * count, s + 3 * count + 1};
        Transfinite Volume{s};
      EndFor
    EndFor
  Else
    corner[] = {o, o + n, o + n * (n + 1) + n, o + n * (n + 1)};
    For side In {0 : 3}
      Line(o + 2 * count + side) = {corner[side] + count, corner[(side + 1) % 4] + count};
      Transfinite Curve{o + 2 * count + side} = n + 1;
      edge[] = {};
      For i In {0 : n - step : step}
        If (side % 2)
          edge[] += {o + 3 * count + i * (n + 1) + ((side == 1) ? n : 0)};
        Else
          edge[] += {o + count + ((side == 2) ? n * (n + 1) : 0) + i};
        EndIf
      EndFor
      way = (side < 2) ? 1 : -1; // edges run along x and z; around the base two sides run back
      loop[] = {corner[side], o + 2 * count + side, -corner[(side + 1) % 4]};
      For i In {0 : #edge[] - 1}
        loop[] += {-way * edge[(side < 2) ? #edge[] - 1 - i : i]};
      EndFor
      Curve Loop(o + 5 * count + side) = {loop[]};
      Plane Surface(o + count + side) = {o + 5 * count + side};
    EndFor
    wall_2[] += {o + count};
    wall_1[] += {o + count + 1};
    wall_3[] += {o + count + 2};
    wall_0[] += {o + count + 3};
    Curve Loop(o + 5 * count + 4) = {o + 2 * count : o + 2 * count + 3};
    Plane Surface(o + count + 4) = {o + 5 * count + 4};
    far~{b}[] = {o + count + 4};
    If (form[b] == 1)
      Transfinite Surface{contact~{b}[]} Alternate;
    EndIf
    Surface Loop(o) = {contact~{b}[], o + count : o + count + 4};
    Volume(o) = {o};
    body~{b}[] = {o};
  EndIf
EndFor
Mesh.MeshSizeExtendFromBoundary = 1;

Physical Volume("lower") = {body_0[]};
Physical Volume("upper") = {body_1[]};
Physical Surface("lower_top") = {contact_0[]};
Physical Surface("upper_bottom") = {contact_1[]};
Physical Surface("lower_bottom") = {far_0[]};
Physical Surface("upper_top") = {far_1[]};
Physical Surface("wall_x_low") = {wall_0[]};
Physical Surface("wall_x_high") = {wall_1[]};
Physical Surface("wall_z_low") = {wall_2[]};
Physical Surface("wall_z_high") = {wall_3[]};
