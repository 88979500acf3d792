// Section of a hollow ball, a quarter about the axis x = 0. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
a = 10; b = 20; n = Ceil(8 * refine);
Point(1) = {0, 0, 0}; Point(2) = {a, 0, 0}; Point(3) = {b, 0, 0}; Point(4) = {0, b, 0}; Point(5) = {0, a, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = n + 1; Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("ball") = {1};
Physical Curve("bore") = {4}; Physical Curve("axis") = {3}; Physical Curve("middle") = {1};
