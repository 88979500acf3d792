// A hollow shaft that is longer than the hub around it, in the meridian.
DefineConstant[ h = 1 ];
Point(1) = {6, -1, 0, h}; Point(2) = {10, -1, 0, h}; Point(3) = {10, 7, 0, h}; Point(4) = {6, 7, 0, h};
Point(11) = {10, 0, 0, h}; Point(12) = {18, 0, 0, 2 * h}; Point(13) = {18, 6, 0, 2 * h}; Point(14) = {10, 6, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Curve Loop(2) = {11:14}; Plane Surface(2) = {2};
Physical Surface("shaft") = {1}; Physical Surface("hub") = {2};
Physical Curve("journal") = {2}; Physical Curve("bore") = {14};
Physical Curve("shaft_end") = {1}; Physical Curve("rim") = {12};
