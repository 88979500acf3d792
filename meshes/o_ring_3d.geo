// A quarter of the O-ring, groove and lid of o_ring.geo in space, between the planes z = 0 and x = 0; y is the axis.
Include "o_ring.geo";
DefineConstant[ arc = {6, Name "elements along the quarter of the ring"} ];
Delete Physicals;
skin[] = {};
starts[] = {};
ends[] = {};
volumes[] = {};
For i In {0 : #ring[] - 1}
  If (triangles)
    out[] = Extrude{{0, 1, 0}, {0, 0, 0}, Pi / 2}{ Surface{ring[i]}; Layers{arc}; };
  Else
    out[] = Extrude{{0, 1, 0}, {0, 0, 0}, Pi / 2}{ Surface{ring[i]}; Layers{arc}; Recombine; };
  EndIf
  starts[] += {ring[i]};
  ends[] += {out[0]};
  volumes[] += {out[1]};
  If (triangles)
    skin[] += {out[{2 : #out[] - 1}]};
  ElseIf (i < 4) // the second side of the surface is the arc of the skin, with gap one has two of them
    skin[] += {out[3]};
    If (fine && i == 3)
      skin[] += {out[4]};
    EndIf
  EndIf
EndFor
groove[] = {};
For i In {21 : 29}
  out[] = Extrude{{0, 1, 0}, {0, 0, 0}, Pi / 2}{ Curve{i}; Layers{arc}; Recombine; };
  groove[] += {out[1]};
EndFor
out[] = Extrude{{0, 1, 0}, {0, 0, 0}, Pi / 2}{ Curve{41}; Layers{arc}; Recombine; };
Physical Volume("ring") = {volumes[]};
Physical Surface("skin") = {skin[]};
Physical Surface("start") = {starts[]};
Physical Surface("end") = {ends[]};
Physical Surface("groove") = {groove[]};
Physical Surface("lid") = {out[1]};
