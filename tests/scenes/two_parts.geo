// two half discs, one on the other, with an overlap where they meet
SetFactory("OpenCASCADE");
DefineConstant[ overlap = 0.04, h = 0.4, bodies = 1 ];
Disk(1) = {0, 0, 0, 4}; Disk(2) = {0, 8 - overlap, 0, 4};
Rectangle(3) = {-5, -5, 0, 10, 5}; Rectangle(4) = {-5, 8 - overlap, 0, 10, 5};
BooleanDifference(5) = { Surface{1}; Delete; }{ Surface{3}; Delete; };
BooleanDifference(6) = { Surface{2}; Delete; }{ Surface{4}; Delete; };
If (bodies == 1)
  Physical Surface("discs") = {5, 6};
Else
  Physical Surface("discs") = {5}; Physical Surface("upper") = {6};
EndIf
e = 1e-3;
base() = Curve In BoundingBox{-5, -e, -e, 5, e, e}; top() = Curve In BoundingBox{-5, 8 - overlap - e, -e, 5, 8 - overlap + e, e};
Physical Curve("base") = base(); Physical Curve("top") = top();
Mesh.MeshSizeMax = h;
