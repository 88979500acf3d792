// A wedge between a wall and an inclined block
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
a = 0.12; h = 0.8/refine; c = 1/refine;
Point(1) = {0, 0, 0, h}; Point(2) = {4, 0, 0, h}; Point(3) = {4+12*a, 12, 0, h}; Point(4) = {0, 12, 0, h};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(5) = {-3, -6, 0, c}; Point(6) = {0, -6, 0, c}; Point(7) = {0, 16, 0, c}; Point(8) = {-3, 16, 0, c};
Line(5) = {5,6}; Line(6) = {6,7}; Line(7) = {7,8}; Line(8) = {8,5}; Curve Loop(2) = {5:8}; Plane Surface(2) = {2};
Point(9) = {4-6*a, -6, 0, c}; Point(10) = {9, -6, 0, c}; Point(11) = {9, 16, 0, c}; Point(12) = {4+16*a, 16, 0, c};
Line(9) = {9,10}; Line(10) = {10,11}; Line(11) = {11,12}; Line(12) = {12,9}; Curve Loop(3) = {9:12}; Plane Surface(3) = {3};
Physical Surface("wedge") = {1}; Physical Surface("wall") = {2}; Physical Surface("block") = {3};
Physical Curve("left") = {4}; Physical Curve("right") = {2}; Physical Curve("head") = {3};
Physical Curve("wall_face") = {6}; Physical Curve("block_face") = {12}; Physical Curve("wall_back") = {8}; Physical Curve("block_back") = {10};
