// Quarter of a section through a tube on a rod and one of the four jaws that crimp it. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.25 / refine;
Point(1)={0,0,0,h};
Point(2)={2,0,0,h}; Point(3)={0,2,0,h};
Line(1)={1,2}; Circle(2)={2,1,3}; Line(3)={3,1}; Curve Loop(1)={1:3}; Plane Surface(1)={1};
Point(4)={2.2,0,0,h}; Point(5)={3.2,0,0,h}; Point(6)={0,3.2,0,h}; Point(7)={0,2.2,0,h};
Line(4)={4,5}; Circle(5)={5,1,6}; Line(6)={6,7}; Circle(7)={7,1,4}; Curve Loop(2)={4:7}; Plane Surface(2)={2};
Point(20)={2.35,2.35,0,h/2}; Point(21)={2.9,2.2,0,h/2}; Point(22)={2.2,2.9,0,h/2};
Point(23)={5,2.2,0,h}; Point(24)={2.2,5,0,h};
Line(20)={21,20}; Line(21)={20,22}; Line(22)={23,21}; Line(23)={22,24};
Physical Surface("rod")={1}; Physical Surface("tube")={2};
Physical Curve("sx")={3,6}; Physical Curve("sy")={1,4};
Physical Curve("shaft")={2}; Physical Curve("bore")={7}; Physical Curve("outside")={5}; Physical Curve("jaw")={20:23};
