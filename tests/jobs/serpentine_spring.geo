// A serpentine spring: arms of rectangular section, joined by half rings; pushed together until its arms lie on each
// other. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"}, arms = {5, Name "number of arms"}, length = {16, Name "of an arm"},
  thick = {1, Name "thickness"}, gap = {1.2, Name "between two arms"}
];
pitch = thick + gap; ri = gap / 2; ro = ri + thick;
For i In {0:arms - 1}
  y = i * pitch; p = 100 * i;
  Point(p + 1) = {0, y, 0}; Point(p + 2) = {length, y, 0};
  Point(p + 3) = {length, y + thick, 0}; Point(p + 4) = {0, y + thick, 0};
  Line(p + 1) = {p + 1, p + 2}; Line(p + 2) = {p + 2, p + 3};
  Line(p + 3) = {p + 3, p + 4}; Line(p + 4) = {p + 4, p + 1};
  Curve Loop(p + 1) = {p + 1:p + 4}; Plane Surface(p + 1) = {p + 1};
  Transfinite Curve{p + 1, p + 3} = Round(32 * refine) + 1;
  Transfinite Curve{p + 2, p + 4} = Round(4 * refine) + 1;
EndFor
For i In {0:arms - 2}
  y = i * pitch + thick + ri; p = 100 * i; q = p + 100;
  x = (i % 2 == 0) ? length : 0; s = (i % 2 == 0) ? 1 : -1;
  Point(p + 5) = {x, y, 0}; Point(p + 6) = {x + s * ri, y, 0}; Point(p + 7) = {x + s * ro, y, 0};
  a = (i % 2 == 0) ? p + 3 : p + 4; b = (i % 2 == 0) ? p + 2 : p + 1; // inner and outer point below
  c = (i % 2 == 0) ? q + 2 : q + 1; d = (i % 2 == 0) ? q + 3 : q + 4; // above
  e = (i % 2 == 0) ? p + 2 : p + 4; f = (i % 2 == 0) ? q + 2 : q + 4; // end lines of the arms
  Circle(p + 11) = {a, p + 5, p + 6}; Circle(p + 12) = {p + 6, p + 5, c};
  Circle(p + 13) = {b, p + 5, p + 7}; Circle(p + 14) = {p + 7, p + 5, d}; Line(p + 15) = {p + 6, p + 7};
  Curve Loop(p + 11) = {p + 11, p + 15, -(p + 13), s * e}; Plane Surface(p + 11) = {p + 11};
  Curve Loop(p + 12) = {p + 12, s * f, -(p + 14), -(p + 15)}; Plane Surface(p + 12) = {p + 12};
  Transfinite Curve{p + 11:p + 14} = Round(10 * refine) + 1;
  Transfinite Curve{p + 15} = Round(4 * refine) + 1;
EndFor
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("spring") = Surface{:};
Physical Curve("bottom") = {1};
Physical Curve("top") = {100 * (arms - 1) + 3};
