// three O-rings stacked in a gland, axisymmetric
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.35/refine; r = 2.5; w = 5.2; X = 20;
skin[]={}; vol[]={};
For k In {0:2}
  b = 10+10*k; x = X + w/2; y = r + 2*r*k;
  Point(b) = {x,y,0,2*h};
  For i In {0:3}
    Point(b+1+i) = {x+r*Cos(i*Pi/2),y+r*Sin(i*Pi/2),0,h};
  EndFor
  For i In {0:3}
    Circle(b+1+i) = {b+1+i,b,b+1+(i+1)%4};
  EndFor
  Curve Loop(b) = {b+1:b+4}; Plane Surface(b) = {b};
  Physical Surface(Sprintf("ring%g", k+1)) = {b};
EndFor
// gland: U shape
Point(101)={X-3,-3,0,1};Point(102)={X+w+3,-3,0,1};Point(103)={X+w+3,20,0,1};Point(104)={X+w,20,0,1};Point(105)={X+w,0,0,h};Point(106)={X,0,0,h};Point(107)={X,20,0,1};Point(108)={X-3,20,0,1};
For i In {0:7}
  Line(101+i)={101+i,101+(i+1)%8};
EndFor
Curve Loop(100)={101:108}; Plane Surface(100)={100}; Physical Surface("gland")={100};
Point(201)={X+.1,6*r,0,h};Point(202)={X+w-.1,6*r,0,h};Point(203)={X+w-.1,18,0,1};Point(204)={X+.1,18,0,1};
For i In {0:3}
  Line(201+i)={201+i,201+(i+1)%4};
EndFor
Curve Loop(200)={201:204}; Plane Surface(200)={200}; Physical Surface("lid")={200};
Physical Curve("gland_out")={101,102,108}; Physical Curve("lid_top")={203};
