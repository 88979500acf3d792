// Section of a suction cup with its stem, axisymmetric, x = r, y = z. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.35 / refine;
Point(1)={0,8,0,h}; Point(2)={0,12,0,1/refine}; Point(3)={3,12,0,1/refine}; Point(4)={3,9,0,h};
Point(5)={15,0.3,0,h/2}; Point(6)={14.2,0,0,h/2}; Point(7)={4,6.5,0,h};
Point(8)={12,6,0,h}; Point(9)={10,4.5,0,h};
Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};
Spline(4)={4,8,5}; Line(5)={5,6}; Spline(6)={6,9,7,1};
Curve Loop(1)={1,2,3,4,5,6}; Plane Surface(1)={1};
Physical Surface("cup")={1}; Physical Curve("axis")={1}; Physical Curve("stem")={2}; Physical Curve("outside")={3,4};
Physical Curve("skin")={3,4,5,6};
Physical Curve("inside")={5,6};
