// Two combs of leaf springs that stand in each other's gaps. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"}, n_len = {20, Name "elements along a finger"},
  n_thick = {2, Name "elements through a finger"}, length = {20, Name "length"}, thick = {1.2, Name "thickness"},
  pitch = {3.2, Name "between neighbours of both combs"}
];
// Lower fingers stand at x = 0 and 2 pitch, the upper ones hang at pitch and 3 pitch; they overlap by 12 mm.
For i In {0:1}
  x = 2 * pitch * i;
  Point(10 * i + 1) = {x, 0, 0}; Point(10 * i + 2) = {x + thick, 0, 0};
  Point(10 * i + 3) = {x + thick, length, 0}; Point(10 * i + 4) = {x, length, 0};
  x = 2 * pitch * i + pitch;
  Point(10 * i + 5) = {x, 8, 0}; Point(10 * i + 6) = {x + thick, 8, 0};
  Point(10 * i + 7) = {x + thick, 8 + length, 0}; Point(10 * i + 8) = {x, 8 + length, 0};
EndFor
For i In {0:1}
  For k In {0:1}
    p = 10 * i + 4 * k; l = 100 * (i + 1) + 10 * k;
    Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3};
    Line(l + 3) = {p + 3, p + 4}; Line(l + 4) = {p + 4, p + 1};
    Curve Loop(l) = {l + 1, l + 2, l + 3, l + 4}; Plane Surface(l) = {l};
    Transfinite Curve{l + 1, l + 3} = Round(n_thick * refine) + 1;
    Transfinite Curve{l + 2, l + 4} = Round(n_len * refine) + 1;
  EndFor
EndFor
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("lower") = {100, 200};
Physical Surface("upper") = {110, 210};
Physical Curve("lower_root") = {101, 201};
Physical Curve("upper_root") = {113, 213};
