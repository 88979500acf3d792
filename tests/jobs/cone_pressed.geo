// A blunt rigid cone on a rubber block as large as a half-space, axisymmetric: x = r, y = z, the axis at x = 0. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  flank = {5, Name "angle of the cone's flank to the block, degrees"},
  size = {60, Name "radius and height of the block"}
];
fine = 0.025 / refine;
coarse = 0.1 * size / refine;
slope = Tan(flank * Pi / 180);
Point(1) = {0, 0, 0, fine};
Point(2) = {0.6, 0.6 * slope, 0, fine};
Line(1) = {1, 2};
Point(11) = {0, -size, 0, coarse};
Point(12) = {size, -size, 0, coarse};
Point(13) = {size, 0, 0, coarse};
Point(14) = {0.6, 0, 0, fine};
Point(15) = {0, 0, 0, fine};
Point(16) = {0, -0.6, 0, 1.5*fine};
For i In {11 : 15}
  Line(i) = {i, i + 1};
EndFor
Line(16) = {16, 11};
Curve Loop(2) = {11 : 16};
Plane Surface(2) = {2};
Physical Surface("block") = {2};
Physical Curve("cone") = {1};
Physical Curve("top") = {14};
Physical Curve("axis") = {15, 16};
Physical Curve("foot") = {11};
