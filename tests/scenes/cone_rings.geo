// Quarters of two rings about the y axis that touch along a cone. The faces of the lower one are long around the axis
// and narrow across it.
DefineConstant[ n_across = {8, Name "elements of the lower ring across"},
                n_around = {5, Name "elements of the lower ring around the quarter"},
                n_upper = {4, Name "elements of the upper ring across, and around"} ];
inner = 8; outer = 12; height = 2; rise = 1; // the cone rises by rise from the inner to the outer side

// A quadrilateral with its corners against the clock: bottom, outer side, top, inner side
For i In {0 : 1}
  p = newp;
  Point(p) = {inner + 0.5 * i, i ? rise / 8 : -height, 0};
  Point(p + 1) = {outer - 0.5 * i, i ? rise * 7 / 8 : -height, 0};
  Point(p + 2) = {outer - 0.5 * i, i ? height + rise : rise, 0};
  Point(p + 3) = {inner + 0.5 * i, i ? height + rise : 0, 0};
  l = newl;
  Line(l) = {p, p + 1};
  Line(l + 1) = {p + 1, p + 2};
  Line(l + 2) = {p + 2, p + 3};
  Line(l + 3) = {p + 3, p};
  c = newll;
  Curve Loop(c) = {l, l + 1, l + 2, l + 3};
  s = news;
  Plane Surface(s) = {c};
  Transfinite Curve{l, l + 2} = (i ? n_upper : n_across) + 1;
  Transfinite Curve{l + 1, l + 3} = 2;
  Transfinite Surface{s};
  Recombine Surface{s};
  around = i ? n_upper : n_around;
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
