// A shaft of radius 10.02 with a chamfer is pushed into a hub with a bore of radius 10; axisymmetric, mm
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.8/refine;
Point(1) = {0, 20.5, 0, 2*h}; Point(2) = {9.5, 20.5, 0, h}; Point(3) = {10.02, 22.5, 0, h};
Point(4) = {10.02, 50, 0, 2*h}; Point(5) = {0, 50, 0, 3*h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1};
Curve Loop(1) = {1:5}; Plane Surface(1) = {1};
Point(11) = {10, 0, 0, h}; Point(12) = {25, 0, 0, 3*h}; Point(13) = {25, 20, 0, 3*h}; Point(14) = {11, 20, 0, h};
Point(15) = {10, 19, 0, h}; Point(16) = {11, 19, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Circle(14) = {14, 16, 15}; Line(15) = {15, 11};
Curve Loop(2) = {11:15}; Plane Surface(2) = {2};
Physical Surface("shaft") = {1}; Physical Surface("hub") = {2};
Physical Curve("journal") = {1, 2, 3}; Physical Curve("head") = {4}; Physical Curve("axis") = {5};
Physical Curve("bottom") = {11}; Physical Curve("bore") = {13, 14, 15};
