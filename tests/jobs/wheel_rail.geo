// A quarter of a crowned wheel on a rail head: an ellipsoid's cap on a cylinder. Lengths in mm.
SetFactory("OpenCASCADE");
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
Rw = 460; Rt = 1000; Rr = 300; L = 20; // rolling and crown radius of the wheel, radius of the rail's head, size of the model
// the rail runs along x, its head is curved in z; the wheel is curved in x by Rw and in z by Rt
// ellipsoid with half axes a (x), c (z) and b (y): radii a^2/b and c^2/b with b = Rw
Sphere(1) = {0, Rw, 0, Rw};
Dilate {{0, Rw, 0}, {1, 1, Sqrt(Rt/Rw)}} { Volume{1}; }
Box(2) = {0, -1, 0, L, L + 1, L};
BooleanIntersection(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Cylinder(4) = {0, -Rr, 0, L, 0, 0, Rr};
Box(5) = {0, -L, 0, L, L + 1, L};
BooleanIntersection(6) = { Volume{4}; Delete; }{ Volume{5}; Delete; };
e = 1e-3;
sx[] = Surface In BoundingBox {-e, -L - e, -e, e, L + e, L + e};
sz[] = Surface In BoundingBox {-e, -L - e, -e, L + e, L + e, e};
top[] = Surface In BoundingBox {-e, L - e, -e, L + e, L + e, L + e};
bottom[] = Surface In BoundingBox {-e, -L - e, -e, L + e, -L + e, L + e};
outer[] = Surface In BoundingBox {L - e, -L - e, -e, L + e, L + e, L + e};
outer[] += Surface In BoundingBox {-e, -L - e, L - e, L + e, L + e, L + e};
tread[] = Boundary{ Volume{3}; }; head[] = Boundary{ Volume{6}; };
tread[] = Abs(tread[]); head[] = Abs(head[]);
tread[] -= sx[]; tread[] -= sz[]; tread[] -= top[]; tread[] -= outer[];
head[] -= sx[]; head[] -= sz[]; head[] -= bottom[]; head[] -= outer[];
Physical Volume("wheel") = {3}; Physical Volume("rail") = {6};
Physical Surface("side_x") = {sx[]}; Physical Surface("side_z") = {sz[]}; Physical Surface("wheel_top") = {top[]}; Physical Surface("rail_base") = {bottom[]};
Physical Surface("tread") = {tread[]}; Physical Surface("head") = {head[]};
Field[1] = Ball; Field[1].Radius = 6; Field[1].Thickness = 14; Field[1].VIn = 0.8 / refine; Field[1].VOut = 5 / refine;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;
