// A cam of radius 12 with its shaft 5 mm off its centre, and over it a flat follower with a foot 24 wide
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.6/refine; c = 3/refine;
Point(1) = {5, 0, 0, h}; Point(2) = {17, 0, 0, h}; Point(3) = {5, 12, 0, h}; Point(4) = {-7, 0, 0, h};
Point(5) = {5, -12, 0, c};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Point(6) = {0, 0, 0}; Point(7) = {4, 0, 0, c}; Point(8) = {0, 4, 0, c}; Point(9) = {-4, 0, 0, c};
Point(10) = {0, -4, 0, c};
Circle(5) = {7, 6, 8}; Circle(6) = {8, 6, 9}; Circle(7) = {9, 6, 10}; Circle(8) = {10, 6, 7};
Curve Loop(1) = {1, 2, 3, 4}; Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(1) = {1, 2};
Point(11) = {-12, 12.05, 0, h}; Point(12) = {22, 12.05, 0, h}; Point(13) = {22, 16, 0, c}; Point(14) = {3, 16, 0, c};
Point(15) = {3, 30, 0, c}; Point(16) = {-3, 30, 0, c}; Point(17) = {-3, 16, 0, c}; Point(18) = {-12, 16, 0, c};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 15}; Line(15) = {15, 16};
Line(16) = {16, 17}; Line(17) = {17, 18};
Line(18) = {18, 11};
Curve Loop(3) = {11:18}; Plane Surface(2) = {3};
Physical Surface("cam") = {1}; Physical Surface("follower") = {2};
Physical Curve("rim") = {1, 2, 3, 4}; Physical Curve("shaft") = {5:8}; Physical Curve("foot") = {11};
Physical Curve("stem") = {15}; Physical Curve("guides") = {14, 16};
