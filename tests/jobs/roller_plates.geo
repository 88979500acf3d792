// Half of a cylindrical roller between two plates; in the plane. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
R = 10; fine = 0.05 / refine; coarse = 2 / refine; z = 1;
a = z/R;
Point(1) = {0, 0, 0, coarse}; Point(2) = {0, -R, 0, fine}; Point(3) = {R*Sin(a), -R*Cos(a), 0, fine}; Point(4) = {R, 0, 0, coarse};
Point(5) = {R*Sin(a), R*Cos(a), 0, fine}; Point(6) = {0, R, 0, fine};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 6}; Line(5) = {6, 1}; Line(6) = {1, 2};
Curve Loop(1) = {1 : 6}; Plane Surface(1) = {1};
Macro Plate
  Point(b) = {0, s*R, 0, fine*1.3}; Point(b + 1) = {z, s*R, 0, fine*1.3}; Point(b + 2) = {20, s*R, 0, coarse}; Point(b + 3) = {20, s*(R + 20), 0, coarse}; Point(b + 4) = {0, s*(R + 20), 0, coarse};
  For i In {0 : 3}
    Line(b + i) = {b + i, b + i + 1};
  EndFor
  Line(b + 4) = {b + 4, b};
  Curve Loop(b) = {b : b + 4}; Plane Surface(b) = {b};
Return
b = 10; s = 1; Call Plate;
b = 20; s = -1; Call Plate;
Physical Surface("roller") = {1}; Physical Surface("upper") = {10}; Physical Surface("lower") = {20};
Physical Curve("roller_low") = {1, 2}; Physical Curve("roller_high") = {3, 4};
Physical Curve("upper_face") = {10, 11}; Physical Curve("lower_face") = {20, 21};
Physical Curve("upper_back") = {13}; Physical Curve("lower_back") = {23};
Physical Curve("middle") = {5, 6, 14, 24};
