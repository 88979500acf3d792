// A quarter of a coarse plate under a finely meshed rigid punch, whose flat ends in a rounded edge; lengths in mm.
DefineConstant[ h = {5, Name "faces of the plate"}, f = {0.4, Name "faces of the punch"} ];
a = 20; t = 1; w = 6.2; r = 1; z = t + 0.02;
Point(1) = {0, 0, 0}; Point(2) = {a, 0, 0}; Point(3) = {a, a, 0}; Point(4) = {0, a, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Transfinite Curve{1:4} = a / h + 1;
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Transfinite Surface{1}; Recombine Surface{1};
out[] = Extrude {0, 0, t} { Surface{1}; Layers{2}; Recombine; };
Physical Volume("plate") = {out[1]};
Physical Surface("top") = {out[0]};
Physical Surface("y_min") = {out[2]}; Physical Surface("x_max") = {out[3]}; Physical Surface("x_min") = {out[5]};
Point(101) = {0, 0, z}; Point(102) = {w, 0, z}; Point(103) = {w, 0, z + r};
Point(104) = {w + r, 0, z + r}; Point(105) = {w + r, 0, z + 3};
Line(201) = {101, 102}; Circle(202) = {102, 103, 104}; Line(203) = {104, 105};
Transfinite Curve{201} = Ceil(w / f) + 1; Transfinite Curve{202} = 9; Transfinite Curve{203} = 6;
out[] = Extrude {0, a, 0} { Curve{201, 202, 203}; Layers{Ceil(a / 2 / f)}; Recombine; };
Physical Surface("punch") = {out[1], out[5], out[9]};
