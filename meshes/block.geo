// A box for tests, in two halves that meet in an oblique plane so that no element need be a parallelepiped.
DefineConstant[
  lx = {1, Name "length"}, ly = {1, Name "height"}, lz = {1, Name "depth"},
  nx = {2, Name "elements along x (even)"}, ny = {2, Name "elements along y"}, nz = {2, Name "elements along z"},
  tet = {0, Name "1: tetrahedra, 0: hexahedra"},
  skew = {0.2, Name "shift of the middle plane over the height, of lx; half of it over the depth"}
];
For k In {0 : 1}
  For j In {0 : 1}
    Point(1 + 3 * j + 6 * k) = {0, j * ly, k * lz};
    Point(2 + 3 * j + 6 * k) = {lx * (0.5 + skew * (j - 0.5) + skew / 2 * (k - 0.5)), j * ly, k * lz};
    Point(3 + 3 * j + 6 * k) = {lx, j * ly, k * lz};
  EndFor
EndFor
For k In {0 : 1}
  For j In {0 : 1}
    For i In {0 : 1}
      Line(1 + i + 2 * j + 4 * k) = {1 + i + 3 * j + 6 * k, 2 + i + 3 * j + 6 * k};
      Transfinite Curve{1 + i + 2 * j + 4 * k} = nx / 2 + 1;
    EndFor
  EndFor
  For i In {0 : 2}
    Line(11 + i + 3 * k) = {1 + i + 6 * k, 4 + i + 6 * k};
    Transfinite Curve{11 + i + 3 * k} = ny + 1;
  EndFor
EndFor
For j In {0 : 1}
  For i In {0 : 2}
    Line(21 + i + 3 * j) = {1 + i + 3 * j, 7 + i + 3 * j};
    Transfinite Curve{21 + i + 3 * j} = nz + 1;
  EndFor
EndFor
For i In {0 : 2} // planes across x
  Curve Loop(1 + i) = {11 + i, 24 + i, -(14 + i), -(21 + i)};
  Plane Surface(1 + i) = {1 + i};
EndFor
For i In {0 : 1}
  For j In {0 : 1} // across y
    Curve Loop(11 + i + 2 * j) = {1 + i + 2 * j, 22 + i + 3 * j, -(5 + i + 2 * j), -(21 + i + 3 * j)};
    Plane Surface(11 + i + 2 * j) = {11 + i + 2 * j};
  EndFor
  For k In {0 : 1} // across z
    Curve Loop(21 + i + 2 * k) = {1 + i + 4 * k, 12 + i + 3 * k, -(3 + i + 4 * k), -(11 + i + 3 * k)};
    Plane Surface(21 + i + 2 * k) = {21 + i + 2 * k};
  EndFor
  Surface Loop(1 + i) = {1 + i, 2 + i, 11 + i, 13 + i, 21 + i, 23 + i};
  Volume(1 + i) = {1 + i};
EndFor
If (!tet)
  Transfinite Surface{:};
  Recombine Surface{:};
  Transfinite Volume{:};
EndIf

Physical Volume("block") = {1, 2};
Physical Surface("x_min") = {1};
Physical Surface("x_max") = {3};
Physical Surface("y_min") = {11, 12};
Physical Surface("y_max") = {13, 14};
Physical Surface("z_min") = {21, 22};
Physical Surface("z_max") = {23, 24};
Physical Point("origin") = {1};
Physical Point("end_x") = {3};
Physical Point("end_y") = {4};
