// A brake drum (a ring) and a block whose lining is outside of it, over 50 degrees
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 2.5/refine; l = 1.5/refine; c = 3/refine;
Point(1) = {0, 0, 0};
Point(2) = {50, 0, 0, h}; Point(3) = {0, 50, 0, h}; Point(4) = {-50, 0, 0, h}; Point(5) = {0, -50, 0, h};
Point(6) = {42, 0, 0, h}; Point(7) = {0, 42, 0, h}; Point(8) = {-42, 0, 0, h}; Point(9) = {0, -42, 0, h};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Circle(5) = {6, 1, 7}; Circle(6) = {7, 1, 8}; Circle(7) = {8, 1, 9}; Circle(8) = {9, 1, 6};
Curve Loop(1) = {1:4}; Curve Loop(2) = {5:8}; Plane Surface(1) = {1, 2};
a = 25*Pi/180; r = 50.2; R = 58;
Point(20) = {0, 0.2, 0};
Point(21) = {r*Sin(a), r*Cos(a)+0.2, 0, l}; Point(22) = {-r*Sin(a), r*Cos(a)+0.2, 0, l};
Point(23) = {-r*Sin(a)-1, 68, 0, c}; Point(24) = {r*Sin(a)+1, 68, 0, c};
Circle(21) = {21, 20, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21};
Curve Loop(3) = {21:24}; Plane Surface(2) = {3};
Physical Surface("drum") = {1}; Physical Surface("block") = {2};
Physical Curve("rim") = {1:4}; Physical Curve("hub") = {5:8};
Physical Curve("lining") = {21}; Physical Curve("top") = {23}; Physical Curve("side") = {22};
