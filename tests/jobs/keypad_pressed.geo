// A rubber key of a keypad: cap, thin conical skirt and base; axisymmetric, x = r, y = z, mm
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.3/refine; k = 0.15/refine;
Point(1) = {0,2.2,0,h}; Point(2) = {2.0,2.2,0,h}; Point(3) = {4.0,0.4,0,k}; Point(4) = {4.0,0,0,k}; Point(5) = {6,0,0,h}; Point(6) = {6,1,0,h}; Point(7) = {4.3,1,0,k}; Point(8) = {2.4,2.7,0,k}; Point(9) = {2.4,4,0,h}; Point(10) = {0,4,0,h};
For i In {1:10}
  Line(i) = {i, i%10+1};
EndFor
Curve Loop(1) = {1:10}; Plane Surface(1) = {1};
Physical Surface("key") = {1}; Physical Curve("below") = {1:4}; Physical Curve("cap") = {9}; Physical Curve("base") = {4}; Physical Curve("axis") = {10}; Physical Curve("skin") = {1:3};
