// Two discs, one on the other, in the meridian plane (x: radius, y: axis); r_in = 0 reaches the axis. The meshes do not match at
// the flat interface y = 0.
DefineConstant[
  n_lower = {13, Name "elements along the radius, lower disc"}, n_upper = {10, Name "elements along the radius, upper disc"},
  r_in = {0, Name "inner radius"}, r_out = {10, Name "outer radius"}
];
height = 4;
n[] = {n_lower, n_upper};
For b In {0 : 1}
  o = 10 * b;
  y = (b == 0) ? -height : height;
  Point(o + 1) = {r_in, 0, 0};
  Point(o + 2) = {r_out, 0, 0};
  Point(o + 3) = {r_out, y, 0};
  Point(o + 4) = {r_in, y, 0};
  Line(o + 1) = {o + 1, o + 2};
  Line(o + 2) = {o + 2, o + 3};
  Line(o + 3) = {o + 3, o + 4};
  Line(o + 4) = {o + 4, o + 1};
  Transfinite Curve{o + 1, o + 3} = n[b] + 1;
  Transfinite Curve{o + 2, o + 4} = Ceil(height * n[b] / (r_out - r_in)) + 1;
  side = (b == 0) ? -1 : 1; // the boundary of each disc turns to the left
  Curve Loop(o + 1) = {side * (o + 1), side * (o + 3 - side), side * (o + 3), side * (o + 3 + side)};
  Plane Surface(o + 1) = {o + 1};
  Transfinite Surface{o + 1};
  Recombine Surface{o + 1};
EndFor
Physical Surface("lower") = {1};
Physical Surface("upper") = {11};
Physical Curve("lower_top") = {1};
Physical Curve("upper_bottom") = {11};
Physical Curve("lower_bottom") = {3};
Physical Curve("upper_top") = {13};
Physical Curve("inside") = {4, 14};
Physical Curve("outside") = {2, 12};
