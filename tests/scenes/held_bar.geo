// A bar along y in two halves, in the plane, about the axis x = 0, or in space.
DefineConstant[
  width = {1, Name "width, or radius"}, length = {2, Name "length"}, depth = {1.5, Name "depth in space"},
  n = {2, Name "elements across"}, solid = {0, Name "1: in space"}, tri = {0, Name "1: triangles or tetrahedra"}
];
For j In {0 : 2}
  Point(1 + 2 * j) = {0, j * length / 2, 0};
  Point(2 + 2 * j) = {width, j * length / 2, 0};
  Line(1 + j) = {1 + 2 * j, 2 + 2 * j};
EndFor
For j In {0 : 1}
  Line(11 + 2 * j) = {1 + 2 * j, 3 + 2 * j};
  Line(12 + 2 * j) = {2 + 2 * j, 4 + 2 * j};
  Curve Loop(1 + j) = {1 + j, 12 + 2 * j, -(2 + j), -(11 + 2 * j)};
  Plane Surface(1 + j) = {1 + j};
EndFor
Transfinite Curve{1 : 3} = n + 1;
Transfinite Curve{11 : 14} = 2 * n + 1;
Transfinite Surface{:};
If (!tri)
  Recombine Surface{:};
EndIf
If (solid)
  For j In {0 : 1}
    If (tri)
      out() = Extrude {0, 0, depth} { Surface{1 + j}; Layers{n}; };
    Else
      out() = Extrude {0, 0, depth} { Surface{1 + j}; Layers{n}; Recombine; };
    EndIf
    volume(j) = out(1);
    low(j) = out(2);
    right(j) = out(3);
    high(j) = out(4);
    left(j) = out(5);
    front(j) = out(0);
  EndFor
  Physical Volume("bar") = {volume(0), volume(1)};
  Physical Surface("low") = {low(0)};
  Physical Surface("middle") = {high(0)};
  Physical Surface("high") = {high(1)};
  Physical Surface("left") = {left(0), left(1)};
  Physical Surface("right") = {right(0), right(1)};
  Physical Surface("back") = {1, 2};
  Physical Surface("front") = {front(0), front(1)};
Else
  Physical Surface("bar") = {1, 2};
  Physical Curve("low") = {1};
  Physical Curve("middle") = {2};
  Physical Curve("high") = {3};
  Physical Curve("left") = {11, 13};
  Physical Curve("right") = {12, 14};
EndIf
