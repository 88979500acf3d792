// Three conical spring washers on each other, in series; the section, x = r. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"}, r_in = 5, r_out = 10, thick = 0.8, rise = 0.6 ];
n = Round(24 * refine); m = Round(4 * refine);
For k In {0:2}
  b = 10 * k;
  up = (k % 2 == 0) ? 1 : 0;
  base = k * (rise + thick * 1.0);
  y1 = base + up * rise;
  y2 = base + (1 - up) * rise;
  Point(b + 1) = {r_in, y1, 0};
  Point(b + 2) = {r_out, y2, 0};
  Point(b + 3) = {r_out, y2 + thick, 0};
  Point(b + 4) = {r_in, y1 + thick, 0};
  Line(b + 1) = {b + 1, b + 2}; Line(b + 2) = {b + 2, b + 3}; Line(b + 3) = {b + 3, b + 4}; Line(b + 4) = {b + 4, b + 1};
  Curve Loop(b + 1) = {b + 1:b + 4};
  Plane Surface(b + 1) = {b + 1};
  Transfinite Curve{b + 1, b + 3} = n + 1;
  Transfinite Curve{b + 2, b + 4} = m + 1;
  Transfinite Surface{b + 1}; Recombine Surface{b + 1};
EndFor
Physical Surface("low") = {1};  Physical Surface("middle") = {11};  Physical Surface("high") = {21};
Physical Curve("low_skin") = {1:4};
Physical Curve("high_skin") = {21:24};
