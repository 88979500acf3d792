// A rectangle for tests (plane strain, or axisymmetric with x = r), in two halves that meet in an oblique line.
DefineConstant[
  lx = {1, Name "length"}, ly = {1, Name "height"},
  nx = {2, Name "elements along x (even)"}, ny = {2, Name "elements along y"},
  tri = {0, Name "1: triangles, 0: quadrilaterals"},
  skew = {0.2, Name "shift of the middle line over the height, of lx"},
  invert = {0, Name "1: the middle line crosses the right side and turns elements inside out"}
];
middle = invert ? 1.2 : 0.5;
For j In {0 : 1}
  Point(1 + 3 * j) = {0, j * ly, 0};
  Point(2 + 3 * j) = {lx * (middle + skew * (j - 0.5)), j * ly, 0};
  Point(3 + 3 * j) = {lx, j * ly, 0};
  Line(1 + 2 * j) = {1 + 3 * j, 2 + 3 * j};
  Line(2 + 2 * j) = {2 + 3 * j, 3 + 3 * j};
EndFor
For i In {0 : 2}
  Line(11 + i) = {1 + i, 4 + i};
EndFor
Curve Loop(1) = {1, 12, -3, -11};
Curve Loop(2) = {2, 13, -4, -12};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Curve{1 : 4} = nx / 2 + 1;
Transfinite Curve{11 : 13} = ny + 1;
If (!tri)
  Transfinite Surface{:};
  Recombine Surface{:};
EndIf

Physical Surface("block") = {1, 2};
Physical Curve("x_min") = {11};
Physical Curve("x_max") = {13};
Physical Curve("y_min") = {1, 2};
Physical Curve("y_max") = {3, 4};
Physical Point("origin") = {1};
Physical Point("end_x") = {3};
