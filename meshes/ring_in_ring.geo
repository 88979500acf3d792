// Two rings of 10-20 and 20-30 mm with an interference, a quarter of them: their cross-section (plane strain), or half their length.
// The interface's nodes are points of their own, so that they can be moved within the surface: one block of elements through the wall stands
// on each face. Edges around are arcs, so that second-order nodes lie on the rings too; in 3D with nodes moved one by one they are straight: first order.
DefineConstant[
  n_inner = {32, Name "elements around the inner ring"}, n_outer = {40, Name "elements around the outer ring"},
  stretch = {1, Name "length of the faces along z over that around"},
  n_len = {0, Name "elements along z, coarser ring; 0: cross-section only"},
  jitter = {0, Name "largest move of an interface node, in face sizes along each direction"}, seed = {1, Name "of the moves"},
  rows = {0, Name "1: in 3D the nodes of a row move together, around and along: faces of second order stay on the rings"},
  matching = {0, Name "1: nodes of both rings are moved alike; with n_inner = n_outer they face each other"},
  interference = {0.0025, Name "by which the inner ring is too large"}
];
r_bore = 10; r = 20; r_rim = 30;
n_around[] = {n_inner, n_outer};
n_coarse = Min(n_inner, n_outer);
len = stretch * n_len * Pi / 2 * r / n_coarse; // without a stretch faces are square, and elements nearly so
cut_x[] = {};
cut_y[] = {};
cut_z[] = {};
rim[] = {};
For b In {0 : 1}
  n = n_around[b];
  m = Round(n_len * n / n_coarse);
  n_wall = Ceil((r_rim - r) * n / (Pi / 2 * r));
  count = (n + 1) * (m + 1);
  o = 100000 * (b + 1); // a tag is o + kind * count + place
  For k In {0 : m}
    y = 43758.5453 * Sin(78.233 * (o + k * (n + 1) + 7 * seed));
    z_row = len * ((rows && k > 0 && k < m) ? k + jitter * (2 * (y - Floor(y)) - 1) : k) / Max(m, 1);
    Point(o - 1 - k) = {0, 0, z_row}; // centre of the arcs
    For i In {0 : n}
      s = o + k * (n + 1) + i;
      draw = (matching ? s - 100000 * b : rows ? o + i : s) + 7 * seed;
      x = 43758.5453 * Sin(12.9898 * draw); // the digits behind the point serve as random numbers
      y = 43758.5453 * Sin(78.233 * draw);
      a = Pi / 2 * i / n;
      moved = (i == 0 || i == n) ? a : Pi / 2 * (i + jitter * (2 * (x - Floor(x)) - 1)) / n;
      z = rows ? z_row : len * k / Max(m, 1); // 0 in the plane
      moved_z = (rows || k == 0 || k == m) ? z : len * (k + jitter * (2 * (y - Floor(y)) - 1)) / Max(m, 1);
      If (b == 0)
        Point(s) = {r_bore * Cos(a), r_bore * Sin(a), z};
        Point(s + count) = {(r + interference) * Cos(moved), (r + interference) * Sin(moved), moved_z};
      Else
        Point(s) = {r * Cos(moved), r * Sin(moved), moved_z};
        Point(s + count) = {r_rim * Cos(a), r_rim * Sin(a), z};
      EndIf
      Line(s) = {s, s + count}; // kind 0: through the wall
      Transfinite Curve{s} = n_wall + 1;
    EndFor
  EndFor
  body~{b}[] = {};
  contact~{b}[] = {};
  For k In {0 : m}
    For i In {0 : n - 1}
      s = o + k * (n + 1) + i;
      For side In {0 : 1} // kinds 1, 2: around, on the inside and the outside
        If (n_len && jitter && !rows)
          Line(s + (1 + side) * count) = {s + side * count, s + 1 + side * count};
        Else
          Circle(s + (1 + side) * count) = {s + side * count, o - 1 - k, s + 1 + side * count};
        EndIf
        Transfinite Curve{s + (1 + side) * count} = 2;
      EndFor
      Curve Loop(s) = {s, s + 2 * count, -(s + 1), -(s + count)};
      Surface(s) = {s}; // kind 0: across the ring
      If (!m)
        body~{b}[] += {s};
        contact~{b}[] += {s + (2 - b) * count};
        If (b)
          rim[] += {s + 2 * count};
        EndIf
      ElseIf (k == 0)
        cut_z[] += {s};
      EndIf
    EndFor
  EndFor
  For k In {1 : m}
    For i In {0 : n}
      s = o + (k - 1) * (n + 1) + i;
      up = s + n + 1;
      For side In {0 : 1} // kinds 3, 4: along z, on the inside and the outside
        Line(s + (3 + side) * count) = {s + side * count, up + side * count};
        Transfinite Curve{s + (3 + side) * count} = 2;
      EndFor
      Curve Loop(s + count) = {s, s + 4 * count, -up, -(s + 3 * count)};
      Surface(s + count) = {s + count}; // kind 1: through the wall and along z
    EndFor
    For i In {0 : n - 1}
      s = o + (k - 1) * (n + 1) + i;
      up = s + n + 1;
      For side In {0 : 1} // kinds 2, 3: faces of the inside and the outside
        Curve Loop(s + (2 + side) * count) = {s + (1 + side) * count, s + 1 + (3 + side) * count, -(up + (1 + side) * count), -(s + (3 + side) * count)};
        Surface(s + (2 + side) * count) = {s + (2 + side) * count};
      EndFor
      Surface Loop(s) = {s, up, s + count, s + 1 + count, s + 2 * count, s + 3 * count};
      Volume(s) = {s};
      body~{b}[] += {s};
      contact~{b}[] += {s + (3 - b) * count};
      If (b)
        rim[] += {s + 3 * count};
      EndIf
    EndFor
    cut_y[] += {o + (k - 1) * (n + 1) + count};
    cut_x[] += {o + (k - 1) * (n + 1) + n + count};
  EndFor
  If (!m)
    cut_y[] += {o};
    cut_x[] += {o + n};
  EndIf
EndFor
Transfinite Surface{:};
Recombine Surface{:};
If (n_len)
  Transfinite Volume{:};
  Physical Volume("inner") = {body_0[]};
  Physical Volume("outer") = {body_1[]};
  Physical Surface("inner_contact") = {contact_0[]};
  Physical Surface("outer_contact") = {contact_1[]};
  Physical Surface("rim") = {rim[]};
  Physical Surface("symmetry_x") = {cut_x[]};
  Physical Surface("symmetry_y") = {cut_y[]};
  Physical Surface("symmetry_z") = {cut_z[]};
Else
  Physical Surface("inner") = {body_0[]};
  Physical Surface("outer") = {body_1[]};
  Physical Curve("inner_contact") = {contact_0[]};
  Physical Curve("outer_contact") = {contact_1[]};
  Physical Curve("rim") = {rim[]};
  Physical Curve("symmetry_x") = {cut_x[]};
  Physical Curve("symmetry_y") = {cut_y[]};
EndIf
