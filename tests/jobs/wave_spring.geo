// A strip whose middle line is a cosine, half a wave between planes of symmetry; plane strain (wave_spring.yaml)
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
n=40; L=20; A=2; t=0.5;
For i In {0:n}
  x=L*i/n;
  Point(i+1)={x, A*(1-Cos(Pi*x/L)), 0};
  Point(101+i)={x, A*(1-Cos(Pi*x/L))+t, 0};
EndFor
Spline(1)={1:n+1}; Spline(2)={101:101+n}; Line(3)={1,101}; Line(4)={n+1,101+n};
Curve Loop(1)={1,4,-2,-3}; Plane Surface(1)={1};
Transfinite Curve{1,2}=50*refine+1; Transfinite Curve{3,4}=2*refine+1; Transfinite Surface{1}; Recombine Surface{1};
Physical Surface("strip")={1}; Physical Curve("low")={1}; Physical Curve("high")={2}; Physical Curve("sym")={3,4};
