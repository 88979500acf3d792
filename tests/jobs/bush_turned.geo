// A stabiliser bar's bush: a D-shaped rubber in a steel bracket, with a round bar in its bore; plane. The bar is a
// rigid line, larger than the bore. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  bar = {10.2, Name "radius of the bar"}, bore = {10, Name "radius of the bore"},
  width = {16, Name "half the width of the rubber"}, corner = {3, Name "radius of its lower corners"},
  plate = {3, Name "thickness of the bracket"}
];
size = 1 / refine;
Point(1) = {0, 0, 0, size};
For i In {0 : 1} // bar, bore
  r = i ? bore : bar;
  For j In {0 : 3}
    Point(10 + 10 * i + j) = {r * Cos(j * Pi / 2), r * Sin(j * Pi / 2), 0, size};
  EndFor
  For j In {0 : 3}
    Circle(10 + 10 * i + j) = {10 + 10 * i + j, 1, 10 + 10 * i + (j + 1) % 4};
  EndFor
EndFor
Function Shape // of the letter D on its side, w wide on either side of x = 0, corners of radius c
  Point(o) = {w, 0, 0, size};
  Point(o + 1) = {0, w, 0, size};
  Point(o + 2) = {-w, 0, 0, size};
  Point(o + 3) = {-w, -width + corner, 0, size};
  Point(o + 4) = {-w + c, -w, 0, size};
  Point(o + 5) = {w - c, -w, 0, size};
  Point(o + 6) = {w, -width + corner, 0, size};
  Circle(o) = {o, 1, o + 1};
  Circle(o + 1) = {o + 1, 1, o + 2};
  Line(o + 2) = {o + 2, o + 3};
  Circle(o + 3) = {o + 3, 7, o + 4};
  Line(o + 4) = {o + 4, o + 5};
  Circle(o + 5) = {o + 5, 8, o + 6};
  Line(o + 6) = {o + 6, o};
  Curve Loop(o) = {o : o + 6};
Return
Point(7) = {-width + corner, -width + corner, 0, size};
Point(8) = {width - corner, -width + corner, 0, size};
o = 30; w = width; c = corner; Call Shape; // rubber
o = 40; Call Shape; // bracket inside
o = 50; w = width + plate; c = corner + plate; Call Shape; // bracket outside
Curve Loop(20) = {20 : 23};
Plane Surface(1) = {30, 20};
Plane Surface(2) = {50, 40};

Physical Surface("rubber") = {1};
Physical Surface("bracket") = {2};
Physical Curve("bar") = {10 : 13};
Physical Curve("bore") = {20 : 23};
Physical Curve("rubber_skin") = {30 : 36};
Physical Curve("bracket_inside") = {40 : 46};
Physical Curve("bracket_outside") = {50 : 56};
