// Half of a sheet on a die with an edge of radius 1 mm, below a punch with a nose of radius 1.5 mm; both have flanks of
// 45 degrees. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
Point(1) = {0, 0, 0}; Point(2) = {20, 0, 0}; Point(3) = {20, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = Round(60 * refine) + 1; Transfinite Curve{2, 4} = Round(4 * refine) + 1;
Transfinite Surface{1}; Recombine Surface{1};
s = Sqrt(2) / 2; e = 12; n = 1.5;
Point(11) = {30, 0, 0}; Point(12) = {e, 0, 0}; Point(13) = {e, -1, 0}; Point(14) = {e - s, -1 + s, 0};
Point(15) = {0, -1 + s - (e - s), 0};
Line(11) = {11, 12}; Circle(12) = {12, 13, 14}; Line(13) = {14, 15};
Point(21) = {0, 1, 0}; Point(22) = {0, 1 + n, 0}; Point(23) = {n * s, 1 + n * (1 - s), 0};
Point(24) = {12, 1 + n * (1 - s) + 12 - n * s, 0};
Circle(21) = {21, 22, 23}; Line(22) = {23, 24};
MeshSize{11, 12, 14, 15, 21, 23, 24} = 0.3 / refine;
Physical Surface("sheet") = {1};
Physical Curve("middle") = {4};
Physical Curve("lower") = {1};
Physical Curve("upper") = {3};
Physical Curve("die") = {11, 12, 13};
Physical Curve("punch") = {21, 22};
