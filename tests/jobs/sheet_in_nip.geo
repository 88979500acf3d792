// A rubber cover on a rigid core, its lower half, above a sheet; plane strain (sheet_in_nip.yaml)
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h=0.8/refine;
Point(1)={0,0,0}; Point(2)={-10,0,0,2*h}; Point(3)={10,0,0,2*h}; Point(4)={-14,0,0,h}; Point(5)={14,0,0,h}; Point(6)={0,-14,0,h}; Point(7)={0,-10,0,h}; 
Circle(1)={2,1,7}; Circle(2)={7,1,3}; Line(3)={3,5}; Circle(4)={5,1,6}; Circle(5)={6,1,4}; Line(6)={4,2};
Curve Loop(1)={1:6}; Plane Surface(1)={1};
g=0.5/refine;
Point(11)={-20,-14.4,0,g}; Point(12)={20,-14.4,0,g}; Point(13)={20,-14,0,g}; Point(14)={-20,-14,0,g};
Line(11)={11,12}; Line(12)={12,13}; Line(13)={13,14}; Line(14)={14,11}; Curve Loop(2)={11:14}; Plane Surface(2)={2};
Transfinite Curve{11,13}=Round(40/g)+1; Transfinite Curve{12,14}=Round(2*refine)+1; Transfinite Surface{2}; Recombine Surface{2};
Physical Surface("cover")={1}; Physical Surface("sheet")={2}; Physical Curve("core")={1,2}; Physical Curve("skin")={4,5}; Physical Curve("top")={13}; Physical Curve("bottom")={11}; Physical Curve("lead")={12};
