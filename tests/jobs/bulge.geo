// Section of a disc of sheet, axisymmetric, x is the radius. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
R = 40; h = 1; nr = Ceil(40 * refine); nh = Ceil(2 * refine);
Point(1) = {0, 0, 0}; Point(2) = {R, 0, 0}; Point(3) = {R, h, 0}; Point(4) = {0, h, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = nr + 1; Transfinite Curve {2, 4} = nh + 1; Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("sheet") = {1}; Physical Curve("bottom") = {1}; Physical Curve("rim") = {2};
Physical Curve("top") = {3}; Physical Curve("axis") = {4};
