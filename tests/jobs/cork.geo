// A cork, a cone of radius 8.6 below and 10.2 above, 20 high, in the mouth of a bottle neck of bore 9.2;
// axisymmetric, mm
DefineConstant[ refine={1} ];
h=1/refine;
Point(1)={0,13,0,h}; Point(2)={8.6,13,0,h}; Point(3)={10.2,33,0,h}; Point(4)={0,33,0,h};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1}; Curve Loop(1)={1:4}; Plane Surface(1)={1};
Point(11)={9.2,0,0,h}; Point(12)={13,0,0,2*h}; Point(13)={13,20,0,2*h}; Point(14)={10.7,20,0,h};
Point(15)={9.2,18.5,0,h}; Point(16)={10.7,18.5,0,h};
Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Circle(14)={14,16,15}; Line(15)={15,11}; Curve Loop(2)={11:15};
Plane Surface(2)={2};
Physical Surface("cork")={1}; Physical Surface("neck")={2};
Physical Curve("cork_skin")={1,2}; Physical Curve("top")={3}; Physical Curve("axis")={4};
Physical Curve("base")={11}; Physical Curve("mouth")={13,14,15};
