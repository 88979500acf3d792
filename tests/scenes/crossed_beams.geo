// Two beams of square section that cross at a right angle, edge towards edge. Lengths in mm.
DefineConstant[
  n = {3, Name "elements along a side"}, n_len = {15, Name "elements along a beam"}, side = {4, Name "of the section"},
  length = {30, Name "of a beam"}, gap = {0.1, Name "between the edges"}
];
d = side / Sqrt(2);
Point(1) = {-length / 2, 0, 0};
Point(2) = {-length / 2, -d, -d};
Point(3) = {-length / 2, 0, -2 * d};
Point(4) = {-length / 2, d, -d};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1:4};
Plane Surface(1) = {1};
Point(11) = {0, -length / 2, gap};
Point(12) = {-d, -length / 2, gap + d};
Point(13) = {0, -length / 2, gap + 2 * d};
Point(14) = {d, -length / 2, gap + d};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(11) = {11:14};
Plane Surface(11) = {11};
Transfinite Curve{1:4, 11:14} = n + 1;
Transfinite Surface{1, 11};
Recombine Surface{1, 11};
lower[] = Extrude {length, 0, 0} { Surface{1}; Layers{n_len}; Recombine; };
upper[] = Extrude {0, length, 0} { Surface{11}; Layers{n_len}; Recombine; };
Physical Volume("lower") = {lower[1]};
Physical Volume("upper") = {upper[1]};
Physical Surface("lower_ends") = {1, lower[0]};
Physical Surface("upper_ends") = {11, upper[0]};
