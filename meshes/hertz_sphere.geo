// A sphere pressed on a block, a quarter of both: x = 0 and z = 0 are planes of symmetry, the first touch is at the origin. Lengths in mm.
// Of the sphere only a square column of base size x size over its lowest point is there, cut at y = size: it is loaded through that cut. Each body
// is four by two blocks of bricks: uniform within `zone` of the planes of symmetry and of the surface, growing from there on.
DefineConstant[
  radius = {50, Name "radius of the sphere"}, size = {16, Name "width and height of the bodies"},
  zone = {1.5, Name "length that is meshed uniformly"}, n = {6, Name "elements along that length, sphere"},
  ratio = {0.8, Name "the block's element size over the sphere's: the two meshes do not match"},
  growth = {1.4, Name "of an element over the one before it, beyond"}
];
edge[] = {0, zone, size};
cut_x[] = {};
cut_z[] = {};
For b In {0 : 1} // sphere, block
  o = 1000 * (b + 1);
  n_zone = Ceil(b ? n / ratio : n);
  h = zone / n_zone;
  n_far = Ceil(Log(1 + (size - zone) * (growth - 1) / (growth * h)) / Log(growth));
  body~{b}[] = {};
  Point(o - 1) = {0, radius, 0};
  For j In {0 : 2} // heights; a tag is o + 100 * kind + place
    For k In {0 : 2}
      For i In {0 : 2}
        fall = b ? 0 : radius - Sqrt(radius^2 - edge[i]^2 - edge[k]^2); // where the sphere is
        share = edge[j] / size;
        Point(o + 9 * j + 3 * k + i) = {edge[i], (b ? -1 : 1) * edge[j] + (1 - share) * fall, edge[k]};
      EndFor
    EndFor
  EndFor
  For k In {0 : 2}
    Point(o - 10 - k) = {0, radius, edge[k]}; // centres of the sphere's sections
    Point(o - 20 - k) = {edge[k], radius, 0};
  EndFor
  For j In {0 : 2}
    For k In {0 : 2}
      For i In {0 : 1}
        s = o + 9 * j + 3 * k + i; // kind 1: along x
        r = o + 9 * j + 3 * i + k; // kind 2: along z
        If (b == 0 && j == 0)
          Circle(s + 100) = {s, o - 10 - k, s + 1};
          Circle(r + 200) = {r, o - 20 - k, r + 3};
        Else
          Line(s + 100) = {s, s + 1};
          Line(r + 200) = {r, r + 3};
        EndIf
        If (i == 0)
          Transfinite Curve{s + 100, r + 200} = n_zone + 1;
        Else
          Transfinite Curve{s + 100, r + 200} = n_far + 1 Using Progression growth;
        EndIf
        Line(o + 9 * i + 3 * k + j + 300) = {o + 9 * i + 3 * k + j, o + 9 * (i + 1) + 3 * k + j}; // kind 3: along y
        If (i == 0)
          Transfinite Curve{o + 9 * i + 3 * k + j + 300} = n_zone + 1;
        Else
          Transfinite Curve{o + 9 * i + 3 * k + j + 300} = n_far + 1 Using Progression growth;
        EndIf
      EndFor
    EndFor
  EndFor
  For j In {0 : 2}
    For k In {0 : 1}
      For i In {0 : 1}
        s = o + 9 * j + 3 * k + i;
        Curve Loop(s) = {s + 100, s + 201, -(s + 103), -(s + 200)};
        If (b == 0 && j == 0)
          Surface(s) = {s} In Sphere{o - 1};
        Else
          Surface(s) = {s};
        EndIf
        r = o + 9 * k + 3 * j + i; // standing along x, at z = edge[j]
        Curve Loop(r + 400) = {r + 100, r + 301, -(r + 109), -(r + 300)};
        Surface(r + 400) = {r + 400};
        q = o + 9 * k + 3 * i + j; // standing along z, at x = edge[j]
        Curve Loop(q + 500) = {q + 200, q + 303, -(q + 209), -(q + 300)};
        Surface(q + 500) = {q + 500};
        If (j == 0)
          cut_z[] += {r + 400};
          cut_x[] += {q + 500};
        EndIf
      EndFor
    EndFor
  EndFor
  For j In {0 : 1}
    For k In {0 : 1}
      For i In {0 : 1}
        s = o + 9 * j + 3 * k + i;
        Surface Loop(s) = {s, s + 9, s + 400, s + 403, s + 500, s + 501};
        Volume(s) = {s};
        body~{b}[] += {s};
      EndFor
    EndFor
  EndFor
  touching~{b}[] = {o, o + 1, o + 3, o + 4};
  far~{b}[] = {o + 18, o + 19, o + 21, o + 22};
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
Physical Surface("symmetry_x") = {cut_x[]};
Physical Surface("symmetry_z") = {cut_z[]};
