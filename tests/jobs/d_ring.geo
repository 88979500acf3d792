// The meridian plane of a D-ring in a groove with rounded corners, under a lid; x = r, y = z. Groove and lid are curves.
// Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
size = 0.25 / refine; wall = 0.877 / refine; w = 3.2; h = 3.6; r = 25; d = 2.9; foot = 0.3;
Point(1) = {r, 0, 0, size}; Point(2) = {r + w, 0, 0, size};
Point(3) = {r + w, h - w / 2, 0, size}; Point(4) = {r + w / 2, h - w / 2, 0, size}; Point(5) = {r, h - w / 2, 0, size};
Point(6) = {r + w / 2, h, 0, size};
Line(1) = {1, 2}; Line(2) = {2, 3}; Circle(3) = {3, 4, 6}; Circle(4) = {6, 4, 5}; Line(5) = {5, 1};
Curve Loop(1) = {1 : 5}; Plane Surface(1) = {1};
a = r - 0.4; b = r + w + 0.4;
Point(11) = {a - 2, d, 0, wall}; Point(12) = {a, d, 0, wall}; Point(13) = {a, foot, 0, wall}; Point(14) = {a + foot, foot, 0, wall}; Point(15) = {a + foot, 0, 0, wall};
Point(16) = {b - foot, 0, 0, wall}; Point(17) = {b - foot, foot, 0, wall}; Point(18) = {b, foot, 0, wall}; Point(19) = {b, d, 0, wall}; Point(20) = {b + 2, d, 0, wall};
Line(11) = {11, 12}; Line(12) = {12, 13}; Circle(13) = {13, 14, 15}; Line(14) = {15, 16}; Circle(15) = {16, 17, 18};
Line(16) = {18, 19}; Line(17) = {19, 20};
Point(21) = {a - 2, h, 0, wall}; Point(22) = {b + 2, h, 0, wall}; Line(21) = {21, 22};
Physical Surface("ring") = {1};
Physical Curve("skin") = {1 : 5};
Physical Curve("groove") = {11 : 17};
Physical Curve("lid") = {21};
