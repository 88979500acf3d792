// Two blocks on top of each other whose meshes do not match at the flat interface y = 1, for the contact patch test; plane or solid.
SetFactory("OpenCASCADE"); // the built-in kernel would merge the blocks' coincident corners when it extrudes
DefineConstant[
  solid = {1, Name "1: extruded along z, 0: plane"},
  width = {2, Name "width"}, height = {1, Name "height of each block"}, depth = {1, Name "depth"},
  n_lower = {3, Name "elements along the lower block"}, n_upper = {5, Name "elements along the upper block"},
  n_height = {2, Name "elements over the height of each block"},
  n_depth_lower = {2, Name "elements along z, lower block"}, n_depth_upper = {3, Name "elements along z, upper block"},
  simplex = {0, Name "1: triangles or tetrahedra"}
];
n_row[] = {n_lower, n_upper};
n_depth[] = {n_depth_lower, n_depth_upper};
Mesh.CharacteristicLengthMax = depth / n_depth_lower; // simplices are not layered
For b In {0 : 1}
  o = 100 * b;
  Point(o + 1) = {0, b * height, 0};
  Point(o + 2) = {width, b * height, 0};
  Point(o + 3) = {width, (b + 1) * height, 0};
  Point(o + 4) = {0, (b + 1) * height, 0};
  Line(o + 1) = {o + 1, o + 2};
  Line(o + 2) = {o + 2, o + 3};
  Line(o + 3) = {o + 3, o + 4};
  Line(o + 4) = {o + 4, o + 1};
  Curve Loop(o + 1) = {o + 1, o + 2, o + 3, o + 4};
  Plane Surface(o + 1) = {o + 1};
  Transfinite Curve{o + 1, o + 3} = n_row[b] + 1;
  Transfinite Curve{o + 2, o + 4} = n_height + 1;
  If (!simplex)
    Transfinite Surface{o + 1};
    Recombine Surface{o + 1};
  EndIf
  body[b] = o + 1;
  bottom[b] = o + 1;
  top[b] = o + 3;
  left[b] = o + 4;
  front[b] = o + 1;
  If (solid)
    If (simplex)
      out[] = Extrude{0, 0, depth}{ Surface{o + 1}; };
    Else
      out[] = Extrude{0, 0, depth}{ Surface{o + 1}; Layers{n_depth[b]}; Recombine; };
    EndIf
    body[b] = out[1];
    bottom[b] = out[2];
    top[b] = out[4];
    left[b] = out[5];
  EndIf
EndFor

If (solid)
  Physical Volume("lower") = {body[0]};
  Physical Volume("upper") = {body[1]};
  Physical Surface("lower_bottom") = {bottom[0]};
  Physical Surface("lower_top") = {top[0]};
  Physical Surface("upper_bottom") = {bottom[1]};
  Physical Surface("upper_top") = {top[1]};
  Physical Surface("symmetry_x") = {left[]};
  Physical Surface("symmetry_z") = {front[]};
Else
  Physical Surface("lower") = {body[0]};
  Physical Surface("upper") = {body[1]};
  Physical Curve("lower_bottom") = {bottom[0]};
  Physical Curve("lower_top") = {top[0]};
  Physical Curve("upper_bottom") = {bottom[1]};
  Physical Curve("upper_top") = {top[1]};
  Physical Curve("symmetry_x") = {left[]};
EndIf
