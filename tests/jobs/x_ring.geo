// The section of an X-ring of four lobes in a groove with rounded edges, under a lid; x = r, y = z. Groove and lid are
// curves. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  inside = {20, Name "inner radius of the ring"}, width = {2.62, Name "of its section"},
  lobe = {0.45, Name "radius of the lobes"}, waist = {0.3, Name "depth of the hollows between them"},
  room = {3.2, Name "width of the groove"}, depth = {2.1, Name "of the groove"},
  foot = {0.3, Name "radius at the groove's floor"}, edge = {0.15, Name "radius at its edges"}
];
size = 0.15 / refine;
c = width / 2;
m = inside + c; // the section's middle; its lowest points lie on the floor, at y = 0
For i In {0 : 3} // lobe i: an arc from its side to its top or bottom
  sx = (i == 0 || i == 3) ? 1 : -1;
  sy = (i < 2) ? 1 : -1;
  Point(10 + i) = {m + sx * (c - lobe), c + sy * (c - lobe), 0, size};
  Point(20 + 2 * i) = {m + sx * c, c + sy * (c - lobe), 0, size};
  Point(21 + 2 * i) = {m + sx * (c - lobe), c + sy * c, 0, size};
  Circle(20 + i) = {20 + 2 * i, 10 + i, 21 + 2 * i};
EndFor
Point(30) = {m, width - waist, 0, size};
Point(31) = {m - c + waist, c, 0, size};
Point(32) = {m, waist, 0, size};
Point(33) = {m + c - waist, c, 0, size};
Spline(30) = {21, 30, 23};
Spline(31) = {22, 31, 24};
Spline(32) = {25, 32, 27};
Spline(33) = {26, 33, 20};
Curve Loop(1) = {20, 30, -21, 31, 22, 32, -23, 33};
Plane Surface(1) = {1};

a = m - room / 2;
b = m + room / 2;
fine = 0.05 / refine;
Point(101) = {a - 1.5, depth, 0, 6 * fine};
Point(102) = {a - edge, depth, 0, fine};
Point(103) = {a - edge, depth - edge, 0, fine};
Point(104) = {a, depth - edge, 0, fine};
Point(105) = {a, foot, 0, 2 * fine};
Point(106) = {a + foot, foot, 0, 2 * fine};
Point(107) = {a + foot, 0, 0, 2 * fine};
Point(108) = {b - foot, 0, 0, 2 * fine};
Point(109) = {b - foot, foot, 0, 2 * fine};
Point(110) = {b, foot, 0, 2 * fine};
Point(111) = {b, depth - edge, 0, fine};
Point(112) = {b + edge, depth - edge, 0, fine};
Point(113) = {b + edge, depth, 0, fine};
Point(114) = {b + 1.5, depth, 0, 6 * fine};
Line(101) = {101, 102};
Circle(102) = {102, 103, 104};
Line(103) = {104, 105};
Circle(104) = {105, 106, 107};
Line(105) = {107, 108};
Circle(106) = {108, 109, 110};
Line(107) = {110, 111};
Circle(108) = {111, 112, 113};
Line(109) = {113, 114};
Point(121) = {a - 1.5, width, 0, 4 * fine};
Point(122) = {b + 1.5, width, 0, 4 * fine};
Line(121) = {121, 122};

Physical Surface("ring") = {1};
Physical Curve("skin") = {20 : 23, 30 : 33};
Physical Curve("groove") = {101 : 109};
Physical Curve("lid") = {121};
