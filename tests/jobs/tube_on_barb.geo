// A soft tube above a hose nipple with two barbs, axisymmetric: x = r, y = z. The barbs' edges are rounded. Lengths in
// mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  bore = {4, Name "radius of the tube's bore"}, wall = {2, Name "thickness of the tube"}, length = {24, Name "of the tube"},
  start = {22.6, Name "height of the tube's end over the nipple's base"},
  barb = {5, Name "radius of the barbs' edges, before they are rounded"}, round = {0.5, Name "radius of the edges"}
];
fine = 0.12 / refine;
middle = 0.4 / refine;
Point(1) = {bore, start, 0, middle};
Point(2) = {bore + wall, start, 0, middle};
Point(3) = {bore + wall, start + length, 0, 2 * middle};
Point(4) = {bore, start + length, 0, 2 * middle};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Transfinite Curve{1, 3} = Round(6 * refine) + 1;
Transfinite Curve{2, 4} = Round(96 * refine) + 1;
Curve Loop(1) = {1 : 4};
Plane Surface(1) = {1};
Transfinite Surface{1};
Recombine Surface{1};

Point(11) = {2.2, 0, 0, middle};
Point(12) = {7, 0, 0, 2 * middle};
Point(13) = {7, 2, 0, 2 * middle};
Point(14) = {3.6, 2, 0, middle};
curves[] = {};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
last = 14;
For i In {0 : 1} // barb i: back face at 45 degrees from the stem, rounded edge, cone of 15 degrees
  z = 8 + 8 * i; // height of the edge
  o = 20 + 10 * i;
  back = Pi / 4; // of the back face against the axis
  front = 13 * Pi / 180; // of the cone against the axis
  half = (Pi - back - front) / 2;
  d = round / Tan(half);
  bx = -Sin(back) - Sin(front);
  bz = Cos(front) - Cos(back);
  bn = Sqrt(bx^2 + bz^2);
  Point(o) = {3.6, z - (barb - 3.6) / Tan(back), 0, middle};
  Point(o + 1) = {barb - d * Sin(back), z - d * Cos(back), 0, fine};
  Point(o + 2) = {barb + round / Sin(half) * bx / bn, z + round / Sin(half) * bz / bn, 0, fine};
  Point(o + 3) = {barb - d * Sin(front), z + d * Cos(front), 0, fine};
  Point(o + 4) = {3.6, z + (barb - 3.6) / Tan(front), 0, middle};
  Line(o) = {last, o};
  Line(o + 1) = {o, o + 1};
  Circle(o + 2) = {o + 1, o + 2, o + 3};
  Line(o + 3) = {o + 3, o + 4};
  curves[] += {o, o + 1, o + 2, o + 3};
  last = o + 4;
EndFor
Point(41) = {2.2, 16 + (barb - 3.6) / Tan(front), 0, middle};
Line(41) = {last, 41};
Line(42) = {41, 11};
Curve Loop(2) = {11, 12, 13, curves[], 41, 42};
Plane Surface(2) = {2};

Physical Surface("tube") = {1};
Physical Surface("nipple") = {2};
Physical Curve("tube_inside") = {1, 4}; // with its end face
Physical Curve("tube_top") = {3};
Physical Curve("nipple_skin") = {curves[]};
Physical Curve("nipple_base") = {11};
