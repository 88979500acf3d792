// Quarters of two flat rings about the y axis, one on the other. Their faces are long around the axis and narrow across.
DefineConstant[ n_across = {24, Name "elements of the lower ring across"},
                n_around = {6, Name "elements of the lower ring around the quarter"},
                m_across = {17, Name "elements of the upper ring across"},
                m_around = {7, Name "elements of the upper ring around the quarter"} ];
inner = 20; outer = 24; height = 2;
gap = 0.001; // between them, so that their points stay apart

For i In {0 : 1}
  p = newp;
  Point(p) = {inner, (i - 1) * height + i * gap, 0};
  Point(p + 1) = {outer, (i - 1) * height + i * gap, 0};
  Point(p + 2) = {outer, i * (height + gap), 0};
  Point(p + 3) = {inner, i * (height + gap), 0};
  l = newl;
  Line(l) = {p, p + 1};
  Line(l + 1) = {p + 1, p + 2};
  Line(l + 2) = {p + 2, p + 3};
  Line(l + 3) = {p + 3, p};
  c = newll;
  Curve Loop(c) = {l, l + 1, l + 2, l + 3};
  s = news;
  Plane Surface(s) = {c};
  Transfinite Curve{l, l + 2} = (i ? m_across : n_across) + 1;
  Transfinite Curve{l + 1, l + 3} = 3;
  Transfinite Surface{s};
  Recombine Surface{s};
  around = i ? m_around : n_around;
  out[] = Extrude{{0, 1, 0}, {0, 0, 0}, Pi / 2}{ Surface{s}; Layers{around}; Recombine; };
  If (i)
    Physical Volume("upper") = {out[1]};
    Physical Surface("press") = {out[2]};
    Physical Surface("push") = {out[4]};
  Else
    Physical Volume("lower") = {out[1]};
    Physical Surface("seat") = {out[4]};
    Physical Surface("foot") = {out[2]};
  EndIf
  starts[] += {s};
  ends[] += {out[0]};
EndFor
Physical Surface("start") = {starts[]};
Physical Surface("end") = {ends[]};
