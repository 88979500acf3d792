// A thin plate of n x n x m bricks and a block of k x k x h bricks on its middle; lengths in mm.
DefineConstant[ n = {60, Name "n"}, m = {2, Name "m"}, k = {16, Name "k"}, h = {6, Name "h"}, gap = {0.1, Name "gap"} ];
// 1: origin and length of a side, height, layers, elements along a side
Macro Slab
  p = newp;
  Point(p) = {x, x, z}; Point(p + 1) = {x + a, x, z}; Point(p + 2) = {x + a, x + a, z}; Point(p + 3) = {x, x + a, z};
  l = newl;
  Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  Transfinite Curve{l : l + 3} = e + 1;
  c = newll; Curve Loop(c) = {l, l + 1, l + 2, l + 3};
  f = news; Plane Surface(f) = {c};
  Transfinite Surface{f}; Recombine Surface{f};
  out[] = Extrude {0, 0, d} { Surface{f}; Layers{d}; Recombine; };
Return
x = 0; z = 0; a = n; e = n; d = m;
Call Slab;
Physical Surface("plate_rim") = {out[2], out[3], out[4], out[5]};
Physical Surface("plate_top") = {out[0]};
Physical Volume("plate") = {out[1]};
x = (n - k) / 2; z = m + gap; a = k; e = Round(1.03 * k); d = h;
Call Slab;
Physical Surface("block_top") = {out[0]};
Physical Surface("block_bottom") = {f};
Physical Volume("block") = {out[1]};
