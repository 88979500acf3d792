n = 24; m = 6;
Point(1) = {0,0,0};
For k In {0:3}
  Point(10+k) = {15*Cos(k*Pi/2), 15*Sin(k*Pi/2), 0};
  Point(20+k) = {20*Cos(k*Pi/2), 20*Sin(k*Pi/2), 0};
  Line(30+k) = {10+k, 20+k};
EndFor
For k In {0:3}
  Circle(40+k) = {10+k, 1, 10+(k+1)%4};
  Circle(50+k) = {20+k, 1, 20+(k+1)%4};
EndFor
For k In {0:3}
  Curve Loop(60+k) = {30+k, 50+k, -(30+(k+1)%4), -(40+k)};
  Plane Surface(60+k) = {60+k};
EndFor
Transfinite Curve {30:33} = m+1;
Transfinite Curve {40:43,50:53} = n+1;
Transfinite Surface {60:63};
Recombine Surface {60:63};
Physical Surface("cover") = {60:63};
Physical Curve("inner") = {40:43};
Physical Curve("tread") = {50:53};
