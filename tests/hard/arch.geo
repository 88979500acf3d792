// A shallow circular arch over the x axis, half of it from its crown on x = 0 to its clamp. Lengths in mm.
DefineConstant[
  span = {100, Name "half the distance of the clamps"}, rise = {15, Name "of the crown over the clamps"}, wall = {2, Name "thickness"},
  n_arc = {40, Name "elements around"}, n_wall = {2, Name "elements through the wall"}
];
radius = (span^2 + rise^2) / (2 * rise);
angle = Asin(span / radius);
Point(1) = {0, rise - radius, 0};
For i In {0 : 1}
  r = radius + (i - 0.5) * wall;
  Point(10 + i) = {0, rise - radius + r, 0};
  Point(20 + i) = {r * Sin(angle), rise - radius + r * Cos(angle), 0};
  Circle(1 + i) = {10 + i, 1, 20 + i};
EndFor
Line(3) = {10, 11};
Line(4) = {20, 21};
Curve Loop(1) = {1, 4, -2, -3};
Plane Surface(1) = {1};
Transfinite Curve{1, 2} = n_arc + 1;
Transfinite Curve{3, 4} = n_wall + 1;
Transfinite Surface{1};
Recombine Surface{1};

Physical Surface("arch") = {1};
Physical Curve("back") = {2};
Physical Curve("crown") = {3};
Physical Curve("clamp") = {4};
