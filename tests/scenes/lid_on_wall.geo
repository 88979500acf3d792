DefineConstant[ n = 10, x = 1.03 ];
// A wide block on a wall below its middle; lengths in mm
Point(1)={0,0,0};Point(2)={4,0,0};Point(3)={4,1,0};Point(4)={0,1,0};
Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};Line(4)={4,1};
Curve Loop(1)={1:4};Plane Surface(1)={1};
Point(11)={x,-1,0};Point(12)={x+1,-1,0};Point(13)={x+1,0,0};Point(14)={x,0,0};
Line(11)={11,12};Line(12)={12,13};Line(13)={13,14};Line(14)={14,11};
Curve Loop(2)={11:14};Plane Surface(2)={2};
MeshSize{:}=1/n;
Physical Surface("lid")={1};Physical Surface("wall")={2};Physical Curve("top")={3};Physical Curve("bottom")={11};
Physical Curve("under")={1};Physical Curve("wall_sides")={12,13,14};
