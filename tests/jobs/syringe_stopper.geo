// The meridian plane of a stopper with two ribs above the barrel of a syringe; x = r, y = z. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
size = 0.25 / refine; rib = 5.25;
Point(1) = {0, 2.5, 0, size}; Point(2) = {4.2, 1, 0, size}; Point(3) = {4.9, 1.5, 0, size};
Point(4) = {rib, 2, 0, size}; Point(5) = {rib, 2.6, 0, size}; Point(6) = {4.7, 3.2, 0, size};
Point(7) = {4.7, 5, 0, size}; Point(8) = {rib, 5.6, 0, size}; Point(9) = {rib, 6.4, 0, size};
Point(10) = {4.8, 7, 0, size}; Point(11) = {2.2, 7, 0, size}; Point(12) = {2.2, 4.5, 0, size};
Point(13) = {0, 4.5, 0, size};
For i In {1 : 12}
  Line(i) = {i, i + 1};
EndFor
Line(13) = {13, 1};
Curve Loop(1) = {1 : 13};
Plane Surface(1) = {1};
Point(21) = {6.6, 2.4, 0, size}; Point(22) = {5.4, 0.8, 0, size}; Point(23) = {5, -0.6, 0, size};
Point(24) = {5, -14, 0, size}; Point(25) = {6, -14, 0, size}; Point(26) = {6, -1, 0, size};
Point(27) = {7.2, 2.2, 0, size};
Spline(21) = {21, 22, 23};
Line(22) = {23, 24}; Line(23) = {24, 25}; Line(24) = {25, 26}; Line(25) = {26, 27}; Line(26) = {27, 21};
Curve Loop(2) = {21 : 26};
Plane Surface(2) = {2};
Physical Surface("stopper") = {1};
Physical Surface("barrel") = {2};
Physical Curve("skin") = {3 : 9};
Physical Curve("axis") = {13};
Physical Curve("rod") = {11, 12};
Physical Curve("bore") = {21, 22};
Physical Curve("base") = {23};
