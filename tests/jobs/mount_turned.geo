// A bonded mount: a ring of rubber between a pin and a sleeve, mm
DefineConstant[ refine = {1, Name "divides all element sizes"}, a = {5}, b = {10}, L = {12} ];
n = Ceil(3 * refine); m = 2 * Ceil(6 * refine);
For k In {0:3}
  t = k*Pi/2; 
  Point(10+k) = {a*Cos(t), a*Sin(t), 0}; Point(20+k) = {b*Cos(t), b*Sin(t), 0};
EndFor
Point(1) = {0,0,0};
For k In {0:3}
  Circle(10+k) = {10+k,1,10+(k+1)%4}; Circle(20+k) = {20+k,1,20+(k+1)%4}; Line(30+k) = {10+k,20+k};
EndFor
For k In {0:3}
  Curve Loop(k+1) = {10+k, 30+(k+1)%4, -(20+k), -(30+k)}; Plane Surface(k+1) = {k+1};
EndFor
Transfinite Curve{10:13,20:23} = m/2+1; Transfinite Curve{30:33} = n+1; Transfinite Surface{1:4}; Recombine Surface{1:4};
in[] = {}; out[] = {}; v[] = {};
For k In {1:4}
  e[] = Extrude{0,0,L}{ Surface{k}; Layers{Ceil(4 * refine)}; Recombine; };
  v[] += {e[1]}; in[] += {e[2]}; out[] += {e[4]};
EndFor
Physical Volume("rubber") = {v[]}; Physical Surface("pin") = {in[]}; Physical Surface("sleeve") = {out[]};
