// Two half rings, of which the upper one opens upwards and is dragged over the lower one.
DefineConstant[
  n_arc = {64, Name "elements along each half ring (even)"}, n_wall = {4, Name "elements over the wall"},
  rise = {17, Name "of the upper ring's centre over that of the lower one"},
  apart = {0.001, Name "gap at the start"}
];
shift = -Sqrt((22 + apart)^2 - rise^2); // along x, of the upper ring's centre
r_in[] = {8, 10};
r_out[] = {10, 12};
For b In {0 : 1}
  o = 100 * b;
  s = 1 - 2 * b;
  x = b * shift;
  y = b * rise;
  Point(o + 1) = {x, y, 0};
  Point(o + 2) = {x + r_in[b], y, 0};
  Point(o + 3) = {x, y + s * r_in[b], 0};
  Point(o + 4) = {x - r_in[b], y, 0};
  Point(o + 5) = {x + r_out[b], y, 0};
  Point(o + 6) = {x, y + s * r_out[b], 0};
  Point(o + 7) = {x - r_out[b], y, 0};
  Circle(o + 1) = {o + 2, o + 1, o + 3};
  Circle(o + 2) = {o + 3, o + 1, o + 4};
  Circle(o + 3) = {o + 5, o + 1, o + 6};
  Circle(o + 4) = {o + 6, o + 1, o + 7};
  Line(o + 5) = {o + 2, o + 5};
  Line(o + 6) = {o + 3, o + 6};
  Line(o + 7) = {o + 4, o + 7};
  Curve Loop(o + 1) = {o + 5, o + 3, -(o + 6), -(o + 1)};
  Curve Loop(o + 2) = {o + 6, o + 4, -(o + 7), -(o + 2)};
  Plane Surface(o + 1) = {o + 1};
  Plane Surface(o + 2) = {o + 2};
  Transfinite Curve{o + 1, o + 2, o + 3, o + 4} = n_arc / 2 + 1;
  Transfinite Curve{o + 5, o + 6, o + 7} = n_wall + 1;
  Transfinite Surface{o + 1, o + 2};
  Recombine Surface{o + 1, o + 2};
EndFor
Physical Surface("lower") = {1, 2};
Physical Surface("upper") = {101, 102};
Physical Curve("lower_outer") = {3, 4};
Physical Curve("upper_outer") = {103, 104};
Physical Curve("lower_ends") = {5, 7};
Physical Curve("upper_ends") = {105, 107};
