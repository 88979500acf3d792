// A box that fills a groove: walls and floor are one surface. Lengths in mm.
DefineConstant[
  width = {2, Name "of the groove and the box"}, deep = {1, Name "depth of the groove"}, wall = {1, Name "thickness of walls and floor"},
  tall = {2, Name "height of the box"}, play = {0, Name "between the box and each wall"},
  h = {0.25, Name "element size of the groove"}, h_box = {0.2, Name "of the box"}
];
w = width / 2 + play;
Point(1) = {-w - wall, -wall, 0};
Point(2) = {w + wall, -wall, 0};
Point(3) = {w + wall, deep, 0};
Point(4) = {w, deep, 0};
Point(5) = {w, 0, 0};
Point(6) = {-w, 0, 0};
Point(7) = {-w, deep, 0};
Point(8) = {-w - wall, deep, 0};
For i In {1 : 8}
  Line(i) = {i, i % 8 + 1};
EndFor
Curve Loop(1) = {1 : 8};
Plane Surface(1) = {1};
Point(11) = {-width / 2, 0, 0};
Point(12) = {width / 2, 0, 0};
Point(13) = {width / 2, tall, 0};
Point(14) = {-width / 2, tall, 0};
For i In {0 : 3}
  Line(11 + i) = {11 + i, 11 + (i + 1) % 4};
EndFor
Curve Loop(2) = {11 : 14};
Plane Surface(2) = {2};
Transfinite Curve{11, 13} = Round(width / h_box) + 1;
Transfinite Curve{12, 14} = Round(tall / h_box) + 1;
Transfinite Surface{2};
Recombine Surface{2};
MeshSize{1 : 8} = h;
Physical Surface("groove") = {1};
Physical Surface("box") = {2};
Physical Curve("floor") = {1};
Physical Curve("inside") = {4, 5, 6};
Physical Curve("skin") = {11, 12, 14};
Physical Curve("top") = {13};
Physical Curve("bed") = {5};
Physical Curve("walls") = {4, 6};
Physical Curve("sole") = {11};
Physical Curve("sides") = {12, 14};
