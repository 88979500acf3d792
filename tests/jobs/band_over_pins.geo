// A flat band between two pins. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ]; h = 0.7/refine;
Point(1)={-40,0,0,h}; Point(2)={40,0,0,h}; Point(3)={40,1,0,h}; Point(4)={-40,1,0,h};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1};
n=Round(80/h); m=Round(1.4*refine);
Transfinite Curve{1,3}=n+1; Transfinite Curve{2,4}=m+1; Curve Loop(1)={1:4}; Plane Surface(1)={1}; Transfinite Surface{1}; Recombine Surface{1};
Physical Surface("belt")={1}; Physical Curve("low")={1}; Physical Curve("right")={2}; Physical Curve("up")={3}; Physical Curve("left")={4};
