// A foundation of 12 x 4 and on it a punch that is 1.2 wide and 1.2 high, with an arc of radius 0.75 at its bottom, which is
// 0.3 deep. The arc touches the foundation at x = 1. The punch's sides meet the arc in corners of 143 degrees.
DefineConstant[
  n = {4, Name "elements per unit of length along the foundation, twice as many over the upper half of its height"},
  sole = {8, Name "elements along the arc over n / 4"}
];
Point(1) = {0, -4, 0}; Point(2) = {12, -4, 0}; Point(3) = {12, -2, 0}; Point(4) = {12, 0, 0}; Point(5) = {0, 0, 0}; Point(6) = {0, -2, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1}; Line(7) = {6, 3};
Curve Loop(1) = {1, 2, -7, 6}; Plane Surface(1) = {1};
Curve Loop(2) = {7, 3, 4, 5}; Plane Surface(2) = {2};
Transfinite Curve{1, 4, 7} = 12 * n + 1;
Transfinite Curve{2, 6} = n + 1;
Transfinite Curve{3, 5} = 2 * n + 1;
x = 1; r = 0.75; w = 0.6; h = r - Sqrt(r * r - w * w); top = 1.2;
Point(10) = {x, r, 0}; Point(11) = {x - w, h, 0}; Point(12) = {x + w, h, 0}; Point(13) = {x + w, top, 0}; Point(14) = {x - w, top, 0};
Circle(11) = {11, 10, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14}; Plane Surface(3) = {3};
m = Round(sole * n / 4);
Transfinite Curve{11, 13} = m + 1;
Transfinite Curve{12, 14} = Ceil(m * 0.75) + 1;
Transfinite Surface{:}; Recombine Surface{:};
Physical Surface("foundation") = {1, 2}; Physical Surface("punch") = {3};
Physical Curve("foundation_bottom") = {1}; Physical Curve("foundation_top") = {4};
Physical Curve("punch_sole") = {11}; Physical Curve("punch_skin") = {11, 12, 14}; Physical Curve("punch_top") = {13};
