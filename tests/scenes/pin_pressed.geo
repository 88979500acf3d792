// A tapered pin above a bush, axisymmetric, x is the radius. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.5 / refine;
Point(1) = {5, 0, 0}; Point(2) = {9, 0, 0}; Point(3) = {9, 10, 0}; Point(4) = {5, 10, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = Ceil(4 / h) + 1; Transfinite Curve {2, 4} = Ceil(10 / h) + 1;
Transfinite Surface {1}; Recombine Surface {1};
// The pin: taper over 2 mm, then a cylinder of radius 5.1
Point(11) = {0, 10.1, 0}; Point(12) = {4.8, 10.1, 0}; Point(13) = {5.1, 12.1, 0};
Point(14) = {5.1, 20.1, 0}; Point(15) = {0, 20.1, 0}; Point(16) = {0, 12.1, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14};
Line(14) = {14, 15}; Line(15) = {15, 16}; Line(16) = {16, 11}; Line(17) = {16, 13};
Curve Loop(2) = {11, 12, -17, 16}; Plane Surface(2) = {2};
Curve Loop(3) = {17, 13, 14, 15}; Plane Surface(3) = {3};
Transfinite Curve {11, 17, 14} = Ceil(9*refine) + 1; Transfinite Curve {12, 16} = Ceil(2 / h) + 1;
Transfinite Curve {13, 15} = Ceil(8 / h) + 1;
Transfinite Surface {2, 3}; Recombine Surface {2, 3};
Physical Surface("bush") = {1}; Physical Surface("pin") = {2, 3};
Physical Curve("bore") = {4, 3}; Physical Curve("foot") = {1};
Physical Curve("skin") = {11, 12, 13}; Physical Curve("head") = {14}; Physical Curve("axis") = {15, 16};
