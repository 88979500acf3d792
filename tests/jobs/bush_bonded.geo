// A rubber bush, half of it by symmetry. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.8 / refine; R=20; r=10;
Point(1)={0,0,0,h}; Point(2)={r,0,0,h}; Point(3)={0,r,0,h}; Point(4)={-r,0,0,h}; Point(5)={R,0,0,h}; Point(6)={0,R,0,h}; Point(7)={-R,0,0,h};
Circle(1)={2,1,3}; Circle(2)={3,1,4}; Circle(3)={5,1,6}; Circle(4)={6,1,7}; Line(5)={2,5}; Line(6)={4,7};
Curve Loop(1)={1,2,6,-4,-3,-5}; Plane Surface(1)={1};
Physical Surface("rubber")={1}; Physical Curve("inner")={1,2}; Physical Curve("outer")={3,4}; Physical Curve("sym")={5,6};
