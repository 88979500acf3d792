// Three rubber balls in a column, axisymmetric: the lower and the upper one are cut at their equators. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
R = 10;          // radius of each
fine = 0.14 / refine;     // element size where the balls touch, lower and upper one
fine_middle = 0.11 / refine;
coarse = 2 / refine;      // elsewhere
touch = 8 * Pi / 180;  // angle from the pole up to which the mesh is fine

// lower half, its pole at the origin
Point(1) = {0, -R, 0, coarse};
Point(2) = {R, -R, 0, coarse};
Point(3) = {R * Sin(touch), -R + R * Cos(touch), 0, fine};
Point(4) = {0, 0, 0, fine};
Line(1) = {1, 2};
Circle(2) = {2, 1, 3};
Circle(3) = {3, 1, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

// middle one
Point(11) = {0, R, 0, coarse};
Point(12) = {0, 0, 0, fine_middle};
Point(13) = {R * Sin(touch), R - R * Cos(touch), 0, fine_middle};
Point(14) = {R, R, 0, coarse};
Point(15) = {R * Sin(touch), R + R * Cos(touch), 0, fine_middle};
Point(16) = {0, 2 * R, 0, fine_middle};
Circle(11) = {12, 11, 13};
Circle(12) = {13, 11, 14};
Circle(13) = {14, 11, 15};
Circle(14) = {15, 11, 16};
Line(15) = {16, 11};
Line(16) = {11, 12};
Curve Loop(2) = {11, 12, 13, 14, 15, 16};
Plane Surface(2) = {2};

// upper half
Point(21) = {0, 3 * R, 0, coarse};
Point(22) = {0, 2 * R, 0, fine};
Point(23) = {R * Sin(touch), 3 * R - R * Cos(touch), 0, fine};
Point(24) = {R, 3 * R, 0, coarse};
Circle(21) = {22, 21, 23};
Circle(22) = {23, 21, 24};
Line(23) = {24, 21};
Line(24) = {21, 22};
Curve Loop(3) = {21, 22, 23, 24};
Plane Surface(3) = {3};

Physical Surface("lower") = {1};
Physical Surface("middle") = {2};
Physical Surface("upper") = {3};
Physical Curve("base") = {1};
Physical Curve("lower_skin") = {2, 3};
Physical Curve("middle_south") = {11, 12};
Physical Curve("middle_north") = {13, 14};
Physical Curve("upper_skin") = {21, 22};
Physical Curve("top") = {23};
Physical Curve("axis") = {4, 15, 16, 24};
