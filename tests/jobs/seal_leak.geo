// A gasket with a round bead, seen in the plane; the bead's lowest point touches y = 0. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
fine = 0.1 / refine; coarse = 0.5 / refine;
R = 1.5; w = 3; h = 1.5;
Point(1) = {0, R, 0, coarse}; // centre of the bead
Point(2) = {-R, R, 0, 3*fine}; Point(3) = {0, 0, 0, fine}; Point(4) = {R, R, 0, 3*fine};
Point(5) = {w, R, 0, coarse}; Point(6) = {w, R + h, 0, coarse}; Point(7) = {-w, R + h, 0, coarse}; Point(8) = {-w, R, 0, coarse};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4};
Line(3) = {4, 5}; Line(4) = {5, 6}; Line(5) = {6, 7}; Line(6) = {7, 8}; Line(7) = {8, 2};
Curve Loop(1) = {1 : 7}; Plane Surface(1) = {1};
Physical Surface("gasket") = {1};
Physical Curve("bead") = {7, 1, 2, 3};
Physical Curve("back") = {5};
Physical Point("inlet") = {8};
