// Two blocks, one on the other, whose meshes do not match at the joint.
DefineConstant[ n = {20, Name "faces of the upper side of the joint"}, lower = {n + 2, Name "faces of its lower side"}, solid = {0, Name "1: in space"} ];
gap = solid * 1e-4; // in space nodes of both blocks at one place would be one to gmsh
Point(1) = {0, 0, 0}; Point(2) = {10, 0, 0}; Point(3) = {10, 4, 0}; Point(4) = {0, 4, 0};
Point(11) = {0, -4, 0}; Point(12) = {10, -4, 0}; Point(13) = {10, -gap, 0}; Point(14) = {0, -gap, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
Curve Loop(2) = {11 : 14}; Plane Surface(2) = {2};
Transfinite Curve {1, 3} = n + 1;
Transfinite Curve {11, 13} = lower + 1;
Transfinite Curve {2, 4, 12, 14} = 5;
Transfinite Surface {1, 2};
Recombine Surface {1, 2};
If (solid)
  up[] = Extrude {0, 0, 2} { Surface{1}; Layers{2}; Recombine; };
  down[] = Extrude {0, 0, 2} { Surface{2}; Layers{3}; Recombine; };
  Physical Volume("upper") = {up[1]}; Physical Volume("lower") = {down[1]};
  Physical Surface("bottom") = {up[2]}; Physical Surface("right") = {up[3]}; Physical Surface("top") = {up[4]};
  Physical Surface("left") = {up[5]}; Physical Surface("sides") = {1, up[0], 2, down[0]};
  Physical Surface("base") = {down[2]}; Physical Surface("shore") = {down[3]}; Physical Surface("ground") = {down[4]};
  Physical Surface("bank") = {down[5]};
Else
  Physical Surface("upper") = {1}; Physical Surface("lower") = {2};
  Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("left") = {4};
  Physical Curve("base") = {11}; Physical Curve("shore") = {12}; Physical Curve("ground") = {13};
  Physical Curve("bank") = {14};
EndIf
Physical Point("pin") = {1};
