// A wiper lip turned inside out by a plunger, axisymmetric
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.3/refine; 
// lip: root at radius 14, points inward and down, 45 degrees, 1.2 thick
Point(1) = {14, 0, 0, h}; Point(2) = {9, -3, 0, h}; Point(3) = {8.7, -2.1, 0, h}; Point(4) = {14, 1.4, 0, h}; Point(5) = {16,1.4,0,2*h}; Point(6) = {16,0,0,2*h};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,5}; Line(5) = {5,6}; Line(6) = {6,1};
Curve Loop(1) = {1:6}; Plane Surface(1) = {1};
// plunger with a round nose, below
Point(11) = {0,-14,0,2*h}; Point(12) = {10.5,-14,0,h}; Point(13) = {10.5,-7,0,h}; Point(14) = {7.5,-4,0,h}; Point(15) = {7.5,-7,0,h}; Point(16) = {0,-4,0,2*h};
Line(11) = {11,12}; Line(12) = {12,13}; Circle(13) = {13,15,14}; Line(14) = {14,16}; Line(15) = {16,11};
Curve Loop(2) = {11:15}; Plane Surface(2) = {2};
Physical Surface("lip") = {1}; Physical Surface("plunger") = {2};
Physical Curve("lip_skin") = {1,2,3}; Physical Curve("root") = {5}; Physical Curve("plunger_skin") = {12,13,14}; Physical Curve("plunger_end") = {11}; Physical Curve("axis") = {15};
