// Three blocks that meet in a line.
Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={1,0.5,0}; Point(4)={1,1,0}; Point(5)={0.5,1,0}; Point(6)={0,1,0};
Point(7)={0,0.5,0}; Point(8)={0.5,0.5,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,5}; Line(5)={5,6}; Line(6)={6,7}; Line(7)={7,1};
Line(8)={7,8}; Line(9)={8,3}; Line(10)={8,5};
Curve Loop(1)={1,2,-9,-8,7}; Curve Loop(2)={9,3,4,-10}; Curve Loop(3)={8,10,5,6};
Plane Surface(1)={1}; Plane Surface(2)={2}; Plane Surface(3)={3};
MeshSize{:}=0.25;
Physical Surface("low")={1}; Physical Surface("right")={2}; Physical Surface("left")={3};
Physical Curve("bottom")={1}; Physical Curve("top")={4,5};
