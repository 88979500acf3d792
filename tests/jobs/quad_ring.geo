// The section of a quad ring (four lobes, here of radius 0.6 mm) in a groove below a lid. Lengths in mm.
SetFactory("OpenCASCADE");
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.12 / refine;
Rectangle(1) = {9, -1, 0, 2, 2};
For i In {0 : 3}
  Disk(2 + i) = {10 + 0.85 * Cos((2 * i + 1) * Pi / 4) * Sqrt(2), 0.85 * Sin((2 * i + 1) * Pi / 4) * Sqrt(2), 0, 0.6};
  Disk(12 + i) = {10 + 1.9 * Cos(i * Pi / 2), 1.9 * Sin(i * Pi / 2), 0, 1};
EndFor
BooleanUnion(10) = { Surface{1}; Delete; }{ Surface{2 : 5}; Delete; };
BooleanDifference(20) = { Surface{10}; Delete; }{ Surface{12 : 15}; Delete; };
MeshSize{:} = h;
Point(201) = {8.2, -1.47, 0, h}; Point(202) = {12.3, -1.47, 0, h}; Point(203) = {12.3, 1.6, 0, h};
Point(204) = {8.2, 1.6, 0, h}; Point(205) = {7, 1.47, 0, h}; Point(206) = {13.5, 1.47, 0, h};
Line(201) = {201, 202}; Line(202) = {202, 203}; Line(203) = {204, 201}; Line(204) = {206, 205};
Physical Surface("ring") = {20};
Physical Curve("skin") = Boundary{ Surface{20}; };
Physical Curve("groove") = {201, 202, 203};
Physical Curve("lid") = {204};
