// Two flanges, and a bolt with head and nut that clamps them at one side. Lengths in mm.
Point(1) = {0,0,0}; Point(2)={40,0,0}; Point(3)={40,10,0}; Point(4)={0,10,0};
For i In {1:4}
Line(i)={i,i%4+1};
EndFor
Curve Loop(1)={1:4}; Plane Surface(1)={1};
Point(11) = {0,10.0,0}; Point(12)={40,10.0,0}; Point(13)={40,20,0}; Point(14)={0,20,0};
For i In {1:4}
Line(10+i)={10+i,10+i%4+1};
EndFor
Curve Loop(2)={11:14}; Plane Surface(2)={2};
Transfinite Curve{1,3}=21; Transfinite Curve{11,13}=17; Transfinite Curve{2,4,12,14}=5;
Transfinite Surface{1,2}; Recombine Surface{1,2};
// The bolt: its head is over the upper flange, its nut below the lower one
Point(21)={45,-3,0}; Point(22)={50,-3,0}; Point(23)={50,0,0}; Point(24)={50,20,0}; Point(25)={50,23,0}; Point(26)={45,23,0};
Point(27)={45,20,0}; Point(28)={45,0,0}; Point(29)={30,20,0}; Point(30)={30,23,0}; Point(31)={30,0,0}; Point(32)={30,-3,0};
Line(21)={28,23}; Line(22)={23,24}; Line(23)={24,27}; Line(24)={27,28}; Curve Loop(3)={21,22,23,24}; Plane Surface(3)={3};
Line(31)={29,27}; Line(32)={24,25}; Line(33)={25,30}; Line(34)={30,29}; Curve Loop(4)={31,-23,32,33,34}; Plane Surface(4)={4};
Line(41)={32,22}; Line(42)={22,23}; Line(43)={28,31}; Line(44)={31,32}; Curve Loop(5)={41,42,-21,43,44}; Plane Surface(5)={5};
MeshSize{21:32}=1.5;
Physical Surface("low")={1}; Physical Surface("up")={2}; Physical Surface("shank")={3}; Physical Surface("head")={4}; Physical Surface("nut")={5};
Physical Curve("left_low")={4}; Physical Curve("left_up")={14}; Physical Curve("joint_low")={3}; Physical Curve("joint_up")={11};
Physical Curve("up_top")={13}; Physical Curve("low_bottom")={1}; Physical Curve("under_head")={31}; Physical Curve("under_nut")={43}; Physical Curve("bolt_axis")={22};
