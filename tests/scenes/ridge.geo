// A block over a ridge, whose edge is under the middle of a face of the block: no slave node is near the edge.
DefineConstant[
  solid = {0, Name "1: 3D, one unit deep"}, rigid = {0, Name "1: the ridge is a rigid surface"},
  width = {4, Name "width of the block"}, height = {2, Name "height of the block"}, slope = {0.3, Name "of the ridge"},
  reach = {3, Name "half the width of the ridge"},
  n_block = {5, Name "elements along the block"}, n_ridge = {7, Name "elements along either side of the ridge"},
  n_height = {3, Name "elements over the height"}, n_depth = {2, Name "elements over the depth"}
];
Point(1) = {-width / 2, 0, 0};
Point(2) = {width / 2, 0, 0};
Point(3) = {width / 2, height, 0};
Point(4) = {-width / 2, height, 0};
Point(11) = {-reach, -slope * reach, 0};
Point(12) = {0, 0, 0};
Point(13) = {reach, -slope * reach, 0};
Point(14) = {reach, -slope * reach - 1, 0};
Point(15) = {0, -slope * reach - 1, 0};
Point(16) = {-reach, -slope * reach - 1, 0};
For i In {1 : 4}
  Line(i) = {i, i % 4 + 1};
EndFor
Line(11) = {12, 11};
Line(12) = {13, 12};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = n_block + 1;
Transfinite Curve{2, 4} = n_height + 1;
Transfinite Curve{11, 12} = n_ridge + 1;
If (!rigid)
  Line(13) = {11, 16};
  Line(14) = {16, 15};
  Line(15) = {15, 12};
  Line(16) = {15, 14};
  Line(17) = {14, 13};
  Curve Loop(2) = {11, 13, 14, 15};
  Curve Loop(3) = {12, -15, 16, 17};
  Plane Surface(2) = {2};
  Plane Surface(3) = {3};
  Transfinite Curve{14, 16} = n_ridge + 1;
  Transfinite Curve{13, 15, 17} = n_height + 1;
EndIf
Transfinite Surface "*";
Recombine Surface "*";
If (!solid)
  Physical Surface("block") = {1};
  Physical Curve("block_bottom") = {1};
  Physical Curve("block_top") = {3};
  Physical Curve("ridge") = {11, 12};
  If (!rigid)
    Physical Surface("anvil") = {2, 3};
    Physical Curve("anvil_bottom") = {14, 16};
  EndIf
EndIf
If (solid)
  block[] = Extrude {0, 0, 1} { Surface{1}; Layers{n_depth}; Recombine; };
  Physical Volume("block") = {block[1]};
  Physical Surface("block_bottom") = {block[2]};
  Physical Surface("block_top") = {block[4]};
  Physical Surface("front") = {1, block[0]};
  If (rigid)
    left[] = Extrude {0, 0, 1} { Curve{11, 12}; Layers{n_depth + 1}; Recombine; };
    Physical Surface("ridge") = {left[1], left[5]};
  EndIf
  If (!rigid)
    anvil[] = Extrude {0, 0, 1} { Surface{2, 3}; Layers{n_depth + 1}; Recombine; };
    Physical Volume("anvil") = {anvil[1], anvil[7]};
    Physical Surface("ridge") = {anvil[2], anvil[8]};
    Physical Surface("anvil_bottom") = {anvil[4], anvil[10]};
  EndIf
EndIf
