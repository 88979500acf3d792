// Section of a rubber tube in a box. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
n = 4 * Ceil(16 * refine);
R = 8; t = 0.8; Point(1) = {0,0,0}; 
Point(2)={R,0,0};Point(3)={0,R,0};Point(4)={-R,0,0};Point(5)={0,-R,0};
r=R-t; Point(6)={r,0,0};Point(7)={0,r,0};Point(8)={-r,0,0};Point(9)={0,-r,0};
Circle(1)={2,1,3};Circle(2)={3,1,4};Circle(3)={4,1,5};Circle(4)={5,1,2};
Circle(5)={6,1,7};Circle(6)={7,1,8};Circle(7)={8,1,9};Circle(8)={9,1,6};
Line(9)={6,2};Line(10)={7,3};Line(11)={8,4};Line(12)={9,5};
Curve Loop(1)={5,10,-1,-9};Curve Loop(2)={6,11,-2,-10};Curve Loop(3)={7,12,-3,-11};Curve Loop(4)={8,9,-4,-12};
Plane Surface(1)={1};Plane Surface(2)={2};Plane Surface(3)={3};Plane Surface(4)={4};
Transfinite Curve {1:8} = n/4+1; Transfinite Curve {9:12}=Ceil(2 * refine) + 1;
Transfinite Surface {1:4}; Recombine Surface {1:4};
Physical Surface("tube")={1:4}; Physical Curve("outer")={1:4}; Physical Curve("inner")={5:8};
a = 12; b = 9; Point(20)={-a,-b,0,2};Point(21)={a,-b,0,2};Point(22)={a,b,0,2};Point(23)={-a,b,0,2};
Line(20)={20,21};Line(21)={21,22};Line(22)={22,23};Line(23)={23,20};
Physical Curve("box")={20:23};
