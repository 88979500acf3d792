// A pad of k x k x h bricks between two rigid sheets of n x n faces; lengths in mm.
DefineConstant[ n = {30, Name "n"}, k = {6, Name "k"}, h = {3, Name "h"}, gap = {0.05, Name "gap"} ];
// a square of side a and e x e faces with its corner at x, x, z
Macro Square
  p = newp;
  Point(p) = {x, x, z}; Point(p + 1) = {x + a, x, z}; Point(p + 2) = {x + a, x + a, z}; Point(p + 3) = {x, x + a, z};
  l = newl;
  Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  Transfinite Curve{l : l + 3} = e + 1;
  c = newll; Curve Loop(c) = {l, l + 1, l + 2, l + 3};
  f = news; Plane Surface(f) = {c};
  Transfinite Surface{f}; Recombine Surface{f};
Return
a = 0.4 * n; x = -a / 2; e = n;  // faces of the sheets are smaller than those of the pad
z = -gap; Call Square;
Physical Surface("bed") = {f};
z = h + gap; Call Square;
Physical Surface("lid") = {f};
a = k; x = -a / 2; e = k; z = 0; Call Square;
out[] = Extrude {0, 0, h} { Surface{f}; Layers{h}; Recombine; };
Physical Volume("pad") = {out[1]};
Physical Surface("pad_end") = {out[2]};
