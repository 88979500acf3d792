// Two blocks that meet along y = f(x, z), for hard cases: a strip of the plane, or solid with n_z > 0. Every node of the interface is a point of its
// own with one column of elements behind it. The lower block covers the unit square (interval), cut in two along x = 1/2 with seam = 1: then its two
// halves share no nodes there. Everything may be drawn in another unit, turned about z and moved away.
DefineConstant[
  shape = {0, Name "of the interface: 0 flat, 1 roof, 2 wave, 3 saddle"}, rise = {0.2, Name "height of that shape"},
  n_lower = {6, Name "faces along the lower block"}, n_upper = {5, Name "faces along the upper block"},
  n_z = {0, Name "1: solid, with as many faces along z as along x; 0: plane"},
  n_height = {3, Name "elements over the height of each block"}, height = {0.5, Name "of each block"},
  wall = {0, Name "height of the lower block where it is another one; 'skin' is then its upper and lower face"},
  from = {0, Name "where the upper block begins along x (and z)"}, to = {1, Name "where it ends"},
  gap = {0, Name "between the blocks; negative: overlap"},
  bulge = {0, Name "curvature of the upper block's lower face, about x = 1/2 (and z)"},
  wedge = {0, Name "slope of the upper block's lower face on both sides of x = 1/2"},
  ratio = {1, Name "of the longest face of the lower block to the shortest, along x"},
  jitter = {0, Name "largest move of an interface node, in faces"}, seed = {1, Name "of the moves"},
  seam = {0, Name "1: the lower block is two, 'lower' and 'right'"},
  unit = {1, Name "length of the unit"}, angle = {0, Name "turn about z in degrees"}, away = {0, Name "move along x and y, in units"}
];
n_faces[] = {seam ? n_lower / 2 : n_lower, n_upper, n_lower / 2};
begin[] = {0, from, 0.5};
end[] = {seam ? 0.5 : 1, to, 1};
tops[] = {};
For b In {0 : seam ? 2 : 1}
  n = n_faces[b];
  m = n_z ? ((b == 1) ? n_upper : n_lower) : 0;
  count = (n + 1) * (m + 1);
  o = 100000 * (b + 1); // a tag is o + kind * count + place
  body~{b}[] = {};
  contact~{b}[] = {};
  far~{b}[] = {};
  left~{b}[] = {};
  right~{b}[] = {};
  front~{b}[] = {};
  back~{b}[] = {};
  For k In {0 : m}
    For i In {0 : n}
      s = o + k * (n + 1) + i;
      x = 43758.5453 * Sin(12.9898 * (s + 7 * seed)); // the digits behind the point serve as random numbers
      z = 43758.5453 * Sin(78.233 * (s + 7 * seed));
      u = (i == 0 || i == n) ? i / n : (i + jitter * (2 * (x - Floor(x)) - 1)) / n;
      w = (k == 0 || k == m) ? k / Max(m, 1) : (k + jitter * (2 * (z - Floor(z)) - 1)) / Max(m, 1);
      If (b != 1 && ratio != 1)
        u = (ratio^u - 1) / (ratio - 1);
      EndIf
      u = begin[b] + u * (end[b] - begin[b]);
      w = (b == 1) ? from + w * (to - from) : w;
      c = u - 0.5;
      d = m ? w - 0.5 : 0;
      y = (shape == 1) ? -2 * rise * Fabs(c) : (shape == 2) ? rise / 2 * Cos(2 * Pi * c) : (shape == 3) ? 4 * rise * (c^2 - d^2) : 0;
      y = y + ((b == 1) ? gap + bulge / 2 * (c^2 + d^2) + wedge * Fabs(c) : 0);
      f = (b == 1) ? height : wall ? -wall : -height;
      For level In {0 : 1}
        p = unit * (away + u * Cos(angle * Pi / 180) - (level ? f : y) * Sin(angle * Pi / 180));
        q = unit * (away + u * Sin(angle * Pi / 180) + (level ? f : y) * Cos(angle * Pi / 180));
        Point(s + level * count) = {p, q, unit * (m ? w : 0)};
      EndFor
      Line(s) = {s + ((b == 1) ? 0 : count), s + ((b == 1) ? count : 0)}; // kind 0: upwards
      Transfinite Curve{s} = n_height + 1;
    EndFor
  EndFor
  For level In {0 : 1} // kinds 1, 2: along x, on the interface and on the far side; 3, 4: along z
    For k In {0 : m}
      For i In {0 : n}
        s = o + k * (n + 1) + i + level * count;
        If (i < n)
          Line(s + count) = {s, s + 1};
          Transfinite Curve{s + count} = 2;
        EndIf
        If (k < m)
          Line(s + 3 * count) = {s, s + n + 1};
          Transfinite Curve{s + 3 * count} = 2;
        EndIf
      EndFor
    EndFor
  EndFor
  low = (b == 1) ? 1 : 2;
  high = 3 - low;
  For k In {0 : m}
    For i In {0 : n}
      s = o + k * (n + 1) + i;
      If (i < n)
        Curve Loop(s) = {s + low * count, s + 1, -(s + high * count), -s};
        Surface(s) = {s}; // kind 0: standing, along x
      EndIf
      If (k < m)
        Curve Loop(s + count) = {s + (2 + low) * count, s + n + 1, -(s + (2 + high) * count), -s};
        Surface(s + count) = {s + count}; // kind 1: standing, along z
      EndIf
      If (i < n && k < m)
        For level In {0 : 1} // kinds 2, 3: of the interface and the far side
          r = s + (1 + level) * count;
          Curve Loop(r + count) = {r, s + 1 + (3 + level) * count, -(r + n + 1), -(s + (3 + level) * count)};
          Surface(r + count) = {r + count};
        EndFor
      EndIf
    EndFor
  EndFor
  If (m)
    For k In {0 : m - 1}
      For i In {0 : n - 1}
        s = o + k * (n + 1) + i;
        Surface Loop(s) = {s, s + n + 1, s + count, s + 1 + count, s + 2 * count, s + 3 * count};
        Volume(s) = {s};
        body~{b}[] += {s};
        contact~{b}[] += {s + 2 * count};
        far~{b}[] += {s + 3 * count};
        If (k == 0)
          front~{b}[] += {s};
          back~{b}[] += {s + m * (n + 1)};
        EndIf
        If (i == 0)
          left~{b}[] += {s + count};
          right~{b}[] += {s + n + count};
        EndIf
      EndFor
    EndFor
  Else
    body~{b}[] = {o : o + n - 1};
    contact~{b}[] = {o + count : o + count + n - 1};
    far~{b}[] = {o + 2 * count : o + 2 * count + n - 1};
    left~{b}[] = {o};
    right~{b}[] = {o + n};
  EndIf
  If (b != 1)
    tops[] += {contact~{b}[]};
  EndIf
EndFor
Transfinite Surface{:};
Recombine Surface{:};

names[] = Str("lower", "upper", "right");
For b In {0 : seam ? 2 : 1}
  name = Str(names[b]);
  If (n_z)
    Physical Volume(Str(name)) = {body~{b}[]};
    Physical Surface(StrCat(name, "_contact")) = {contact~{b}[]};
    Physical Surface(StrCat(name, "_far")) = {far~{b}[]};
    Physical Surface(StrCat(name, "_x_low")) = {left~{b}[]};
    Physical Surface(StrCat(name, "_x_high")) = {right~{b}[]};
    Physical Surface(StrCat(name, "_z_low")) = {front~{b}[]};
    Physical Surface(StrCat(name, "_z_high")) = {back~{b}[]};
  Else
    Physical Surface(Str(name)) = {body~{b}[]};
    Physical Curve(StrCat(name, "_contact")) = {contact~{b}[]};
    Physical Curve(StrCat(name, "_far")) = {far~{b}[]};
    Physical Curve(StrCat(name, "_x_low")) = {left~{b}[]};
    Physical Curve(StrCat(name, "_x_high")) = {right~{b}[]};
  EndIf
EndFor
If (n_z)
  Transfinite Volume{:};
EndIf
If (seam && n_z)
  Physical Surface("tops") = {tops[]};
ElseIf (seam)
  Physical Curve("tops") = {tops[]};
ElseIf (wall)
  Physical Curve("skin") = {contact_0[], far_0[]};
EndIf
