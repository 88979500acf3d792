// A rubber plug and an orifice; axisymmetric
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.4/refine; R = 5.4; e = 2;
Point(1) = {0,0,0,h}; Point(2) = {R-e,0,0,h}; Point(3) = {R,e,0,h}; Point(4) = {R,10-e,0,h}; Point(5) = {R-e,10,0,h}; Point(6) = {0,10,0,h}; Point(7) = {R-e,e,0,h}; Point(8) = {R-e,10-e,0,h};
Point(9) = {2.5,10,0,h}; Point(10) = {2.5,14,0,h}; Point(11) = {0,14,0,h};
Line(1) = {1,2}; Circle(2) = {2,7,3}; Line(3) = {3,4}; Circle(4) = {4,8,5}; Line(5) = {5,9}; Line(6) = {9,10}; Line(7) = {10,11}; Line(8) = {11,1};
Curve Loop(1) = {1:8}; Plane Surface(1) = {1};
// plate with hole of radius 5, y -5..-1, edge rounded by 1
k = 0.4/refine; c = 1.5/refine; A = 5; g = 1;
Point(21) = {A+g,-0.5,0,k}; Point(22) = {A,-0.5-g,0,k}; Point(23) = {A,-5.5+g,0,k}; Point(24) = {A+g,-5.5,0,k}; Point(25) = {14,-5.5,0,c}; Point(26) = {14,-0.5,0,c}; Point(27) = {A+g,-0.5-g,0,k}; Point(28) = {A+g,-5.5+g,0,k};
Circle(21) = {21,27,22}; Line(22) = {22,23}; Circle(23) = {23,28,24}; Line(24) = {24,25}; Line(25) = {25,26}; Line(26) = {26,21};
Curve Loop(2) = {21:26}; Plane Surface(2) = {2};
Physical Surface("plug") = {1}; Physical Surface("plate") = {2};
Physical Curve("axis") = {8}; Physical Curve("push") = {7}; Physical Curve("plug_skin") = {1:5}; Physical Curve("orifice") = {21:24,26}; Physical Curve("rim") = {25};
