// A hollow journal in a bush with a clearance of 0.05 mm on the radius, in the plane. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
SetFactory("OpenCASCADE");
r = 10;             // bore of the bush
clearance = 0.05;
Disk(1) = {0, 0, 0, r + 5};
Disk(2) = {0, 0, 0, r};
BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
Disk(4) = {0, 0, 0, r - clearance};
Disk(5) = {0, 0, 0, r / 2};
BooleanDifference(6) = { Surface{4}; Delete; }{ Surface{5}; Delete; };
MeshSize{:} = 1.5 / refine;
Physical Surface("bush") = {3};
Physical Surface("journal") = {6};
b() = Boundary{ Surface{3}; };
j() = Boundary{ Surface{6}; };
Physical Curve("rim") = {b(0)};
Physical Curve("inside") = {j(1)};
