// Two concentric hollow spheres of 10-20 and 20-30 mm with an interference, an octant of them. Each is the surface of a cube's corner, n x n x n
// squares of which three sides count, blown up; the point where they meet has three neighbours. The interface's nodes are points of their
// own, so that they can be moved within the surface; between them run arcs of great circles, on which second-order nodes lie.
DefineConstant[
  n_inner = {10, Name "elements along a side, inner sphere"}, n_outer = {12, Name "elements along a side, outer sphere"},
  jitter = {0, Name "largest move of an interface node, in face sizes along each direction"}, seed = {1, Name "of the moves"},
  interference = {0.0025, Name "by which the inner sphere is too large"}
];
r_bore = 10; r = 20; r_rim = 30;
Point(1) = {0, 0, 0};
n_side[] = {n_inner, n_outer};
For d In {0 : 2}
  cut~{d}[] = {};
EndFor
For b In {0 : 1}
  n = n_side[b];
  n_wall = Ceil((r_rim - r) * n / (Pi / 4 * r));
  count = (n + 1)^3;
  step[] = {(n + 1)^2, n + 1, 1}; // from one lattice point to the next along x, y, z
  o = 1000000 * (b + 1);          // a tag is o + kind * count + place in the lattice
  body~{b}[] = {};
  contact~{b}[] = {};
  For place In {0 : count - 1}
    c[] = {Floor(place / step[0]), Floor(place / step[1]) % (n + 1), place % (n + 1)};
    If (c[0] == n || c[1] == n || c[2] == n)
      s = o + place;
      side = (c[0] == n) ? 0 : (c[1] == n) ? 1 : 2;
      For d In {0 : 2}
        x = 43758.5453 * Sin(12.9898 * (3 * s + d + 7 * seed)); // the digits behind the point serve as random numbers
        move = (d == side || c[d] == 0) ? 0 : jitter * (2 * (x - Floor(x)) - 1);
        even[d] = Tan(Pi / 4 * c[d] / n);
        moved[d] = Tan(Pi / 4 * (c[d] + move) / n);
      EndFor
      f_even = (b ? r_rim : r_bore) / Sqrt(even[0]^2 + even[1]^2 + even[2]^2);
      f_moved = (b ? r : r + interference) / Sqrt(moved[0]^2 + moved[1]^2 + moved[2]^2);
      Point(s + (1 - b) * count) = {f_moved * moved[0], f_moved * moved[1], f_moved * moved[2]};
      Point(s + b * count) = {f_even * even[0], f_even * even[1], f_even * even[2]};
      Line(s) = {s, s + count}; // kind 0: through the wall
      Transfinite Curve{s} = n_wall + 1;
    EndIf
  EndFor
  For place In {0 : count - 1}
    c[] = {Floor(place / step[0]), Floor(place / step[1]) % (n + 1), place % (n + 1)};
    s = o + place;
    For d In {0 : 2}
      e = (d + 1) % 3;
      f = (d + 2) % 3;
      If (c[d] < n && (c[e] == n || c[f] == n))
        For shell In {0 : 1} // kinds 1 to 6: along x, y, z on the inside, then on the outside
          Circle(s + (1 + 3 * shell + d) * count) = {s + shell * count, 1, s + step[d] + shell * count};
          Transfinite Curve{s + (1 + 3 * shell + d) * count} = 2;
        EndFor
        Curve Loop(s + d * count) = {s, s + (4 + d) * count, -(s + step[d]), -(s + (1 + d) * count)};
        Surface(s + d * count) = {s + d * count}; // kinds 0 to 2: through the wall
        If (c[e] == 0)
          cut~{e}[] += {s + d * count};
        EndIf
        If (c[f] == 0)
          cut~{f}[] += {s + d * count};
        EndIf
      EndIf
    EndFor
  EndFor
  For place In {0 : count - 1}
    c[] = {Floor(place / step[0]), Floor(place / step[1]) % (n + 1), place % (n + 1)};
    s = o + place;
    For d In {0 : 2}
      e = (d + 1) % 3;
      f = (d + 2) % 3;
      If (c[d] == n && c[e] < n && c[f] < n)
        For shell In {0 : 1} // kinds 3, 4: faces of the inside and the outside
          k = 1 + 3 * shell;
          Curve Loop(s + (3 + shell) * count) = {s + (k + e) * count, s + step[e] + (k + f) * count, -(s + step[f] + (k + e) * count), -(s + (k + f) * count)};
          Surface(s + (3 + shell) * count) = {s + (3 + shell) * count} In Sphere{1};
        EndFor
        Surface Loop(s) = {s + e * count, s + step[f] + e * count, s + f * count, s + step[e] + f * count, s + 3 * count, s + 4 * count};
        Volume(s) = {s};
        body~{b}[] += {s};
        contact~{b}[] += {s + (4 - b) * count};
      EndIf
    EndFor
  EndFor
EndFor
Transfinite Surface{:};
Recombine Surface{:};
Transfinite Volume{:};

Physical Volume("inner") = {body_0[]};
Physical Volume("outer") = {body_1[]};
Physical Surface("inner_contact") = {contact_0[]};
Physical Surface("outer_contact") = {contact_1[]};
Physical Surface("symmetry_x") = {cut_0[]};
Physical Surface("symmetry_y") = {cut_1[]};
Physical Surface("symmetry_z") = {cut_2[]};
