// Two blocks of a few elements over each other, and a bent line or sheet above them. Lengths in mm.
DefineConstant[
  dim = {2, Name "2 or 3"}, simplex = {0, Name "1: triangles or tetrahedra"}, gap = {0.02, Name "between the blocks"},
  n_lower = {2, Name "elements along the lower block"}, n_upper = {2, Name "along the upper block"}
];
length = 1;
height = 0.5;
top = 2 * height + gap + 0.03;
For b In {0 : 1}
  o = 100 * b;
  y = b * (height + gap);
  Point(o + 1) = {0, y, 0};
  Point(o + 2) = {length, y, 0};
  Point(o + 3) = {length, y + height, 0};
  Point(o + 4) = {0, y + height, 0};
  For i In {1 : 4}
    Line(o + i) = {o + i, o + i % 4 + 1};
  EndFor
  Curve Loop(o + 1) = {o + 1 : o + 4};
  Plane Surface(o + 1) = {o + 1};
  Transfinite Curve{o + 1, o + 3} = (b ? n_upper : n_lower) + 1;
  Transfinite Curve{o + 2, o + 4} = 2;
  Transfinite Surface{o + 1};
  If (!simplex)
    Recombine Surface{o + 1};
  EndIf
EndFor
Point(201) = {-0.3, top, 0};
Point(202) = {length / 2, top - 0.02, 0};
Point(203) = {length + 0.3, top, 0};
Line(201) = {201, 202};
Line(202) = {202, 203};
Transfinite Curve{201, 202} = 2;
If (dim == 2)
  Physical Surface("lower") = {1};
  Physical Surface("upper") = {101};
  Physical Curve("lower_bottom") = {1};
  Physical Curve("lower_top") = {3};
  Physical Curve("upper_bottom") = {101};
  Physical Curve("upper_top") = {103};
  Physical Curve("left") = {4, 104};
  Physical Curve("tool") = {201, 202};
Else
  For b In {0 : 1}
    If (simplex)
      block[] = Extrude {0, 0, 1} { Surface{100 * b + 1}; Layers{1}; };
    Else
      block[] = Extrude {0, 0, 1} { Surface{100 * b + 1}; Layers{1}; Recombine; };
    EndIf
    block~{b}[] = block[];
  EndFor
  sheet[] = Extrude {0, 0, 1} { Line{201, 202}; Layers{1}; Recombine; };
  Physical Volume("lower") = {block_0[1]};
  Physical Volume("upper") = {block_1[1]};
  Physical Surface("lower_bottom") = {block_0[2]};
  Physical Surface("lower_top") = {block_0[4]};
  Physical Surface("upper_bottom") = {block_1[2]};
  Physical Surface("upper_top") = {block_1[4]};
  Physical Surface("left") = {block_0[5], block_1[5]};
  Physical Surface("tool") = {sheet[1], sheet[5]};
EndIf
