// A straight seal with the section, groove and lid of o_ring.geo, along z
Include "../../meshes/o_ring.geo";
DefineConstant[ length = {5, Name "of the seal"}, layers = {1, Name "elements along it"} ];
Delete Physicals;
skin[] = {};
starts[] = {};
ends[] = {};
volumes[] = {};
For i In {0 : #ring[] - 1}
  out[] = Extrude{0, 0, length}{ Surface{ring[i]}; Layers{layers}; Recombine; };
  starts[] += {ring[i]};
  ends[] += {out[0]};
  volumes[] += {out[1]};
  If (i < 4) // the second side of the surface is the arc of the skin
    skin[] += {out[3]};
  EndIf
EndFor
groove[] = {};
For i In {21 : 29}
  out[] = Extrude{0, 0, length}{ Curve{i}; Layers{layers}; Recombine; };
  groove[] += {out[1]};
EndFor
out[] = Extrude{0, 0, length}{ Curve{41}; Layers{layers}; Recombine; };
Physical Volume("seal") = {volumes[]};
Physical Surface("skin") = {skin[]};
Physical Surface("start") = {starts[]};
Physical Surface("end") = {ends[]};
Physical Surface("groove") = {groove[]};
Physical Surface("lid") = {out[1]};
