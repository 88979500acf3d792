// Half of a wedge driven down beside a block, in space. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
a = 10 * Pi / 180; h = 12; w = 4; d = 10;
x0 = w + h * Tan(a);
n = 5 * refine; m = 4 * refine; k = 3 * refine;
Point(1) = {0, 0, 0}; Point(2) = {w, 0, 0}; Point(3) = {x0, h, 0}; Point(4) = {0, h, 0};
For i In {1 : 4}
  Line(i) = {i, i % 4 + 1};
EndFor
Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = 3 * refine + 1; Transfinite Curve{2, 4} = n + 1; Transfinite Surface{1}; Recombine Surface{1};
y0 = -5; y1 = h + 3;
Point(11) = {w + y0 * Tan(a), y0, -2}; Point(12) = {w + 14, y0, -2}; Point(13) = {w + 14, y1, -2}; Point(14) = {w + y1 * Tan(a), y1, -2};
For i In {1 : 4}
  Line(10 + i) = {10 + i, 10 + i % 4 + 1};
EndFor
Curve Loop(11) = {11 : 14}; Plane Surface(11) = {11};
Transfinite Curve{11, 13} = m + 1; Transfinite Curve{12, 14} = 7 * refine + 1; Transfinite Surface{11}; Recombine Surface{11};
u() = Extrude {0, 0, d} { Surface{1}; Layers{4 * refine}; Recombine; };
v() = Extrude {0, 0, d + 4} { Surface{11}; Layers{5 * refine}; Recombine; };
Physical Volume("wedge") = {u(1)}; Physical Volume("block") = {v(1)};
Physical Surface("flank") = {u(3)}; Physical Surface("head") = {u(4)}; Physical Surface("middle") = {u(5)};
Physical Surface("seat") = {v(5)}; Physical Surface("rear") = {v(3)};
