// Two blocks of unit width that share the nodes of their common side.
DefineConstant[ n = {8, Name "elements through a block"}, simplex = {1, Name "1: triangles"} ];
Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={1,0.5,0}; Point(4)={1,1,0}; Point(5)={0,1,0}; Point(6)={0,0.5,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,5}; Line(5)={5,6}; Line(6)={6,1}; Line(7)={3,6};
Curve Loop(1)={1,2,7,6}; Curve Loop(2)={3,4,5,-7};
Plane Surface(1)={1}; Plane Surface(2)={2};
Transfinite Curve{1,7,4}=2*n+1; Transfinite Curve{2,3,5,6}=n+1;
Transfinite Surface{1,2};
If (!simplex)
Recombine Surface{1,2};
EndIf
Physical Surface("low")={1}; Physical Surface("high")={2};
Physical Curve("bottom")={1}; Physical Curve("top")={4}; Physical Curve("sides")={2,3,5,6};
