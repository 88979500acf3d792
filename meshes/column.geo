// A square column along z, solid or with a square bore. Lengths in mm.
DefineConstant[
  n_side = {4, Name "elements across"}, n_len = {60, Name "elements along"},
  side = {10, Name "of the section"}, length = {120, Name "of the column"},
  bore = {0, Name "side of the bore; 0: none"}, n_wall = {2, Name "elements through the wall beside the bore"}
];
Point(1) = {-side / 2, -side / 2, 0};
Point(2) = {side / 2, -side / 2, 0};
Point(3) = {side / 2, side / 2, 0};
Point(4) = {-side / 2, side / 2, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Transfinite Curve{1:4} = n_side + 1;
If (bore == 0)
  Curve Loop(1) = {1:4};
  Plane Surface(1) = {1};
  foot[] = {1};
Else
  Point(5) = {-bore / 2, -bore / 2, 0};
  Point(6) = {bore / 2, -bore / 2, 0};
  Point(7) = {bore / 2, bore / 2, 0};
  Point(8) = {-bore / 2, bore / 2, 0};
  Line(5) = {5, 6};  Line(6) = {6, 7};  Line(7) = {7, 8};  Line(8) = {8, 5};
  Line(9) = {1, 5};  Line(10) = {2, 6};  Line(11) = {3, 7};  Line(12) = {4, 8};
  Transfinite Curve{5:8} = n_side + 1;
  Transfinite Curve{9:12} = n_wall + 1;
  Curve Loop(1) = {1, 10, -5, -9};
  Curve Loop(2) = {2, 11, -6, -10};
  Curve Loop(3) = {3, 12, -7, -11};
  Curve Loop(4) = {4, 9, -8, -12};
  For i In {1 : 4}
    Plane Surface(i) = {i};
  EndFor
  foot[] = {1:4};
EndIf
Transfinite Surface{foot[]};
Recombine Surface{foot[]};
column[] = {};
head[] = {};
sides[] = {};
For i In {0 : #foot[] - 1}
  out[] = Extrude {0, 0, length} { Surface{foot[i]}; Layers{n_len}; Recombine; };
  column[] += {out[1]};
  head[] += {out[0]};
  If (bore == 0)
    sides[] = {out[2], out[3], out[4], out[5]};
  Else
    sides[] += {out[2], out[4]};
  EndIf
EndFor
Physical Volume("column") = {column[]};
Physical Surface("foot") = {foot[]};
Physical Surface("head") = {head[]};
Physical Surface("sides") = {sides[]};
