// A parabola-like body on a flat one, both whole and rectangular, in the plane: the first touch is at the origin. The elements are even near it and
// grow beyond. Lengths in half-widths of the contact, or any other.
DefineConstant[
  radius = {50, Name "radius of the upper body's lower side"}, size = {60, Name "half width, and height, of each body"},
  zone = {1.4, Name "half width that is meshed evenly"}, deep = {1, Name "depth that is meshed evenly"},
  n = {16, Name "elements per unit length there, lower body"}, ratio = {0.8, Name "the upper body's elements over the lower one's, in number"},
  growth = {1.2, Name "of an element over the one before it, beyond"}, simplex = {0, Name "1: triangles"}
];
Point(1) = {0, radius, 0};
For b In {0 : 1} // lower, upper
  side = b ? 1 : -1;
  m = b ? n * ratio : n;
  n_zone = Ceil(2 * zone * m);
  n_deep = Ceil(deep * m);
  n_far = Ceil(Log(1 + (size - zone) * (growth - 1) * m) / Log(growth));
  n_below = Ceil(Log(1 + (size - deep) * (growth - 1) * m) / Log(growth));
  rise = b ? radius - Sqrt(radius^2 - zone^2) : 0;
  x[] = {-size, -zone, zone, size};
  y[] = {0, deep, size};
  o = 100 * (b + 1);
  For j In {0 : 2}
    For i In {0 : 3}
      lift = (j < 2 && (i == 1 || i == 2)) ? rise : 0;
      If (j < 2 && (i == 0 || i == 3))
        lift = b ? rise + (size - zone) * zone / radius : 0;
      EndIf
      Point(o + 4 * j + i) = {x[i], side * y[j] + lift, 0};
    EndFor
  EndFor
  For j In {0 : 2}
    For i In {0 : 2}
      c = o + 3 * j + i;
      If (b == 1 && j == 0 && i == 1)
        Circle(c) = {o + 1, 1, o + 2};
      Else
        Line(c) = {o + 4 * j + i, o + 4 * j + i + 1};
      EndIf
      If (i == 1)
        Transfinite Curve{c} = n_zone + 1;
      ElseIf (i == 0)
        Transfinite Curve{-c} = n_far + 1 Using Progression growth;
      Else
        Transfinite Curve{c} = n_far + 1 Using Progression growth;
      EndIf
    EndFor
  EndFor
  For i In {0 : 3}
    For j In {0 : 1}
      c = o + 20 + 4 * j + i;
      Line(c) = {o + 4 * j + i, o + 4 * j + i + 4};
      If (j == 0)
        Transfinite Curve{c} = n_deep + 1;
      Else
        Transfinite Curve{c} = n_below + 1 Using Progression growth;
      EndIf
    EndFor
  EndFor
  body~{b}[] = {};
  For j In {0 : 1}
    For i In {0 : 2}
      s = o + 3 * j + i;
      Curve Loop(s) = {s, o + 20 + 4 * j + i + 1, -(s + 3), -(o + 20 + 4 * j + i)};
      Plane Surface(s) = {side * s};
      body~{b}[] += {s};
    EndFor
  EndFor
EndFor
Transfinite Surface{:};
If (!simplex)
  Recombine Surface{:};
EndIf
Physical Surface("lower") = {body_0[]};
Physical Surface("upper") = {body_1[]};
Physical Curve("lower_top") = {101};
Physical Curve("upper_bottom") = {201};
Physical Curve("floor") = {106 : 108};
Physical Curve("platen") = {206 : 208};
