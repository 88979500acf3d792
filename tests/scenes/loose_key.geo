// A shaft, its key and a hub, cut across, with play on all sides. Lengths in mm.
DefineConstant[ h = {2.5, Name "element size"} ];
SetFactory("OpenCASCADE");
R = 15;     // of the shaft
play = 0.02;

Disk(1) = {0, 0, 0, R};
Disk(2) = {0, 0, 0, 5};
BooleanDifference(10) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
Rectangle(3) = {-4, R - 5, 0, 8, 10};
BooleanDifference(11) = { Surface{10}; Delete; }{ Surface{3}; Delete; };
Disk(4) = {0, 0, 0, 26};
Disk(5) = {0, 0, 0, R + play};
BooleanDifference(12) = { Surface{4}; Delete; }{ Surface{5}; Delete; };
Rectangle(6) = {-4 - play, 0, 0, 8 + 2 * play, R + 3.4};
BooleanDifference(13) = { Surface{12}; Delete; }{ Surface{6}; Delete; };
Rectangle(20) = {-4 + play / 2, R - 5 + play, 0, 8 - play, 8, 0.4};

Physical Surface("shaft") = {11};
Physical Surface("hub") = {13};
Physical Surface("key") = {20};
around() = Boundary{ Surface{11}; };
bore() = {};
For i In {0:#around() - 1}
  box() = BoundingBox Curve{ Abs(around(i)) };
  If (box(3) - box(0) < 10.5 && box(1) > -6 && box(4) < 6)
    bore() += Abs(around(i));
  EndIf
EndFor
Physical Curve("bore") = bore();
around() = Boundary{ Surface{13}; };
rim() = {};
For i In {0:#around() - 1}
  box() = BoundingBox Curve{ Abs(around(i)) };
  If (box(4) - box(1) > 40)
    rim() += Abs(around(i));
  EndIf
EndFor
Physical Curve("rim") = rim();
Mesh.MeshSizeMax = h;
