// A square seal with rounded edges in a dovetail groove under a lid, seen along the seal. Groove and lid are curves.
// Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
size = 0.3 / refine; wall = 1.077 / refine; a = 4; q = 0.4;
For i In {0 : 3}
  x = (i == 0 || i == 3) ? -a / 2 : a / 2;
  y = (i < 2) ? 0 : a;
  sx = (x < 0) ? q : -q; sy = (y < 1) ? q : -q;
  Point(10 * i + 1) = {x + sx, y + sy, 0, size};
  Point(10 * i + 2) = {x, y + sy, 0, size};
  Point(10 * i + 3) = {x + sx, y, 0, size};
EndFor
Circle(1) = {2, 1, 3}; Line(2) = {3, 13}; Circle(3) = {13, 11, 12}; Line(4) = {12, 22};
Circle(5) = {22, 21, 23}; Line(6) = {23, 33}; Circle(7) = {33, 31, 32}; Line(8) = {32, 2};
Curve Loop(1) = {1 : 8}; Plane Surface(1) = {1};
For i In {0 : 1} // left and right wall, round at the edges
  s = 2 * i - 1;
  Point(101 + 10 * i) = {5 * s, 3.2, 0, wall}; Point(102 + 10 * i) = {2.4 * s, 3.2, 0, wall}; Point(103 + 10 * i) = {2.4 * s, 3, 0, wall};
  Point(104 + 10 * i) = {2.2 * s, 3, 0, wall}; Point(105 + 10 * i) = {3 * s, 0, 0, wall};
  Line(101 + 10 * i) = {101 + 10 * i, 102 + 10 * i};
  Circle(102 + 10 * i) = {102 + 10 * i, 103 + 10 * i, 104 + 10 * i};
  Line(103 + 10 * i) = {104 + 10 * i, 105 + 10 * i};
EndFor
Line(120) = {105, 115};
Point(201) = {-5, 4, 0, wall}; Point(202) = {5, 4, 0, wall}; Line(201) = {201, 202};
Physical Surface("ring") = {1};
Physical Curve("skin") = {1 : 8};
Physical Curve("groove") = {101 : 103, 111 : 113, 120};
Physical Curve("lid") = {201};
