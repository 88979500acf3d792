// A taper pin of 3 degrees above its hole in a hub; axisymmetric. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
a = 3*Pi/180; n = Round(16*refine); k = Round(5*refine);
Point(1) = {0, 2, 0}; Point(2) = {5 + 2*Tan(a), 2, 0}; Point(3) = {5 + 22*Tan(a), 22, 0}; Point(4) = {0, 22, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {5, 0, 0}; Point(12) = {12, 0, 0}; Point(13) = {12, 18, 0}; Point(14) = {5 + 18*Tan(a), 18, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Transfinite Curve{2, 4} = n + 1; Transfinite Curve{12, 14} = Round(18*refine) + 1; Transfinite Curve{1, 3, 11, 13} = k + 1;
Transfinite Surface{1, 2}; Recombine Surface{1, 2};
Physical Surface("pin") = {1}; Physical Surface("hub") = {2}; Physical Curve("flank") = {1, 2}; Physical Curve("bore") = {13, 14};
Physical Curve("head") = {3}; Physical Curve("axis") = {4}; Physical Curve("bottom") = {11};
