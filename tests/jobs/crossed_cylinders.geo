// Two half cylinders crossed at right angles, a quarter of both: symmetric about x = 0 and z = 0. There is a small gap
// between them. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
R = 10;           // radius of both
L = 8;            // half length
fine = 0.22 / refine;      // element size where they touch
coarse = 3 / refine;
gap = 0.01;

// upper one: axis along x through (0, R, 0)
Point(1) = {0, 0, 0, coarse};
Point(2) = {0, R, R, coarse};
Point(3) = {0, R, 0, coarse};
Circle(1) = {1, 3, 2};
Line(2) = {2, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};

// lower one: axis along z through (0, -R - gap, 0)
Point(21) = {0, -gap, 0, coarse};
Point(22) = {R, -R - gap, 0, coarse};
Point(23) = {0, -R - gap, 0, coarse};
Circle(21) = {21, 23, 22};
Line(22) = {22, 23};
Line(23) = {23, 21};
Curve Loop(2) = {21, 22, 23};
Plane Surface(2) = {2};
up[] = Extrude{L, 0, 0}{ Surface{1}; };
low[] = Extrude{0, 0, L}{ Surface{2}; };

// element size grows with the distance from the origin; the lower body is meshed a little coarser
Field[1] = MathEval;
Field[1].F = Sprintf("(%g + %g * (sqrt(x*x + y*y + z*z) - 1.2 + abs(sqrt(x*x + y*y + z*z) - 1.2))) * (1 - 0.1 * (y + 0.005) / sqrt((y + 0.005)^2 + 1e-6))", fine, 0.2 / refine);
Background Field = 1;
Mesh.MeshSizeMax = coarse;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Volume("upper") = {up[1]};
Physical Volume("lower") = {low[1]};
Physical Surface("upper_skin") = {up[2]};
Physical Surface("lower_skin") = {low[2]};
Physical Surface("press") = {up[3]};
Physical Surface("base") = {low[3]};
Physical Surface("symmetry_x") = {1, low[4]};
Physical Surface("symmetry_z") = {2, up[4]};
