// Half of a strip between a vee die and a punch. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
t = 2; L = 25;
Point(1) = {0,0,0}; Point(2) = {L,0,0}; Point(3) = {L,t,0}; Point(4) = {0,t,0};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1};
Curve Loop(1) = {1,2,3,4}; Plane Surface(1) = {1};
Transfinite Curve {1,3} = Ceil(60 * refine) + 1; Transfinite Curve {2,4} = Ceil(4 * refine) + 1;
Transfinite Surface {1}; Recombine Surface {1};
// vee die of 90 degrees, opening 2*16, shoulder radius 2, bottom radius 1
w = 16; r = 2; s = Sqrt(2)/2;
// flank direction (1,1); shoulder arc from flank to the flat; centre (w+r*Tan(22.5deg).., -r)
cx = w + r*Tan(Pi/8);
Point(10) = {cx,-r,0}; Point(11) = {cx,0,0,0.4 / refine}; Point(12) = {cx - r*s,-r+r*s,0,0.4 / refine};
Point(13) = {40,0,0,3};
// flank down to the bottom arc: tangent point for radius b about (0,yb)
b = 1; ax = b*s; 
Point(14) = {ax, (-r+r*s) - (cx-r*s-ax), 0, 0.3};
Point(15) = {0, (-r+r*s) - (cx-r*s-ax) + b*s, 0};
Point(16) = {0, (-r+r*s) - (cx-r*s-ax) + b*s - b, 0, 0.3};
Line(10) = {13,11}; Circle(11) = {11,10,12}; Line(12) = {12,14}; Circle(13) = {14,15,16};
// punch: radius 3, flanks 45 degrees
q = 3;
Point(20) = {0,t,0,0.3 / refine}; Point(21) = {0,t+q,0}; Point(22) = {q*s,t+q-q*s,0,0.3 / refine};
Point(23) = {q*s+12,t+q-q*s+12,0,1};
Circle(20) = {20,21,22}; Line(21) = {22,23};
Physical Surface("strip") = {1};
Physical Curve("middle") = {4}; Physical Curve("bottom") = {1}; Physical Curve("top") = {3};
Physical Curve("die") = {10,11,12,13}; Physical Curve("punch") = {20,21};
