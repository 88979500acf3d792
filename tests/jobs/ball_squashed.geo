// A rubber ball and a plate above it; axisymmetric, x = r, y = z; upper half. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.6 / refine; R=10;
Point(1)={0,0,0,h}; Point(2)={R,0,0,h}; Point(3)={0,R,0,h};
Line(1)={1,2}; Circle(2)={2,1,3}; Line(3)={3,1}; Curve Loop(1)={1:3}; Plane Surface(1)={1};
Point(11)={0,R,0,h}; Point(12)={14,R,0,h}; Point(13)={14,R+4,0,2 / refine}; Point(14)={0,R+4,0,2 / refine};
Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Line(14)={14,11}; Curve Loop(2)={11:14}; Plane Surface(2)={2};
Physical Surface("ball")={1}; Physical Surface("plate")={2}; Physical Curve("skin")={2}; Physical Curve("equator")={1}; Physical Curve("axis")={3}; Physical Curve("plate_axis")={14}; Physical Curve("face")={11}; Physical Curve("plate_top")={13};
