// Two blocks on each other on a bed. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 10, 10};
Rectangle(2) = {0, 10, 0, 10, 10};
Rectangle(3) = {-10, -5, 0, 40, 5};
Physical Surface("lower") = {1};
Physical Surface("upper") = {2};
Physical Surface("bed") = {3};
f() = Curve In BoundingBox{-11, -5.1, -1, 31, -4.9, 1};
Physical Curve("floor") = {f()};
s() = Curve In BoundingBox{-0.1, 9.9, -1, 0.1, 20.1, 1};
Physical Curve("side") = {s()};
MeshSize{:} = 1.5 / refine;
