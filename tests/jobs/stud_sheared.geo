// Half of a rubber stud, a dome of radius 10 mm on a foot. Lengths in mm.
SetFactory("OpenCASCADE");
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
Sphere(1) = {0, 0, 0, 10, 0, Pi / 2, Pi};
Cylinder(2) = {0, 0, 0, 0, 0, -3, 12, Pi};
v() = BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; };
MeshSize{:} = 2.5 / refine;
Physical Volume("rubber") = {v()};
Physical Surface("foot") = Surface In BoundingBox{-20, -0.001, -3.01, 20, 20, -2.99};
middle() = Surface In BoundingBox{-20, -0.001, -20, 20, 0.001, 20};
Physical Surface("middle") = {middle()};
dome() = Surface In BoundingBox{-10.01, -0.001, -0.001, 10.01, 10.01, 10.01};
dome() -= middle();
Physical Surface("dome") = {dome(0)};
