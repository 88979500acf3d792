// A slab of 12 x 4 mm, and on it a tool that is 2.4 mm wide with an arc of radius 1.75 at its bottom
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
n_slab = 3 * Round(12 * refine); n_tool = 2 * Round(4 * refine);
Point(1) = {0, 0, 0}; Point(2) = {12, 0, 0}; Point(3) = {12, 4, 0}; Point(4) = {0, 4, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = n_slab + 1; Transfinite Curve{2, 4} = n_slab/3 + 1; Transfinite Surface{1}; Recombine Surface{1};
x = 2.5; r = 1.75; h = Sqrt(r*r - 1.2*1.2);
Point(10) = {x, 4 + r, 0}; Point(11) = {x - 1.2, 4 + r - h, 0}; Point(12) = {x + 1.2, 4 + r - h, 0};
Point(13) = {x + 1.2, 4 + 2.2, 0}; Point(14) = {x - 1.2, 4 + 2.2, 0};
Circle(11) = {11, 10, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Transfinite Curve{11, 13} = n_tool + 1; Transfinite Curve{12, 14} = n_tool/2 + 1; Transfinite Surface{2}; Recombine Surface{2};
Physical Surface("slab") = {1}; Physical Surface("tool") = {2};
Physical Curve("slab_bottom") = {1}; Physical Curve("slab_top") = {3};
Physical Curve("tool_sole") = {11}; Physical Curve("tool_top") = {13};
