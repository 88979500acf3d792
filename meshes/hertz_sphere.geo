// A sphere pressed on a block, a quarter of both, or with `half` a half: x = 0 and z = 0 are planes of symmetry, the first touch is at the origin. Lengths in mm.
// Of the sphere only a square column of base size x size over its lowest point is there, cut at y = size: it is loaded through that cut. Each body
// is a lattice of bricks: uniform within `zone` of the planes of symmetry and of the surface, growing from there on. The interface's nodes are points
// of their own, so that they can be moved within the surface; on the sphere run arcs of great circles between them.
DefineConstant[
  radius = {50, Name "radius of the sphere"}, size = {16, Name "width and height of the bodies"},
  zone = {1.5, Name "length that is meshed uniformly"}, n = {6, Name "elements along that length, sphere"},
  ratio = {0.8, Name "the block's element size over the sphere's: the two meshes do not match"},
  growth = {1.4, Name "of an element over the one before it, beyond"},
  half = {0, Name "1: both sides of x = 0, which then is no plane of symmetry"},
  jitter = {0, Name "largest move of an interface node inside the uniform length, in elements along each direction"}, seed = {1, Name "of the moves"}
];
height[] = {0, zone, size};
cut_x[] = {};
cut_z[] = {};
Point(1) = {0, radius, 0};
For b In {0 : 1} // sphere, block
  n_zone = Ceil(b ? n / ratio : n);
  h = zone / n_zone;
  n_far = Ceil(Log(1 + (size - zone) * (growth - 1) / (growth * h)) / Log(growth));
  n_side = n_zone + n_far;
  n_low = half ? n_side : 0; // elements on the far side of x = 0
  row = n_low + n_side + 1;
  count = row * (n_side + 1);
  o = 1000000 * (b + 1); // a tag is o + kind * count + place in the lattice, from x to x along z
  body~{b}[] = {};
  touching~{b}[] = {};
  far~{b}[] = {};
  For i In {0 : n_side}
    even[i] = (i <= n_zone) ? i * h : zone + (size - zone) * (growth^(i - n_zone) - 1) / (growth^n_far - 1);
  EndFor
  For k In {0 : n_side}
    For i In {0 : n_low + n_side}
      s = o + k * row + i;
      For d In {0 : 1}
        x = 43758.5453 * Sin(12.9898 * (2 * s + d + 7 * seed)); // the digits behind the point serve as random numbers
        at = d ? k : i - n_low;
        move[d] = ((at == 0 && (d || !half)) || Abs(i - n_low) >= n_zone || k >= n_zone) ? 0 : jitter * h * (2 * (x - Floor(x)) - 1);
      EndFor
      For j In {0 : 2} // heights, kinds 0 to 2
        x = (i < n_low ? -1 : 1) * even[Abs(i - n_low)] + (j ? 0 : move[0]);
        z = even[k] + (j ? 0 : move[1]);
        fall = b ? 0 : radius - Sqrt(radius^2 - x^2 - z^2); // where the sphere is
        Point(s + j * count) = {x, (b ? -1 : 1) * height[j] + (1 - height[j] / size) * fall, z};
      EndFor
      Line(s) = {s, s + count}; // kinds 0 and 1: along y
      Transfinite Curve{s} = n_zone + 1;
      Line(s + count) = {s + count, s + 2 * count};
      Transfinite Curve{s + count} = n_far + 1 Using Progression growth;
    EndFor
  EndFor
  For k In {0 : n_side}
    For i In {0 : n_low + n_side}
      s = o + k * row + i;
      For d In {0 : 1} // along x, along z
        next = d ? row : 1;
        If ((d ? k : i - n_low) < n_side)
          For j In {0 : 2} // kinds 2 to 7
            c = s + (2 + 3 * d + j) * count;
            If (b == 0 && j == 0)
              Circle(c) = {s, 1, s + next};
            Else
              Line(c) = {s + j * count, s + next + j * count};
            EndIf
            Transfinite Curve{c} = 2;
          EndFor
          For j In {0 : 1} // kinds 0 to 3: standing
            c = s + (2 + 3 * d + j) * count;
            q = s + (2 * d + j) * count;
            Curve Loop(q) = {c, s + next + j * count, -(c + count), -(s + j * count)};
            Surface(q) = {q};
            If (d == 0 && k == 0)
              cut_z[] += {q};
            EndIf
            If (d == 1 && i == 0 && !half)
              cut_x[] += {q};
            EndIf
          EndFor
        EndIf
      EndFor
    EndFor
  EndFor
  For k In {0 : n_side - 1}
    For i In {0 : n_low + n_side - 1}
      s = o + k * row + i;
      For j In {0 : 2} // kinds 4 to 6: lying
        c = s + (2 + j) * count;
        q = s + (4 + j) * count;
        Curve Loop(q) = {c, c + 1 + 3 * count, -(c + row), -(c + 3 * count)};
        If (b == 0 && j == 0)
          Surface(q) = {q} In Sphere{1};
        Else
          Surface(q) = {q};
        EndIf
      EndFor
      touching~{b}[] += {s + 4 * count};
      far~{b}[] += {s + 6 * count};
      For j In {0 : 1}
        v = s + j * count;
        Surface Loop(v) = {v, v + row, v + 2 * count, v + 1 + 2 * count, v + 4 * count, v + 5 * count};
        Volume(v) = {v};
        body~{b}[] += {v};
      EndFor
    EndFor
  EndFor
EndFor
Transfinite Surface{:};
Recombine Surface{:};
Transfinite Volume{:};

Physical Volume("sphere") = {body_0[]};
Physical Volume("block") = {body_1[]};
Physical Surface("sphere_sole") = {touching_0[]};
Physical Surface("sphere_cut") = {far_0[]};
Physical Surface("block_top") = {touching_1[]};
Physical Surface("block_bottom") = {far_1[]};
If (!half)
  Physical Surface("symmetry_x") = {cut_x[]};
EndIf
Physical Surface("symmetry_z") = {cut_z[]};
