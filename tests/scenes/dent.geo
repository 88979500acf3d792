// A quarter of a block of tetrahedra.
DefineConstant[ h = 2.5 ];
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 10, 10, 5};
MeshSize{ PointsOf{ Volume{1}; } } = h;
e = 1e-3;
Physical Volume("block") = {1};
Physical Surface("x_0") = Surface In BoundingBox{-e, -e, -e, e, 10 + e, 5 + e};
Physical Surface("y_0") = Surface In BoundingBox{-e, -e, -e, 10 + e, e, 5 + e};
Physical Surface("bottom") = Surface In BoundingBox{-e, -e, -e, 10 + e, 10 + e, e};
Physical Surface("top") = Surface In BoundingBox{-e, -e, 5 - e, 10 + e, 10 + e, 5 + e};
