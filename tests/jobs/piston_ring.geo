// PTFE piston ring in its groove, axisymmetric
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.25/refine; c = 1.2/refine; q = 0.3;
x0 = 37; x1 = 39.95; y0 = 0.1; y1 = 2.1;
Point(1) = {x0 + q, y0, 0, h}; Point(2) = {x1 - q, y0, 0, h}; Point(3) = {x1, y0 + q, 0, h}; Point(4) = {x1, y1 - q, 0, h};
Point(5) = {x1 - q, y1, 0, h}; Point(6) = {x0 + q, y1, 0, h}; Point(7) = {x0, y1 - q, 0, h}; Point(8) = {x0, y0 + q, 0, h};
Point(9) = {x0 + q, y0 + q, 0, h}; Point(10) = {x1 - q, y0 + q, 0, h}; Point(11) = {x1 - q, y1 - q, 0, h}; Point(12) = {x0 + q, y1 - q, 0, h};
Line(1) = {1, 2}; Circle(2) = {2, 10, 3}; Line(3) = {3, 4}; Circle(4) = {4, 11, 5}; Line(5) = {5, 6}; Circle(6) = {6, 12, 7}; Line(7) = {7, 8}; Circle(8) = {8, 9, 1};
Curve Loop(1) = {1:8}; Plane Surface(1) = {1};
// piston
Point(20) = {30, -6, 0, c}; Point(21) = {39.7, -6, 0, c}; Point(22) = {39.7, 0, 0, h}; Point(23) = {36, 0, 0, h}; Point(24) = {36, 2.3, 0, h}; Point(25) = {39.7, 2.3, 0, h}; Point(26) = {39.7, 6, 0, c}; Point(27) = {30, 6, 0, c};
For i In {0:7}
 Line(20+i) = {20+i, 20+(i+1)%8};
EndFor
Curve Loop(2) = {20:27}; Plane Surface(2) = {2};
Point(40) = {40, -6, 0, 2*h}; Point(41) = {44, -6, 0, c}; Point(42) = {44, 6, 0, c}; Point(43) = {40, 6, 0, 2*h};
For i In {0:3}
 Line(40+i) = {40+i, 40+(i+1)%4};
EndFor
Curve Loop(3) = {40:43}; Plane Surface(3) = {3};
Physical Surface("ring") = {1}; Physical Surface("piston") = {2}; Physical Surface("liner") = {3};
Physical Curve("ring_under") = {8, 1, 2}; Physical Curve("ring_face") = {2, 3, 4}; Physical Curve("ring_gas") = {5, 6, 7};
Physical Curve("ring_skin") = {1:8};
Physical Curve("land") = {22}; Physical Curve("wall") = {43}; Physical Curve("piston_in") = {27}; Physical Curve("liner_out") = {41};
Physical Curve("groove") = {22, 23, 24};
