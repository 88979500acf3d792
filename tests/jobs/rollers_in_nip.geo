// Two rubber covers on steel cores, which press against each other at the origin; the half x >= 0. The cores are not
// drawn: they are the inner skins of the covers. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  core_up = {30, Name "radius of the upper core"}, cover_up = {10, Name "thickness of its cover"},
  core_low = {25, Name "radius of the lower core"}, cover_low = {7, Name "thickness of its cover"}
];
fine = 0.6 / refine;
coarse = 4 / refine;
Function Cover // half of a ring about (0, y) from its point next to the origin, in two sectors
  o = 100 * k;
  Point(o) = {0, y, 0, coarse};
  For i In {0 : 1}
    r = i ? outer : inner;
    Point(o + 10 * i + 1) = {0, y - s * r, 0, i ? fine : 2 * fine};
    Point(o + 10 * i + 2) = {r * Sin(Pi / 8), y - s * r * Cos(Pi / 8), 0, i ? fine : 2 * fine};
    Point(o + 10 * i + 3) = {r, y, 0, coarse};
    Point(o + 10 * i + 4) = {0, y + s * r, 0, coarse};
    For j In {1 : 3}
      Circle(o + 10 * i + j) = {o + 10 * i + j, o, o + 10 * i + j + 1};
    EndFor
  EndFor
  Line(o + 4) = {o + 1, o + 11};
  Line(o + 5) = {o + 4, o + 14};
  Curve Loop(k) = {s * (o + 4), s * (o + 11), s * (o + 12), s * (o + 13), -s * (o + 5), -s * (o + 3), -s * (o + 2), -s * (o + 1)};
  Plane Surface(k) = {k};
Return
k = 1; s = 1; inner = core_up; outer = core_up + cover_up; y = outer; Call Cover;
k = 2; s = -1; inner = core_low; outer = core_low + cover_low; y = -outer; Call Cover;

Physical Surface("upper") = {1};
Physical Surface("lower") = {2};
Physical Curve("upper_skin") = {111, 112};
Physical Curve("lower_skin") = {211, 212};
Physical Curve("upper_core") = {101, 102, 103};
Physical Curve("lower_core") = {201, 202, 203};
Physical Curve("middle") = {104, 105, 204, 205};
