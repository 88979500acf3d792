// three leaves, half of the spring; lengths in mm
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
t = 4; n = 3;
Macro Leaf
  Point(b) = {0, y, 0}; Point(b+1) = {l, y, 0}; Point(b+2) = {l, y+t, 0}; Point(b+3) = {0, y+t, 0};
  For i In {0:3}
    Line(b+i) = {b+i, b+(i+1)%4};
  EndFor
  Transfinite Curve {b, b+2} = Ceil(l/k*refine) + 1; Transfinite Curve {b+1, b+3} = Ceil(2*refine) + 1;
  Curve Loop(b) = {b:b+3}; Plane Surface(b) = {b}; Transfinite Surface {b}; Recombine Surface {b};
Return
b = 10; y = 0; l = 100; k = 2.5; Call Leaf;
b = 20; y = -t; l = 70; k = 2.2; Call Leaf;
b = 30; y = -2*t; l = 40; k = 1.9; Call Leaf;
Physical Surface("leaf1") = {10}; Physical Surface("leaf2") = {20}; Physical Surface("leaf3") = {30};
Physical Curve("clamp") = {13, 23, 33}; Physical Curve("tip") = {11};
Physical Curve("under1") = {10}; Physical Curve("over2") = {22}; Physical Curve("under2") = {20}; Physical Curve("over3") = {32};
