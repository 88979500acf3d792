// The meridian plane of an O-ring in a groove with rounded edges, under a lid; x = r, y = z, lengths in mm. Groove and
// lid are curves.
DefineConstant[
  cord = {3.53, Name "diameter of the cord"}, mean = {53.53, Name "mean diameter of the ring"},
  depth = {2.8, Name "of the groove: depth"}, width = {4.7, Name "of the groove: width"},
  foot = {0.4, Name "radius at the groove's floor"}, edge = {0.2, Name "radius at the groove's edges"},
  n = {12, Name "elements along a quarter of the cord"}, triangles = {0, Name "1: triangles instead of quadrangles"},
  gap = {0, Name "size of elements at the outer gap between groove and lid; 0: as elsewhere"}
];
R = cord / 2; rm = mean / 2; c = Sqrt(0.5); // the cord rests on the floor at y = 0, in the middle of the groove
q = 0.45 * R; // half the diagonal of the square in the cord's middle, whose sides are next to those of the skin
mouth = 37 * Pi / 180; // where on the cord lies what goes to the outer gap
fine = (gap > 0 && !triangles); // quadrangles have a corner of the square there, and grow from it by a tenth
growth = 1.1;
Point(1) = {rm, R, 0};
For i In {0 : 3}
  along = (i == 0 || i == 3) ? c : -c;
  up = (i < 2) ? c : -c;
  If (fine && i == 0)
    along = Cos(mouth); up = Sin(mouth);
  EndIf
  Point(2 + i) = {rm + R * along, R + R * up, 0};
  Point(6 + i) = {rm + q / c * along, R + q / c * up, 0};
EndFor
For i In {0 : 3}
  Circle(1 + i) = {2 + i, 1, 2 + (i + 1) % 4};
  Line(5 + i) = {6 + i, 6 + (i + 1) % 4};
  Line(9 + i) = {6 + i, 2 + i};
EndFor
skin[] = {1 : 4};
If (fine) // the skin has a node halfway up on either side
  Delete { Curve{4}; }
  Point(10) = {rm + R, R, 0};
  Circle(4) = {5, 1, 10}; Circle(13) = {10, 1, 2};
  skin[] += {13};
EndIf
For i In {0 : 3}
  If (fine && i == 3)
    Curve Loop(4) = {12, 4, 13, -9, -8};
  Else
    Curve Loop(1 + i) = {9 + i, 1 + i, -(9 + (i + 1) % 4), -(5 + i)};
  EndIf
  Plane Surface(1 + i) = {1 + i};
EndFor
Curve Loop(5) = {5 : 8};
Plane Surface(5) = {5};
Transfinite Curve{1 : 8} = n + 1;
Transfinite Curve{9 : 12} = Ceil(0.6 * n) + 1;
If (fine)
  top = Ceil(Log(1 + R * (3 * Pi / 4 - mouth) * (growth - 1) / gap) / Log(growth));
  high = Ceil(Log(1 + R * mouth * (growth - 1) / gap) / Log(growth));
  low = Ceil(Log(1 + R * Pi / 4 * (growth - 1) / (gap * growth^high)) / Log(growth));
  low += (high + low) % 2; // the inner side has its node halfway up, too
  Transfinite Curve{1, 5} = top + 1 Using Progression growth; Transfinite Curve{3, 7} = top + 1;
  Transfinite Curve{-13} = high + 1 Using Progression growth;
  Transfinite Curve{-4} = low + 1 Using Progression growth;
  Transfinite Curve{-8} = high + low + 1 Using Progression growth; Transfinite Curve{2, 6} = high + low + 1;
  Transfinite Curve{-9} = Ceil(0.6 * n) + 1 Using Progression growth;
EndIf
If (triangles)
  Mesh.MeshSizeMin = R * Pi / 2 / n; Mesh.MeshSizeMax = R * Pi / 2 / n;
  Delete { Surface{1 : 5}; Curve{5 : 12}; }
  If (gap > 0) // grows from there by a fifth of the distance; the skin has a node halfway up on either side
    Delete { Curve{1, 4}; }
    Point(10) = {rm + R, R, 0};
    Circle(1) = {2, 1, 3}; Circle(4) = {5, 1, 10}; Circle(13) = {10, 1, 2};
    skin[] = {1 : 4, 13};
    Mesh.MeshSizeMin = gap; Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeExtendFromBoundary = 0;
    near[] = {};
    For i In {0 : 40}
      angle = (25 + 50 * i / 40) * Pi / 180;
      near[] += {100 + i};
      Point(100 + i) = {rm + R * Cos(angle), R + R * Sin(angle), 0};
    EndFor
    Field[1] = Distance; Field[1].PointsList = {near[]};
    Field[2] = MathEval; Field[2].F = Sprintf("%g + 0.2 * F1", gap);
    Background Field = 2;
  EndIf
  Curve Loop(6) = {skin[]};
  Plane Surface(1) = {6};
  ring[] = {1};
Else
  Transfinite Surface{1 : 3, 5};
  Transfinite Surface{4} = {9, 5, 2, 6};
  Recombine Surface{1 : 5};
  ring[] = {1 : 5};
EndIf
a = rm - width / 2; b = rm + width / 2;
Point(21) = {a - 1, depth, 0}; Point(22) = {a - edge, depth, 0}; Point(23) = {a - edge, depth - edge, 0}; Point(24) = {a, depth - edge, 0};
Point(25) = {a, foot, 0}; Point(26) = {a + foot, foot, 0}; Point(27) = {a + foot, 0, 0};
Point(28) = {b - foot, 0, 0}; Point(29) = {b - foot, foot, 0}; Point(30) = {b, foot, 0};
Point(31) = {b, depth - edge, 0}; Point(32) = {b + edge, depth - edge, 0}; Point(33) = {b + edge, depth, 0}; Point(34) = {b + 1, depth, 0};
Line(21) = {21, 22}; Circle(22) = {22, 23, 24}; Line(23) = {24, 25}; Circle(24) = {25, 26, 27}; Line(25) = {27, 28};
Circle(26) = {28, 29, 30}; Line(27) = {30, 31}; Circle(28) = {31, 32, 33}; Line(29) = {33, 34};
Point(41) = {a - 1, cord, 0}; Point(42) = {b + 1, cord, 0};
Line(41) = {41, 42};
Transfinite Curve{24, 26} = 7; Transfinite Curve{22, 28} = 5;
Transfinite Curve{23, 27} = 21; Transfinite Curve{25, 41} = 41;
Transfinite Curve{21, 29} = 9;
Physical Surface("ring") = {ring[]};
Physical Curve("skin") = {skin[]};
Physical Curve("groove") = {21 : 29};
Physical Curve("lid") = {41};
