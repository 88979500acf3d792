// A block of 30 x 5, and on it a die 8 wide with an arc of radius 16 at its bottom, which touches the block at x = 8
DefineConstant[ n = {1, Name "elements per unit of length along the block"} ];
Point(1) = {0, -5, 0}; Point(2) = {30, -5, 0}; Point(3) = {30, 0, 0}; Point(4) = {0, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = 30 * n + 1; Transfinite Curve{2, 4} = 5 * n + 1; Transfinite Surface{1}; Recombine Surface{1};
r = 16; x = 8; w = 0.95 * 4; h = r - Sqrt(r * r - w * w);
Point(10) = {x, r, 0}; Point(11) = {x - w, h, 0}; Point(12) = {x + w, h, 0};
Point(13) = {x + 4, 3, 0}; Point(14) = {x - 4, 3, 0};
Circle(11) = {11, 10, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Transfinite Curve{11, 13} = 12 * n + 1; Transfinite Curve{12, 14} = 3 * n + 1; Transfinite Surface{2}; Recombine Surface{2};
Physical Surface("block") = {1}; Physical Surface("die") = {2};
Physical Curve("block_bottom") = {1}; Physical Curve("block_top") = {3};
Physical Curve("die_sole") = {11}; Physical Curve("die_top") = {13};
