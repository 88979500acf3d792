// Two blocks that share a corner. Lengths in mm.
h = 0.5;
Point(1)={0,0,0};Point(2)={1,0,0};Point(3)={1,1,0};Point(4)={0,1,0};
Point(5)={2,1,0};Point(6)={2,2,0};Point(7)={1,2,0};
Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};Line(4)={4,1};
Line(5)={3,5};Line(6)={5,6};Line(7)={6,7};Line(8)={7,3};
Curve Loop(1)={1:4};Plane Surface(1)={1};Curve Loop(2)={5:8};Plane Surface(2)={2};
Transfinite Surface{1,2};Recombine Surface{1,2};MeshSize{:}=h;
Physical Surface("low")={1};Physical Surface("high")={2};Physical Curve("floor")={1};Physical Curve("top")={7};
Physical Curve("side")={6};
