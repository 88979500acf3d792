// Half of a wedge on half of a block, in the plane: x = 0 is the plane of symmetry. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  half_angle = {50, Name "of the wedge against its plane of symmetry, degrees"}
];
fine = 0.08 / refine;
coarse = 0.8 / refine;
slope = 1 / Tan(half_angle * Pi / 180);
Point(1) = {0, 0, 0, fine};
Point(2) = {1, slope, 0, fine};
Point(3) = {4, 4 * slope, 0, coarse};
Point(4) = {4, 6, 0, coarse};
Point(5) = {0, 6, 0, coarse};
Point(11) = {0, -8, 0, coarse};
Point(12) = {8, -8, 0, coarse};
Point(13) = {8, 0, 0, coarse};
Point(14) = {1, 0, 0, fine};
Point(15) = {0, 0, 0, fine};
For i In {1 : 4}
  Line(i) = {i, i + 1};
  Line(10 + i) = {10 + i, 11 + i};
EndFor
Line(5) = {5, 1};
Line(15) = {15, 11};
Curve Loop(1) = {1 : 5};
Plane Surface(1) = {1};
Curve Loop(2) = {11 : 15};
Plane Surface(2) = {2};
Physical Surface("wedge") = {1};
Physical Surface("block") = {2};
Physical Curve("flank") = {1, 2};
Physical Curve("back") = {4};
Physical Curve("symmetry") = {5, 15};
Physical Curve("top") = {13, 14};
Physical Curve("foot") = {11};
