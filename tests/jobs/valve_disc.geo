// A rubber disc above the bead of a seat, axisymmetric, x = r, y = z. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.5 / refine;
Point(1)={0,0,0,h}; Point(2)={20,0,0,h}; Point(3)={20,2,0,h}; Point(4)={0,2,0,h};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1};
Curve Loop(1)={1:4}; Plane Surface(1)={1};
Point(11)={7,-6,0,h}; Point(12)={7,-4,0,h}; Point(13)={8,-3,0,h/2}; Point(14)={9,-4,0,h}; Point(15)={9,-6,0,h};
Point(16)={8,-4,0,h};
Line(11)={11,12}; Circle(12)={12,16,13}; Circle(13)={13,16,14}; Line(14)={14,15};
Physical Surface("disc")={1}; Physical Curve("axis")={4}; Physical Curve("rim")={2}; Physical Curve("under")={1};
Physical Curve("above")={3}; Physical Curve("seat")={11:14};
