// Block below a ball, axisymmetric. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
n = Ceil(16 * refine); L = 12;
Point(1) = {0,0,0}; Point(2) = {3,0,0}; Point(3) = {3,-3,0}; Point(4) = {0,-3,0};
Point(5) = {L,0,0}; Point(6) = {L,-L,0}; Point(7) = {0,-L,0};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1};
Line(5) = {2,5}; Line(6) = {5,6}; Line(7) = {6,7}; Line(8) = {7,4}; Line(9) = {3,6};
Curve Loop(1) = {1,2,3,4}; Plane Surface(1) = {1};
Curve Loop(2) = {5,6,-9,-2}; Plane Surface(2) = {2};
Curve Loop(3) = {9,7,8,-3}; Plane Surface(3) = {3};
Transfinite Curve {1,2,3,4,6,7} = n + 1; Transfinite Curve {5,-8,9} =
  Ceil(8 * refine) + 1 Using Progression 1.25^(1/refine);
Transfinite Surface {1,2,3}; Recombine Surface {1,2,3};
Physical Surface("block") = {1,2,3};
Physical Curve("top") = {1,5}; Physical Curve("axis") = {4,8}; Physical Curve("foot") = {7};
