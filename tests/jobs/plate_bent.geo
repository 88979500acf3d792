// A quarter of a plate 40 x 12 x 2 with a hole of radius 2, tetrahedra (plate_bent.yaml)
DefineConstant[ refine = 1 ];
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 20, 6, 2};
Cylinder(2) = {0, 0, -1, 0, 0, 4, 2};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Mesh.MeshSizeMax = 1.4/refine;
e = 1e-3;
bottom() = Surface In BoundingBox{-e, -e, -e, 20 + e, 6 + e, e};
top() = Surface In BoundingBox{-e, -e, 2 - e, 20 + e, 6 + e, 2 + e};
middle() = Surface In BoundingBox{-e, -e, -e, e, 6 + e, 2 + e};
side() = Surface In BoundingBox{-e, -e, -e, 20 + e, e, 2 + e};
Physical Volume("plate") = {3};
Physical Surface("bottom") = bottom();
Physical Surface("top") = top();
Physical Surface("middle") = middle();
Physical Surface("side") = side();
