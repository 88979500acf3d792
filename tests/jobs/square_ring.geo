// A square-cut ring with round corners in a groove under a lid, axisymmetric: x = r, y = z. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"}, quads = {0, Name "1: quadrangles"} ];
r = 20; w = 3; h = 3; c = 0.4; f = 0.15 / refine; g = 0.35 / refine;
x[] = {r + c, r + w - c, r + w, r + w, r + w - c, r + c, r, r};
y[] = {0, 0, c, h - c, h, h, h - c, c};
For i In {0 : 7}
  Point(1 + i) = {x[i], y[i], 0, f};
EndFor
Point(11) = {r + w - c, c, 0, f}; Point(12) = {r + w - c, h - c, 0, f}; Point(13) = {r + c, h - c, 0, f}; Point(14) = {r + c, c, 0, f};
Point(15) = {r, h / 2, 0, f}; Point(16) = {r + w, h / 2, 0, f}; Point(17) = {r + w / 2, h / 2, 0, 2 * g};
Line(1) = {1, 2}; Circle(2) = {2, 11, 3}; Line(3) = {3, 16}; Line(4) = {16, 4}; Circle(5) = {4, 12, 5}; Line(6) = {5, 6};
Circle(7) = {6, 13, 7}; Line(8) = {7, 15}; Line(9) = {15, 8}; Circle(10) = {8, 14, 1};
Curve Loop(1) = {1 : 10}; Plane Surface(1) = {1}; Point{17} In Surface{1};
If (quads) Recombine Surface{1}; EndIf
e = 0.15; W = 4.2; H = 2.6; // groove, whose outer wall begins at r + W - 0.5
Point(30) = {r - 0.7, 6, 0, g}; Point(31) = {r - 0.7, 0, 0, g}; Point(32) = {r + W - 0.7, 0, 0, g};
Point(33) = {r + W - 0.7, H - e, 0, f}; Point(34) = {r + W - 0.7 + e, H, 0, f}; Point(35) = {r + W + 1, H, 0, g}; Point(36) = {r + W - 0.7 + e, H - e, 0, f};
Line(30) = {30, 31}; Line(31) = {31, 32}; Line(32) = {32, 33}; Circle(33) = {33, 36, 34}; Line(34) = {34, 35};
Point(40) = {r - 1.5, h, 0, g}; Point(41) = {r + W + 1, h, 0, g};
Line(40) = {40, 41};
Physical Surface("ring") = {1};
Physical Curve("skin") = {1 : 10};
Physical Curve("groove") = {30 : 34};
Physical Curve("lid") = {40};
