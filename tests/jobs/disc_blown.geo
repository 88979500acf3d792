// The meridian plane of a rubber disc under a mould with rounded edges; x = r, y = z. The mould is a curve. Lengths in
// mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
size = 0.6 / refine; thick = 1.2; rim = 20; gap = 0.05;
Point(1) = {0, 0, 0}; Point(2) = {rim, 0, 0}; Point(3) = {rim, thick, 0}; Point(4) = {0, thick, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Transfinite Curve{1, 3} = Round(40 * refine) + 1;
Transfinite Curve{2, 4} = Round(2 * refine) + 1;
Curve Loop(1) = {1 : 4};
Plane Surface(1) = {1};
Transfinite Surface{1};
Recombine Surface{1};
mouth = 18; bore = 15.5; deep = 14; r = 2; foot = 3; y = thick + gap;
Point(11) = {rim + 1, y, 0, size}; Point(12) = {mouth + r, y, 0, size}; Point(13) = {mouth + r, y + r, 0, size};
Point(14) = {mouth, y + r, 0, size}; Point(15) = {bore, deep - foot, 0, size};
Point(16) = {bore - foot, deep - foot, 0, size}; Point(17) = {bore - foot, deep, 0, size}; Point(18) = {0, deep, 0, size};
Line(11) = {11, 12}; Circle(12) = {12, 13, 14}; Line(13) = {14, 15}; Circle(14) = {15, 16, 17}; Line(15) = {17, 18};
Physical Surface("disc") = {1};
Physical Curve("below") = {1};
Physical Curve("rim") = {2};
Physical Curve("above") = {3};
Physical Curve("axis") = {4};
Physical Curve("mould") = {11 : 15};
