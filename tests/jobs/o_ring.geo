// An O-ring in a rectangular groove with rounded corners, closed by a lid; axisymmetric, x = r, y = z. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
fine = 0.25 / refine; coarse = 1.2 / refine;
R = 2.65; rm = 20; depth = 4; width = 7; round = 0.6;
Point(1) = {rm, R, 0, fine}; // cord, resting on the groove's bottom at y = 0
Point(2) = {rm + R, R, 0, fine}; Point(3) = {rm, 2*R, 0, fine}; Point(4) = {rm - R, R, 0, fine}; Point(5) = {rm, 0, 0, fine};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
a = rm - R; b = a + width; // the inner wall touches the cord
Point(11) = {a - 4, -4, 0, coarse}; Point(12) = {b + 4, -4, 0, coarse};
Point(13) = {b + 4, depth, 0, coarse}; Point(14) = {b + round, depth, 0, fine};
Point(15) = {b + round, depth - round, 0}; Point(16) = {b, depth - round, 0, fine};
Point(17) = {b, round, 0, fine}; Point(18) = {b - round, round, 0}; Point(19) = {b - round, 0, 0, fine};
Point(20) = {a + round, 0, 0, fine}; Point(21) = {a + round, round, 0}; Point(22) = {a, round, 0, fine};
Point(23) = {a, depth - round, 0, fine}; Point(24) = {a - round, depth - round, 0}; Point(25) = {a - round, depth, 0, fine};
Point(26) = {a - 4, depth, 0, coarse};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Circle(14) = {14, 15, 16}; Line(15) = {16, 17};
Circle(16) = {17, 18, 19}; Line(17) = {19, 20}; Circle(18) = {20, 21, 22}; Line(19) = {22, 23}; Circle(20) = {23, 24, 25};
Line(21) = {25, 26}; Line(22) = {26, 11};
Curve Loop(2) = {11 : 22}; Plane Surface(2) = {2};
Point(31) = {a - 1, 2*R, 0, fine}; Point(32) = {b + 1, 2*R, 0, fine}; Point(33) = {b + 1, 2*R + 3, 0, coarse}; Point(34) = {a - 1, 2*R + 3, 0, coarse};
Line(31) = {31, 32}; Line(32) = {32, 33}; Line(33) = {33, 34}; Line(34) = {34, 31};
Curve Loop(3) = {31 : 34}; Plane Surface(3) = {3};
Physical Surface("ring") = {1}; Physical Surface("groove") = {2}; Physical Surface("lid") = {3};
Physical Curve("ring_skin") = {1 : 4}; Physical Curve("groove_wall") = {14 : 20}; Physical Curve("groove_base") = {11};
Physical Curve("lid_face") = {31}; Physical Curve("lid_top") = {33};
