// Shoe with a lining on a drum, pivoted at its end; plane. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
R = 100; lining = 8; back = 20; a0 = 45 * Pi / 180; a1 = 135 * Pi / 180; gap = 0.2;
fine = 4 / refine; coarse = 8 / refine;
Function Arc
  Point(p + 1) = {r * Cos(a0), r * Sin(a0), 0, size}; Point(p + 2) = {r * Cos(a1), r * Sin(a1), 0, size};
Return
Point(100) = {0, 0, 0};
p = 0; r = R + gap; size = fine; Call Arc;
p = 2; r = R + gap + lining; Call Arc;
p = 4; r = R + gap + lining + back; size = coarse; Call Arc;
Circle(1) = {1, 100, 2}; Circle(2) = {3, 100, 4}; Circle(3) = {5, 100, 6};
Line(4) = {1, 3}; Line(5) = {3, 5}; Line(6) = {2, 4}; Line(7) = {4, 6};
Curve Loop(1) = {1, 6, -2, -4}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 7, -3, -5}; Plane Surface(2) = {2};
Point(11) = {R, 0, 0, fine}; Point(12) = {0, R, 0, fine}; Point(13) = {-R, 0, 0, fine};  Point(14) = {0, -R, 0, coarse};
Point(21) = {R - 15, 0, 0, coarse}; Point(22) = {0, R - 15, 0, coarse}; Point(23) = {15 - R, 0, 0, coarse};  Point(24) = {0, 15 - R, 0, coarse};
For i In {1 : 4}
  Circle(10 + i) = {10 + i, 100, 10 + i % 4 + 1}; Circle(20 + i) = {20 + i, 100, 20 + i % 4 + 1};
EndFor
Curve Loop(3) = {11 : 14}; Curve Loop(4) = {21 : 24}; Plane Surface(3) = {3, 4};
Physical Surface("shoe") = {1}; Physical Surface("steel") = {2}; Physical Surface("drum") = {3};
Physical Curve("face") = {1}; Physical Curve("tread") = {11 : 14}; Physical Curve("bore") = {21 : 24};
Physical Curve("pivot") = {7}; Physical Curve("tip") = {5}; Physical Curve("rear") = {3};
