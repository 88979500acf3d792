// A rubber tube and a plate above it, a quarter by symmetry. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.5 / refine; R=10; r=7;
Point(1)={0,0,0,h}; Point(2)={r,0,0,h}; Point(3)={0,r,0,h}; Point(5)={R,0,0,h}; Point(6)={0,R,0,h};
Circle(1)={2,1,3}; Circle(3)={5,1,6}; Line(5)={2,5}; Line(6)={3,6};
Curve Loop(1)={1,6,-3,-5}; Plane Surface(1)={1};
Point(11)={0,R,0,h}; Point(12)={16,R,0,h}; Point(13)={16,R+3,0,2 / refine}; Point(14)={0,R+3,0,2 / refine};
Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Line(14)={14,11}; Curve Loop(2)={11:14}; Plane Surface(2)={2};
Physical Surface("tube")={1}; Physical Surface("plate")={2}; Physical Curve("skin")={3}; Physical Curve("bottom")={5}; Physical Curve("side")={6}; Physical Curve("face")={11}; Physical Curve("plate_top")={13};
