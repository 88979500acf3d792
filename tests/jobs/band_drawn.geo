// An eighth of a rubber band about two pins. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
na = Ceil(16 * refine); nt = Ceil(2 * refine); nw = Ceil(3 * refine);
r = 10; t = 1.5; w = 3;
Point(1) = {0, 0, 0};
Point(2) = {r, 0, 0}; Point(3) = {r + t, 0, 0}; Point(4) = {0, r + t, 0}; Point(5) = {0, r, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = nt + 1; Transfinite Curve{2, 4} = na + 1; Transfinite Surface{1};
Recombine Surface{1};
e[] = Extrude{0, 0, w}{ Surface{1}; Layers{nw}; Recombine; };
Physical Volume("band") = {e[1]};
Physical Surface("half") = {1};
Physical Surface("end") = {e[2]};
Physical Surface("middle") = {e[4]};
Physical Surface("inside") = {e[5]};
