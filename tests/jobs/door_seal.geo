// A hollow door seal, pressed by the rounded edge of a blade from above, 1.5 mm beside its middle. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
fine = 0.35 / refine; coarse = 1.0 / refine;
R = 8; th = 1.6; c = 6;
Point(1) = {0, c, 0};
Point(2) = {R, c, 0, fine}; Point(3) = {0, c + R, 0, fine}; Point(4) = {-R, c, 0, fine};
Point(5) = {-R, 0, 0, fine}; Point(6) = {R, 0, 0, fine};
Point(7) = {R - th, c, 0, fine}; Point(8) = {0, c + R - th, 0, fine}; Point(9) = {-R + th, c, 0, fine};
Point(10) = {-R + th, 2, 0, fine}; Point(11) = {R - th, 2, 0, fine};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Line(4) = {5, 6}; Line(5) = {6, 2};
Circle(6) = {7, 1, 8}; Circle(7) = {8, 1, 9}; Line(8) = {9, 10}; Line(9) = {10, 11}; Line(10) = {11, 7};
Curve Loop(1) = {1 : 5}; Curve Loop(2) = {6 : 10}; Plane Surface(1) = {1, 2};
// blade
bx = 1.5; rt = 1; top = c + Sqrt(R*R - 0) + 0.3;
Point(21) = {bx, top + rt, 0}; Point(22) = {bx - rt, top + rt, 0, fine/2}; Point(23) = {bx, top, 0, fine/2}; Point(24) = {bx + rt, top + rt, 0, fine/2};
Point(25) = {bx + rt, top + 10, 0, coarse}; Point(26) = {bx - rt, top + 10, 0, coarse};
Circle(21) = {22, 21, 23}; Circle(22) = {23, 21, 24}; Line(23) = {24, 25}; Line(24) = {25, 26}; Line(25) = {26, 22};
Curve Loop(3) = {21 : 25}; Plane Surface(3) = {3};
Physical Surface("seal") = {1}; Physical Surface("blade") = {3};
Physical Curve("seal_skin") = {1, 2}; Physical Curve("seal_foot") = {4};
Physical Curve("blade_skin") = {21, 22, 23, 25}; Physical Curve("blade_top") = {24};
