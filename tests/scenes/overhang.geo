// A long soft slab lies on a block that ends under it. The symmetry plane, or the axis, is x = 0. Lengths in mm.
DefineConstant[
  block = {10, Name "length of the block"}, slab = {20, Name "length of the slab"},
  high = {8, Name "height of the block"}, thick = {4, Name "thickness of the slab"},
  h_block = {1, Name "element size of the block"}, h_slab = {0.8, Name "element size of the slab"},
  solid = {0, Name "1: a strip of width 2 in 3D"}
];
Point(1) = {0, -high, 0};
Point(2) = {block, -high, 0};
Point(3) = {block, 0, 0};
Point(4) = {0, 0, 0};
y = solid * 1e-3; // nodes of the extruded bodies that coincide would be merged
Point(11) = {0, y, 0};
Point(12) = {slab, y, 0};
Point(13) = {slab, y + thick, 0};
Point(14) = {0, y + thick, 0};
For i In {0 : 3}
  Line(1 + i) = {1 + i, 1 + (i + 1) % 4};
  Line(11 + i) = {11 + i, 11 + (i + 1) % 4};
EndFor
Curve Loop(1) = {1 : 4};
Plane Surface(1) = {1};
Curve Loop(2) = {11 : 14};
Plane Surface(2) = {2};
Transfinite Curve{1, 3} = Round(block / h_block) + 1;
Transfinite Curve{2, 4} = Round(high / h_block) + 1;
Transfinite Curve{11, 13} = Round(slab / h_slab) + 1;
Transfinite Curve{12, 14} = Round(thick / h_slab) + 1;
Transfinite Surface{1, 2};
Recombine Surface{1, 2};
If (solid == 0)
  Physical Surface("block") = {1};
  Physical Surface("slab") = {2};
  Physical Curve("floor") = {1};
  Physical Curve("block_top") = {3};
  Physical Curve("middle") = {4, 14};
  Physical Curve("underside") = {11};
  Physical Curve("slab_top") = {13};
Else
  b[] = Extrude{0, 0, 2}{ Surface{1}; Layers{3}; Recombine; };
  s[] = Extrude{0, 0, 2}{ Surface{2}; Layers{3}; Recombine; };
  Physical Volume("block") = {b[1]};
  Physical Volume("slab") = {s[1]};
  Physical Surface("floor") = {b[2]};
  Physical Surface("block_top") = {b[4]};
  Physical Surface("middle") = {b[5], s[5]};
  Physical Surface("underside") = {s[2]};
  Physical Surface("slab_top") = {s[4]};
  Physical Surface("ends") = {1, 2, b[0], s[0]};
EndIf
