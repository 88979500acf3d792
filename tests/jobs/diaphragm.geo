// A rubber diaphragm above a plate with a hole; x = r, y = z. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
R = 25; t = 2; gap = 4; hole = 5; edge = 1;
nt = Ceil(3 * refine); nl = Ceil(40 * refine);
Point(1) = {0, 0, 0}; Point(2) = {R, 0, 0}; Point(3) = {R, t, 0}; Point(4) = {0, t, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = nl + 1; Transfinite Curve{2, 4} = nt + 1; Transfinite Surface{1};
Recombine Surface{1};
Point(11) = {hole, -gap - 6, 0}; Point(12) = {hole, -gap - edge, 0}; Point(13) = {hole + edge, -gap - edge, 0};
Point(14) = {hole + edge, -gap, 0}; Point(15) = {R + 1, -gap, 0};
Line(11) = {11, 12}; Circle(12) = {12, 13, 14}; Line(13) = {14, 15};
Transfinite Curve{11} = Ceil(10 * refine) + 1; Transfinite Curve{12} = Ceil(8 * refine) + 1; Transfinite Curve{13} = Ceil(20 * refine) + 1;
Physical Surface("rubber") = {1};
Physical Curve("below") = {1}; Physical Curve("rim") = {2}; Physical Curve("above") = {3}; Physical Curve("axis") = {4};
Physical Curve("plate") = {11 : 13};
