// A C-shaped clip with legs and lips, pushed from above over a rod of radius 5
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.5/refine; c = 2/refine;
// rod
Point(1) = {0, 0, 0}; Point(2) = {5, 0, 0, h}; Point(3) = {0, 5, 0, h}; Point(4) = {-5, 0, 0, h};
Point(5) = {0, -5, 0, h};
Point(6) = {2, 0, 0, c}; Point(7) = {0, 2, 0, c}; Point(8) = {-2, 0, 0, c}; Point(9) = {0, -2, 0, c};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Circle(5) = {6, 1, 7}; Circle(6) = {7, 1, 8}; Circle(7) = {8, 1, 9}; Circle(8) = {9, 1, 6};
Curve Loop(1) = {1:4}; Curve Loop(2) = {5:8}; Plane Surface(1) = {1, 2};
// clip: centre (0, 9), inner radius 4.9, outer 6.4, open below by 2*50 degrees, tips rounded
y = 9.4; a = 40*Pi/180; r = 4.9; R = 6.4; m = (r + R)/2; q = (R - r)/2;
Point(20) = {0, y, 0};
Point(21) = { r*Sin(a), y - r*Cos(a), 0, h}; Point(22) = { r, y, 0, h}; Point(23) = {0, y + r, 0, h};
Point(24) = {-r, y, 0, h}; Point(25) = {-r*Sin(a), y - r*Cos(a), 0, h};
Point(31) = { R*Sin(a), y - R*Cos(a), 0, h}; Point(32) = { R, y, 0, h}; Point(33) = {0, y + R, 0, h};
Point(34) = {-R, y, 0, h}; Point(35) = {-R*Sin(a), y - R*Cos(a), 0, h};
Point(41) = { m*Sin(a), y - m*Cos(a), 0}; Point(45) = {-m*Sin(a), y - m*Cos(a), 0};
Point(46) = { m*Sin(a) - q*Cos(a), y - m*Cos(a) - q*Sin(a), 0, h};
Point(47) = {-m*Sin(a) + q*Cos(a), y - m*Cos(a) - q*Sin(a), 0, h};
Point(50) = {2, y + R - 0.32, 0, h}; Point(51) = {2, y + 10, 0, c}; Point(52) = {-2, y + 10, 0, c};
Point(53) = {-2, y + R - 0.32, 0, h};
yy = Sqrt(R*R - 4); Point(54) = {2, y + yy, 0, h}; Point(55) = {-2, y + yy, 0, h};
Circle(21) = {21, 20, 22}; Circle(22) = {22, 20, 23}; Circle(23) = {23, 20, 24}; Circle(24) = {24, 20, 25};
Circle(25) = {25, 45, 47}; Circle(26) = {47, 45, 35}; Circle(27) = {35, 20, 34}; Circle(28) = {34, 20, 55};
Line(29) = {55, 52}; Line(30) = {52, 51}; Line(31) = {51, 54}; Circle(32) = {54, 20, 32}; Circle(33) = {32, 20, 31};
Circle(34) = {31, 41, 46}; Circle(35) = {46, 41, 21};
Curve Loop(3) = {21:35}; Plane Surface(2) = {3};
Physical Surface("rod") = {1}; Physical Surface("clip") = {2};
Physical Curve("round") = {1:4}; Physical Curve("core") = {5:8}; Physical Curve("inside") = {21:26, 34, 35};
Physical Curve("stem") = {30};
