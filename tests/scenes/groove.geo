// A block in a rigid groove with a clearance at either side; plane. The three curves of the groove run in different directions.
DefineConstant[
  clearance = {0.02, Name "between block and side"}, gap = {0.05, Name "between block and floor"},
  turned = {0, Name "1: curves that all run the other way, 2: curves that run in different directions"},
  n = {6, Name "elements along the block"}, clockwise = {0, Name "1: the block's outline runs clockwise"}
];
Point(1) = {-1, 0, 0};
Point(2) = {1, 0, 0};
Point(3) = {1, 1.5, 0};
Point(4) = {-1, 1.5, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
If (clockwise)
  Curve Loop(1) = {-4, -3, -2, -1};
Else
  Curve Loop(1) = {1, 2, 3, 4};
EndIf
Plane Surface(1) = {1};
Transfinite Curve{1, 2, 3, 4} = n + 1;
Transfinite Surface{1};
Recombine Surface{1};
w = 1 + clearance;
Point(11) = {-w, 2, 0};
Point(12) = {-w, -gap, 0};
Point(13) = {w, -gap, 0};
Point(14) = {w, 2, 0};
If (turned == 0)
  Line(11) = {12, 11};
  Line(12) = {13, 12};
  Line(13) = {14, 13};
ElseIf (turned == 1)
  Line(11) = {11, 12};
  Line(12) = {12, 13};
  Line(13) = {13, 14};
Else
  Line(11) = {11, 12};
  Line(12) = {13, 12};
  Line(13) = {13, 14};
EndIf
Transfinite Curve{11, 12, 13} = 2 * n + 2;
Physical Surface("block") = {1};
Physical Curve("skin") = {1, 2, 4};
Physical Curve("top") = {3};
Physical Curve("groove") = {11, 12, 13};
