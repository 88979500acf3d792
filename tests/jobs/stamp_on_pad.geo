// A stamp over a pad, whose edges are not over nodes of the pad
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
Point(1) = {-15, -10, 0}; Point(2) = {15, -10, 0}; Point(3) = {15, 0, 0}; Point(4) = {-15, 0, 0};
Point(5) = {-5.2, 0.01, 0}; Point(6) = {4.8, 0.01, 0}; Point(7) = {4.8, 8, 0}; Point(8) = {-5.2, 8, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Curve Loop(2) = {5:8}; Plane Surface(2) = {2};
Transfinite Curve{1, 3} = Round(60 * refine) + 1;
Transfinite Curve{2, 4} = Round(20 * refine) + 1;
Transfinite Curve{5, 7} = Round(16 * refine) + 1;
Transfinite Curve{6, 8} = Round(12 * refine) + 1;
Transfinite Surface "*"; Recombine Surface "*";
Physical Surface("pad") = {1}; Physical Surface("stamp") = {2};
Physical Curve("bottom") = {1}; Physical Curve("top") = {3}; Physical Curve("face") = {5, 6, 8}; Physical Curve("grip") = {7};
