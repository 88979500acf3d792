// Half of a ferrule around a rod, axisymmetric. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.5 / refine;
Point(1) = {0,0,0}; Point(2) = {5,0,0}; Point(3) = {5,14,0}; Point(4) = {0,14,0};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1};
Point(5) = {5.1,0,0}; Point(6) = {6.3,0,0}; Point(7) = {6.3,3,0}; Point(8) = {6.3,8,0}; Point(9) = {5.1,8,0};
Line(5) = {5,6}; Line(6) = {6,7}; Line(7) = {7,8}; Line(8) = {8,9}; Line(9) = {9,5};
Curve Loop(1) = {1,2,3,4}; Plane Surface(1) = {1}; Curve Loop(2) = {5,6,7,8,9}; Plane Surface(2) = {2};
Transfinite Curve {1,3} = Ceil(5*refine) + 1; Transfinite Curve {2,4} = Ceil(20*refine) + 1; Transfinite Surface {1};
Transfinite Curve {5,8} = Ceil(3*refine) + 1; Transfinite Curve {6} = Ceil(6*refine) + 1;
Transfinite Curve {7} = Ceil(10*refine) + 1;
Transfinite Curve {9} = Ceil(6*refine) + Ceil(10*refine) + 1; Transfinite Surface {2} = {5,6,8,9};
Recombine Surface {1,2};
Physical Surface("rod") = {1}; Physical Surface("ferrule") = {2};
Physical Curve("axis") = {4}; Physical Curve("middle") = {1,5}; Physical Curve("band") = {6};
Physical Curve("skin") = {2}; Physical Curve("bore") = {9};
