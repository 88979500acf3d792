// A quarter of a pyramid on a block; the planes x = 0 and y = 0 are planes of symmetry. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  half_angle = {68, Name "between the faces and the axis, degrees"}
];
h = 0.1 / refine;
H = 0.5 / refine;
b = 1; // half of the side of the pyramid's base
z = b / Tan(half_angle * Pi / 180);
top = z + 0.7;
Point(1) = {0, 0, 0, h};
Point(2) = {b, 0, z, H};
Point(3) = {b, b, z, H};
Point(4) = {0, b, z, H};
Point(5) = {0, 0, top, H}; Point(6) = {b, 0, top, H}; Point(7) = {b, b, top, H}; Point(8) = {0, b, top, H};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Line(5) = {1, 3};
Line(11) = {5, 6}; Line(12) = {6, 7}; Line(13) = {7, 8}; Line(14) = {8, 5};
Line(21) = {1, 5}; Line(22) = {2, 6}; Line(23) = {3, 7}; Line(24) = {4, 8};
Curve Loop(1) = {1, 2, -5}; Plane Surface(1) = {1};
Curve Loop(2) = {5, 3, 4}; Plane Surface(2) = {2};
face() = {1, 2};
Curve Loop(3) = {11, 12, 13, 14}; Plane Surface(3) = {3};
Curve Loop(4) = {1, 22, -11, -21}; Plane Surface(4) = {4};
Curve Loop(5) = {2, 23, -12, -22}; Plane Surface(5) = {5};
Curve Loop(6) = {3, 24, -13, -23}; Plane Surface(6) = {6};
Curve Loop(7) = {4, 21, -14, -24}; Plane Surface(7) = {7};
Surface Loop(1) = {face(), 3:7};
Volume(1) = {1};
c = 2;
Point(31) = {0, 0, 0, h}; Point(32) = {c, 0, 0, H}; Point(33) = {c, c, 0, H}; Point(34) = {0, c, 0, H};
Point(35) = {0, 0, -c, H}; Point(36) = {c, 0, -c, H}; Point(37) = {c, c, -c, H}; Point(38) = {0, c, -c, H};
Line(31) = {31, 32}; Line(32) = {32, 33}; Line(33) = {33, 34}; Line(34) = {34, 31};
Line(41) = {35, 36}; Line(42) = {36, 37}; Line(43) = {37, 38}; Line(44) = {38, 35};
Line(51) = {31, 35}; Line(52) = {32, 36}; Line(53) = {33, 37}; Line(54) = {34, 38};
Curve Loop(31) = {31:34}; Plane Surface(31) = {31};
Curve Loop(32) = {41:44}; Plane Surface(32) = {32};
Curve Loop(33) = {31, 52, -41, -51}; Plane Surface(33) = {33};
Curve Loop(34) = {32, 53, -42, -52}; Plane Surface(34) = {34};
Curve Loop(35) = {33, 54, -43, -53}; Plane Surface(35) = {35};
Curve Loop(36) = {34, 51, -44, -54}; Plane Surface(36) = {36};
Surface Loop(2) = {31:36};
Volume(2) = {2};
Physical Volume("pyramid") = {1};
Physical Volume("block") = {2};
Physical Surface("point") = {face()};
Physical Surface("back") = {3};
Physical Surface("on_x") = {7, 36};
Physical Surface("on_y") = {4, 33};
Physical Surface("top") = {31};
Physical Surface("foot") = {32};
