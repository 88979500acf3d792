// A rubber sheet over the rounded edge of a table; plane. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
r = 4; t = 2; over = 20; along = 40;
n_arc = 16 * refine; fine = 0.4 / refine;
// table: upper face y = 0, edge rounded by r about (0, -r), then down at x = r
Point(1) = {-along - 5, 0, 0}; Point(2) = {0, 0, 0}; Point(3) = {r, -r, 0}; Point(4) = {r, -over - 12, 0}; Point(5) = {0, -r, 0};
Point(6) = {-along - 5, -over - 12, 0};
Line(1) = {1, 2}; Circle(2) = {2, 5, 3}; Line(3) = {3, 4}; Line(4) = {4, 6}; Line(5) = {6, 1};
Curve Loop(1) = {1 : 5}; Plane Surface(1) = {1};
MeshSize{1, 6, 4} = 3 / refine; MeshSize{2, 3, 5} = fine;
// sheet: along the table, around the edge, down
Point(11) = {-along, 0, 0}; Point(12) = {0, 0, 0}; Point(13) = {r, -r, 0}; Point(14) = {r, -over, 0};
Point(21) = {-along, t, 0}; Point(22) = {0, t, 0}; Point(23) = {r + t, -r, 0}; Point(24) = {r + t, -over, 0};
Line(11) = {11, 12}; Circle(12) = {12, 5, 13}; Line(13) = {13, 14};
Line(21) = {21, 22}; Circle(22) = {22, 5, 23}; Line(23) = {23, 24};
For i In {1 : 4}
  Line(30 + i) = {10 + i, 20 + i};
EndFor
For i In {1 : 3}
  Curve Loop(10 + i) = {10 + i, 31 + i, -(20 + i), -(30 + i)}; Plane Surface(10 + i) = {10 + i};
EndFor
Transfinite Curve{11, 21} = 40 * refine + 1; Transfinite Curve{12, 22} = n_arc + 1; Transfinite Curve{13, 23} = 16 * refine + 1;
Transfinite Curve{31 : 34} = 2 * refine + 1;
Transfinite Surface{11 : 13}; Recombine Surface{11 : 13};
Physical Surface("table") = {1}; Physical Surface("sheet") = {11 : 13};
Physical Curve("table_bottom") = {4, 5}; Physical Curve("table_face") = {1, 2, 3};
Physical Curve("under") = {11, 12, 13}; Physical Curve("tail") = {31}; Physical Curve("end") = {34}; Physical Curve("top") = {21};
