SetFactory("OpenCASCADE");
DefineConstant[refine=1];
// `refine` divides the size of the elements.
// saddle with half a bore of radius 10, and a shaft of radius 9.95 that lies in it and stands out at both ends
c = 0.05; b = 8;
Box(1) = {-18, -18, 0, 36, 18, b};
Cylinder(2) = {0, 0, -1, 0, 0, b + 2, 10};
BooleanDifference(3) = {Volume{1}; Delete;}{Volume{2}; Delete;};
Cylinder(7) = {0, -c, -2, 0, 0, b + 4, 10 - c};
MeshSize{:} = 3.5/refine;
Physical Volume("saddle") = {3};
Physical Volume("shaft") = {7};
q() = Surface In BoundingBox{-18.1, -18.1, -0.1, 18.1, -17.9, b + 0.1};
w() = Surface In BoundingBox{-10.1, -10.1, -0.1, 10.1, 0.1, b + 0.1};
v() = Surface In BoundingBox{-10.1, -10.1, -2.1, 10.1, 10.1, b + 2.1};
e() = Surface In BoundingBox{-10.1, -10.1, -2.1, 10.1, 10.1, -1.9};
f() = Surface In BoundingBox{-10.1, -10.1, b + 1.9, 10.1, 10.1, b + 2.1};
v() -= {w(), e(), f()};
Physical Surface("foot") = {q()};
Physical Surface("bore") = {w()};
Physical Surface("side") = {v()};
Physical Surface("ends") = {e(), f()};
