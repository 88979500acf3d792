// A flat wire that is clamped at its left end, side view. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
Point(1)={-5,0,0}; Point(2)={60,0,0}; Point(3)={60,2,0}; Point(4)={-5,2,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1};
Transfinite Curve{2,4} = Round(4 * refine) + 1; Transfinite Curve{1,3} = Round(65 * refine) + 1;
Curve Loop(1)={1:4}; Plane Surface(1)={1}; Transfinite Surface{1}; Recombine Surface{1};
Physical Surface("wire")={1}; Physical Curve("clamp")={4}; Physical Curve("under")={1}; Physical Curve("top")={3};
