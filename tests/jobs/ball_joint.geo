// A ball stud before a socket with a bead; axisymmetric, x is the radius. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
ball = 6; neck = 2.5; bore = 6.35; bead = 0.7; wall = 2.5; way = 8;
up = Sqrt(ball^2 - neck^2);
Point(1) = {0, 0, 0}; Point(2) = {0, -ball, 0}; Point(3) = {ball, 0, 0}; Point(4) = {neck, up, 0};
Point(5) = {neck, 14, 0}; Point(6) = {0, 14, 0};
Line(1) = {1, 2}; Circle(2) = {2, 1, 3}; Circle(3) = {3, 1, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Curve Loop(1) = {1 : 6}; Plane Surface(1) = {1};
Point(10) = {bore, -way, 0}; Point(11) = {bore, -way + bead, 0}; Point(12) = {bore - bead, -way, 0};
Point(13) = {bore, -way - bead, 0}; Point(14) = {bore, -way - 8, 0}; Point(15) = {bore + wall, -way - 8, 0};
Point(16) = {bore + wall, -way + 2, 0}; Point(17) = {bore, -way + 2, 0};
Line(10) = {17, 11}; Circle(11) = {11, 10, 12}; Circle(12) = {12, 10, 13}; Line(13) = {13, 14}; Line(14) = {14, 15};
Line(15) = {15, 16}; Line(16) = {16, 17};
Curve Loop(2) = {10 : 16}; Plane Surface(2) = {2};
Physical Surface("stud") = {1}; Physical Surface("socket") = {2};
Physical Curve("ball") = {2, 3}; Physical Curve("inside") = {10 : 13}; Physical Curve("axis") = {1, 6};
Physical Curve("base") = {14}; Physical Curve("head") = {5};
Transfinite Curve{11, 12} = Round(5 * refine) + 1;
Mesh.MeshSizeMax = 0.7 / refine;
