// The meridian plane of a pipe's flange on a soft gasket, half of the joint; x = r, y = z. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 1 / refine;
Point(1) = {50, 0, 0, h}; Point(2) = {68, 0, 0, h}; Point(3) = {68, 2, 0, h}; Point(4) = {50, 2, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
Point(11) = {50, 2, 0, 1.5 * h}; Point(12) = {100, 2, 0, 4 * h}; Point(13) = {100, 20, 0, 4 * h};
Point(14) = {60, 20, 0, 4 * h}; Point(15) = {56, 60, 0, 4 * h}; Point(16) = {50, 60, 0, 4 * h};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 16}; Line(16) = {16, 11};
Curve Loop(2) = {11 : 16}; Plane Surface(2) = {2};
Physical Surface("gasket") = {1}; Physical Surface("flange") = {2};
Physical Curve("middle") = {1}; Physical Curve("gasket_outer") = {2}; Physical Curve("gasket_top") = {3};
Physical Curve("gasket_inner") = {4};
Physical Curve("face") = {11}; Physical Curve("rim") = {12}; Physical Curve("back") = {13}; Physical Curve("pipe_end") = {15};
Physical Curve("bore") = {16};
