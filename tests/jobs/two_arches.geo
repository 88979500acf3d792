// Two arches of radii 10 and 12 mm; the upper one stands upside down beside the crown of the lower one.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
n = 2 * Round(20 * refine); m = Round(3 * refine);
Macro Arch
  p = newp;
  Point(p) = {cx, cy, 0}; Point(p+1) = {cx - 10, cy, 0}; Point(p+2) = {cx, cy + s*10, 0}; Point(p+3) = {cx + 10, cy, 0};
  Point(p+4) = {cx - 12, cy, 0}; Point(p+5) = {cx, cy + s*12, 0}; Point(p+6) = {cx + 12, cy, 0};
  c = newl;
  Circle(c) = {p+1, p, p+2}; Circle(c+1) = {p+2, p, p+3}; Circle(c+2) = {p+4, p, p+5}; Circle(c+3) = {p+5, p, p+6};
  Line(c+4) = {p+1, p+4}; Line(c+5) = {p+2, p+5}; Line(c+6) = {p+3, p+6};
  ll = newll; Curve Loop(ll) = {c, c+5, -(c+2), -(c+4)}; q = news; Plane Surface(q) = {ll};
  ll = newll; Curve Loop(ll) = {c+1, c+6, -(c+3), -(c+5)}; q2 = news; Plane Surface(q2) = {ll};
  Transfinite Curve{c, c+1, c+2, c+3} = n/2 + 1; Transfinite Curve{c+4, c+5, c+6} = m + 1;
  Transfinite Surface{q, q2}; Recombine Surface{q, q2};
Return
cx = 0; cy = 0; s = 1; Call Arch;
Physical Surface("lower") = {q, q2}; Physical Curve("lower_outer") = {c+2, c+3}; Physical Curve("lower_feet") = {c+4, c+6};
cx = -14; cy = 22.5; s = -1; Call Arch;
ReverseMesh Surface{q, q2};
Physical Surface("upper") = {q, q2}; Physical Curve("upper_outer") = {c+2, c+3}; Physical Curve("upper_feet") = {c+4, c+6};
