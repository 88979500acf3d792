// A cone on a block, axisymmetric: x = r, y = z, the axis at x = 0. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  half_angle = {70.3, Name "of the cone against its axis, degrees"}
];
fine = 0.04 / refine;
coarse = 0.4 / refine;
t = half_angle * Pi / 180;
Point(1) = {0, 0, 0, fine};
Point(2) = {0.5, 0.5 / Tan(t), 0, fine};
Point(3) = {2, 2 / Tan(t), 0, coarse};
Point(4) = {2, 2, 0, coarse};
Point(5) = {0, 2, 0, coarse};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1};
Curve Loop(1) = {1:5};
Plane Surface(1) = {1};
Point(11) = {0, -4, 0, coarse};
Point(12) = {4, -4, 0, coarse};
Point(13) = {4, 0, 0, coarse};
Point(14) = {0.6, 0, 0, fine};
Point(15) = {0, 0, 0, fine};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 11};
Curve Loop(2) = {11:15};
Plane Surface(2) = {2};
Physical Surface("cone") = {1};
Physical Surface("block") = {2};
Physical Curve("flank") = {1, 2};
Physical Curve("back") = {4};
Physical Curve("axis") = {5, 15};
Physical Curve("top") = {13, 14};
Physical Curve("foot") = {11};
