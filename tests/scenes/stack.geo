// Two blocks over each other with a gap between them, plane, and a floor below: what may be lost, tunnelled through or left free in tests of the guards.
DefineConstant[
  width = {2, Name "width"}, height = {1, Name "height of the upper block"}, thickness = {1, Name "height of the lower block"},
  gap = {0.25, Name "distance of the blocks"}, overhang = {0.5, Name "how far the lower block stands out on either side"},
  n_lower = {6, Name "elements along the lower block"}, n_upper = {4, Name "elements along the upper block"},
  n_height = {2, Name "elements over the height of each block"},
  floor = {0, Name "depth of the floor below the lower block, 0: none"}
];
x_0[] = {-overhang, 0, -overhang};
x_1[] = {width + overhang, width, width + overhang};
y_0[] = {0, thickness + gap, -floor - 1};
y_1[] = {thickness, thickness + gap + height, -floor};
n_row[] = {n_lower, n_upper, n_lower};
For b In {0 : floor > 0 ? 2 : 1}
  o = 100 * b;
  Point(o + 1) = {x_0[b], y_0[b], 0};
  Point(o + 2) = {x_1[b], y_0[b], 0};
  Point(o + 3) = {x_1[b], y_1[b], 0};
  Point(o + 4) = {x_0[b], y_1[b], 0};
  For i In {1 : 4}
    Line(o + i) = {o + i, o + i % 4 + 1};
  EndFor
  Curve Loop(o + 1) = {o + 1, o + 2, o + 3, o + 4};
  Plane Surface(o + 1) = {o + 1};
  Transfinite Curve{o + 1, o + 3} = n_row[b] + 1;
  Transfinite Curve{o + 2, o + 4} = n_height + 1;
  Transfinite Surface{o + 1};
  Recombine Surface{o + 1};
EndFor
Physical Surface("lower") = {1};
Physical Surface("upper") = {101};
Physical Curve("lower_bottom") = {1};
Physical Curve("lower_top") = {3};
Physical Curve("lower_all") = {1, 2, 3, 4};
Physical Curve("upper_bottom") = {101};
Physical Curve("upper_top") = {103};
Physical Curve("upper_left") = {104};
If (floor > 0)
  Physical Surface("floor") = {201};
  Physical Curve("floor_bottom") = {201};
  Physical Curve("floor_top") = {203};
  Physical Curve("tops") = {3, 203};
EndIf
