// A pin in the hole of a plate with a clearance of 0.05 mm, which is below the sagitta of its faces. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
SetFactory("OpenCASCADE");
r = 10;             // hole
clearance = 0.05;   // on the radius
W = 15;             // half the width of the plate
T = 6;              // its thickness
out = 3;            // how far the pin stands out on either side
Box(1) = {-W, -W, 0, 2 * W, 2 * W, T};
Cylinder(2) = {0, 0, -1, 0, 0, T + 2, r};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Cylinder(4) = {0, 0, -out, 0, 0, T + 2 * out, r - clearance};
MeshSize{:} = 3 / refine;
Physical Volume("plate") = {3};
Physical Volume("pin") = {4};
f() = Surface In BoundingBox{-W - 0.1, -W - 0.1, -0.1, W + 0.1, -W + 0.1, T + 0.1};
Physical Surface("foot") = {f()};
a() = Surface In BoundingBox{-r, -r, -out - 0.1, r, r, -out + 0.1};
b() = Surface In BoundingBox{-r, -r, T + out - 0.1, r, r, T + out + 0.1};
Physical Surface("ends") = {a(), b()};
c() = Surface In BoundingBox{-r - 0.01, -r - 0.01, -0.1, r + 0.01, r + 0.01, T + 0.1};
Physical Surface("bore") = {c()};
d() = Surface In BoundingBox{-r, -r, -out - 0.1, r, r, T + out + 0.1};
d() -= {a(), b()};
Physical Surface("skin") = {d()};
