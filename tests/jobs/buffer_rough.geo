// A hollow rubber buffer; axisymmetric, upper half, mm
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 1/refine;
Point(1) = {6,0,0,h}; Point(2) = {15,0,0,h}; Point(3) = {15,20,0,h}; Point(4) = {6,20,0,h};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Physical Surface("buffer") = {1}; Physical Curve("skin") = {1:4};
