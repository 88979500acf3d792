// The rubber head of a syringe's plunger, with two ribs, above a barrel with a conical mouth; axisymmetric, mm
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  bore = {6, Name "radius of the barrel inside"}, core = {5.55, Name "radius of the head between the ribs"},
  rib = {0.8, Name "radius of the ribs"}, wall = {1, Name "thickness of the barrel"}
];
h = 0.35 / refine;
Point(1) = {0, 0, 0, 2 * h};
Point(2) = {core - 0.5, 0, 0, h};
Point(3) = {core, 0.4, 0, h};
Point(4) = {core, 0.4 + rib, 0, h};       // centres of the ribs
Point(5) = {core + rib, 0.4 + rib, 0, h};
Point(6) = {core, 0.4 + 2 * rib, 0, h};
Point(7) = {core, 6, 0, h};
Point(8) = {core, 6 + rib, 0, h};
Point(9) = {core + rib, 6 + rib, 0, h};
Point(10) = {core, 6 + 2 * rib, 0, h};
Point(11) = {core, 8.4, 0, h};
Point(12) = {0, 8.4, 0, 2 * h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Circle(3) = {3, 4, 5};
Circle(4) = {5, 4, 6};
Line(5) = {6, 7};
Circle(6) = {7, 8, 9};
Circle(7) = {9, 8, 10};
Line(8) = {10, 11};
Line(9) = {11, 12};
Line(10) = {12, 1};
Curve Loop(1) = {1 : 10};
Plane Surface(1) = {1};
Point(21) = {bore, -16, 0, h};
Point(22) = {bore + wall, -16, 0, h};
Point(23) = {bore + wall, 0, 0, h};
Point(24) = {bore + 0.8 * wall, 0, 0, h};
Point(25) = {bore, -2, 0, h};
Line(21) = {21, 22};
Line(22) = {22, 23};
Line(23) = {23, 24};
Line(24) = {24, 25};
Line(25) = {25, 21};
Curve Loop(2) = {21 : 25};
Plane Surface(2) = {2};

Physical Surface("head") = {1};
Physical Surface("barrel") = {2};
Physical Curve("skin") = {2 : 8};
Physical Curve("top") = {9};
Physical Curve("axis") = {10};
Physical Curve("base") = {21};
Physical Curve("bore") = {24, 25};
