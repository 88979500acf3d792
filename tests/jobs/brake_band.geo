// A band 2 thick around a drum of radius 50, from -30 to 210 degrees; plane
DefineConstant[ refine={1} ];
h=2/refine; a=-30*Pi/180; b=210*Pi/180;
Point(1)={0,0,0};
For i In {0:4}
  q=a+(b-a)*i/4;
  Point(10+i)={50*Cos(q),50*Sin(q),0}; Point(20+i)={52*Cos(q),52*Sin(q),0};
EndFor
For i In {0:3}
  Circle(10+i)={10+i,1,11+i}; Circle(20+i)={20+i,1,21+i};
EndFor
For i In {0:4}
  Line(30+i)={10+i,20+i};
EndFor
n=Ceil(50*(b-a)/4/h);
For i In {0:3}
  Curve Loop(i+1)={10+i,31+i,-(20+i),-(30+i)}; Plane Surface(i+1)={i+1};
  Transfinite Curve{10+i,20+i}=n+1; Transfinite Curve{30+i,31+i}=2;
  Transfinite Surface{i+1}; Recombine Surface{i+1};
EndFor
For i In {0:3}
  q=Pi/2*i;
  Point(40+i)={49.9*Cos(q),49.9*Sin(q),0,h}; Point(50+i)={40*Cos(q),40*Sin(q),0,3*h};
EndFor
For i In {0:3}
  Circle(40+i)={40+i,1,40+(i+1)%4}; Circle(50+i)={50+i,1,50+(i+1)%4};
EndFor
Curve Loop(10)={40:43}; Curve Loop(11)={50:53}; Plane Surface(10)={10,11};
Physical Surface("band")={1:4}; Physical Surface("drum")={10};
Physical Curve("lining")={10:13}; Physical Curve("fixed")={34}; Physical Curve("pulled")={30};
Physical Curve("rim")={40:43}; Physical Curve("hub")={50:53};
