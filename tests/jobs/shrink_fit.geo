// A hub shrunk on a hollow shaft, a quarter of the cross-section. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
bore = 10;          // radius
fit = 25;           // radius of the interface
rim = 50;           // radius
DefineConstant[ overlap = {0.025, Name "on the radius: 0.1 % of it"} ];
h_shaft = 1.9 / refine;      // element sizes
h_hub = 2.4 / refine;

Point(1) = {0, 0, 0};
Point(2) = {bore, 0, 0, h_shaft};
Point(3) = {fit + overlap, 0, 0, h_shaft};
Point(4) = {0, fit + overlap, 0, h_shaft};
Point(5) = {0, bore, 0, h_shaft};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Point(12) = {fit, 0, 0, h_hub};
Point(13) = {rim, 0, 0, 2 * h_hub};
Point(14) = {0, rim, 0, 2 * h_hub};
Point(15) = {0, fit, 0, h_hub};
Line(11) = {12, 13};
Circle(12) = {13, 1, 14};
Line(13) = {14, 15};
Circle(14) = {15, 1, 12};
Curve Loop(2) = {11, 12, 13, 14};
Plane Surface(2) = {2};
Recombine Surface{1, 2};

Physical Surface("shaft") = {1};
Physical Surface("hub") = {2};
Physical Curve("shaft_skin") = {2};
Physical Curve("hub_bore") = {14};
Physical Curve("hub_rim") = {12};
Physical Curve("symmetry_x") = {3, 13};
Physical Curve("symmetry_y") = {1, 11};
