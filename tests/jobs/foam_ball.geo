// A quarter of a foam block, 60 x 60 x 40, finer under the ball. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
L = 60; H = 40;
n = 12 * refine;          // elements along each side
m = 8 * refine;           // through the height
s = 1.12 ^ (1 / refine);  // each is so much longer than the one before
Point(1) = {0, 0, 0};
Point(2) = {L, 0, 0};
Point(3) = {L, L, 0};
Point(4) = {0, L, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {4, 3};
Line(4) = {1, 4};
Transfinite Curve{1, 2, 3, 4} = n + 1 Using Progression s;
Curve Loop(1) = {1, 2, -3, -4};
Plane Surface(1) = {1};
Transfinite Surface{1};
Recombine Surface{1};
out() = Extrude {0, 0, -H} { Surface{1}; Layers{m}; Recombine; };
Physical Volume("foam") = {out(1)};
Physical Surface("top") = {1};
Physical Surface("base") = {out(0)};
Physical Surface("symmetry_y") = {out(2)};
Physical Surface("symmetry_x") = {out(5)};
